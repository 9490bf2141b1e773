// Panels: straight pieces of the cage, on which maps are integrated and proved.
//
// They are the panels of `glid_nb.geometry.graded_panels`: each is no longer than its distance to the
// nearest singularity. Nodes are the panels' starts, then their middles.

import { zeros } from "./domain.js";
import { modulus } from "./elementary.js";

/** @import { Point } from "../types.js" */
/** @import { Domain } from "./domain.js" */
/** @import { Complex } from "./types.js" */

const MOST_BISECTIONS = 48; // bisecting an edge this often brings it below rounding

/**
 * @typedef {object} Panels
 * @property {number} count
 * @property {number} loops
 * @property {Int32Array} next the panel that follows on the same loop
 * @property {Int32Array} loop of the cage: 0 exterior, then the holes
 * @property {Complex} nodes the starts, then the middles
 * @property {Float64Array} lengths relative to the perimeter
 * @property {Float64Array} weights of Simpson's rule at the nodes; they sum to 1
 */

/**
 * @param {Domain} domain
 * @returns {Panels}
 */
export function gradedPanels(domain) {
  /** @type {Point[]} */
  const starts = [];
  /** @type {number[]} */
  const loop = [];
  for (const [number, vertices] of domain.cage.entries()) {
    for (const [i, vertex] of vertices.entries()) {
      appendPieces(domain, vertex, vertices[(i + 1) % vertices.length], 0, starts);
    }
    while (loop.length < starts.length) {
      loop.push(number);
    }
  }
  const count = starts.length;
  const next = nextOnLoop(loop);
  const nodes = nodesOf(starts, next);
  const lengths = relativeLengths(starts, next);
  const loops = domain.cage.length;
  const weights = simpson(lengths, next);
  return { count, loops, next, loop: Int32Array.from(loop), nodes, lengths, weights };
}

/**
 * The panels as pieces of the cage's edges, loop by loop: [k, d] from k / 2^d to (k + 1) / 2^d.
 * @param {Domain} domain
 */
export function bisections(domain) {
  return domain.cage.flatMap((vertices) =>
    vertices.map((vertex, i) => {
      /** @type {[k: number, d: number][]} */
      const pieces = [];
      appendBisections(domain, vertex, vertices[(i + 1) % vertices.length], 0, 0, pieces);
      return pieces;
    }),
  );
}

/**
 * @param {Domain} domain
 * @param {Point} start
 * @param {Point} end
 * @param {number} k
 * @param {number} d
 * @param {[k: number, d: number][]} pieces
 */
function appendBisections(domain, start, end, k, d, pieces) {
  if (isPanel(domain, start, end, d)) {
    pieces.push([k, d]);
    return;
  }
  const middle = middleOf(start, end);
  appendBisections(domain, start, middle, 2 * k, d + 1, pieces);
  appendBisections(domain, middle, end, 2 * k + 1, d + 1, pieces);
}

/**
 * Whether a piece of an edge is no longer than its distance to the nearest singularity.
 * @param {Domain} domain
 * @param {Point} start
 * @param {Point} end
 * @param {number} depth how often the edge was bisected
 */
function isPanel(domain, start, end, depth) {
  const length = modulus(end[0] - start[0], end[1] - start[1]);
  return depth === MOST_BISECTIONS || length <= clearance(domain, start, end);
}

/**
 * Appends the starts of the pieces of a straight line.
 * @param {Domain} domain
 * @param {Point} start
 * @param {Point} end
 * @param {number} depth how often it was bisected before
 * @param {Point[]} starts
 */
function appendPieces(domain, start, end, depth, starts) {
  if (isPanel(domain, start, end, depth)) {
    starts.push(start);
    return;
  }
  const middle = middleOf(start, end);
  appendPieces(domain, start, middle, depth + 1, starts);
  appendPieces(domain, middle, end, depth + 1, starts);
}

/**
 * @param {Point} a
 * @param {Point} b
 * @returns {Point}
 */
function middleOf(a, b) {
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
}

/**
 * The distance of a segment to the nearest singularity.
 * @param {Domain} domain
 * @param {Point} start
 * @param {Point} end
 */
function clearance(domain, start, end) {
  let least = Infinity;
  for (let j = 0; j < domain.columns; j++) {
    least = Math.min(least, distance(domain.singular, j, start[0], start[1], end[0], end[1]));
  }
  return least;
}

/**
 * The distance of point j to the segment from (ax, ay) to (bx, by).
 * @param {Complex} points
 * @param {number} j
 * @param {number} ax
 * @param {number} ay
 * @param {number} bx
 * @param {number} by
 */
export function distance(points, j, ax, ay, bx, by) {
  const alongX = bx - ax;
  const alongY = by - ay;
  const x = points.re[j] - ax;
  const y = points.im[j] - ay;
  const square = alongX * alongX + alongY * alongY;
  const position = (x * alongX + y * alongY) / (square > 0 ? square : 1);
  const t = Math.min(1, Math.max(0, position));
  return modulus(x - t * alongX, y - t * alongY);
}

/** @param {number[]} loop */
function nextOnLoop(loop) {
  const next = new Int32Array(loop.length);
  let first = 0;
  for (let i = 0; i < loop.length; i++) {
    if (loop[i] !== loop[first]) {
      first = i;
    }
    next[i] = loop[i + 1] === loop[i] ? i + 1 : first;
  }
  return next;
}

/**
 * @param {Point[]} starts
 * @param {Int32Array} next
 */
function nodesOf(starts, next) {
  const count = starts.length;
  const nodes = zeros(2 * count);
  for (const [i, start] of starts.entries()) {
    const middle = middleOf(start, starts[next[i]]);
    nodes.re[i] = start[0];
    nodes.im[i] = start[1];
    nodes.re[count + i] = middle[0];
    nodes.im[count + i] = middle[1];
  }
  return nodes;
}

/**
 * @param {Point[]} starts
 * @param {Int32Array} next
 */
function relativeLengths(starts, next) {
  const lengths = Float64Array.from(starts, (start, i) => {
    const end = starts[next[i]];
    return modulus(end[0] - start[0], end[1] - start[1]);
  });
  const perimeter = lengths.reduce((sum, length) => sum + length, 0);
  return lengths.map((length) => length / perimeter);
}

/**
 * @param {Float64Array} lengths
 * @param {Int32Array} next
 */
function simpson(lengths, next) {
  const count = lengths.length;
  const weights = new Float64Array(2 * count);
  for (let i = 0; i < count; i++) {
    weights[i] += lengths[i] / 6;
    weights[next[i]] += lengths[i] / 6;
    weights[count + i] = (4 * lengths[i]) / 6;
  }
  return weights;
}
