// The numbers of a pin beside it while the hand moves or turns it.

import { strokePath, tracePath } from "../pad/pen.js";
import { pixelAt } from "./constrain.js";

/** @import { Found, Mark, Point } from "../types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { View } from "../pad/view.js" */
/** @import { Marks } from "./traits.js" */

// CSS pixels.
const BESIDE = 20; // between the pin and its numbers
const PADDING = 6;
const LINE = 16;

const FONT = "600 11px system-ui, sans-serif";
const GROUND = "rgba(25,28,34,0.88)";
const INK = "#ffffff";
const GUIDE = "#d55e00";

/**
 * A press of the left button.
 *
 * @typedef {object} Pressing
 * @property {Found | null} found what was there
 * @property {Point} [start] the place of the pin that is dragged, when it was pressed
 * @property {number} pins how many pins there were
 * @property {{ axis: boolean, whole: boolean }} [keys] what the last move was kept on
 */

/**
 * What a drag moves: the pin, where it is, and its numbers in words.
 *
 * @typedef {object} Moved
 * @property {Point} at
 * @property {string[]} words
 */

/**
 * @param {Pressing} pressed
 * @param {Marks} marks
 * @param {Map<Mark, Point>} held where the pointer holds targets
 * @param {number[]} size width and height of the picture in pixels
 * @returns {Moved | null} null if no pin is moved
 */
export function movedPin(pressed, marks, held, size) {
  const mark = pinOf(pressed, marks);
  if (mark === undefined || !marks.targets[mark]) return null;
  const at = held.get(mark) ?? marks.targets[mark];
  if (pressed.found?.part) return { at, words: turnWords(marks.ring) };
  const [x, y] = at;
  const words = [`x ${coordinate(x)}   y ${coordinate(y)}`];
  if (pressed.keys?.whole && size.length) {
    const [px, py] = pixelAt(at, size).map(Math.round);
    words.push(`pixel ${px}, ${py}`);
  }
  return { at, words };
}

/**
 * The pin that is moved: the one that was pressed, or the one that a drag of the shape has made.
 *
 * @param {Pressing} pressed
 * @param {Marks} marks
 */
function pinOf({ found, pins }, { selected, targets }) {
  if (found?.mark !== undefined) return Number(found.mark);
  return found?.part || targets.length > pins ? selected.at(-1) : undefined;
}

/**
 * By how much the shape is turned and scaled at a pin, also where that is free.
 *
 * @param {Marks["ring"]} ring
 */
export function turnWords([angle = 0, scale = 1, turned, scaled]) {
  const freely = (/** @type {boolean | undefined} */ wanted) => (wanted ? "" : " free");
  const degrees = Number(((angle * 180) / Math.PI).toFixed(1)) || 0; // avoids -0
  return [`${degrees}°${freely(turned)}`, `× ${scale.toFixed(2)}${freely(scaled)}`];
}

/**
 * As the inspector writes it, but always as long.
 *
 * @param {number} number
 */
function coordinate(number) {
  return (number || 0).toFixed(3).replace("-", "−");
}

/**
 * @param {Pen} pen
 * @param {View} view
 * @param {Moved} moved
 */
export function drawNumbers(pen, view, { at, words }) {
  if (!words.length) return;
  const [x, y] = view.toScreen(at);
  pen.font = FONT;
  const width = Math.max(...words.map((text) => pen.measureText(text).width)) + 2 * PADDING;
  const height = LINE * words.length + PADDING;
  const beside = x + BESIDE + width <= view.width ? x + BESIDE : x - BESIDE - width;
  const left = Math.max(beside, 2); // a narrow canvas has no room at either side
  const top = Math.min(Math.max(y - BESIDE - height, 2), view.height - height - 2);
  pen.beginPath();
  pen.roundRect(left, top, width, height, 4);
  pen.fillStyle = GROUND;
  pen.fill();
  pen.fillStyle = INK;
  pen.textBaseline = "middle";
  words.forEach((text, i) => {
    pen.fillText(text, left + PADDING, top + PADDING / 2 + LINE * (i + 0.5));
  });
}

/**
 * The axis on which Shift keeps a pin.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {Point} start the pin's place when the drag began
 * @param {Point} at where it is
 */
export function drawAxis(pen, view, start, at) {
  const [x, y] = view.toScreen(start);
  const across = start[1] === at[1];
  /** @type {[Point, Point]} */
  const line = across
    ? [
        [0, y],
        [view.width, y],
      ]
    : [
        [x, 0],
        [x, view.height],
      ];
  tracePath(pen, [line], false);
  strokePath(pen, [[1, GUIDE]], [4, 4]);
}
