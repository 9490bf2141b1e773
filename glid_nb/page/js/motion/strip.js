// The strip that shows what is proved along a motion, as the editor's timeline does: one colour, and
// the higher the larger is the bound on sigma_2. What is not proved is grey.

/** @import { Motion } from "./motion.js" */

const STRIPES = 100; // each as wide as 1 %
const LEAST_HEIGHT = 0.06; // of what is proved, as a share of the strip's
const UNPROVED = "#7f7f7f";

/** The height of a piece with this bound, as a share of the strip's. @param {number} bound */
export function heightOf(bound) {
  return Math.min(Math.max(bound, LEAST_HEIGHT), 1);
}

/**
 * A background of layers side by side.
 *
 * @param {Motion<Float32Array> | Motion<Float64Array>} motion
 * @param {(time: number) => number} boundAt the bound on sigma_2; negative where nothing is proved
 */
export function proofStrip(motion, boundAt) {
  const layers = Array.from({ length: STRIPES }, (_, i) => {
    const bound = boundAt(motion.start + ((i + 0.5) / STRIPES) * (motion.end - motion.start));
    const [fill, height] = bound < 0 ? [UNPROVED, 1] : ["var(--accent)", heightOf(bound)];
    // A position in per cent aligns that per cent of the layer with that per cent of the strip.
    const left = (100 * i) / (STRIPES - 1);
    return `linear-gradient(${fill} 0 0) ${left}% 100%/1% ${100 * height}% no-repeat`;
  });
  return layers.join();
}
