// The visible part of the world: a centre, and world units per CSS pixel.

const WHEEL_SPEED = 0.0015;
const WHEEL_LINE = 33;

export const distance = ([x, y], [u, v]) => Math.hypot(x - u, y - v);

export class View {
  // up: 1 if the world's y points up, -1 if down. changed(): called after every change.
  constructor(changed, { up = 1, nearest, farthest }) {
    Object.assign(this, { changed, up, nearest, farthest });
    Object.assign(this, { x: 0, y: 0, unit: 1, width: 0, height: 0 });
  }

  toWorld([px, py]) {
    const { x, y, unit, up } = this;
    return [x + (px - this.width / 2) * unit, y - up * (py - this.height / 2) * unit];
  }

  toScreen([x, y]) {
    const { unit, up } = this;
    return [(x - this.x) / unit + this.width / 2, (up * (this.y - y)) / unit + this.height / 2];
  }

  line(points) {
    return points.map((point) => this.toScreen(point));
  }

  pan(dx, dy) {
    this.x -= dx * this.unit;
    this.y += this.up * dy * this.unit;
    this.changed();
  }

  // Zooms about a place on the screen, by default its middle.
  zoom(factor, place = [this.width / 2, this.height / 2]) {
    const [x, y] = this.toWorld(place);
    const unit = Math.min(this.farthest, Math.max(this.nearest, this.unit * factor));
    this.x = x + (this.x - x) * (unit / this.unit);
    this.y = y + (this.y - y) * (unit / this.unit);
    this.unit = unit;
    this.changed();
  }

  // A pinch on a touchpad is a wheel with Ctrl.
  wheel(e, place) {
    e.preventDefault();
    const step = e.deltaMode === WheelEvent.DOM_DELTA_LINE ? e.deltaY * WHEEL_LINE : e.deltaY;
    this.zoom(Math.exp(step * WHEEL_SPEED * (e.ctrlKey ? 5 : 1)), place);
  }

  // Follows one of the pressed pointers, whose last places are known; two of them zoom as well.
  follow(pointers, id, place) {
    const before = pointers.get(id);
    const other = [...pointers].find(([one]) => one !== id)?.[1];
    const share = other ? 0.5 : 1; // two move the view by their mean
    pointers.set(id, place);
    this.pan(share * (place[0] - before[0]), share * (place[1] - before[1]));
    if (!other) return;
    const apart = (one) => Math.max(distance(one, other), 1);
    this.zoom(apart(before) / apart(place), [(place[0] + other[0]) / 2, (place[1] + other[1]) / 2]);
  }
}
