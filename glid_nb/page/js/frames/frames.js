// Which frame belongs to the sliders' positions, and its words.

/** @import { Control, Frames } from "./data.js" */

/**
 * The number of the frame. The last control's position changes first.
 *
 * @param {Control[]} controls
 * @param {number[]} positions
 */
export function frameAt(controls, positions) {
  return controls.reduce((at, { values }, i) => at * values.length + positions[i], 0);
}

/**
 * A frame as SVG.
 *
 * @param {Frames} data
 * @param {number} at
 */
export function svgOf({ lines, frames }, at) {
  return frames[at].map((line) => lines[line]).join("\n");
}

/**
 * The words of a picture for screen readers.
 *
 * @param {Frames} data
 * @param {number[]} positions
 */
export function wordsOf({ controls, titles }, positions) {
  const where = controls.map(({ name, values }, i) => `${name} = ${values[positions[i]]}`);
  const title = titles[frameAt(controls, positions)];
  return where.join(", ") + (title && `: ${title}`);
}
