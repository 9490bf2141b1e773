// Bounds in words, rounded to what is still a bound.

/** @import { MotionData } from "./data.js" */

/** @param {number} x */
export function down(x) {
  return (Math.floor(1000 * x) / 1000).toFixed(3);
}

/**
 * A positive number, of which something is seen however small it is.
 *
 * @param {number} x
 */
export function downSmall(x) {
  if (!(x > 0) || x >= 0.01) return down(x);
  const power = Math.floor(Math.log10(x));
  const digits = Math.floor((0.999999 * x) / 10 ** (power - 1)) / 10;
  return `${digits}e${power}`;
}

/** @param {number} x */
export function up(x) {
  return (Math.ceil(1000 * x) / 1000).toFixed(3);
}

/**
 * What is proved at a time for all shapes.
 *
 * @param {{ proof: MotionData, piece: number }[]} shapes their proofs, and the pieces with that time
 * @param {number} time
 */
export function provedNow(shapes, time) {
  const low = worstOf(
    shapes.map(({ proof, piece }) => proof.sigma2[piece]),
    Math.min,
  );
  const high = worstOf(
    shapes.map(({ proof, piece }) => proof.sigma1[piece]),
    Math.max,
  );
  const most = worstOf(
    shapes.map(({ proof, piece }) => proof.k[piece]),
    Math.max,
  );
  if (low !== null && high !== null && most !== null) {
    return `Now: σ₂ ≥ ${down(low)}, σ₁ ≤ ${up(high)}, k ≤ ${up(most)}`;
  }
  const folds = shapes.some(({ proof }) => time >= proof.until);
  return folds ? "Now: not proved" : "Now: proved not to fold";
}

/**
 * The bound on sigma_2 that is proved at a time for all shapes; negative where one is not proved.
 *
 * @param {{ proof: MotionData, piece: number }[]} shapes
 * @param {number} time
 */
export function sigma2At(shapes, time) {
  if (shapes.some(({ proof }) => time >= proof.until)) return -1;
  return Math.min(...shapes.map(({ proof, piece }) => proof.sigma2[piece] ?? 0));
}

/**
 * @param {(number | null)[]} bounds null where nothing is proved
 * @param {(...values: number[]) => number} worst
 */
function worstOf(bounds, worst) {
  const known = bounds.filter((bound) => bound !== null);
  return known.length < bounds.length ? null : worst(...known);
}
