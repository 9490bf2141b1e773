// The picture's mesh: triangles divided into four, and the point of the undeformed shape below a pointer.

/** @import { Mesh } from "../exported/renderer.js" */
/** @import { Point } from "../types.js" */

/**
 * The mesh with each triangle divided into four. The first vertices are those of before.
 * @param {Mesh} mesh
 * @returns {Mesh}
 */
export function divided({ source, heights, triangles }) {
  const points = [...source];
  const lifted = [...heights];
  /** @type {Map<number, number>} */
  const middles = new Map();
  const count = heights.length;
  const middle = (/** @type {number} */ a, /** @type {number} */ b) => {
    const key = Math.min(a, b) * count + Math.max(a, b);
    const known = middles.get(key);
    if (known !== undefined) return known;
    const fresh = lifted.length;
    points.push((points[2 * a] + points[2 * b]) / 2, (points[2 * a + 1] + points[2 * b + 1]) / 2);
    lifted.push((lifted[a] + lifted[b]) / 2);
    middles.set(key, fresh);
    return fresh;
  };
  const finer = triangles.flatMap(([a, b, c]) => {
    const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    /** @type {[number, number, number][]} */
    const four = [
      [a, ab, ca],
      [ab, b, bc],
      [ca, bc, c],
      [ab, bc, ca],
    ];
    return four;
  });
  return {
    source: Float32Array.from(points),
    heights: Float32Array.from(lifted),
    triangles: finer,
  };
}

/**
 * The mesh divided so many times.
 * @param {Mesh} mesh
 * @param {number} times
 * @returns {Mesh}
 */
export function dividedTimes(mesh, times) {
  return times > 0 ? dividedTimes(divided(mesh), times - 1) : mesh;
}

/** @param {Mesh} mesh */
export function pointsOf({ source }) {
  return Array.from(
    { length: source.length / 2 },
    (_, i) => /** @type {Point} */ ([source[2 * i], source[2 * i + 1]]),
  );
}

/**
 * The point of the undeformed shape whose image is at a place; the highest one where the image
 * overlaps itself, null where there is none.
 * @param {Mesh} mesh
 * @param {ArrayLike<number>} images x and y of the vertices in turn
 * @param {Point} place
 * @returns {Point | null}
 */
export function sourceAt({ source, heights, triangles }, images, [x, y]) {
  let best = -Infinity;
  /** @type {Point | null} */
  let found = null;
  for (const [a, b, c] of triangles) {
    const [ax, ay] = [images[2 * a], images[2 * a + 1]];
    const [ux, uy] = [images[2 * b] - ax, images[2 * b + 1] - ay];
    const [vx, vy] = [images[2 * c] - ax, images[2 * c + 1] - ay];
    const area = ux * vy - uy * vx;
    const s = ((x - ax) * vy - (y - ay) * vx) / area;
    const t = (ux * (y - ay) - uy * (x - ax)) / area;
    if (!(s >= 0 && t >= 0 && s + t <= 1)) continue;
    const r = 1 - s - t;
    const height = r * heights[a] + s * heights[b] + t * heights[c];
    if (height <= best) continue;
    best = height;
    found = [
      r * source[2 * a] + s * source[2 * b] + t * source[2 * c],
      r * source[2 * a + 1] + s * source[2 * b + 1] + t * source[2 * c + 1],
    ];
  }
  return found;
}

/**
 * The least box around points.
 * @param {ArrayLike<number>} xy x and y in turn
 * @returns {import("../exported/data.js").Box}
 */
export function boxOf(xy) {
  let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < xy.length; i += 2) {
    left = Math.min(left, xy[i]);
    right = Math.max(right, xy[i]);
    bottom = Math.min(bottom, xy[i + 1]);
    top = Math.max(top, xy[i + 1]);
  }
  return [left, bottom, right, top];
}
