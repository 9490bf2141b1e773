// A map at many points, such as the vertices of a mesh: images, derivatives and distortion.
//
// The rows of the basis at the points are kept, so a new map costs a product or two.

import {
  coordinatesAt,
  emptyRows,
  evenly,
  quarters,
  rowsAt,
  samplesAt,
  slopesOf,
} from "./basis.js";
import { complexOf } from "./domain.js";

/** @import { Point } from "../types.js" */
/** @import { Domain } from "./domain.js" */
/** @import { Rows } from "./basis.js" */
/** @import { Coefficients, Samples } from "./types.js" */

/**
 * A map at k points. Outside the cage the values mean nothing.
 * @typedef {object} Field
 * @property {Float64Array} images x and y of each point in turn, 2 k numbers
 * @property {Samples} samples [Re f_z, Im f_z, Re conj(f_zbar), Im conj(f_zbar)], k numbers each
 */

export class FieldPoints {
  #domain;
  #points;
  #coordinates;
  /** @type {Rows | null} made when they are first asked for */
  #rows = null;

  /**
   * @param {Domain} domain
   * @param {Point[]} points
   */
  constructor(domain, points) {
    const { columns } = domain;
    this.#domain = domain;
    this.#points = complexOf(points);
    this.count = points.length;
    this.#coordinates = emptyRows(points.length, columns);
    for (const [i, point] of points.entries()) {
      const c = coordinatesAt(domain, point);
      this.#coordinates.re.set(c.re, i * evenly(columns));
      this.#coordinates.im.set(c.im, i * evenly(columns));
    }
  }

  /**
   * @param {Coefficients} coefficients
   * @returns {Field}
   */
  evaluate(coefficients) {
    return { images: this.images(coefficients), samples: this.samples(coefficients) };
  }

  /**
   * Images sum C phi + conj(sum C psi).
   * @param {Coefficients} coefficients
   */
  images(coefficients) {
    const [fr, fi, gr, gi] = quarters(samplesAt(this.#coordinates, coefficients));
    const images = new Float64Array(2 * this.count);
    for (let i = 0; i < this.count; i++) {
      images[2 * i] = fr[i] + gr[i];
      images[2 * i + 1] = fi[i] - gi[i];
    }
    return images;
  }

  /** @param {Coefficients} coefficients */
  samples(coefficients) {
    this.#rows ??= rowsAt(this.#domain, this.#points);
    return samplesAt(this.#rows, slopesOf(this.#domain, coefficients));
  }
}

/**
 * The singular values sigma_1 and sigma_2 and the dilatation k at each point.
 * @param {Samples} samples
 */
export function distortionOf(samples) {
  const count = samples.length / 4;
  const [fr, fi, gr, gi] = quarters(samples);
  const sigma1 = new Float64Array(count);
  const sigma2 = new Float64Array(count);
  const k = new Float64Array(count);
  for (let i = 0; i < count; i++) {
    const f = Math.sqrt(fr[i] * fr[i] + fi[i] * fi[i]);
    const g = Math.sqrt(gr[i] * gr[i] + gi[i] * gi[i]);
    sigma1[i] = f + g;
    sigma2[i] = f - g;
    k[i] = g / f;
  }
  return { sigma1, sigma2, k };
}
