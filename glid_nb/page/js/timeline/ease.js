// The easings of glid_nb/motion/easing.py: names, or the handles of a cubic Bezier curve.

/** @import { Point } from "../types.js" */

/** @typedef {[x1: number, y1: number, x2: number, y2: number]} Handles */
/** @typedef {string | Handles} Easing */

const HELD = 0.99; // share of the time for which "hold" stays
const THIRD = 1 / 3;

/** @type {Record<string, { label: string, handles: Handles }>} */
const NAMED = {
  linear: { label: "Even", handles: [THIRD, THIRD, 2 * THIRD, 2 * THIRD] },
  in: { label: "Ease in", handles: [THIRD, 0, 2 * THIRD, THIRD] },
  out: { label: "Ease out", handles: [THIRD, 2 * THIRD, 2 * THIRD, 1] },
  "in-out": { label: "Ease in, out", handles: [THIRD, 0, 2 * THIRD, 1] },
};
const HOLD = "hold";

/** @type {[easing: string, label: string][]} */
export const PRESETS = [
  ...Object.entries(NAMED).map(
    ([name, { label }]) => /** @type {[string, string]} */ ([name, label]),
  ),
  [HOLD, "Hold"],
];

/**
 * The handles of an easing's curve; null for "hold", which is no curve.
 *
 * @param {Easing} easing
 * @returns {Handles | null}
 */
export function handlesOf(easing) {
  return typeof easing === "string" ? (NAMED[easing]?.handles ?? null) : easing;
}

/** @param {Easing} easing */
export function nameOf(easing) {
  return PRESETS.find(([name]) => name === easing)?.[1] ?? "Curve";
}

/**
 * The curve as an SVG path: the time to the right, the way up.
 *
 * @param {Easing} easing
 * @param {number} size of the square
 */
export function pathOf(easing, size) {
  const at = (/** @type {number} */ x, /** @type {number} */ y) =>
    `${Number((x * size).toFixed(2))} ${Number(((1 - y) * size).toFixed(2))}`;
  const handles = handlesOf(easing);
  if (!handles) return `M${at(0, 0)} L${at(HELD, 0)} L${at(1, 1)}`;
  const [x1, y1, x2, y2] = handles;
  return `M${at(0, 0)} C${at(x1, y1)} ${at(x2, y2)} ${at(1, 1)}`;
}

/**
 * The curve as a picture that is stretched over its room; its line stays as thick.
 *
 * @param {Easing} easing
 */
export function stretchedCurve(easing) {
  const path = pathOf(easing, 100);
  return (
    `<svg viewBox="0 0 100 100" preserveAspectRatio="none" aria-hidden="true">` +
    `<path vector-effect="non-scaling-stroke" d="${path}"/></svg>`
  );
}

/**
 * A curve with one handle elsewhere, in the unit square and at hundredths.
 *
 * @param {Easing} easing
 * @param {0 | 1} which
 * @param {Point} place
 * @returns {Handles}
 */
export function withHandle(easing, which, place) {
  const [x, y] = place.map((one) => Math.round(100 * Math.min(Math.max(one, 0), 1)) / 100);
  const [x1, y1, x2, y2] = handlesOf(easing) ?? NAMED.linear.handles;
  return which === 0 ? [x, y, x2, y2] : [x1, y1, x, y];
}
