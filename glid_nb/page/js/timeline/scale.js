// Where things lie along time.

/** @import { Keyframe, Shown } from "./traits.js" */

const LATER = 0.15; // room behind the last keyframe, for the next one, as a share of its time
const LEAST = 1.15; // s, of this room
const MOST_LABELS = 12;
const LABEL = 48; // CSS pixels that a label needs
const STEPS = [0.02, 0.04, 0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60, 300, 600]; // s between labels
const LONGEST_STEP = 1800;
const SAME = 1e-9; // s
const WHOLE = 1e-6; // frames
const ROUNDING = 0.006; // s: times are rounded to hundredths

/**
 * The keyframes, and of a loop its return to the first.
 *
 * @param {Shown} shown
 * @returns {Keyframe[]}
 */
export function withReturn({ keyframes, repeat, back }) {
  const last = keyframes.at(-1);
  if (repeat !== "loop" || keyframes.length < 2 || !last) return keyframes;
  const [first] = keyframes;
  return [...keyframes, { ...first, time: last.time + back, name: `Back to ${first.name}` }];
}

/**
 * How much time the track shows, from 0 on.
 *
 * @param {Keyframe[]} keyframes
 */
export function spanOf(keyframes) {
  const last = keyframes.at(-1)?.time ?? 0;
  return last + Math.max(LEAST, LATER * last);
}

/**
 * The time between a keyframe and its nearest neighbour, by default the span.
 *
 * @param {Keyframe[]} keyframes
 * @param {number} index
 * @param {number} span
 */
export function roomAt(keyframes, index, span) {
  const { time } = keyframes[index];
  const before = index > 0 ? time - keyframes[index - 1].time : span;
  const after = index + 1 < keyframes.length ? keyframes[index + 1].time - time : span;
  return Math.min(before, after);
}

/**
 * The times that get a label.
 *
 * @param {number} span
 * @param {number} width of the span in CSS pixels; 0 while it is not known
 * @param {number} zoom how many times as wide as the window it is
 */
export function labelledTimes(span, width = 0, zoom = 1) {
  const most = width ? Math.min(width / LABEL, MOST_LABELS * zoom) : MOST_LABELS;
  const step = STEPS.find((one) => span / one <= most) ?? LONGEST_STEP;
  return Array.from({ length: Math.floor(span / step) + 1 }, (_, i) => i * step);
}

/**
 * The frame of an export that shows a time; null between two frames.
 *
 * @param {number} time
 * @param {number} rate frames in a second
 */
export function frameAt(time, rate) {
  const frame = Math.round(time * rate);
  return Math.abs(frame - time * rate) < WHOLE ? frame : null;
}

/**
 * The index of the keyframe at a time, -1 for none.
 *
 * @param {Keyframe[]} keyframes
 * @param {number} time
 */
export function keyAt(keyframes, time) {
  return keyframes.findIndex((key) => Math.abs(key.time - time) < SAME);
}

/**
 * The index of the next keyframe after a time, or before it; null for none.
 *
 * @param {Keyframe[]} keyframes
 * @param {number} time
 * @param {1 | -1} sign
 */
export function nextKey(keyframes, time, sign) {
  const beyond = [...keyframes.keys()].filter((i) => sign * (keyframes[i].time - time) > SAME);
  return (sign > 0 ? beyond[0] : beyond.at(-1)) ?? null;
}

/**
 * The time nearest to one at which a keyframe, or a loop's return, can be told from the others.
 *
 * @param {Keyframe[]} keyframes
 * @param {number} index of the keyframe; their number for the return
 * @param {number} time
 * @param {number} least seconds from any other
 */
export function landing(keyframes, index, time, least) {
  const gap = Math.ceil(100 * least) / 100;
  const others = keyframes.filter((_, i) => i !== index).map((key) => key.time);
  const earliest = index < keyframes.length ? 0 : (others.at(-1) ?? 0) + gap;
  const free = (/** @type {number} */ at) =>
    at >= earliest && others.every((other) => Math.abs(at - other) > gap - ROUNDING);
  const places = [
    Math.max(time, earliest),
    ...others.flatMap((other) => [other - gap, other + gap]),
  ];
  const far = (/** @type {number} */ at) => Math.abs(at - time);
  return places
    .map((at) => Math.round(100 * at) / 100)
    .filter(free)
    .sort((a, b) => far(a) - far(b))[0];
}
