// Pins on the screen: what is at a place, the ring around the pin that was selected last, and the
// arrows to pins that are out of sight.

import { nearest } from "../pad/hit.js";
import { distance } from "../pad/view.js";

/** @import { Found, Mark, Point } from "../types.js" */
/** @import { View } from "../pad/view.js" */
/** @import { Marks } from "./traits.js" */

// CSS pixels.
export const KNOB = 6; // half a side of the ring's knob
const KNOB_REACH = 4; // around the knob
const RADIUS = 42; // of the ring, and of its knob where the scale is 1 or free
const LEAST_RADIUS = 24; // of the knob around the pin
const EDGE = 14; // between an arrow and the edge
const CORNER = [36, 112]; // width and height of the buttons in the corner
const ARROW_REACH = 12;

/**
 * The ring around the pin that was selected last: where it is, and its knob, on the screen. The ring
 * is as large for every scale. A wanted scale is the knob's distance, within limits.
 *
 * @param {View} view
 * @param {Marks} marks
 * @param {Map<Mark, Point>} [held] where the pointer holds targets
 */
export function dial(view, marks, held) {
  const last = marks.selected.at(-1);
  const [angle, scale, , scaled] = marks.ring;
  if (angle === undefined || scale === undefined) return null;
  if (last === undefined || !marks.targets[last]) return null;
  const centre = view.toScreen(held?.get(last) ?? marks.targets[last]);
  const far = RADIUS * (scaled ? Math.min(2.5, Math.max(0.5, scale)) : 1);
  return { centre, radius: RADIUS, knob: knobInside(view, centre, far, angle) };
}

/**
 * The place of the knob: at its angle and distance, as far as the view goes. Near a corner of the view
 * that would be on the pin, so there it is at another angle.
 *
 * @param {View} view
 * @param {Point} centre
 * @param {number} radius
 * @param {number} angle
 * @returns {Point}
 */
function knobInside(view, centre, radius, angle) {
  const places = [0, 1, -1, 2, -2, 3, -3, 4].map((eighths) => {
    const direction = angle + (eighths * Math.PI) / 4;
    const x = centre[0] + radius * Math.cos(direction);
    const y = centre[1] - radius * Math.sin(direction);
    return /** @type {Point} */ ([within(x, view.width), within(y, view.height)]);
  });
  return places.find((place) => distance(place, centre) >= LEAST_RADIUS) ?? places[0];
}

/**
 * Whether the ring's knob is below the corner's buttons.
 *
 * @param {View} view
 * @param {Marks} marks
 * @param {Map<Mark, Point>} held
 */
export function knobInCorner(view, marks, held) {
  const [x, y] = dial(view, marks, held)?.knob ?? [0, 0];
  return x > view.width - CORNER[0] - KNOB && y < CORNER[1] + KNOB;
}

/**
 * The part of the ring at a place on the screen; null for none.
 *
 * @param {View} view
 * @param {Marks} marks
 * @param {Point} place
 * @param {number} reach CSS pixels
 * @returns {Found | null}
 */
export function ringAt(view, marks, place, reach) {
  const ring = dial(view, marks);
  if (!ring) return null;
  if (distance(place, ring.knob) <= Math.max(KNOB + KNOB_REACH, reach)) return { part: "knob" };
  const far = Math.abs(distance(place, ring.centre) - ring.radius);
  return far <= reach ? { part: "turn" } : null;
}

/**
 * The nearest target, or else the nearest image, within reach of a point; null for none. As in the
 * kernel's gestures, a hidden one counts as farther away by a third of the reach.
 *
 * @param {Marks} marks
 * @param {Point} point
 * @param {number} reach world units
 */
export function markAt(marks, point, reach) {
  return pinAt(marks, false, point, reach) ?? pinAt(marks, true, point, reach);
}

/**
 * The nearest of the pins of a motion within reach of a point; null for none.
 *
 * @param {Point[]} places
 * @param {Point} point
 * @param {number} reach world units
 */
export function pinBetweenAt(places, point, reach) {
  const pins = places.map((place, mark) => ({ mark, d: distance(place, point) }));
  return nearest(pins, reach);
}

/**
 * @param {Marks} marks
 * @param {boolean} reached whether images are looked at, not targets
 * @param {Point} point
 * @param {number} reach
 */
function pinAt(marks, reached, point, reach) {
  const places = reached ? marks.images : marks.targets;
  const pins = places.map((place, mark) => {
    const loss = marks.hidden.includes(mark) ? reach / 3 : 0;
    return { mark, reached, d: distance(place, point), loss };
  });
  return nearest(pins, reach);
}

/**
 * The arrows at the edge that point to points out of sight.
 *
 * @param {View} view
 * @param {Point[]} targets
 * @returns {{ at: Point, target: Point, angle: number }[]} where an arrow is on the screen, the
 *   point in the world, and the arrow's direction
 */
export function arrowsTo(view, targets) {
  return targets
    .filter((target) => !inSight(view, target))
    .map((target) => {
      const [x, y] = view.toScreen(target);
      const height = within(y, view.height);
      const besideButtons = height < CORNER[1] ? CORNER[0] : 0;
      const width = within(x, view.width - besideButtons);
      return { at: [width, height], target, angle: Math.atan2(y - height, x - width) };
    });
}

/**
 * The point that an arrow at a place on the screen points to; null where there is none.
 *
 * @param {View} view
 * @param {Marks} marks
 * @param {Point} place
 */
export function arrowAt(view, marks, place) {
  const arrow = arrowsTo(view, marks.targets).find(({ at }) => distance(at, place) < ARROW_REACH);
  return arrow?.target ?? null;
}

/**
 * @param {View} view
 * @param {Point} point
 */
export function inSight(view, point) {
  const [x, y] = view.toScreen(point);
  return x >= 0 && y >= 0 && x <= view.width && y <= view.height;
}

/**
 * @param {number} at
 * @param {number} size
 */
function within(at, size) {
  return Math.min(size - EDGE, Math.max(EDGE, at));
}
