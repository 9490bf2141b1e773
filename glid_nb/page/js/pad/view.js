// The visible part of the world: a centre, and world units per CSS pixel.

/** @import { Point } from "../types.js" */

export const ZOOM = 1.25; // by a button or a key
const WHEEL_SPEED = 0.0015;
const WHEEL_LINE = 33; // CSS pixels
const LINES = 1; // WheelEvent.DOM_DELTA_LINE
const PINCH = 5; // times as fast: a pinch on a touchpad is a wheel with Ctrl

/**
 * @param {Point} a
 * @param {Point} b
 */
export function distance([x, y], [u, v]) {
  return Math.hypot(x - u, y - v);
}

export class View {
  x = 0; // the centre, world units
  y = 0;
  unit = 1; // world units per CSS pixel
  width = 0; // CSS pixels
  height = 0;

  /**
   * @param {() => void} changed called after every change by a hand
   * @param {object} options
   * @param {1 | -1} [options.up] 1 if the world's y points up, -1 if down
   * @param {number} options.nearest the least unit
   * @param {number} options.farthest the greatest unit
   */
  constructor(changed, { up = 1, nearest, farthest }) {
    this.changed = changed;
    this.up = up;
    this.nearest = nearest;
    this.farthest = farthest;
  }

  /**
   * @param {Point} place
   * @returns {Point}
   */
  toWorld([px, py]) {
    const x = this.x + (px - this.width / 2) * this.unit;
    const y = this.y - this.up * (py - this.height / 2) * this.unit;
    return [x, y];
  }

  /**
   * @param {Point} point
   * @returns {Point}
   */
  toScreen([x, y]) {
    const px = (x - this.x) / this.unit + this.width / 2;
    const py = (this.up * (this.y - y)) / this.unit + this.height / 2;
    return [px, py];
  }

  /** @param {Point[]} points */
  line(points) {
    return points.map((point) => this.toScreen(point));
  }

  /**
   * @param {Point} point
   */
  centreOn([x, y]) {
    this.x = x;
    this.y = y;
    this.changed();
  }

  /**
   * @param {number} dx CSS pixels
   * @param {number} dy
   */
  pan(dx, dy) {
    this.x -= dx * this.unit;
    this.y += this.up * dy * this.unit;
    this.changed();
  }

  /**
   * Zooms about a place on the screen, by default its middle.
   *
   * @param {number} factor
   * @param {Point} place
   */
  zoom(factor, place = [this.width / 2, this.height / 2]) {
    const [x, y] = this.toWorld(place);
    const unit = Math.min(this.farthest, Math.max(this.nearest, this.unit * factor));
    this.x = x + (this.x - x) * (unit / this.unit);
    this.y = y + (this.y - y) * (unit / this.unit);
    this.unit = unit;
    this.changed();
  }

  /**
   * @param {WheelEvent} e
   * @param {Point} place
   */
  wheel(e, place) {
    e.preventDefault();
    this.zoom(Math.exp(turnOf(e) * WHEEL_SPEED * (e.ctrlKey ? PINCH : 1)), place);
  }

  /**
   * Follows one of the pressed pointers to a place. Two of them zoom as well.
   *
   * @param {Map<number, Point>} pointers their last places
   * @param {number} id
   * @param {Point} place
   */
  follow(pointers, id, place) {
    const before = pointers.get(id) ?? place;
    const other = [...pointers].find(([one]) => one !== id)?.[1];
    const share = other ? 0.5 : 1; // two move the view by their mean
    pointers.set(id, place);
    this.pan(share * (place[0] - before[0]), share * (place[1] - before[1]));
    if (!other) return;
    const apart = (/** @type {Point} */ one) => Math.max(distance(one, other), 1);
    const middle = /** @type {Point} */ ([(place[0] + other[0]) / 2, (place[1] + other[1]) / 2]);
    this.zoom(apart(before) / apart(place), middle);
  }
}

/**
 * How far a wheel was turned, in CSS pixels.
 *
 * @param {WheelEvent} e
 */
export function turnOf(e) {
  return e.deltaMode === LINES ? e.deltaY * WHEEL_LINE : e.deltaY;
}
