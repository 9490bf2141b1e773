// Dense real matrices, row by row: products, Cholesky's factor, and solves with it.

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
  const tile = new Float64Array(8);
  for (let i = 0; i < rows; i += 4) {
    const end = lower ? Math.min(i + 4, columns) : columns;
    for (let j = 0; j < end; j += 2) {
      fillTile(a, b, i, j, rows, columns, length, tile);
      for (let k = 0; k < 8; k++) {
        const row = i + (k >> 1);
        const column = j + (k & 1);
        if (row < rows && column < columns) {
          c.values[c.first + row * c.stride + column] += sign * tile[k];
        }
      }
    }
  }
}

/**
 * The products of rows i to i + 3 of a and rows j and j + 1 of b.
 * @param {Part} a
 * @param {Part} b
 * @param {number} i
 * @param {number} j
 * @param {number} rows
 * @param {number} columns
 * @param {number} length
 * @param {Float64Array} tile
 */
function fillTile(a, b, i, j, rows, columns, length, tile) {
  const left = a.values;
  const right = b.values;
  const a0 = a.first + i * a.stride;
  const a1 = a.first + Math.min(i + 1, rows - 1) * a.stride;
  const a2 = a.first + Math.min(i + 2, rows - 1) * a.stride;
  const a3 = a.first + Math.min(i + 3, rows - 1) * a.stride;
  const b0 = b.first + j * b.stride;
  const b1 = b.first + Math.min(j + 1, columns - 1) * b.stride;
  let s00 = 0;
  let s01 = 0;
  let s10 = 0;
  let s11 = 0;
  let s20 = 0;
  let s21 = 0;
  let s30 = 0;
  let s31 = 0;
  for (let t = 0; t < length; t++) {
    const x = right[b0 + t];
    const y = right[b1 + t];
    const p = left[a0 + t];
    const q = left[a1 + t];
    const r = left[a2 + t];
    const s = left[a3 + t];
    s00 += p * x;
    s01 += p * y;
    s10 += q * x;
    s11 += q * y;
    s20 += r * x;
    s21 += r * y;
    s30 += s * x;
    s31 += s * y;
  }
  tile[0] = s00;
  tile[1] = s01;
  tile[2] = s10;
  tile[3] = s11;
  tile[4] = s20;
  tile[5] = s21;
  tile[6] = s30;
  tile[7] = s31;
}

/**
 * Cholesky's factor of a symmetric n x n matrix, in place, from its lower half, by blocks of columns.
 * @param {Float64Array} a
 * @param {number} n
 * @returns {boolean} whether the matrix is positive definite
 */
export function factorise(a, n) {
  for (let start = 0; start < n; start += BLOCK) {
    const end = Math.min(start + BLOCK, n);
    if (!factoriseBlock(a, n, start, end)) {
      return false;
    }
    const below = { values: a, first: end * n + start, stride: n };
    const rest = { values: a, first: end * n + end, stride: n };
    addProduct(below, below, rest, n - end, n - end, end - start, { sign: -1, lower: true });
  }
  return true;
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
  const n = b.length;
  const x = Float64Array.from(b);
  for (let i = 0; i < n; i++) {
    const row = i * n;
    let rest = x[i];
    for (let j = 0; j < i; j++) {
      rest -= factor[row + j] * x[j];
    }
    x[i] = rest / factor[row + i];
  }
  for (let i = n - 1; i >= 0; i--) {
    const row = i * n;
    x[i] /= factor[row + i];
    const own = x[i];
    for (let j = 0; j < i; j++) {
      x[j] -= factor[row + j] * own;
    }
  }
  return x;
}
