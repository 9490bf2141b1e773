// Numbers from the text that `packed` and `factored` in glid_nb/export/page.py wrote.

/** @import { Factored, Packed } from "./data.js" */

/**
 * @param {string} text base64
 * @returns {ArrayBuffer}
 */
export function bytesOf(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
}

/**
 * @param {Packed} packed
 * @param {number} width numbers of a row
 */
export async function unpacked({ bytes, step }, width) {
  const stream = new Blob([bytesOf(bytes)])
    .stream()
    .pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const n = planes.length / 4;
  const whole = new Int32Array(n);
  for (let i = 0; i < n; i++) {
    const low = planes[i] | (planes[n + i] << 8);
    const folded = low | (planes[2 * n + i] << 16) | (planes[3 * n + i] << 24);
    const second = (folded >>> 1) ^ -(folded & 1); // difference; odd ones are negative
    whole[i] = second + 2 * (whole[i - width] ?? 0) - (whole[i - 2 * width] ?? 0);
  }
  return Float32Array.from(whole, (value) => step * value);
}

/**
 * @param {Factored} factored
 * @param {number} width numbers of a row
 */
export async function restored({ sizes, rows, shares }, width) {
  const few = await unpacked(rows, rows.width);
  const each = await unpacked(shares, sizes.length);
  const values = new Float64Array((each.length / sizes.length) * width);
  each.forEach((share, i) => {
    const k = i % sizes.length;
    const to = width * Math.floor(i / sizes.length);
    for (let j = 0; j < width; j++) values[to + j] += (share / sizes[k]) * few[width * k + j];
  });
  return Float32Array.from(values);
}

/**
 * The triangles' corners; each triangle is its first corner and the differences to it.
 *
 * @param {Packed} triangles
 * @returns {Promise<[number, number, number][]>}
 */
export async function cornersOf(triangles) {
  const numbers = await unpacked(triangles, 3);
  return Array.from({ length: numbers.length / 3 }, (_, i) => {
    const [first, second, third] = numbers.subarray(3 * i, 3 * i + 3);
    return [first, first + second, first + third];
  });
}
