// The pins that a drag takes while a motion is seen: those of the keyframe there, or of the one before,
// where the shape carries them. Between two knots they move on straight lines, as the coefficients do.

import { Motion } from "../motion/motion.js";
import { toFloats } from "../pad/dom.js";

/** @import { Point } from "../types.js" */
/** @import { MovingPins, Pins, PinsThen } from "./traits.js" */

const LEAST_GAP = 1e-3; // s, as in the kernel, which rounds times to hundredths

/**
 * Where pins are at a time of the motion.
 *
 * @param {MovingPins} pins
 * @param {number} at
 * @returns {PinsThen}
 */
export function pinsAt({ spans, poses, keyframes }, at) {
  const time = Math.round(100 * at) / 100;
  const index = keyframes.findIndex((key) => Math.abs(key - time) < LEAST_GAP);
  if (index >= 0) return ofPose(poses[index % poses.length]);
  const span = spans.find(({ end }) => at <= end) ?? spans.at(-1);
  const floats = toFloats(span?.floats);
  if (!span || !floats.length) return { places: [], locked: [] };
  const motion = new Motion({ times: span.times, repeat: "once" }, floats);
  return { places: pairs(motion.at(at)), locked: span.locked };
}

/**
 * Where pins are after the last keyframe.
 *
 * @param {MovingPins} pins
 * @returns {PinsThen}
 */
export function pinsLater({ poses }) {
  return ofPose(poses.at(-1));
}

/**
 * @param {Pins} [pins]
 * @returns {PinsThen}
 */
function ofPose(pins) {
  return { places: pairs(toFloats(pins?.floats)), locked: pins?.locked ?? [] };
}

/**
 * @param {Float32Array} numbers
 * @returns {Point[]}
 */
function pairs(numbers) {
  return Array.from({ length: numbers.length / 2 }, (_, i) => [numbers[2 * i], numbers[2 * i + 1]]);
}
