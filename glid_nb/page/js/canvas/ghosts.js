// Three pale pins on a shape without pins, where a drag moves most. They are no part of the pose, and
// whoever has pinned something since the page was opened sees none.

import { encloses, nearestEdge } from "../pad/hit.js";
import { circle, disk } from "../pad/pen.js";
import { distance } from "../pad/view.js";

/** @import { Outline } from "../live/types.js" */
/** @import { Point } from "../types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { View } from "../pad/view.js" */

const COUNT = 3;
const GRID = 24; // candidates along each side of the shape
const USED = "glid-nb-pinned"; // in the page's session
const RADIUS = 8; // CSS pixels

/** @typedef {{ point: Point, clearance: number }} Candidate */

/**
 * Places far from each other and from the boundary.
 *
 * @param {Pick<Outline, "cage" | "holes">} outline
 * @returns {Point[]}
 */
export function ghostPins({ cage, holes }) {
  const loops = [cage, ...holes];
  const candidates = gridOver(cage)
    .filter((point) => encloses(cage, point) && !holes.some((hole) => encloses(hole, point)))
    .map((point) => ({ point, clearance: nearestEdge(loops, point, Infinity)?.d ?? 0 }));
  if (!candidates.length) return [];
  const places = [best(candidates, [middleOf(candidates)])];
  while (places.length < COUNT) places.push(best(candidates, places));
  return places;
}

/**
 * @param {Point[]} loop
 * @returns {Point[]}
 */
function gridOver(loop) {
  const xs = loop.map(([x]) => x);
  const ys = loop.map(([, y]) => y);
  const along = (/** @type {number[]} */ values, /** @type {number} */ i) => {
    const [low, high] = [Math.min(...values), Math.max(...values)];
    return low + ((i + 0.5) / GRID) * (high - low);
  };
  return Array.from({ length: GRID * GRID }, (_, i) => [
    along(xs, i % GRID),
    along(ys, Math.floor(i / GRID)),
  ]);
}

/**
 * @param {Candidate[]} candidates
 * @returns {Point}
 */
function middleOf(candidates) {
  const sum = candidates.reduce(([u, v], { point: [x, y] }) => [u + x, v + y], [0, 0]);
  return [sum[0] / candidates.length, sum[1] / candidates.length];
}

/**
 * The place that is farthest from others, where the shape is wide rather than at its boundary.
 *
 * @param {Candidate[]} candidates
 * @param {Point[]} others
 */
function best(candidates, others) {
  const score = (/** @type {Candidate} */ { point, clearance }) =>
    Math.min(...others.map((other) => distance(point, other))) * Math.sqrt(clearance);
  return candidates.reduce((a, b) => (score(b) > score(a) ? b : a)).point;
}

export class Ghosts {
  /** @type {Outline | null} whose places are known */
  #outline = null;
  /** @type {Point[]} */
  #places = [];

  /**
   * Draws them while there are no pins.
   *
   * @param {Pen} pen
   * @param {View} view
   * @param {Outline | undefined} outline of the undeformed shape
   * @param {boolean} pinned whether there are pins
   */
  draw(pen, view, outline, pinned) {
    if (pinned) remember();
    if (pinned || !outline || remembered()) return;
    if (outline !== this.#outline) {
      this.#outline = outline;
      this.#places = ghostPins(outline);
    }
    pen.globalAlpha = 0.75;
    for (const place of view.line(this.#places)) {
      disk(pen, place, RADIUS, "rgba(255,255,255,0.75)");
      const ring = /** @type {import("../types.js").Strokes} */ ([[2, "#067a82"]]);
      circle(pen, place, RADIUS, ring, [4, 2.3]);
      disk(pen, place, 2.5, "#067a82");
    }
    pen.globalAlpha = 1;
  }
}

let used = false; // where the page may not store anything

function remembered() {
  try {
    return used || sessionStorage.getItem(USED) !== null;
  } catch {
    return used;
  }
}

function remember() {
  if (used) return;
  used = true;
  try {
    sessionStorage.setItem(USED, "1");
  } catch {
    // This page remembers it as long as it is open.
  }
}
