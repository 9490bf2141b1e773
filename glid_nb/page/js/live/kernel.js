// The inner loops in WebAssembly with SIMD (kernel.wat), where the browser has it. Without, the loops in
// JavaScript compute the same bits.

import { CODE } from "./kernel_code.js";

/**
 * @typedef {object} Kernel
 * @property {(re: number, im: number, slopes: number, width: number, size: number, into: number) => void
 * } samples
 * @property {(re: number, im: number, by: number, width: number, size: number, into: number) => void
 * } pull
 * @property {(a: number, b: number, c: number, d: number, p: number, q: number, size: number,
 *   into: number) => void} tile
 * @property {(l: number, width: number, x: number) => void} solve
 */

const PAGE = 65_536; // bytes
/** The first numbers of a kernel's memory are for what `tile` computes. */
const TILE = 8;

/** Set to null, new arrays are plain ones. */
export const compiled = { module: moduleOrNull() };

/** @type {WeakMap<ArrayBufferLike, Kernel>} */
const kernels = new WeakMap();

/** Browsers may have no SIMD, and pages may forbid WebAssembly. */
function moduleOrNull() {
  try {
    const pairs = CODE.match(/../g) ?? [];
    return new WebAssembly.Module(Uint8Array.from(pairs, (pair) => Number.parseInt(pair, 16)));
  } catch {
    return null;
  }
}

/**
 * Arrays of these lengths, in one memory that a kernel of its own reaches.
 * @param {number[]} lengths
 * @returns {Float64Array<ArrayBuffer>[]}
 */
export function arraysOf(...lengths) {
  const buffer = reachable(8 * lengths.reduce((sum, length) => sum + length, TILE));
  let first = 8 * TILE;
  return lengths.map((length) => {
    const array = buffer ? new Float64Array(buffer, first, length) : new Float64Array(length);
    first += array.byteLength;
    return array;
  });
}

/**
 * @param {number} size in bytes
 * @returns {ArrayBuffer | null} null where there is no kernel, or no room
 */
function reachable(size) {
  if (!compiled.module) {
    return null;
  }
  try {
    const memory = new WebAssembly.Memory({ initial: Math.ceil(size / PAGE) });
    const { exports } = new WebAssembly.Instance(compiled.module, { page: { memory } });
    kernels.set(memory.buffer, /** @type {any} */ (exports));
    return /** @type {ArrayBuffer} */ (memory.buffer);
  } catch {
    return null;
  }
}

/**
 * The kernel that reaches all these arrays, if there is one.
 * @param {Float64Array[]} arrays
 */
export function kernelOf(...arrays) {
  const [{ buffer }] = arrays;
  return arrays.every((array) => array.buffer === buffer) ? kernels.get(buffer) : undefined;
}

/**
 * Where a kernel that reaches this array writes a tile.
 * @param {Float64Array} array
 */
export function tileOf({ buffer }) {
  return new Float64Array(buffer, 0, TILE);
}
