// The visible part of the world: a centre, and world units per CSS pixel.

export class View {
  // up: 1 if the world's y points up, -1 if down. changed(): called after every change.
  constructor(changed, { up = 1, nearest, farthest }) {
    Object.assign(this, { changed, up, nearest, farthest, x: 0, y: 0, unit: 1, width: 1, height: 1 });
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
}
