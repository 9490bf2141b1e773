// Which frame belongs to the sliders' positions, its words, and where a dragged point leads.

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

/**
 * These positions, and those of which each slider is at most one step away.
 *
 * @param {Control[]} controls
 * @param {number[]} positions
 */
function around(controls, positions) {
  let found = [/** @type {number[]} */ ([])];
  controls.forEach(({ values, check }, i) => {
    const steps = check ? [0] : [0, -1, 1];
    const here = steps.map((step) => positions[i] + step).filter((at) => at in values);
    found = found.flatMap((before) => here.map((at) => [...before, at]));
  });
  return found;
}

/**
 * The positions to which dragging the point leads. They are reached step by step, each nearer to
 * the hand. So a point that walks around a hole twice does not forget the first round.
 *
 * @param {Control[]} controls
 * @param {[x: number, y: number][]} points of each frame, in pixels
 * @param {number[]} positions
 * @param {[x: number, y: number]} hand in pixels
 */
export function dragged(controls, points, positions, hand) {
  const far = (/** @type {number[]} */ at) => {
    const [x, y] = points[frameAt(controls, at)];
    return Math.hypot(x - hand[0], y - hand[1]);
  };
  let now = positions;
  for (;;) {
    const next = around(controls, now).reduce((best, at) => (far(at) < far(best) ? at : best));
    if (far(next) >= far(now)) return now;
    now = next;
  }
}
