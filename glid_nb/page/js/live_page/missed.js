// Says at a pin that the shape cannot follow it.

/** @import { Marks } from "../canvas/traits.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { View } from "../pad/view.js" */

const ABOVE = 20; // CSS pixels
const PADDING = 8;
const HEIGHT = 22;
const GROUND = "#9a3b00";

/**
 * @param {Pen} pen
 * @param {View} view
 * @param {Marks} marks
 * @param {number[]} missed the pins' numbers
 * @param {boolean} refused whether a step was refused because it was not proved
 */
export function drawMissed(pen, view, marks, missed, refused) {
  const text = refused ? "would fold: the shape stays here" : "as far as the shape goes";
  pen.font = "600 12px system-ui, sans-serif";
  pen.textBaseline = "middle";
  const width = pen.measureText(text).width + 2 * PADDING;
  for (const i of missed) {
    const [x, y] = view.toScreen(marks.targets[i]);
    const left = Math.min(Math.max(x - width / 2, 4), view.width - width - 4);
    const top = y > HEIGHT + 2 * ABOVE ? y - ABOVE - HEIGHT : y + ABOVE;
    pen.beginPath();
    pen.roundRect(left, top, width, HEIGHT, HEIGHT / 2);
    pen.fillStyle = GROUND;
    pen.fill();
    pen.fillStyle = "#fff";
    pen.fillText(text, left + PADDING, top + HEIGHT / 2);
  }
}
