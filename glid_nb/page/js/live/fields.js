// A map at many points, such as the vertices of a mesh: images, derivatives and distortion.
//
// The rows of the basis at the points are kept, so a new map costs two products.

import { coordinatesAt, quarters, rowsAt, samplesAt, slopesOf } from "./basis.js";
import { complexOf, zeros } from "./domain.js";

/** @import { Point } from "../types.js" */
/** @import { Domain } from "./domain.js" */
/** @import { Coefficients, Complex, Samples } from "./types.js" */

/**
 * A map at k points. Outside the cage the values mean nothing.
 * @typedef {object} Field
 * @property {Float64Array} images x and y of each point in turn, 2 k numbers
 * @property {Samples} samples [Re f_z, Im f_z, Re conj(f_zbar), Im conj(f_zbar)], k numbers each
 */

export class FieldPoints {
  #domain;
  #coordinates;
  #rows;

  /**
   * @param {Domain} domain
   * @param {Point[]} points
   */
  constructor(domain, points) {
    const { columns } = domain;
    this.#domain = domain;
    this.count = points.length;
    this.#coordinates = zeros(points.length * columns);
    for (const [i, point] of points.entries()) {
      const c = coordinatesAt(domain, point);
      this.#coordinates.re.set(c.re, i * columns);
      this.#coordinates.im.set(c.im, i * columns);
    }
    this.#rows = rowsAt(domain, complexOf(points));
  }

  /**
   * @param {Coefficients} coefficients
   * @returns {Field}
   */
  evaluate(coefficients) {
    const slopes = slopesOf(this.#domain, coefficients);
    return {
      images: imagesAt(this.#coordinates, this.count, coefficients),
      samples: samplesAt(this.#rows, slopes),
    };
  }
}

/**
 * Images sum C phi + conj(sum C psi).
 * @param {Complex} coordinates row by row
 * @param {number} count
 * @param {Coefficients} coefficients
 */
function imagesAt({ re, im }, count, coefficients) {
  const images = new Float64Array(2 * count);
  const n = coefficients.length / 4;
  const [pr, pi, qr, qi] = quarters(coefficients);
  const sum = { re: pr.map((value, j) => value + qr[j]), im: pi.map((value, j) => value + qi[j]) };
  const less = { re: pr.map((value, j) => value - qr[j]), im: pi.map((value, j) => value - qi[j]) };
  for (let i = 0; i < count; i++) {
    const first = i * n;
    let x = 0;
    let y = 0;
    for (let j = 0; j < n; j++) {
      x += re[first + j] * sum.re[j] - im[first + j] * sum.im[j];
      y += re[first + j] * less.im[j] + im[first + j] * less.re[j];
    }
    images[2 * i] = x;
    images[2 * i + 1] = y;
  }
  return images;
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
