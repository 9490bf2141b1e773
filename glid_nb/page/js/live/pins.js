// The energy of the pins (Section 6.1, (F.1)): 1/2 sum w (row . coefficients - aim)^2.
//
// Every pin has two rows for its image. Angles and scales add two rows for f_z at their pins, along and
// across one direction: that of the map's own f_z, turned towards the wanted angle by at most one
// radian. `glid_nb/solvers/problem.py` has the same rows.

import { coordinatesAt, derivativesOf, fillRow } from "./basis.js";
import { dot } from "./dense.js";
import { zeros } from "./domain.js";

/** @import { Shape } from "./shape.js" */
/** @import { Coefficients, Complex, Pose } from "./types.js" */

const TURN = 10; // weight of f_z at a pin, relative to the weight of the pin's image
// Larger weights of an image or of f_z would hide the distortion in rounding errors.
const MOST = 2.5e10;
const MOST_TURN = 1e13;
const FARTHEST_TURN = 1; // radians between two measurements
const SAME_DIRECTION = 1e-4; // radians

/**
 * @typedef {object} Row
 * @property {Float64Array} row derivatives with respect to the coefficients
 * @property {Float64Array} reduced derivatives with respect to the whitened coordinates
 * @property {number} aim
 * @property {number} weight
 */

export class Pins {
  /**
   * @param {Shape} shape
   * @param {Pose} pose
   * @param {number} weight lambda of (20), for lengths in twentieths of the cage's longer side
   */
  constructor(shape, pose, weight) {
    this.shape = shape;
    this.pose = pose;
    this.weight = weight;
    this.coordinates = pose.handles.map((handle) => coordinatesAt(shape.domain, handle));
    this.derivatives = turnedPins(pose).map((i) => derivativesAt(shape, pose.handles[i]));
    const { unit } = shape.domain;
    /** @type {Row[]} */
    this.images = this.coordinates.flatMap((c, i) => {
      const firm = pose.weights?.[i] ?? 1;
      const held = (Math.min(weight, MOST / firm) * firm) / (unit * unit);
      const [x, y] = pose.targets[i];
      const rows = imageRows(c);
      return [this.#row(rows[0], x, held), this.#row(rows[1], y, held)];
    });
    /** @type {Row[]} */
    this.turns = [];
  }

  get rows() {
    return [...this.images, ...this.turns];
  }

  /** Whether angles or scales are held. */
  get turned() {
    return this.derivatives.length > 0;
  }

  /**
   * Moves the targets.
   * @param {Pose} pose with the same handles
   */
  aim(pose) {
    this.pose = pose;
    for (const [i, [x, y]] of pose.targets.entries()) {
      this.images[2 * i].aim = x;
      this.images[2 * i + 1].aim = y;
    }
  }

  /**
   * Measures angles and scales from a map.
   * @param {Coefficients} coefficients
   * @param {number} damping enlarges the weight across the direction of a scale without an angle
   */
  measure(coefficients, damping) {
    this.turns = turnedPins(this.pose).flatMap((i, place) => {
      const d = this.derivatives[place];
      const [re, im] = productOf(d, coefficients);
      const size = Math.hypot(re, im);
      const own = Math.atan2(im, re);
      const angle = this.pose.angles?.[i] ?? null;
      const scale = this.pose.scales?.[i] ?? null;
      const left = angle === null ? 0 : wrapped(angle - own);
      const direction = own + Math.max(-FARTHEST_TURN, Math.min(FARTHEST_TURN, left));
      const [along, across] = turnRows(d, direction);
      const firm = this.pose.weights?.[i] ?? 1;
      const held = Math.min(TURN * this.weight, MOST_TURN / firm) * firm;
      const bent = scale === null ? 1 : bend(1 - scale / size, damping);
      return [
        this.#row(along, scale ?? 0, scale === null ? 0 : held),
        this.#row(across, 0, held * (angle === null ? bent : 1)),
      ];
    });
  }

  /**
   * How far the measured rows are from others, roughly in radians; 0 if that is little.
   * @param {Row[]} others
   */
  apartFrom(others) {
    if (others.length !== this.turns.length) {
      return Infinity;
    }
    let apart = 0;
    let alike = true;
    for (const [i, { row, weight }] of this.turns.entries()) {
      const gap = row.map((value, j) => value - others[i].row[j]);
      apart = Math.max(apart, Math.sqrt(dot(gap, gap) / dot(row, row)));
      alike = alike && Math.abs(weight - others[i].weight) <= 0.1 * (1 + weight);
    }
    return alike && apart <= SAME_DIRECTION ? 0 : Math.max(apart, SAME_DIRECTION);
  }

  /**
   * @param {Float64Array} row
   * @param {number} aim
   * @param {number} weight
   * @returns {Row}
   */
  #row(row, aim, weight) {
    return { row, reduced: this.shape.whitening.pulledBack(row), aim, weight };
  }

  /**
   * What is left of each row to its aim.
   * @param {Coefficients} coefficients
   */
  residual(coefficients) {
    return Float64Array.from(this.rows, ({ row, aim }) => dot(row, coefficients) - aim);
  }

  /**
   * The change of the residual along a direction.
   * @param {Coefficients} direction
   */
  change(direction) {
    return Float64Array.from(this.rows, ({ row }) => dot(row, direction));
  }

  /**
   * sum w a b of two residuals or changes.
   * @param {Float64Array} a
   * @param {Float64Array} b
   */
  product(a, b) {
    return this.rows.reduce((sum, { weight }, i) => sum + weight * a[i] * b[i], 0);
  }
}

/**
 * The numbers of the pins whose angle or scale is held.
 * @param {Pose} pose
 */
function turnedPins({ handles, angles, scales }) {
  const all = [...handles.keys()];
  return all.filter((i) => (angles?.[i] ?? null) !== null || (scales?.[i] ?? null) !== null);
}

/**
 * @param {Shape} shape
 * @param {[number, number]} point
 */
function derivativesAt({ domain }, [x, y]) {
  const row = zeros(domain.columns);
  fillRow(domain, x, y, row, 0);
  return derivativesOf(domain, row, 0);
}

/**
 * The rows of Re f and Im f, from C at a point.
 * @param {Complex} c
 */
function imageRows({ re, im }) {
  const minusRe = re.map((value) => -value);
  const minusIm = im.map((value) => -value);
  return [joined([re, minusIm, re, minusIm]), joined([im, re, minusIm, minusRe])];
}

/**
 * The rows of f_z along and across a direction, from D at a point.
 * @param {Complex} d
 * @param {number} direction
 */
function turnRows(d, direction) {
  const cos = Math.cos(direction);
  const sin = Math.sin(direction);
  const re = d.re.map((value, j) => value * cos + d.im[j] * sin);
  const im = d.im.map((value, j) => value * cos - d.re[j] * sin);
  const minusIm = im.map((value) => -value);
  const none = new Float64Array(re.length);
  return [joined([re, minusIm, none, none]), joined([im, re, none, none])];
}

/** @param {Float64Array[]} parts of equal length */
function joined(parts) {
  const size = parts[0].length;
  const whole = new Float64Array(parts.length * size);
  for (const [i, part] of parts.entries()) {
    whole.set(part, i * size);
  }
  return whole;
}

/**
 * d . phi.
 * @param {Complex} d
 * @param {Coefficients} coefficients
 */
function productOf(d, coefficients) {
  const n = d.re.length;
  let re = 0;
  let im = 0;
  for (let j = 0; j < n; j++) {
    re += d.re[j] * coefficients[j] - d.im[j] * coefficients[n + j];
    im += d.re[j] * coefficients[n + j] + d.im[j] * coefficients[j];
  }
  return [re, im];
}

/**
 * The curvature of |f_z| = scale across f_z, relative to that along it, where the strain is
 * 1 - scale / |f_z|.
 * @param {number} strain
 * @param {number} damping
 */
function bend(strain, damping) {
  return Math.min(1, Math.max(0, damping * strain, (1 - damping) * strain));
}

/**
 * An angle between -pi and pi.
 * @param {number} angle
 */
function wrapped(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}
