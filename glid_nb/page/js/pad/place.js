// Where a pointer is in an element that the page around may have zoomed or scaled.

/** @import { Point } from "../types.js" */

/**
 * How many pixels of the window one CSS pixel of an element takes, across and down: not 1 below a
 * CSS zoom or a transform.
 *
 * @param {HTMLElement} element
 */
export function scaleOf(element) {
  const { width, height } = element.getBoundingClientRect();
  const across = width / element.offsetWidth || 1;
  return { across, down: height / element.offsetHeight || across };
}

/**
 * @param {HTMLElement} element
 * @param {{ clientX: number, clientY: number }} e
 * @returns {Point} CSS pixels from the element's upper left corner
 */
export function placeIn(element, { clientX, clientY }) {
  const { left, top } = element.getBoundingClientRect();
  const { across, down } = scaleOf(element);
  return [(clientX - left) / across, (clientY - top) / down];
}
