// The line search (Section 9.2): along a direction, samples are linear in the step.

const RATIO = 0.6; // of a step to the one before, while the energy does not fall enough
const LONGER = 1.3; // then steps are made longer, or shorter, by these ratios while that helps
const SHORTER = 0.75;
const LONGEST_STEP = 2;
const ARMIJO = 1e-4; // sufficient decrease, the constant c of Algorithm 1
const SAFETY = 0.7; // the longest step, as a fraction of the one that inverts the first sample
const LEAST_STEP = 1e-12;

/** @import { Samples } from "./types.js" */

/**
 * The step at which the first sample becomes inverted, or infinity: the first zero of
 * |f + t df|^2 - |g + t dg|^2, which is positive at t = 0.
 * @param {Samples} samples
 * @param {Samples} change
 */
export function largestStep(samples, change) {
  const count = samples.length / 4;
  let least = Infinity;
  for (let i = 0; i < count; i++) {
    const a = difference(change, change, i, count);
    const b = 2 * difference(samples, change, i, count);
    const c = difference(samples, samples, i, count);
    const discriminant = b * b - 4 * a * c;
    const denominator = Math.sqrt(Math.max(discriminant, 0)) - b;
    if (discriminant >= 0 && denominator > 0) {
      least = Math.min(least, (2 * c) / denominator);
    }
  }
  return least;
}

/**
 * |f|^2 - |g|^2 as a bilinear form, at node i.
 * @param {Samples} a
 * @param {Samples} b
 * @param {number} i
 * @param {number} count
 */
function difference(a, b, i, count) {
  const [j, k, l] = [count + i, 2 * count + i, 3 * count + i];
  return a[i] * b[i] + a[j] * b[j] - a[k] * b[k] - a[l] * b[l];
}

/**
 * The step with the least energy among those tried, or 0 if none lowers the energy enough.
 * @param {(t: number) => number} energyAt
 * @param {number} slope of the energy at 0
 * @param {number} largest the step that inverts the first sample
 */
export function search(energyAt, slope, largest) {
  const start = energyAt(0);
  const limit = SAFETY * largest;
  const first = Math.min(1, limit);
  let step = first;
  let energy = energyAt(step);
  while (!(energy < start + ARMIJO * step * slope)) {
    step *= RATIO;
    if (step < LEAST_STEP) {
      return 0;
    }
    energy = energyAt(step);
  }
  for (const ratio of step === first ? [LONGER, SHORTER] : [SHORTER]) {
    const better = followed(energyAt, step, energy, ratio, Math.min(LONGEST_STEP, limit));
    if (better !== step) {
      return better;
    }
  }
  return step;
}

/**
 * The last of the steps `step`, `ratio step`, ... while the energy falls.
 * @param {(t: number) => number} energyAt
 * @param {number} step
 * @param {number} energy
 * @param {number} ratio
 * @param {number} longest
 */
function followed(energyAt, step, energy, ratio, longest) {
  let best = step;
  let least = energy;
  for (let next = ratio * step; next <= longest && next > LEAST_STEP; next *= ratio) {
    const found = energyAt(next);
    if (!(found < least)) {
      break;
    }
    best = next;
    least = found;
  }
  return best;
}
