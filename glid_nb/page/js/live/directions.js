// Directions of descent: by a kept factor of a Hessian, improved by limited memory BFGS.

import { addScaled, dot, factorise, solveWith } from "./dense.js";

/** @import { Assembler } from "./hessian.js" */
/** @import { Energy } from "./energy.js" */
/** @import { Pins } from "./pins.js" */
/** @import { Samples } from "./types.js" */

const MEMORY = 30; // pairs of steps and changes of the gradient
const LEAST_CURVATURE = 1e-12; // of a pair, relative to the product of the norms
// Shifts of the diagonal, relative to its mean, if the projected Hessian is still not definite.
const RIDGES = [0, 1e-9, 1e-7, 1e-5, 1e-3, 1e-2];

/**
 * @typedef {object} Pair
 * @property {Float64Array} step
 * @property {Float64Array} change of the gradient
 * @property {number} curvature their product
 */

/** The inverse of a Hessian at an earlier map, and what was learned since. */
export class Metric {
  /** @type {Pair[]} */
  #pairs = [];

  /**
   * @param {Float64Array} isometric the lower half of the isometric energy's Hessian
   * @param {Float64Array} factor of Cholesky, with the pins' Hessian
   */
  constructor(isometric, factor) {
    this.isometric = isometric;
    this.factor = factor;
  }

  /**
   * Minus the approximate inverse Hessian times the gradient.
   * @param {Float64Array} gradient
   */
  direction(gradient) {
    const q = Float64Array.from(gradient);
    const shares = this.#pairs.map(() => 0);
    for (let i = this.#pairs.length - 1; i >= 0; i--) {
      const { step, change, curvature } = this.#pairs[i];
      shares[i] = dot(step, q) / curvature;
      addScaled(-shares[i], change, q);
    }
    const direction = solveWith(this.factor, q);
    for (const [i, { step, change, curvature }] of this.#pairs.entries()) {
      const share = dot(change, direction) / curvature;
      addScaled(shares[i] - share, step, direction);
    }
    return direction.map((value) => -value);
  }

  /**
   * Learns from a step.
   * @param {Float64Array} step
   * @param {Float64Array} change of the gradient
   */
  learn(step, change) {
    const curvature = dot(step, change);
    const sizes = Math.sqrt(dot(step, step) * dot(change, change));
    if (!(curvature > LEAST_CURVATURE * sizes)) {
      return;
    }
    this.#pairs.push({ step, change, curvature });
    if (this.#pairs.length > MEMORY) {
      this.#pairs.shift();
    }
  }
}

/**
 * The metric of the Hessian at a map: exact where that is positive definite, else projected; null if
 * neither can be factorised.
 * @param {Assembler} assembler
 * @param {Samples} samples
 * @param {Energy} energy
 * @param {Pins} pins
 */
export function metricAt(assembler, samples, energy, pins) {
  const exact = assembler.assemble(samples, energy, false);
  const metric = factorised(exact, pins, [0]);
  return metric ?? factorised(assembler.assemble(samples, energy, true), pins, RIDGES);
}

/**
 * The metric with other pins: a new factor of the same isometric Hessian.
 * @param {Metric} metric
 * @param {Pins} pins
 */
export function repinned(metric, pins) {
  return factorised(metric.isometric, pins, RIDGES);
}

/**
 * @param {Float64Array} isometric
 * @param {Pins} pins
 * @param {number[]} ridges to try
 */
function factorised(isometric, pins, ridges) {
  const size = Math.sqrt(isometric.length);
  for (const ridge of ridges) {
    const whole = withPins(withRidge(isometric, size, ridge), size, pins);
    if (factorise(whole, size)) {
      return new Metric(isometric, whole);
    }
  }
  return null;
}

/**
 * Adds the Hessian of the pins' energy to the lower half, in place.
 * @param {Float64Array} h
 * @param {number} size
 * @param {Pins} pins
 */
function withPins(h, size, pins) {
  for (const { reduced, weight } of pins.rows) {
    for (let i = 0; i < size; i++) {
      const x = weight * reduced[i];
      for (let j = 0; j <= i; j++) {
        h[i * size + j] += x * reduced[j];
      }
    }
  }
  return h;
}

/**
 * A copy with a larger diagonal.
 * @param {Float64Array} h
 * @param {number} size
 * @param {number} ridge
 */
function withRidge(h, size, ridge) {
  const shifted = Float64Array.from(h);
  let trace = 0;
  for (let i = 0; i < size; i++) {
    trace += h[i * size + i];
  }
  for (let i = 0; i < size; i++) {
    shifted[i * size + i] += (ridge * trace) / size;
  }
  return shifted;
}
