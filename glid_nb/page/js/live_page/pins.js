// Pins as values: every function gives new lists.

/** @import { Pose } from "../live/types.js" */
/** @import { Point } from "../types.js" */
/** @import { Pin } from "./data.js" */

const LEAST_SCALE = 0.05;
const LARGEST_SCALE = 20;

/**
 * A pin that holds a point where it is.
 * @param {Point} handle
 * @param {Point} target
 * @returns {Pin}
 */
export function pinAt(handle, target) {
  return { handle, target, angle: null, scale: null, weight: 1, depth: 0, name: "" };
}

/**
 * The pins as the solver takes them.
 * @param {readonly Pin[]} pins
 * @returns {Pose}
 */
export function poseOf(pins) {
  return {
    handles: pins.map(({ handle }) => handle),
    targets: pins.map(({ target }) => target),
    weights: pins.map(({ weight }) => weight),
    angles: pins.map(({ angle }) => angle),
    scales: pins.map(({ scale }) => scale),
  };
}

/**
 * Pins of which some have changed.
 * @param {readonly Pin[]} pins
 * @param {readonly number[]} which
 * @param {(pin: Pin, i: number) => Partial<Pin>} change
 * @returns {Pin[]}
 */
export function changed(pins, which, change) {
  return pins.map((pin, i) => (which.includes(i) ? { ...pin, ...change(pin, i) } : pin));
}

/**
 * @param {readonly Pin[]} pins
 * @param {readonly number[]} which
 */
export function without(pins, which) {
  return pins.filter((_, i) => !which.includes(i));
}

/** @param {number} scale */
export function allowedScale(scale) {
  return Math.min(LARGEST_SCALE, Math.max(LEAST_SCALE, scale));
}

/**
 * An angle between -pi and pi.
 * @param {number} angle
 */
export function wrapped(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

/**
 * The number of the next pin; -1 without pins.
 * @param {number} count
 * @param {number | undefined} last the one that is selected
 * @param {number} step 1 or -1
 */
export function nextPin(count, last, step) {
  if (!count) return -1;
  const from = last ?? (step > 0 ? -1 : count);
  return (from + step + count) % count;
}

/**
 * Both poses with the pins of either. A pin that one of them lacks follows the shape there.
 * @param {readonly Pin[]} first
 * @param {readonly Pin[]} second
 * @param {(handle: Point) => Point} firstImage where the first pose's map takes a point
 * @param {(handle: Point) => Point} secondImage
 * @returns {[Pin[], Pin[]]}
 */
export function joined(first, second, firstImage, secondImage) {
  const inFirst = new Map(first.map((pin) => [keyOf(pin), pin]));
  const inSecond = new Map(second.map((pin) => [keyOf(pin), pin]));
  const keys = [...new Set([...inFirst.keys(), ...inSecond.keys()])];
  /** @type {[Pin[], Pin[]]} */
  const both = [[], []];
  for (const key of keys) {
    const a = inFirst.get(key) ?? /** @type {Pin} */ (inSecond.get(key));
    const b = inSecond.get(key) ?? a;
    both[0].push(inFirst.has(key) ? a : pinAt(a.handle, firstImage(a.handle)));
    both[1].push(inSecond.has(key) ? b : pinAt(b.handle, secondImage(b.handle)));
  }
  return both;
}

/**
 * Pins on the way from one pose to another, which has the same handles.
 * @param {readonly Pin[]} first
 * @param {readonly Pin[]} second
 * @param {number} share
 * @returns {Pin[]}
 */
export function between(first, second, share) {
  const mixed = (/** @type {number} */ a, /** @type {number} */ b) => a + share * (b - a);
  return first.map((a, i) => {
    const b = second[i];
    const turn = a.angle === null || b.angle === null ? null : wrapped(b.angle - a.angle);
    return {
      ...a,
      target: [mixed(a.target[0], b.target[0]), mixed(a.target[1], b.target[1])],
      weight: mixed(a.weight, b.weight),
      angle: a.angle === null || turn === null ? null : a.angle + share * turn,
      scale: a.scale === null || b.scale === null ? null : mixed(a.scale, b.scale),
    };
  });
}

/** @param {Pin} pin */
function keyOf({ handle }) {
  return handle.join();
}
