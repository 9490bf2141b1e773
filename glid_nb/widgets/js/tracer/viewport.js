// The similarity between the picture's pixels and the stage's CSS pixels.

const MARGIN = 24;
const MOST_ZOOM = 40; // CSS pixels per picture pixel

export class Viewport {
  constructor() {
    this.scale = 1;
    this.x = 0; // of the picture's top left corner on the stage
    this.y = 0;
  }

  fit(size, width, height) {
    const [w, h] = size;
    this.scale = Math.max(1e-3, Math.min((width - 2 * MARGIN) / w, (height - 2 * MARGIN) / h));
    this.x = (width - w * this.scale) / 2;
    this.y = (height - h * this.scale) / 2;
    this.least = this.scale / 4;
  }

  toStage([x, y]) {
    return [this.x + x * this.scale, this.y + y * this.scale];
  }

  toPicture([x, y]) {
    return [(x - this.x) / this.scale, (y - this.y) / this.scale];
  }

  zoom(factor, [x, y]) {
    const scale = Math.min(Math.max(this.scale * factor, this.least ?? 1e-3), MOST_ZOOM);
    const ratio = scale / this.scale;
    this.x = x - (x - this.x) * ratio;
    this.y = y - (y - this.y) * ratio;
    this.scale = scale;
  }

  pan(dx, dy) {
    this.x += dx;
    this.y += dy;
  }
}
