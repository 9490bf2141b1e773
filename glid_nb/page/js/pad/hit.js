// What is at a point; all arguments in the same coordinates.

import { distance } from "./view.js";

/** @import { Point } from "../types.js" */

/**
 * The nearest of things at a distance `d`, within reach; null for none. What has a `loss` counts as
 * farther away by that.
 *
 * @template {{ d: number, loss?: number }} T
 * @param {T[]} things
 * @param {number} reach
 * @returns {T | null}
 */
export function nearest(things, reach) {
  let best = null;
  let least = Infinity;
  for (const thing of things) {
    const far = thing.d + (thing.loss ?? 0);
    if (!(thing.d <= reach) || far >= least) continue; // a place may be no number
    best = thing;
    least = far;
  }
  return best;
}

/**
 * @param {Point[][]} loops
 * @param {Point} point
 * @param {number} reach
 */
export function nearestVertex(loops, point, reach) {
  const vertices = loops.flatMap((loop, i) =>
    loop.map((vertex, j) => ({ loop: i, index: j, d: distance(vertex, point) })),
  );
  return nearest(vertices, reach);
}

/**
 * @param {Point[][]} loops
 * @param {Point} point
 * @param {number} reach
 */
export function nearestEdge(loops, point, reach) {
  const edges = loops.flatMap((loop) =>
    loop.map((start, j) => {
      const foot = footOn(start, loop[(j + 1) % loop.length], point);
      return { foot, d: distance(foot, point) };
    }),
  );
  return nearest(edges, reach);
}

/**
 * The point of a segment that is nearest to a point.
 *
 * @param {Point} start
 * @param {Point} end
 * @param {Point} point
 * @returns {Point}
 */
function footOn(start, end, point) {
  const along = [end[0] - start[0], end[1] - start[1]];
  const dot = (point[0] - start[0]) * along[0] + (point[1] - start[1]) * along[1];
  const share = Math.min(Math.max(dot / (distance(start, end) ** 2 || 1e-30), 0), 1);
  return [start[0] + share * along[0], start[1] + share * along[1]];
}

/**
 * The index of the smallest hole around a point, -1 for none.
 *
 * @param {{ loop: Point[], area: number }[]} holes
 * @param {Point} point
 */
export function holeAt(holes, point) {
  let found = -1;
  holes.forEach((hole, i) => {
    if ((found < 0 || hole.area < holes[found].area) && encloses(hole.loop, point)) found = i;
  });
  return found;
}

/**
 * Whether a loop goes around a point, by the non-zero rule.
 *
 * @param {Point[]} loop
 * @param {Point} point
 */
export function encloses(loop, [x, y]) {
  let winding = 0;
  loop.forEach(([x0, y0], i) => {
    const [x1, y1] = loop[(i + 1) % loop.length];
    const left = (x1 - x0) * (y - y0) - (x - x0) * (y1 - y0);
    if (y0 <= y && y1 > y && left > 0) winding += 1;
    if (y0 > y && y1 <= y && left < 0) winding -= 1;
  });
  return winding !== 0;
}
