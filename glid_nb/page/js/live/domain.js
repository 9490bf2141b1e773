// A cage, the offset cage around it and its hole points, as flat arrays.
//
// The basis is singular at the offset cage's vertices and at the hole points. They come in this order
// everywhere: the vertices loop by loop, then one point for each hole.

import { modulus } from "./elementary.js";

/** @import { Point } from "../types.js" */
/** @import { Complex, Outline } from "./types.js" */

export class Domain {
  /** @param {Outline} outline */
  constructor(outline) {
    const loops = [outline.offset_cage, ...outline.offset_holes];
    /** The cage's loops: the exterior, then the holes. */
    this.cage = [outline.cage, ...outline.holes];
    /** The singularities: vertices of the offset cage, then hole points. */
    this.singular = complexOf([...loops.flat(), ...outline.hole_points]);
    this.exterior = outline.offset_cage.length; // vertices of the exterior loop, which come first
    this.holes = outline.hole_points.length;
    this.vertices = loops.flat().length;
    this.columns = this.vertices + this.holes;
    const { next, previous } = neighbours(loops.map((loop) => loop.length));
    this.next = next;
    this.previous = previous;
    const { edge, inverse } = edgesOf(this.singular, next);
    /** z_{e+1} - z_e for the edge from vertex e, and its inverse. */
    this.edge = edge;
    this.inverseEdge = inverse;
    /** The largest modulus of a coordinate. */
    this.largest = largestModulus(this.singular, this.exterior);
    /** A twentieth of the longer side. */
    this.unit = longerSide(outline.cage) / 20;
    this.free = freeColumns(loops.map((loop) => loop.length));
  }
}

/**
 * @param {Point[]} points
 * @returns {Complex}
 */
export function complexOf(points) {
  return {
    re: Float64Array.from(points, (point) => point[0]),
    im: Float64Array.from(points, (point) => point[1]),
  };
}

/**
 * @param {number} size
 * @returns {Complex}
 */
export function zeros(size) {
  return { re: new Float64Array(size), im: new Float64Array(size) };
}

/**
 * The vertex after each, and the one before it, on loops of these sizes.
 * @param {number[]} sizes
 */
function neighbours(sizes) {
  const total = sizes.reduce((sum, size) => sum + size, 0);
  const next = new Int32Array(total);
  const previous = new Int32Array(total);
  let first = 0;
  for (const size of sizes) {
    for (let i = 0; i < size; i++) {
      const after = first + ((i + 1) % size);
      next[first + i] = after;
      previous[after] = first + i;
    }
    first += size;
  }
  return { next, previous };
}

/**
 * The columns of single-valued functions that are unknowns (Section 5): not the first two of a hole's
 * loop, nor the exterior's first, whose place the translation takes.
 * @param {number[]} sizes
 */
function freeColumns(sizes) {
  /** @type {number[]} */
  const free = [];
  let first = 0;
  for (const [loop, size] of sizes.entries()) {
    for (let i = loop === 0 ? 1 : 2; i < size; i++) {
      free.push(first + i);
    }
    first += size;
  }
  return Int32Array.from(free);
}

/**
 * @param {Complex} singular
 * @param {Int32Array} next
 */
function edgesOf(singular, next) {
  const edge = zeros(next.length);
  const inverse = zeros(next.length);
  for (let e = 0; e < next.length; e++) {
    const re = singular.re[next[e]] - singular.re[e];
    const im = singular.im[next[e]] - singular.im[e];
    const square = re * re + im * im;
    edge.re[e] = re;
    edge.im[e] = im;
    inverse.re[e] = re / square;
    inverse.im[e] = -im / square;
  }
  return { edge, inverse };
}

/**
 * @param {Complex} points
 * @param {number} count
 */
function largestModulus(points, count) {
  let largest = 0;
  for (let j = 0; j < count; j++) {
    largest = Math.max(largest, modulus(points.re[j], points.im[j]));
  }
  return largest;
}

/** @param {Point[]} loop */
function longerSide(loop) {
  const sides = [0, 1].map((axis) => {
    const values = loop.map((point) => point[axis]);
    return Math.max(...values) - Math.min(...values);
  });
  return Math.max(...sides);
}
