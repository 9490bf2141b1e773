// What part of the world is seen: a centre and a scale. Kept here, so that panning and zooming need
// no kernel; the kernel learns of it afterwards, for the next page.

const NEAREST = 1e-4, FARTHEST = 1; // world units of a pixel
const SAVE_AFTER = 250; // ms

export class View {
  constructor(model, changed) {
    this.model = model;
    this.changed = changed;
    this.load();
    this.onModel = () => {
      this.load();
      changed();
    };
    model.on("change:view", this.onModel);
  }

  load() {
    [this.x, this.y, this.unit] = this.model.get("view");
  }

  get width() { return this.model.get("width"); }
  get height() { return this.model.get("height"); }

  toWorld(px, py) {
    return [this.x + (px - this.width / 2) * this.unit, this.y - (py - this.height / 2) * this.unit];
  }

  toScreen([x, y]) {
    return [(x - this.x) / this.unit + this.width / 2, (this.y - y) / this.unit + this.height / 2];
  }

  // The camera's frame, in the terms of an orthographic camera.
  get frame() {
    const w = (this.width / 2) * this.unit, h = (this.height / 2) * this.unit;
    return { left: this.x - w, right: this.x + w, top: this.y + h, bottom: this.y - h };
  }

  pan(dx, dy) {
    this.x -= dx * this.unit;
    this.y += dy * this.unit;
    this.save();
  }

  // The world stays under the pointer.
  zoom(factor, px, py) {
    const [x, y] = this.toWorld(px, py);
    const unit = Math.min(FARTHEST, Math.max(NEAREST, this.unit * factor));
    this.x = x + (this.x - x) * (unit / this.unit);
    this.y = y + (this.y - y) * (unit / this.unit);
    this.unit = unit;
    this.save();
  }

  save() {
    this.changed();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.model.set("view", [this.x, this.y, this.unit]);
      this.model.save_changes();
    }, SAVE_AFTER);
  }

  close() {
    clearTimeout(this.timer);
    this.model.off("change:view", this.onModel);
  }
}
