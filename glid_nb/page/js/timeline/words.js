// What the timeline says of a motion.

/** @import { Shown, Span } from "./traits.js" */

const KERNEL = "Played by the kernel (too large for shaders). ";

/** @param {number} time */
export function seconds(time) {
  return `${time.toFixed(2)} s`;
}

/**
 * @param {Shown} shown
 * @param {Span[]} spans
 */
export function noteOn({ keyframes, recording, kernel }, spans) {
  const bad = spans.find(({ reason }) => reason);
  const note = state(keyframes.length, recording, bad?.reason, spans);
  return kernel && spans.length && !bad ? KERNEL + note : note;
}

/**
 * @param {number} count of keyframes
 * @param {boolean} recording
 * @param {string | undefined} reason why it is not proved
 * @param {Span[]} spans
 */
function state(count, recording, reason, spans) {
  if (recording) return "Recording: drag a pin; its movement becomes keyframes.";
  if (reason) return reason;
  if (spans.some(({ status }) => status === "computing"))
    return "Proving the motion between poses…";
  const last = spans.at(-1);
  if (!last) return count < 2 ? "Key (K) a second pose to see the motion between them." : "";
  const least = Math.min(...spans.flatMap(({ sigma2 }) => sigma2));
  const lasts = seconds(last.end - spans[0].start);
  return `Proved at every instant of ${lasts}: σ₂ ≥ ${least.toFixed(3)}.`;
}
