// Dense real matrices, row by row: products, Cholesky's factor, and solves with it.

import { arraysOf, kernelOf, tileOf } from "./kernel.js";

const BLOCK = 48; // columns of a block of the factorisation

/**
 * @param {Float64Array} a
 * @param {Float64Array} b
 */
export function dot(a, b) {
  let sum = 0;
  for (let i = 0; i < a.length; i++) {
    sum += a[i] * b[i];
  }
  return sum;
}

/**
 * y += t x, in place.
 * @param {number} t
 * @param {Float64Array} x
 * @param {Float64Array} y
 */
export function addScaled(t, x, y) {
  for (let i = 0; i < y.length; i++) {
    y[i] += t * x[i];
  }
}

/**
 * A matrix, or a part of one: `first` is the place of its first element, `stride` the distance of rows.
 * @typedef {object} Part
 * @property {Float64Array} values
 * @property {number} first
 * @property {number} stride
 */

/**
 * c += sign a b^T for a of `rows` rows and b of `columns` rows of `length` numbers. Four rows and two
 * columns are computed at once.
 * @param {Part} a
 * @param {Part} b
 * @param {Part} c
 * @param {number} rows
 * @param {number} columns
 * @param {number} length
 * @param {{ sign?: number, lower?: boolean }} [options] `lower`: only what meets the lower half
 */
export function addProduct(a, b, c, rows, columns, length, { sign = 1, lower = false } = {}) {
  const kernel = kernelOf(a.values, b.values);
  const tile = kernel ? tileOf(a.values) : new Float64Array(8);
  const even = length - (length % 2);
  for (let i = 0; i < rows; i += 4) {
    const end = lower ? Math.min(i + 4, columns) : columns;
    const places = [0, 1, 2, 3].map((k) => a.first + Math.min(i + k, rows - 1) * a.stride);
    for (let j = 0; j < end; j += 2) {
      const p = b.first + j * b.stride;
      const q = b.first + Math.min(j + 1, columns - 1) * b.stride;
      if (kernel) {
        const [r0, r1, r2, r3] = places;
        const left = a.values.byteOffset;
        const right = b.values.byteOffset;
        kernel.tile(
          left + 8 * r0,
          left + 8 * r1,
          left + 8 * r2,
          left + 8 * r3,
          right + 8 * p,
          right + 8 * q,
          8 * even,
          tile.byteOffset,
        );
      } else {
        fillHalf(a.values, places[0], places[1], b.values, p, q, even, tile, 0);
        fillHalf(a.values, places[2], places[3], b.values, p, q, even, tile, 4);
      }
      for (let k = 0; k < 8; k++) {
        const row = i + (k >> 1);
        const column = j + (k & 1);
        if (row < rows && column < columns) {
          const last = even < length ? a.values[places[k >> 1] + even] : 0;
          const rest = last && last * b.values[(k & 1 ? q : p) + even];
          c.values[c.first + row * c.stride + column] += sign * (tile[k] + rest);
        }
      }
    }
  }
}

/**
 * The products of two rows and two rows; even and odd terms are summed on their own.
 * @param {Float64Array} left
 * @param {number} a0 where its rows begin
 * @param {number} a1
 * @param {Float64Array} right
 * @param {number} b0
 * @param {number} b1
 * @param {number} length of a row, even
 * @param {Float64Array} tile
 * @param {number} first where the four products go
 */
function fillHalf(left, a0, a1, right, b0, b1, length, tile, first) {
  let s00 = 0;
  let s01 = 0;
  let s10 = 0;
  let s11 = 0;
  let t00 = 0;
  let t01 = 0;
  let t10 = 0;
  let t11 = 0;
  for (let t = 0; t < length; t += 2) {
    const x = right[b0 + t];
    const y = right[b1 + t];
    const p = left[a0 + t];
    const q = left[a1 + t];
    s00 += p * x;
    s01 += p * y;
    s10 += q * x;
    s11 += q * y;
    const v = right[b0 + t + 1];
    const w = right[b1 + t + 1];
    const r = left[a0 + t + 1];
    const s = left[a1 + t + 1];
    t00 += r * v;
    t01 += r * w;
    t10 += s * v;
    t11 += s * w;
  }
  tile[first] = s00 + t00;
  tile[first + 1] = s01 + t01;
  tile[first + 2] = s10 + t10;
  tile[first + 3] = s11 + t11;
}

/**
 * Cholesky's factor of a symmetric n x n matrix, in place, from its lower half, by blocks of columns.
 * @param {Float64Array} a
 * @param {number} n
 * @returns {boolean} whether the matrix is positive definite
 */
export function factorise(a, n) {
  const { values } = scratchFor(a, n);
  values.set(a);
  for (let start = 0; start < n; start += BLOCK) {
    const end = Math.min(start + BLOCK, n);
    if (!factoriseBlock(values, n, start, end)) {
      return false;
    }
    const below = { values, first: end * n + start, stride: n };
    const rest = { values, first: end * n + end, stride: n };
    addProduct(below, below, rest, n - end, n - end, end - start, { sign: -1, lower: true });
  }
  a.set(values);
  return true;
}

/**
 * The matrix that was factorised last, and its factor where the kernel reaches it.
 * @type {{ of: Float64Array | null, values: Float64Array, x: Float64Array }}
 */
let last = { of: null, values: new Float64Array(0), x: new Float64Array(0) };

/**
 * @param {Float64Array} a
 * @param {number} n
 */
function scratchFor(a, n) {
  if (last.x.length === n) {
    last.of = a;
  } else {
    const [values, x] = arraysOf(n * n, n);
    last = { of: a, values, x };
  }
  return last;
}

/**
 * The block's columns of the factor; all columns before them are already taken off.
 * @param {Float64Array} a
 * @param {number} n
 * @param {number} start
 * @param {number} end
 */
function factoriseBlock(a, n, start, end) {
  for (let i = start; i < n; i++) {
    const row = i * n;
    const last = Math.min(i, end - 1);
    for (let j = start; j <= last; j++) {
      const other = j * n;
      let rest = a[row + j];
      for (let k = start; k < j; k++) {
        rest -= a[row + k] * a[other + k];
      }
      if (i !== j) {
        a[row + j] = rest / a[other + j];
      } else if (rest > 0) {
        a[row + j] = Math.sqrt(rest);
      } else {
        return false;
      }
    }
  }
  return true;
}

/**
 * Solves L L^T x = b.
 * @param {Float64Array} factor L in the lower half
 * @param {Float64Array} b
 * @returns {Float64Array} x
 */
export function solveWith(factor, b) {
  const kernel = last.of === factor ? kernelOf(last.values, last.x) : undefined;
  if (kernel) {
    last.x.set(b);
    kernel.solve(last.values.byteOffset, 8 * b.length, last.x.byteOffset);
    return last.x.slice();
  }
  const x = Float64Array.from(b);
  solveInPlace(factor, x);
  return x;
}

/**
 * @param {Float64Array} factor
 * @param {Float64Array} x
 */
function solveInPlace(factor, x) {
  const n = x.length;
  for (let i = 0; i < n; i++) {
    const row = i * n;
    const even = i - (i % 2);
    let s = 0;
    let t = 0;
    for (let j = 0; j < even; j += 2) {
      s += factor[row + j] * x[j];
      t += factor[row + j + 1] * x[j + 1];
    }
    const rest = even < i ? s + t + factor[row + even] * x[even] : s + t;
    x[i] = (x[i] - rest) / factor[row + i];
  }
  for (let i = n - 1; i >= 0; i--) {
    const row = i * n;
    x[i] /= factor[row + i];
    const own = x[i];
    for (let j = 0; j < i; j++) {
      x[j] -= factor[row + j] * own;
    }
  }
}
