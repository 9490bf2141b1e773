// From one kept pose to the next: the pins move on straight lines, and the solver follows, certified step
// by step. Where it has got to at even times are the knots of the motion.

import { between, joined, keyOf, poseOf } from "./pins.js";

/** @import { Coefficients } from "../live/types.js" */
/** @import { Point } from "../types.js" */
/** @import { Handle, Kept, Pin } from "./data.js" */
/** @import { Solver } from "../live/solving_types.js" */

export const KNOTS = 12; // of an interval

/** @typedef {{ coefficients: Coefficients, sigma2: number }} Knot */

/**
 * The knots after a pose, up to the next one. The last knot is what the solver has reached there.
 * @param {Solver} solving
 * @param {Kept} first
 * @param {Kept} second
 * @param {Coefficients} start where the way begins, near the first pose's map
 * @returns {Promise<Knot[]>}
 */
export async function wayBetween(solving, first, second, start) {
  const handles = [...first.pins, ...second.pins];
  const from = await imagesAt(solving, handles, start);
  const to = await imagesAt(solving, handles, second.frame.coefficients);
  const [leaving, arriving] = joined(first.pins, second.pins, from, to);
  await solving.map({ type: "place", pose: poseOf(leaving), coefficients: start });
  /** @type {Knot[]} */
  const knots = [];
  for (let i = 1; i <= KNOTS; i++) {
    const pins = between(leaving, arriving, eased(i / KNOTS));
    const { coefficients, certificate } = await solving.map({ type: "drag", pose: poseOf(pins) });
    knots.push({ coefficients, sigma2: certificate.sigma2_lower });
  }
  return knots;
}

/**
 * Where a map takes the handles of pins.
 * @param {Solver} solving
 * @param {Pin[]} pins
 * @param {Coefficients} coefficients
 * @returns {Promise<(handle: Handle) => Point>}
 */
async function imagesAt(solving, pins, coefficients) {
  const handles = pins.map(({ handle }) => handle);
  const places = /** @type {Point[]} */ (handles);
  const held = { handles: places, targets: places };
  const { pins: found } = await solving.map({ type: "place", pose: held, coefficients });
  return (handle) => {
    const i = handles.findIndex((one) => keyOf(one) === keyOf(handle));
    return [found.images[2 * i], found.images[2 * i + 1]];
  };
}

/** @param {number} share */
function eased(share) {
  return share * share * (3 - 2 * share);
}
