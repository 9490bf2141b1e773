// Drawing on a 2D canvas, in CSS pixels.

import { penOf } from "./dom.js";

/** @import { Point, Strokes } from "../types.js" */
/** @typedef {CanvasRenderingContext2D} Pen */

const NEARLY_NOTHING = "rgba(255, 255, 255, 0.004)"; // one step of 255

/**
 * A function that has draw(pen) fill a canvas in the next frame, in the CSS pixels of a view,
 * however often it is called until then.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {{ width: number, height: number }} view
 * @param {AbortSignal} signal ends it
 * @param {(pen: Pen) => void} draw
 */
export function painter(canvas, view, signal, draw) {
  let due = 0;
  signal.addEventListener("abort", () => cancelAnimationFrame(due));
  return () => {
    if (due) return;
    due = requestAnimationFrame(() => {
      due = 0;
      draw(clearedPen(canvas, view));
    });
  };
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {{ width: number, height: number }} view
 */
function clearedPen(canvas, { width, height }) {
  const ratio = window.devicePixelRatio || 1;
  const wide = Math.round(width * ratio);
  const high = Math.round(height * ratio);
  if (canvas.width !== wide || canvas.height !== high) {
    canvas.width = wide;
    canvas.height = high;
  }
  const pen = penOf(canvas);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  // Chromium with GPU raster does not show a frame that only clears. Something nearly transparent
  // makes it draw.
  pen.fillStyle = NEARLY_NOTHING;
  pen.fillRect(0, 0, width, height);
  return pen;
}

/**
 * @param {Pen} pen
 * @param {Point} centre
 * @param {number} radius
 * @param {Strokes} strokes
 * @param {number[]} [dash]
 */
export function circle(pen, [x, y], radius, strokes, dash) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  strokePath(pen, strokes, dash);
}

/**
 * @param {Pen} pen
 * @param {Point} place
 * @param {number} radius
 * @param {string} fill
 * @param {string} [stroke]
 * @param {number} width
 */
export function disk(pen, place, radius, fill, stroke, width = 1) {
  circle(pen, place, radius, []);
  pen.fillStyle = fill;
  pen.fill();
  if (stroke) strokePath(pen, [[width, stroke]]);
}

/**
 * Begins a path along lines of points, by default closed.
 *
 * @param {Pen} pen
 * @param {Point[][]} lines
 * @param {boolean} closed
 */
export function tracePath(pen, lines, closed = true) {
  pen.beginPath();
  for (const line of lines) {
    line.forEach(([x, y], i) => {
      if (i) pen.lineTo(x, y);
      else pen.moveTo(x, y);
    });
    if (closed) pen.closePath();
  }
}

/**
 * The corners of a rectangle between two opposite ones.
 *
 * @param {Point} corner
 * @param {Point} opposite
 * @returns {Point[]}
 */
export function rectangle([left, top], [right, bottom]) {
  return [
    [left, top],
    [right, top],
    [right, bottom],
    [left, bottom],
  ];
}

/**
 * Fills the inside of lines of points, by default with their holes left out, and keeps their path.
 *
 * @param {Pen} pen
 * @param {Point[][]} lines
 * @param {string | CanvasPattern} style
 * @param {CanvasFillRule} rule
 */
export function fillPath(pen, lines, style, rule = "evenodd") {
  tracePath(pen, lines);
  pen.fillStyle = style;
  pen.fill(rule);
}

/**
 * Strokes the present path.
 *
 * @param {Pen} pen
 * @param {Strokes} strokes
 * @param {number[]} dash
 */
export function strokePath(pen, strokes, dash = []) {
  pen.setLineDash(dash);
  for (const [width, style] of strokes) {
    pen.lineWidth = width;
    pen.strokeStyle = style;
    pen.stroke();
  }
  pen.setLineDash([]);
}
