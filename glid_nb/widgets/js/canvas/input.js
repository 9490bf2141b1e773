// Pointers, wheel and keys. What they mean for handles is decided by the kernel; panning and zooming
// are done here.

import { markAt } from "./marks.js";

const REACH = { mouse: 13, pen: 16, touch: 26 }; // CSS pixels
const WHEEL_SPEED = 0.0015, WHEEL_LINE = 33;
const LONG_PRESS = 600, LONG_PRESS_GRACE = 100, LONG_PRESS_SLACK = 8; // ms, ms, CSS pixels

// Keys that the kernel acts on; the others go on to the notebook.
const KEYS = new Set([
  "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Delete", "Backspace", "Escape", "Enter",
  "0", "f", "F", ",", ".", "a", "A",
]);

export class Input {
  constructor(pad, view, link, state, changed) {
    Object.assign(this, { pad, view, link, state, changed });
    this.pointers = new Map(); // id -> last place, of touches and of the mouse while pressed
    this.mode = null; // what the pressed pointer does: "hand", "pan" or "pinch"
    this.space = false;
    this.listeners = [];
    this.on("pointerdown", (e) => this.down(e));
    this.on("pointermove", (e) => this.move(e));
    this.on("pointerup", (e) => this.up(e, "up"));
    this.on("pointercancel", (e) => this.up(e, "cancel"));
    this.on("lostpointercapture", (e) => this.up(e, "cancel"));
    this.on("pointerleave", () => this.hover(-1));
    this.on("wheel", (e) => this.wheel(e), { passive: false });
    // The right button removes a handle; neither the browser's nor JupyterLab's menu may open.
    this.on("contextmenu", (e) => {
      e.preventDefault();
      e.stopPropagation();
    });
    this.on("keydown", (e) => this.keydown(e));
    this.on("keyup", (e) => { if (e.key === " ") this.space = false; this.cursorShape(); });
    this.on("focus", () => this.focus(true));
    this.on("blur", () => { this.space = false; this.focus(false); });
  }

  on(name, handler, options) {
    this.pad.addEventListener(name, handler, options);
    this.listeners.push([name, handler, options]);
  }

  close() {
    clearTimeout(this.longPress);
    for (const [name, handler, options] of this.listeners) {
      this.pad.removeEventListener(name, handler, options);
    }
  }

  place(e) {
    const box = this.pad.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  send(type, e, place) {
    const [x, y] = this.view.toWorld(...place);
    this.link.put({
      type, x, y, id: e.pointerId ?? 0, button: e.button ?? 0, shift: e.shiftKey,
      reach: (REACH[e.pointerType] || REACH.mouse) * this.view.unit, unit: this.view.unit,
    });
  }

  down(e) {
    if (this.pointers.has(e.pointerId) || this.pointers.size > 1) return;
    e.preventDefault();
    this.pad.focus({ preventScroll: true });
    const place = this.place(e);
    this.pointers.set(e.pointerId, place);
    this.pad.setPointerCapture(e.pointerId);
    if (this.pointers.size === 2) return this.beginPinch();
    if (e.button === 1 || (e.button === 0 && this.space)) {
      this.mode = "pan";
      return this.cursorShape();
    }
    this.mode = "hand";
    this.start = place;
    const reach = REACH[e.pointerType] || REACH.mouse;
    const mark = markAt(this.view, this.state.marks(), place, reach);
    this.grip = e.button === 0 && !e.shiftKey && mark >= 0 ? this.gripAt(mark, place) : null;
    this.send("down", e, place);
    if (e.pointerType === "touch" && mark >= 0) {
      this.longPress = setTimeout(() => this.pressedLong(e, place, mark), LONG_PRESS);
    }
    this.cursorShape();
  }

  pressedLong(e, place, mark) {
    // A busy page may have moves waiting that were made in time; they cancel this.
    this.longPress = setTimeout(() => {
      this.letGo();
      this.mode = null;
      this.send("cancel", e, place);
      this.link.put({ type: "remove", x: 0, y: 0, id: e.pointerId, handle: mark });
    }, LONG_PRESS_GRACE);
  }

  // Which targets go with the hand, so that they can be drawn before the kernel answers.
  gripAt(mark, place) {
    const marks = this.state.marks();
    const chosen = marks.selected.includes(mark) ? marks.selected : [mark];
    return { from: this.view.toWorld(...place), targets: new Map(chosen.map((i) => [i, marks.targets[i]])) };
  }

  move(e) {
    const place = this.place(e);
    if (!this.pointers.has(e.pointerId)) {
      if (e.pointerType !== "touch") {
        this.hover(markAt(this.view, this.state.marks(), place, REACH.mouse));
      }
      return;
    }
    const before = this.pointers.get(e.pointerId);
    this.pointers.set(e.pointerId, place);
    if (this.mode === "pan") return this.view.pan(place[0] - before[0], place[1] - before[1]);
    if (this.mode === "pinch") return this.pinch();
    if (this.mode !== "hand") return;
    if (Math.hypot(place[0] - this.start[0], place[1] - this.start[1]) > LONG_PRESS_SLACK) {
      clearTimeout(this.longPress);
    }
    if (this.grip) {
      const [x, y] = this.view.toWorld(...place);
      const [dx, dy] = [x - this.grip.from[0], y - this.grip.from[1]];
      for (const [i, [tx, ty]] of this.grip.targets) this.state.held.set(i, [tx + dx, ty + dy]);
      this.changed();
    }
    this.send("move", e, place);
  }

  up(e, type) {
    if (!this.pointers.has(e.pointerId)) return;
    const place = this.place(e);
    this.pointers.delete(e.pointerId);
    clearTimeout(this.longPress);
    if (this.mode === "hand") this.send(type, e, place);
    this.letGo();
    if (this.mode !== "pinch" || !this.pointers.size) this.mode = null;
    this.cursorShape();
  }

  letGo() {
    clearTimeout(this.longPress);
    this.grip = null;
    this.state.release();
  }

  beginPinch() {
    if (this.mode === "hand") {
      // Two fingers were meant from the start: what the first one began is taken back.
      const [id] = this.pointers.keys();
      this.link.put({ type: "cancel", x: 0, y: 0, id });
    }
    this.letGo();
    this.mode = "pinch";
    this.span = this.spread();
  }

  spread() {
    const [[ax, ay], [bx, by]] = [...this.pointers.values()];
    return { x: (ax + bx) / 2, y: (ay + by) / 2, length: Math.hypot(ax - bx, ay - by) };
  }

  pinch() {
    if (this.pointers.size < 2) return;
    const now = this.spread();
    this.view.pan(now.x - this.span.x, now.y - this.span.y);
    if (now.length > 0) this.view.zoom(this.span.length / now.length, now.x, now.y);
    this.span = now;
  }

  wheel(e) {
    e.preventDefault();
    e.stopPropagation();
    const step = e.deltaMode === 1 ? e.deltaY * WHEEL_LINE : e.deltaY;
    this.view.zoom(Math.exp(step * WHEEL_SPEED * (e.ctrlKey ? 5 : 1)), ...this.place(e));
  }

  keydown(e) {
    if (e.key === " ") {
      this.space = true;
      e.preventDefault();
      return this.cursorShape();
    }
    const command = e.ctrlKey || e.metaKey;
    const undo = command && ["z", "Z", "y"].includes(e.key);
    if (!undo && !(KEYS.has(e.key) && (!command || e.key === "a"))) return;
    e.preventDefault();
    e.stopPropagation();
    if (e.key === "Escape") this.letGo();
    const redo = e.key === "y" || (undo && e.shiftKey);
    const key = undo ? (redo ? "redo" : "undo") : e.key;
    const [x, y] = this.view.toWorld(this.view.width / 2, this.view.height / 2);
    this.link.put({
      type: "key", key, x, y, id: 0, shift: e.shiftKey, reach: REACH.mouse * this.view.unit,
      unit: this.view.unit,
    });
  }

  hover(mark) {
    if (mark === this.state.hovered) return;
    this.state.hovered = mark;
    this.cursorShape();
    this.changed();
  }

  focus(has) {
    this.state.focus = has;
    this.changed();
  }

  cursorShape() {
    const shape = this.mode === "pan" ? "grabbing" : this.space ? "grab"
      : this.grip ? "grabbing" : this.state.hovered >= 0 ? "grab" : "crosshair";
    this.pad.style.cursor = shape;
  }
}
