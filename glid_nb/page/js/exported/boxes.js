// Boxes in the world, and the view that shows one.

/** @import { Box } from "./data.js" */

/**
 * The box around boxes.
 *
 * @param {Box[]} boxes
 * @returns {Box}
 */
export function around(boxes) {
  const all = (/** @type {number} */ side) => boxes.map((box) => box[side]);
  return [Math.min(...all(0)), Math.min(...all(1)), Math.max(...all(2)), Math.max(...all(3))];
}

/**
 * The view that shows a box.
 *
 * @param {Box} box
 * @param {number} width CSS pixels
 * @param {number} height
 * @param {number} margin on each side, as a share of the view
 */
export function viewOn([left, bottom, right, top], width, height, margin) {
  const room = 1 - 2 * margin;
  const unit = Math.max((right - left) / width, (top - bottom) / height) / room;
  return { width, height, unit, x: (left + right) / 2, y: (bottom + top) / 2 };
}
