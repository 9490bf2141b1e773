// Coordinates in which the Hessian of an isometric energy is well conditioned.
//
// With phi = T x the derivatives D T are orthonormal along the boundary. T has a row for each column of
// the basis. Its columns are the translation, k single-valued functions, and one for each hole's
// logarithm: u = 1 + k + holes in all. Every column but the translation vanishes at one point of the
// boundary. Coordinates of a map are [Re phi (u), Im phi (u), Re psi (k), Im psi (k)]; the holes'
// coefficients of psi are conjugates of those of phi.

import { coordinatesAt, derivativesOf, evenly, quarters } from "./basis.js";
import { zeros } from "./domain.js";

/** @import { Rows } from "./basis.js" */
/** @import { Domain } from "./domain.js" */
/** @import { Panels } from "./panels.js" */
/** @import { Coefficients, Complex } from "./types.js" */

// Raises the Gram matrix's diagonal, relative to its mean, in case columns are dependent.
const RIDGE = 1e-13;

export class Whitening {
  /**
   * @param {Domain} domain
   * @param {Panels} panels
   * @param {Rows} rows of the basis at the panels' nodes
   */
  constructor(domain, panels, rows) {
    this.domain = domain;
    this.k = domain.free.length;
    this.u = 1 + this.k + domain.holes;
    /** Number of real coordinates of a map. */
    this.size = 2 * this.u + 2 * this.k;
    /** T, row by row. */
    this.t = zeros(domain.columns * this.u);
    const samples = scaledDerivatives(domain, panels, rows);
    const inverse = inverseFactor(gramMatrix(samples, domain.free), this.k);
    this.#setTranslation();
    this.#setSingleValued(inverse);
    for (let h = 0; h < domain.holes; h++) {
      this.#setLogarithm(h, inverse, samples);
    }
    this.#vanishAt(panels.nodes.re[0], panels.nodes.im[0]);
  }

  #setTranslation() {
    for (let j = 0; j < this.domain.exterior; j++) {
      this.t.re[j * this.u] = 1;
    }
  }

  /** @param {Complex} inverse V with V G V^H = I; T = V^H */
  #setSingleValued(inverse) {
    const { k, u, t } = this;
    for (let c = 0; c < k; c++) {
      for (let j = 0; j <= c; j++) {
        const place = this.domain.free[j] * u + 1 + c;
        t.re[place] = inverse.re[c * k + j];
        t.im[place] = -inverse.im[c * k + j];
      }
    }
  }

  /**
   * The column of a hole's logarithm, orthogonal to the single-valued functions.
   * @param {number} h
   * @param {Complex} inverse
   * @param {Scaled} samples
   */
  #setLogarithm(h, inverse, samples) {
    const { domain, k, u, t } = this;
    const column = domain.vertices + h;
    const projections = projectionsOn(samples, domain.free, column);
    const along = timesAdjoint(inverse, timesLower(inverse, projections, k), k);
    const rest = normOfRest(samples, domain.free, along, column);
    const place = 1 + k + h;
    for (let j = 0; j < k; j++) {
      t.re[domain.free[j] * u + place] = -along.re[j] / rest;
      t.im[domain.free[j] * u + place] = -along.im[j] / rest;
    }
    t.re[column * u + place] = 1 / rest;
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  #vanishAt(x, y) {
    const { domain, u, t } = this;
    const c = coordinatesAt(domain, [x, y]);
    for (let column = 1; column < u; column++) {
      let re = 0;
      let im = 0;
      for (let j = 0; j < domain.columns; j++) {
        const a = t.re[j * u + column];
        const b = t.im[j * u + column];
        re += c.re[j] * a - c.im[j] * b;
        im += c.re[j] * b + c.im[j] * a;
      }
      for (let j = 0; j < domain.exterior; j++) {
        t.re[j * u + column] -= re;
        t.im[j * u + column] -= im;
      }
    }
  }

  /**
   * The coefficients of coordinates.
   * @param {Float64Array} x
   * @returns {Coefficients}
   */
  toCoefficients(x) {
    const { u, t } = this;
    const { columns, vertices } = this.domain;
    const coefficients = new Float64Array(4 * columns);
    const [pr, pi, qr, qi] = quarters(this.#expanded(x));
    for (let j = 0; j < columns; j++) {
      let phiRe = 0;
      let phiIm = 0;
      let psiRe = 0;
      let psiIm = 0;
      for (let c = 0; c < u; c++) {
        const a = t.re[j * u + c];
        const b = t.im[j * u + c];
        phiRe += a * pr[c] - b * pi[c];
        phiIm += a * pi[c] + b * pr[c];
        psiRe += a * qr[c] - b * qi[c];
        psiIm += a * qi[c] + b * qr[c];
      }
      coefficients[j] = phiRe;
      coefficients[columns + j] = phiIm;
      coefficients[2 * columns + j] = psiRe;
      coefficients[3 * columns + j] = psiIm;
    }
    tieHoles(coefficients, vertices, columns);
    return coefficients;
  }

  /**
   * Derivatives with respect to coordinates, from those with respect to coefficients.
   * @param {Coefficients} g
   * @returns {Float64Array}
   */
  pulledBack(g) {
    const { u, t } = this;
    const { columns } = this.domain;
    const pulled = new Float64Array(4 * u);
    const [pr, pi, qr, qi] = quarters(pulled);
    for (let j = 0; j < columns; j++) {
      const phiRe = g[j];
      const phiIm = g[columns + j];
      const psiRe = g[2 * columns + j];
      const psiIm = g[3 * columns + j];
      for (let c = 0; c < u; c++) {
        const a = t.re[j * u + c];
        const b = t.im[j * u + c];
        pr[c] += a * phiRe + b * phiIm;
        pi[c] += a * phiIm - b * phiRe;
        qr[c] += a * psiRe + b * psiIm;
        qi[c] += a * psiIm - b * psiRe;
      }
    }
    return this.#folded(pulled);
  }

  /**
   * All columns' coordinates of phi and psi. That of psi is 0 for the translation, and the conjugate of
   * that of phi for a logarithm.
   * @param {Float64Array} x
   */
  #expanded(x) {
    const { k, u } = this;
    const all = new Float64Array(4 * u);
    all.set(x.subarray(0, 2 * u));
    all.set(x.subarray(2 * u, 2 * u + k), 2 * u + 1);
    all.set(x.subarray(2 * u + k), 3 * u + 1);
    for (let c = 1 + k; c < u; c++) {
      all[2 * u + c] = x[c];
      all[3 * u + c] = -x[u + c];
    }
    return all;
  }

  /**
   * The transpose of {@link #expanded}.
   * @param {Float64Array} all
   */
  #folded(all) {
    const { k, u } = this;
    const g = new Float64Array(this.size);
    g.set(all.subarray(0, 2 * u));
    g.set(all.subarray(2 * u + 1, 2 * u + 1 + k), 2 * u);
    g.set(all.subarray(3 * u + 1, 3 * u + 1 + k), 2 * u + k);
    for (let c = 1 + k; c < u; c++) {
      g[c] += all[2 * u + c];
      g[u + c] -= all[3 * u + c];
    }
    return g;
  }
}

/**
 * Makes phi_h = conj(psi_h) for the holes, exactly.
 * @param {Coefficients} coefficients
 * @param {number} vertices
 * @param {number} columns
 */
export function tieHoles(coefficients, vertices, columns) {
  for (let h = vertices; h < columns; h++) {
    coefficients[2 * columns + h] = coefficients[h];
    coefficients[3 * columns + h] = -coefficients[columns + h];
  }
}

/**
 * D at the panels' middles, times the roots of their weights: one row for each column of the basis.
 * @typedef {object} Scaled
 * @property {Float64Array} re
 * @property {Float64Array} im
 * @property {number} count
 */

/**
 * @param {Domain} domain
 * @param {Panels} panels
 * @param {Rows} rows
 * @returns {Scaled}
 */
function scaledDerivatives(domain, panels, rows) {
  const { count, lengths } = panels;
  const samples = { ...zeros(domain.columns * count), count };
  for (let i = 0; i < count; i++) {
    const root = Math.sqrt(lengths[i]);
    const d = derivativesOf(domain, rows, (count + i) * evenly(domain.columns));
    for (let j = 0; j < domain.columns; j++) {
      samples.re[j * count + i] = root * d.re[j];
      samples.im[j * count + i] = root * d.im[j];
    }
  }
  return samples;
}

/**
 * conj(a) . b for the rows a and b of samples.
 * @param {Scaled} samples
 * @param {number} a
 * @param {number} b
 * @returns {[number, number]}
 */
function inner({ re, im, count }, a, b) {
  const p = a * count;
  const q = b * count;
  let x = 0;
  let y = 0;
  for (let i = 0; i < count; i++) {
    x += re[p + i] * re[q + i] + im[p + i] * im[q + i];
    y += re[p + i] * im[q + i] - im[p + i] * re[q + i];
  }
  return [x, y];
}

/**
 * The lower half of the Gram matrix of some rows, its diagonal raised a little.
 * @param {Scaled} samples
 * @param {Int32Array} chosen
 */
function gramMatrix(samples, chosen) {
  const k = chosen.length;
  const gram = zeros(k * k);
  let trace = 0;
  for (let a = 0; a < k; a++) {
    for (let b = 0; b <= a; b++) {
      const [re, im] = inner(samples, chosen[a], chosen[b]);
      gram.re[a * k + b] = re;
      gram.im[a * k + b] = im;
    }
    trace += gram.re[a * k + a];
  }
  for (let a = 0; a < k; a++) {
    gram.re[a * k + a] += (RIDGE * trace) / k;
  }
  return gram;
}

/**
 * The inverse of the Cholesky factor of a Hermitian k x k matrix; destroys the matrix.
 * @param {Complex} gram
 * @param {number} k
 */
function inverseFactor(gram, k) {
  complexFactor(gram, k);
  const inverse = zeros(k * k);
  for (let a = 0; a < k; a++) {
    const diagonal = gram.re[a * k + a];
    inverse.re[a * k + a] = 1 / diagonal;
    for (let j = 0; j < a; j++) {
      const x = gram.re[a * k + j] / diagonal;
      const y = gram.im[a * k + j] / diagonal;
      for (let b = 0; b <= j; b++) {
        const re = inverse.re[j * k + b];
        const im = inverse.im[j * k + b];
        inverse.re[a * k + b] -= x * re - y * im;
        inverse.im[a * k + b] -= x * im + y * re;
      }
    }
  }
  return inverse;
}

/**
 * Cholesky's factor in the lower half, in place.
 * @param {Complex} gram
 * @param {number} k
 */
function complexFactor({ re, im }, k) {
  for (let a = 0; a < k; a++) {
    const p = a * k;
    for (let b = 0; b <= a; b++) {
      const q = b * k;
      let x = re[p + b];
      let y = im[p + b];
      for (let j = 0; j < b; j++) {
        x -= re[p + j] * re[q + j] + im[p + j] * im[q + j];
        y -= im[p + j] * re[q + j] - re[p + j] * im[q + j];
      }
      re[p + b] = a === b ? Math.sqrt(x) : x / re[q + b];
      im[p + b] = a === b ? 0 : y / re[q + b];
    }
  }
}

/**
 * @param {Scaled} samples
 * @param {Int32Array} chosen
 * @param {number} column
 */
function projectionsOn(samples, chosen, column) {
  const projections = zeros(chosen.length);
  for (const [j, row] of chosen.entries()) {
    const [re, im] = inner(samples, row, column);
    projections.re[j] = re;
    projections.im[j] = im;
  }
  return projections;
}

/**
 * A lower triangular matrix times a vector.
 * @param {Complex} lower
 * @param {Complex} vector
 * @param {number} k
 */
function timesLower(lower, vector, k) {
  const product = zeros(k);
  for (let c = 0; c < k; c++) {
    for (let j = 0; j <= c; j++) {
      const a = lower.re[c * k + j];
      const b = lower.im[c * k + j];
      product.re[c] += a * vector.re[j] - b * vector.im[j];
      product.im[c] += a * vector.im[j] + b * vector.re[j];
    }
  }
  return product;
}

/**
 * The adjoint of a lower triangular matrix times a vector.
 * @param {Complex} lower
 * @param {Complex} vector
 * @param {number} k
 */
function timesAdjoint(lower, vector, k) {
  const product = zeros(k);
  for (let c = 0; c < k; c++) {
    for (let j = 0; j <= c; j++) {
      const a = lower.re[c * k + j];
      const b = -lower.im[c * k + j];
      product.re[j] += a * vector.re[c] - b * vector.im[c];
      product.im[j] += a * vector.im[c] + b * vector.re[c];
    }
  }
  return product;
}

/**
 * The norm of a column less the combination `along` of the chosen ones.
 * @param {Scaled} samples
 * @param {Int32Array} chosen
 * @param {Complex} along
 * @param {number} column
 */
function normOfRest({ re, im, count }, chosen, along, column) {
  let sum = 0;
  for (let i = 0; i < count; i++) {
    let x = re[column * count + i];
    let y = im[column * count + i];
    for (const [j, row] of chosen.entries()) {
      const a = re[row * count + i];
      const b = im[row * count + i];
      x -= a * along.re[j] - b * along.im[j];
      y -= a * along.im[j] + b * along.re[j];
    }
    sum += x * x + y * y;
  }
  return Math.sqrt(sum);
}
