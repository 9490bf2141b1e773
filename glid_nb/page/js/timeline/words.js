// What the timeline says of a motion.

/** @import { Shown } from "./traits.js" */
/** @import { Segment } from "./worst.js" */

const KERNEL = "Played by the kernel (too large for shaders). ";

/** @param {number} time */
export function seconds(time) {
  return `${time.toFixed(2)} s`;
}

/**
 * What the timeline says, and of which kind that is: what to do next, what goes on, why something is
 * not proved, or what lies below the pointer. At one time one place of the editor gives advice (timeline.css).
 *
 * @typedef {{ text: string, kind: "advice" | "recording" | "bad" | "state" | "hover" }} Note
 */

/**
 * @param {Shown} shown
 * @param {Segment[]} segments
 * @returns {Note}
 */
export function noteOn({ keyframes, recording, kernel }, segments) {
  if (recording) {
    const text = "Recording: drag a pin; its movement becomes keyframes.";
    return { text, kind: "recording" };
  }
  const bad = segments.find(({ reason }) => reason);
  if (bad) return { text: reasonOf(bad), kind: "bad" };
  if (!segments.length) {
    const alone = keyframes.length < 2;
    const text = alone ? "Key (K) a second pose to see the motion between them." : "";
    return { text, kind: "advice" };
  }
  return { text: (kernel ? KERNEL : "") + proofOf(segments), kind: "state" };
}

/**
 * Why a segment is not proved, with the part if there are several.
 *
 * @param {Segment} segment
 */
export function reasonOf({ start, end, reason, part }) {
  const text = reason || `Not proved yet from ${seconds(start)} to ${seconds(end)}`;
  return part ? `${part}: ${text}` : text;
}

/**
 * What is proved of a piece, with the part that is worst if there are several.
 *
 * @param {import("./worst.js").Piece} piece
 */
export function boundOf({ start, end, sigma2, part }) {
  const text = `σ₂ ≥ ${sigma2.toFixed(3)} from ${seconds(start)} to ${seconds(end)}`;
  return part ? `${text}; the worst part is ${part}` : text;
}

/** @param {Segment[]} segments */
function proofOf(segments) {
  if (segments.some(({ status }) => status === "computing")) {
    return "Proving the motion between poses…";
  }
  const pieces = segments.flatMap((segment) => segment.pieces);
  const { sigma2, part } = pieces.reduce((a, b) => (b.sigma2 < a.sigma2 ? b : a));
  const lasts = seconds(segments[segments.length - 1].end - segments[0].start);
  const where = part ? ` (${part})` : "";
  return `Proved at every instant of ${lasts}: σ₂ ≥ ${sigma2.toFixed(3)}${where}.`;
}
