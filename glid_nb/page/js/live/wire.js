// A map as the shader harmonic.glsl takes it, in single precision. `ShaderMap` of glid_nb.page does the
// same for pages without a solver.

/** @import { Coefficients, LiveMap, Outline } from "./types.js" */
/** @import { Point } from "../types.js" */

const FAR = 1e3; // of unused hole points, in sizes of the offset cage

export class Wire {
  #chain;
  #outline;
  #vertices;
  #sizes;

  /**
   * @param {Outline} outline
   * @param {{ chain: number, shaderHoles: number }} sizes of the shader's arrays, in vectors
   */
  constructor(outline, { chain, shaderHoles }) {
    const loops = [outline.offset_cage, ...outline.offset_holes];
    this.#outline = outline;
    this.#sizes = { chain, holes: shaderHoles };
    this.#chain = chainOf(loops.map((loop) => loop.length));
    this.#vertices = loops.flat();
    this.cage = this.#cageOf();
  }

  /** (vertex, 1 / edge that leads to it) of the chain; 0 where none does. */
  #cageOf() {
    const cage = new Float32Array(4 * this.#sizes.chain);
    const last = this.#vertices[this.#vertices.length - 1];
    for (let i = 0; i < this.#sizes.chain; i++) {
      const link = this.#chain[i];
      const [x, y] = link ? this.#vertices[link.vertex] : last;
      const inverse = link && !link.first ? this.#inverseEdge(i) : [0, 0];
      cage.set([x, y, ...inverse], 4 * i);
    }
    return cage;
  }

  /** @param {number} i place in the chain */
  #inverseEdge(i) {
    const [x, y] = this.#vertices[this.#chain[i].vertex];
    const [u, v] = this.#vertices[this.#chain[i - 1].vertex];
    const [dx, dy] = [x - u, y - v];
    const square = dx * dx + dy * dy;
    return [dx / square, -dy / square];
  }

  /** How many numbers a map has. */
  get length() {
    const { chain, holes } = this.#sizes;
    return 4 * (chain + holes);
  }

  /**
   * The coefficients of a map in this form.
   * @param {Float32Array} wire
   * @returns {Coefficients}
   */
  coefficients(wire) {
    const vertices = this.#vertices.length;
    const holes = this.#outline.hole_points.length;
    const n = vertices + holes;
    const coefficients = new Float64Array(4 * n);
    for (const [i, { vertex }] of this.#chain.entries()) {
      for (let part = 0; part < 4; part++) coefficients[part * n + vertex] = wire[4 * i + part];
    }
    for (let h = 0; h < holes; h++) {
      const [re, im] = wire.subarray(4 * (this.#sizes.chain + h) + 2);
      const parts = [re, im, re, -im]; // psi is the conjugate of phi there
      for (const [part, value] of parts.entries()) coefficients[part * n + vertices + h] = value;
    }
    return coefficients;
  }

  /**
   * The arrays `coefficients` and `holes`, one after the other.
   * @param {Coefficients} coefficients
   */
  of(coefficients) {
    const { chain, holes } = this.#sizes;
    const n = coefficients.length / 4;
    const wire = new Float32Array(4 * (chain + holes));
    for (const [i, { vertex }] of this.#chain.entries()) {
      for (let part = 0; part < 4; part++) wire[4 * i + part] = coefficients[part * n + vertex];
    }
    const far = FAR * Math.max(...this.#vertices.map(([x, y]) => Math.hypot(x, y)));
    const points = this.#outline.hole_points;
    for (let h = 0; h < holes; h++) {
      const column = this.#vertices.length + h;
      const vector =
        h < points.length ? [...points[h], coefficients[column], coefficients[n + column]] : [far];
      wire.set(vector, 4 * (chain + h));
    }
    return wire;
  }
}

/**
 * The loops as one chain; each begins with its last vertex.
 * @param {number[]} sizes of the loops
 */
function chainOf(sizes) {
  /** @type {{ vertex: number, first: boolean }[]} */
  const chain = [];
  let start = 0;
  for (const size of sizes) {
    chain.push({ vertex: start + size - 1, first: true });
    for (let i = 0; i < size; i++) chain.push({ vertex: start + i, first: false });
    start += size;
  }
  return chain;
}

/**
 * Images and derivatives of a map's points, as image_buffer.glsl takes them: six numbers for each.
 * @param {Pick<LiveMap, "images" | "samples">} map evaluated at the points
 */
export function movedVertices({ images, samples }) {
  if (!images || !samples) throw new Error("the map was not evaluated at the mesh");
  const count = images.length / 2;
  const moved = new Float32Array(6 * count);
  for (let i = 0; i < count; i++) {
    moved[6 * i] = images[2 * i];
    moved[6 * i + 1] = images[2 * i + 1];
    for (let part = 0; part < 4; part++) moved[6 * i + 2 + part] = samples[part * count + i];
  }
  return moved;
}

/**
 * The coefficients of a map whose row has the complex numbers phi, then psi.
 * @param {ArrayLike<number>} row real and imaginary parts in turn
 * @param {number} holes how many of the last are those of holes, where psi = conj(phi)
 * @returns {Coefficients}
 */
export function coefficientsOf(row, holes) {
  const n = row.length / 4;
  const coefficients = new Float64Array(4 * n);
  for (let j = 0; j < n; j++) {
    const hole = j >= n - holes;
    coefficients[j] = row[2 * j];
    coefficients[n + j] = row[2 * j + 1];
    coefficients[2 * n + j] = hole ? row[2 * j] : row[2 * (n + j)];
    coefficients[3 * n + j] = hole ? -row[2 * j + 1] : row[2 * (n + j) + 1];
  }
  return coefficients;
}

/**
 * The identity.
 * @param {Outline} outline
 * @returns {Coefficients}
 */
export function identityOf(outline) {
  const vertices = [...outline.offset_cage, ...outline.offset_holes.flat()];
  const n = vertices.length + outline.hole_points.length;
  const coefficients = new Float64Array(4 * n);
  /** @type {Point[]} */
  const exterior = outline.offset_cage;
  exterior.forEach(([x, y], j) => {
    coefficients[j] = x;
    coefficients[n + j] = y;
  });
  return coefficients;
}
