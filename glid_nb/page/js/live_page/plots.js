// Small plots of the last steps: the certified bound, the energy, and the time of a step.

import { make, penOf } from "../pad/dom.js";
import { strokePath, tracePath } from "../pad/pen.js";

/** @import { Point } from "../types.js" */

const LENGTH = 90; // values
const MARGIN = 2; // CSS pixels

/**
 * Where a line goes through values in a box, the newest at its right end.
 * @param {number[]} values
 * @param {number} width
 * @param {number} height
 * @param {[least: number, most: number] | null} range null for that of the values
 * @returns {Point[]}
 */
export function lineThrough(values, width, height, range) {
  const [low, high] = range ?? [Math.min(...values), Math.max(...values)];
  const span = Math.max(high - low, 1e-12);
  const step = (width - 2 * MARGIN) / (LENGTH - 1);
  return values.map((value, i) => {
    const share = Math.min(Math.max((value - low) / span, 0), 1);
    const x = width - MARGIN - (values.length - 1 - i) * step;
    return [x, height - MARGIN - share * (height - 2 * MARGIN)];
  });
}

export class Plot {
  /** @type {number[]} */
  #values = [];

  /**
   * @param {string} title
   * @param {string} about its tooltip
   * @param {[number, number] | null} range
   * @param {(value: number) => string} words
   */
  constructor(title, about, range, words) {
    this.range = range;
    this.words = words;
    this.value = make("output", {});
    this.canvas = make("canvas", { "aria-hidden": "true" });
    const name = make("span", {}, title);
    this.element = make("div", { className: "plot", title: about }, name, this.value, this.canvas);
  }

  /** @param {number} value */
  add(value) {
    this.#values.push(value);
    if (this.#values.length > LENGTH) this.#values.shift();
  }

  draw() {
    const { canvas } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (!width || !height) return;
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = penOf(canvas);
    pen.scale(ratio, ratio);
    const line = lineThrough(this.#values, width, height, this.range);
    const last = line.at(-1);
    if (!last) return;
    this.value.textContent = this.words(this.#values[line.length - 1]);
    const color = getComputedStyle(canvas).color;
    const [first] = line;
    tracePath(pen, [[...line, [last[0], height], [first[0], height]]]);
    pen.globalAlpha = 0.12;
    pen.fillStyle = color;
    pen.fill();
    pen.globalAlpha = 1;
    pen.lineJoin = "round";
    tracePath(pen, [line], false);
    strokePath(pen, [[1.5, color]]);
    pen.beginPath();
    pen.arc(last[0], last[1], 2, 0, 2 * Math.PI);
    pen.fillStyle = color;
    pen.fill();
  }
}
