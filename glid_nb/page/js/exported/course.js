// How the time runs: by itself, or along the motion to a pose.

/** @import { Motion } from "../motion/motion.js" */

/**
 * A way through time: `at` gives the time so many ms after it began, while it lasts.
 *
 * @typedef {object} Course
 * @property {boolean} plays whether it is the motion that plays
 * @property {number} lasts ms
 * @property {(ms: number) => number} at
 */

const GLIDE = 600; // ms

/**
 * The motion that plays from a time on; with `loop` for ever, else to its end.
 *
 * @param {Motion<any>} motion
 * @param {number} time
 * @param {boolean} loop
 * @returns {Course}
 */
export function playedFrom(motion, time, loop) {
  const { start, end } = motion;
  const span = end - start;
  const from = (!loop && time >= end ? start : time) - start;
  const lasts = loop ? Infinity : 1000 * (span - from);
  const at = (/** @type {number} */ ms) =>
    ms === lasts ? end : start + ((from + ms / 1000) % span);
  return { plays: true, lasts, at };
}

/**
 * Along the motion to a time, so that everything on the way is proved. A loop goes the shorter way
 * round.
 *
 * @param {Motion<any>} motion
 * @param {number} time
 * @param {number} to
 * @returns {Course}
 */
export function glideTo(motion, time, to) {
  const { last, repeat } = motion;
  const from = repeat === "ping-pong" && time > last ? 2 * last - time : time;
  const goal = repeat === "loop" ? nearestTurn(from, to, motion.end - motion.start) : to;
  const at = (/** @type {number} */ ms) =>
    ms < GLIDE ? from + eased(ms / GLIDE) * (goal - from) : goal;
  return { plays: false, lasts: GLIDE, at };
}

/**
 * @param {number} from
 * @param {number} to
 * @param {number} span of a turn
 */
function nearestTurn(from, to, span) {
  const far = (/** @type {number} */ goal) => Math.abs(goal - from);
  const goals = [to, to + span, to - span];
  return goals.reduce((best, goal) => (far(goal) < far(best) ? goal : best));
}

/** @param {number} share */
function eased(share) {
  return share * share * (3 - 2 * share);
}
