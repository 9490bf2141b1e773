// The part of the pad that no card covers, and the view that shows the shape there.

import { byId } from "./elements.js";
import { boxOf } from "./mesh.js";

/** @typedef {{ width: number, height: number }} Size CSS pixels */
/** @typedef {Size & { left: number, top: number, size: Size }} Room with the size of the whole pad */

const LEAST = 80; // CSS pixels

/**
 * @param {HTMLElement} pad
 * @returns {Room}
 */
export function roomOn(pad) {
  const whole = pad.getBoundingClientRect();
  const free = byId("free").getBoundingClientRect();
  return {
    left: free.left - whole.left,
    top: free.top - whole.top,
    width: Math.max(free.width, LEAST),
    height: Math.max(free.height, LEAST),
    size: { width: whole.width, height: whole.height },
  };
}

/**
 * The view in which points fill a room.
 * @param {ArrayLike<number>} points x and y in turn
 * @param {Room} room
 * @param {number} margin a share of the room
 */
export function fitted(points, room, margin) {
  const [left, bottom, right, top] = boxOf(points);
  const wide = (right - left) / room.width;
  const high = (top - bottom) / room.height;
  const unit = Math.max(wide, high) / (1 - 2 * margin);
  const x = (left + right) / 2 + unit * (room.size.width / 2 - room.left - room.width / 2);
  const y = (bottom + top) / 2 - unit * (room.size.height / 2 - room.top - room.height / 2);
  return { unit, x, y };
}
