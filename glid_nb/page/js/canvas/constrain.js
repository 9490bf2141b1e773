// Where a drag puts a pin: Shift keeps it on an axis, Ctrl on the picture's whole pixels.

/** @import { Point } from "../types.js" */

const LONGER_SIDE = 20; // of a picture, world units: `PixelFrame` of glid_nb/imaging

/**
 * The place of a pin whose drag began elsewhere.
 *
 * @param {Point} start the pin's place when the drag began
 * @param {Point} free where the pointer would put it
 * @param {object} keys
 * @param {boolean} keys.axis whether it stays on the horizontal or vertical line through its start
 * @param {boolean} keys.whole whether it stays on whole pixels
 * @param {number[]} size width and height of the picture in pixels
 * @returns {Point}
 */
export function constrained([x0, y0], [x, y], { axis, whole }, size) {
  const across = Math.abs(x - x0) >= Math.abs(y - y0);
  const [u, v] = whole ? onPixel([x, y], size) : [x, y];
  if (!axis) return [u, v];
  return across ? [u, y0] : [x0, v];
}

/**
 * A point of the world in the picture's pixels, x right and y down from its top left corner.
 *
 * @param {Point} point
 * @param {number[]} size
 * @returns {Point}
 */
export function pixelAt([x, y], [width, height]) {
  const unit = pixelOf([width, height]);
  return [x / unit + width / 2, height / 2 - y / unit];
}

/**
 * The nearest point with whole pixels.
 *
 * @param {Point} point
 * @param {number[]} size
 * @returns {Point}
 */
function onPixel(point, size) {
  const [width, height] = size;
  if (!width || !height) return point;
  const unit = pixelOf(size);
  const [px, py] = pixelAt(point, size).map(Math.round);
  return [(px - width / 2) * unit, (height / 2 - py) * unit];
}

/**
 * The world units of a pixel.
 *
 * @param {number[]} size
 */
function pixelOf([width, height]) {
  return LONGER_SIDE / Math.max(width, height);
}
