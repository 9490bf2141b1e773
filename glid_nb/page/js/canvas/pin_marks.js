// Pins that are locked, hidden by the user, or grouped. The live page has no such pins.

import { fillPath, rectangle, strokePath, tracePath } from "../pad/pen.js";

/** @import { Point, Strokes } from "../types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { View } from "../pad/view.js" */
/** @import { Marks, PinMarks } from "./traits.js" */

// The padlock beside a pin, CSS pixels.
const BESIDE = 9; // its middle is so far to the right of the pin's, and so far below it
const WIDE = 5; // half of its body's width
const HIGH = 3.5; // half of its body's height
const PAPER = "rgba(255,255,255,0.9)";
const INK = "#2b2b2b";

/**
 * The marks with hidden pins elsewhere: where nothing is drawn (NaN), or out of reach (Infinity).
 *
 * @param {Marks} marks
 * @param {PinMarks} pins
 * @param {number} elsewhere
 * @returns {Marks}
 */
export function withoutHidden(marks, { away }, elsewhere) {
  if (!away.length) return marks;
  const placed = (/** @type {Point[]} */ points) =>
    points.map((point, i) =>
      away.includes(i) ? /** @type {Point} */ ([elsewhere, elsewhere]) : point,
    );
  return { ...marks, targets: placed(marks.targets), images: placed(marks.images) };
}

/**
 * The pins that a drag of one of them moves: those that are selected with it, unless they are locked.
 * The kernel's gestures use the same rule.
 *
 * @param {number} pressed
 * @param {number[]} selected
 * @param {PinMarks} pins
 */
export function movedWith(pressed, selected, { locked, groups }) {
  if (locked.includes(pressed)) return [];
  if (selected.includes(pressed)) return selected.filter((i) => !locked.includes(i));
  const group = groups[pressed];
  if (!group) return [pressed];
  return [...groups.keys()].filter((i) => groups[i] === group && !locked.includes(i));
}

/**
 * A padlock beside each locked pin that is drawn.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {Marks} marks
 * @param {PinMarks} pins
 */
export function drawLocks(pen, view, { targets }, { locked }) {
  for (const i of locked) if (targets[i]) drawLock(pen, view.toScreen(targets[i]));
}

/**
 * @param {Pen} pen
 * @param {Point} pin
 */
function drawLock(pen, [x, y]) {
  const [cx, cy] = [x + BESIDE, y + BESIDE];
  pen.beginPath();
  pen.arc(cx, cy - HIGH, WIDE - 1.5, Math.PI, 0);
  /** @type {Strokes} */
  const shackle = [
    [4, PAPER],
    [1.8, INK],
  ];
  strokePath(pen, shackle);
  const body = rectangle([cx - WIDE, cy - HIGH], [cx + WIDE, cy + HIGH]);
  tracePath(pen, [body]);
  strokePath(pen, [[2.5, PAPER]]);
  fillPath(pen, [body], INK);
}
