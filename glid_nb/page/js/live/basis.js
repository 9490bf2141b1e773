// The basis of the harmonic subspace (paper Appendix D, Equation (9)), summed by edges.
//
// One row holds Log(B_{e+1} / B_e) / (2 pi i) for each edge e of the offset cage, with B_e = z_e - z,
// and 1 / (z - rho) for each hole. Its product with the slopes of the coefficients is f_z.

import { zeros } from "./domain.js";
import { atan2, log, modulus } from "./elementary.js";
import { arraysOf, kernelOf } from "./kernel.js";
import { CUT, UPWARD } from "./rounding.js";

/** @import { Point } from "../types.js" */
/** @import { Domain } from "./domain.js" */
/** @import { Coefficients, Complex, Samples } from "./types.js" */

const TAU = 2 * Math.PI;
// A norm beyond this would hide what underflows elsewhere (docs/proof.md, Lemma 23).
const LARGEST_NORM = 1e20;
const FEW = 64; // rows

/**
 * Rows of the basis at points, and their norms. With space for the factors of products, in the same
 * memory: slopes and samples.
 * @typedef {object} Rows
 * @property {number} count
 * @property {number} columns
 * @property {Float64Array} re row by row; each has an even length, with a 0 after an odd last column
 * @property {Float64Array} im
 * @property {Float64Array} slopes
 * @property {Float64Array} samples
 * @property {Float64Array} norms upper bounds; infinite where rounding may have chosen the wrong
 *   branch of a logarithm
 */

/**
 * Empty rows. The arrays of a few are plain ones, because a memory takes at least 64 kB.
 * @param {number} count
 * @param {number} columns
 * @returns {Rows}
 */
export function emptyRows(count, columns) {
  const width = evenly(columns);
  const lengths = [count * width, count * width, 4 * width, 4 * count];
  const [re, im, slopes, samples] =
    count < FEW ? lengths.map((length) => new Float64Array(length)) : arraysOf(...lengths);
  return { count, columns, re, im, slopes, samples, norms: new Float64Array(count) };
}

/**
 * The length of a row in memory.
 * @param {number} columns
 */
export function evenly(columns) {
  return columns + (columns % 2);
}

/**
 * @param {Domain} domain
 * @param {Complex} points
 * @returns {Rows}
 */
export function rowsAt(domain, points) {
  const rows = emptyRows(points.re.length, domain.columns);
  const width = evenly(domain.columns);
  for (let i = 0; i < rows.count; i++) {
    rows.norms[i] = fillRow(domain, points.re[i], points.im[i], rows, i * width);
  }
  return rows;
}

/**
 * Writes the row at (x, y) into `row`, from `first` on.
 * @param {Domain} domain
 * @param {number} x
 * @param {number} y
 * @param {Complex} row
 * @param {number} first
 * @returns {number} an upper bound on its norm, infinite if it is useless for a proof
 */
export function fillRow(domain, x, y, row, first) {
  const { vertices, columns, next, singular } = domain;
  let safe = true;
  for (let e = 0; e < vertices; e++) {
    const after = next[e];
    const bx = singular.re[e] - x;
    const by = singular.im[e] - y;
    const cx = singular.re[after] - x;
    const cy = singular.im[after] - y;
    const angle = atan2(bx * cy - by * cx, bx * cx + by * cy) / TAU;
    row.re[first + e] = angle;
    row.im[first + e] = -log((cx * cx + cy * cy) / (bx * bx + by * by)) / (2 * TAU);
    safe = safe && Math.abs(angle) < 0.5 - CUT;
  }
  for (let h = vertices; h < columns; h++) {
    const bx = x - singular.re[h];
    const by = y - singular.im[h];
    const square = bx * bx + by * by;
    row.re[first + h] = bx / square;
    row.im[first + h] = -by / square;
  }
  const norm = UPWARD * Math.sqrt(squares(row, first, columns));
  return safe && norm < LARGEST_NORM ? norm : Infinity;
}

/**
 * @param {Complex} row
 * @param {number} first
 * @param {number} count
 */
function squares(row, first, count) {
  let sum = 0;
  for (let j = first; j < first + count; j++) {
    sum += row.re[j] * row.re[j] + row.im[j] * row.im[j];
  }
  return sum;
}

/**
 * C_j(z) of (6) and (8): (D.1) for vertices and ln|z - rho| for holes.
 * @param {Domain} domain
 * @param {Point} point
 * @returns {Complex}
 */
export function coordinatesAt(domain, [x, y]) {
  const { vertices, columns, next, previous, singular } = domain;
  const logarithms = zeros(columns);
  fillRow(domain, x, y, logarithms, 0);
  const over = timesInverseEdge(domain, logarithms);
  const c = zeros(columns);
  for (let j = 0; j < vertices; j++) {
    const p = previous[j];
    const cx = singular.re[next[j]] - x;
    const cy = singular.im[next[j]] - y;
    const bx = singular.re[p] - x;
    const by = singular.im[p] - y;
    c.re[j] = cx * over.re[j] - cy * over.im[j] - (bx * over.re[p] - by * over.im[p]);
    c.im[j] = cx * over.im[j] + cy * over.re[j] - (bx * over.im[p] + by * over.re[p]);
  }
  for (let h = vertices; h < columns; h++) {
    c.re[h] = log(modulus(x - singular.re[h], y - singular.im[h]));
  }
  return c;
}

/**
 * D_j(z) of (9): (D.2) for vertices and 1 / (z - rho) for holes.
 * @param {Domain} domain
 * @param {Complex} row of {@link fillRow}
 * @param {number} first where it begins
 * @returns {Complex}
 */
export function derivativesOf(domain, row, first) {
  const { vertices, columns, previous } = domain;
  const end = first + columns;
  const own = { re: row.re.subarray(first, end), im: row.im.subarray(first, end) };
  const over = timesInverseEdge(domain, own);
  const d = { re: Float64Array.from(own.re), im: Float64Array.from(own.im) };
  for (let j = 0; j < vertices; j++) {
    d.re[j] = over.re[previous[j]] - over.re[j];
    d.im[j] = over.im[previous[j]] - over.im[j];
  }
  return d;
}

/**
 * @param {Domain} domain
 * @param {Complex} row
 */
function timesInverseEdge({ vertices, inverseEdge }, row) {
  const over = zeros(vertices);
  for (let e = 0; e < vertices; e++) {
    over.re[e] = row.re[e] * inverseEdge.re[e] - row.im[e] * inverseEdge.im[e];
    over.im[e] = row.re[e] * inverseEdge.im[e] + row.im[e] * inverseEdge.re[e];
  }
  return over;
}

/**
 * Slopes of phi and psi along the edges of the offset cage, and the holes' coefficients. A translation
 * changes none of them.
 * @param {Domain} domain
 * @param {Coefficients} coefficients
 * @returns {Coefficients}
 */
export function slopesOf(domain, coefficients) {
  const { vertices, columns, next, edge } = domain;
  const slopes = new Float64Array(4 * columns);
  for (const part of [0, 2 * columns]) {
    const re = coefficients.subarray(part, part + columns);
    const im = coefficients.subarray(part + columns, part + 2 * columns);
    for (let e = 0; e < vertices; e++) {
      const x = re[next[e]] - re[e];
      const y = im[next[e]] - im[e];
      const a = edge.re[e];
      const b = edge.im[e];
      const square = a * a + b * b;
      slopes[part + e] = (x * a + y * b) / square;
      slopes[part + columns + e] = (y * a - x * b) / square;
    }
    for (let h = vertices; h < columns; h++) {
      slopes[part + h] = re[h];
      slopes[part + columns + h] = im[h];
    }
  }
  return slopes;
}

/**
 * Derivatives with respect to the coefficients, from those with respect to the slopes.
 * @param {Domain} domain
 * @param {Coefficients} g
 * @returns {Coefficients}
 */
export function pulledThroughSlopes(domain, g) {
  const { vertices, columns, next, inverseEdge } = domain;
  const pulled = new Float64Array(4 * columns);
  for (const re of [0, 2 * columns]) {
    const im = re + columns;
    for (let e = 0; e < vertices; e++) {
      const x = g[re + e] * inverseEdge.re[e] + g[im + e] * inverseEdge.im[e];
      const y = g[im + e] * inverseEdge.re[e] - g[re + e] * inverseEdge.im[e];
      pulled[re + next[e]] += x;
      pulled[im + next[e]] += y;
      pulled[re + e] -= x;
      pulled[im + e] -= y;
    }
    for (let h = vertices; h < columns; h++) {
      pulled[re + h] = g[re + h];
      pulled[im + h] = g[im + h];
    }
  }
  return pulled;
}

/**
 * f_z and conj(f_zbar) at the rows' points; or Phi and Psi there, if the rows are those of the
 * coordinates and the slopes are the coefficients themselves.
 * @param {Rows} rows
 * @param {Coefficients} slopes
 * @returns {Samples}
 */
export function samplesAt(rows, slopes) {
  const { count, columns, re, im } = rows;
  const width = evenly(columns);
  const factors = rows.slopes.fill(0);
  for (const [i, part] of quarters(slopes).entries()) {
    factors.set(part, i * width);
  }
  const products = rows.samples.subarray(0, 4 * count);
  const kernel = kernelOf(re, im, factors, products);
  if (kernel) {
    const into = products.byteOffset;
    kernel.samples(re.byteOffset, im.byteOffset, factors.byteOffset, 8 * width, 8 * count, into);
  } else {
    const [pr, pi, qr, qi] = quarters(factors);
    const [fr, fi, gr, gi] = quarters(products);
    fillProduct(rows, pr, pi, fr, fi);
    fillProduct(rows, qr, qi, gr, gi);
  }
  return products.slice();
}

/**
 * The product of the rows and a complex vector. Even and odd terms are summed on their own.
 * @param {Rows} rows
 * @param {Float64Array} re of the vector
 * @param {Float64Array} im
 * @param {Float64Array} intoRe
 * @param {Float64Array} intoIm
 */
function fillProduct(rows, re, im, intoRe, intoIm) {
  const rowRe = rows.re;
  const rowIm = rows.im;
  const width = re.length;
  for (let i = 0; i < rows.count; i++) {
    const first = i * width;
    let x1 = 0;
    let y1 = 0;
    let x2 = 0;
    let y2 = 0;
    for (let e = 0; e < width; e += 2) {
      const a1 = rowRe[first + e];
      const b1 = rowIm[first + e];
      const a2 = rowRe[first + e + 1];
      const b2 = rowIm[first + e + 1];
      const c1 = re[e];
      const d1 = im[e];
      const c2 = re[e + 1];
      const d2 = im[e + 1];
      x1 += a1 * c1 - b1 * d1;
      y1 += a1 * d1 + b1 * c1;
      x2 += a2 * c2 - b2 * d2;
      y2 += a2 * d2 + b2 * c2;
    }
    intoRe[i] = x1 + x2;
    intoIm[i] = y1 + y2;
  }
}

/**
 * Derivatives with respect to the slopes, from those with respect to the samples.
 * @param {Rows} rows
 * @param {Samples} g
 * @returns {Coefficients}
 */
export function pulledThroughRows(rows, g) {
  const { count, columns, re, im } = rows;
  const width = evenly(columns);
  const factors = rows.samples.subarray(0, 4 * count);
  factors.set(g);
  const products = rows.slopes.fill(0);
  const kernel = kernelOf(re, im, factors, products);
  if (kernel) {
    const into = products.byteOffset;
    kernel.pull(re.byteOffset, im.byteOffset, factors.byteOffset, 8 * width, 8 * count, into);
  } else {
    const [pr, pi, qr, qi] = quarters(products);
    const [fr, fi, gr, gi] = quarters(factors);
    addAdjointProduct(rows, fr, fi, pr, pi);
    addAdjointProduct(rows, gr, gi, qr, qi);
  }
  const pulled = new Float64Array(4 * columns);
  for (const [i, part] of quarters(products).entries()) {
    pulled.set(part.subarray(0, columns), i * columns);
  }
  return pulled;
}

/**
 * Adds the product of the rows' adjoint and a complex vector, two rows at once.
 * @param {Rows} rows
 * @param {Float64Array} re of the vector
 * @param {Float64Array} im
 * @param {Float64Array} intoRe
 * @param {Float64Array} intoIm
 */
function addAdjointProduct(rows, re, im, intoRe, intoIm) {
  const { count } = rows;
  const rowRe = rows.re;
  const rowIm = rows.im;
  const width = intoRe.length;
  for (let i = 0; i < count; i += 2) {
    const both = i + 1 < count;
    const first = i * width;
    const second = both ? first + width : first;
    const c1 = re[i];
    const d1 = im[i];
    const c2 = both ? re[i + 1] : 0;
    const d2 = both ? im[i + 1] : 0;
    for (let e = 0; e < width; e++) {
      const a1 = rowRe[first + e];
      const b1 = rowIm[first + e];
      const a2 = rowRe[second + e];
      const b2 = rowIm[second + e];
      intoRe[e] += a1 * c1 + b1 * d1 + (a2 * c2 + b2 * d2);
      intoIm[e] += a1 * d1 - b1 * c1 + (a2 * d2 - b2 * c2);
    }
  }
}

/**
 * The four parts of coefficients or samples.
 * @param {Float64Array} values
 * @returns {[Float64Array, Float64Array, Float64Array, Float64Array]}
 */
export function quarters(values) {
  const n = values.length / 4;
  return [
    values.subarray(0, n),
    values.subarray(n, 2 * n),
    values.subarray(2 * n, 3 * n),
    values.subarray(3 * n),
  ];
}
