// Pointers, wheel and keys over a picture. The kernel decides what they mean; the page pans and
// zooms, and draws what is dragged at the pointer before the kernel answers.

import { rectangle } from "./pen.js";
import { distance } from "./view.js";

const CLICK = 4; // CSS pixels that a click may move
const LONG_PRESS = 600;
const LONG_PRESS_GRACE = 100;
const LONG_PRESS_SLACK = 8; // ms, ms, CSS pixels
const PATH_STEP = 3; // CSS pixels between the points of a path

// What a key does to the history: "undo", "redo" or nothing.
export function undoOrRedo(e) {
  const key = (e.ctrlKey || e.metaKey) && e.key.toLowerCase();
  if (key === "z" || key === "y") return key === "z" && !e.shiftKey ? "undo" : "redo";
}

const TEXT = "textarea, [contenteditable], input:not([type=checkbox], [type=range], [type=radio])";

// Keys in the editor around an element (or in `whole`, where there is no editor): undo, redo, single characters, Escape
// and Delete go to act(e) while the element is seen, unless it has the focus itself, or a field that takes them.
// Jupyter takes none: its X cuts the cell, its M makes it text. The signal ends this.
export function keysAround(element, act, signal, whole = element) {
  const on = (e) => {
    const editor = element.closest(".glid-editor") ?? whole;
    const { target } = e;
    if (!editor.contains(target) || !element.checkVisibility()) return;
    if (e.type !== "keydown") {
      // a click on any part of it focuses it; after one on a tab, so does this
      editor.tabIndex = -1; // and when Undo, which has the focus, runs out
      const lost = e.type === "focusout" ? target.disabled : target.closest("[role=tab]");
      return void (lost && editor.focus({ preventScroll: true }));
    }
    const command = e.ctrlKey || e.metaKey;
    const outside = !element.contains(target);
    const ours = undoOrRedo(e) || !(command || (outside && e.shiftKey && e.key === "Enter"));
    target.toggleAttribute("data-lm-suppress-shortcuts", Boolean(ours));
    editor.onkeydown = ours && ((bubbled) => bubbled.stopPropagation());
    if (!outside || target.matches(TEXT)) return;
    const free = target.closest(".glid-timeline") ? /^[^ ]$/ : /^([^ ]|Escape|Delete)$/;
    const chosen = !command && free.test(e.key) && !target.matches("select");
    if (undoOrRedo(e) ? !e.altKey : chosen) act(e);
  };
  for (const name of ["pointerdown", "focusout", "keydown"]) {
    window.addEventListener(name, on, { capture: true, signal });
  }
}

export class Pad {
  // Options in `canvas`:
  //   reach: the radius that a pointer hits, CSS pixels, by its type
  //   keys: matches those that go to the kernel; the others go on to the notebook
  //   actions: functions of the page, by their key in lower case
  //   find(point, reach): what is there, or null; with `mark` if it can be dragged
  //   held(found): the points that a drag moves, by their marks
  //   pans(found), painting: whether the left button moves the view, or paints a path
  //   encloses(found, e): whether it draws a "box" or a "lasso" around things
  //   tapped(): the space bar was pressed and let go, and nothing was dragged
  //   cursor(found): the pointer's shape
  //   menu(place, found): opens the menu of what is there, by the right button or a long touch
  //   wheelNeedsFocus: whether the wheel zooms only while the element has the focus
  //   changed(): called when something is to be drawn again
  constructor(element, view, link, canvas) {
    Object.assign(this, { element, view, link, canvas });
    this.pointers = new Map(); // id -> last place, of pressed pointers
    this.mode = null; // what pressed pointers do: "hand" or "pan"
    this.grip = null; // where a drag began, and the points that it moves
    this.held = new Map(); // places of dragged marks
    this.path = []; // of the left button, world points
    this.found = this.rests = null; // what is below a pointer that hovers, and its place
    this.space = false;
    element.tabIndex = 0;
    link.signal.addEventListener("abort", () => clearTimeout(this.longPress));
    const listeners = {
      pointerdown: (e) => this.down(e),
      pointermove: (e) => this.move(e),
      pointerup: (e) => this.up(e, "up"),
      pointercancel: (e) => this.up(e, "cancel"),
      lostpointercapture: (e) => this.up(e, "cancel"),
      pointerleave: () => this.hover(null),
      wheel: (e) => this.wheel(e),
      contextmenu: (e) => {
        // neither the browser's nor JupyterLab's may open
        e.preventDefault();
        e.stopPropagation();
        if (e.button === 2 && e.pointerType !== "touch") this.menu(this.place(e), "mouse");
      },
      keydown: (e) => this.keydown(e),
      keyup: (e) => {
        if (e.key !== " ") return;
        this.setSpace(false);
        if (this.tap) this.canvas.tapped?.();
      },
      focus: () => canvas.changed(),
      blur: () => {
        this.setSpace(false);
        canvas.changed();
      },
    };
    for (const [name, act] of Object.entries(listeners)) {
      element.addEventListener(name, act, { passive: false });
    }
  }

  get focused() {
    return this.element.matches(":focus");
  }

  place(e) {
    const box = this.element.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  reach(type) {
    return this.canvas.reach[type] ?? this.canvas.reach.mouse;
  }

  send(type, place, e = {}, more = {}) {
    const [x, y] = this.view.toWorld(place);
    const { unit } = this.view;
    return this.link.put({
      type,
      x,
      y,
      unit,
      reach: this.reach(e.pointerType) * unit,
      button: e.button ?? 0,
      shift: Boolean(e.shiftKey),
      time: e.timeStamp ?? performance.now(),
      ...more,
    });
  }

  find(place, type) {
    return this.canvas.find(this.view.toWorld(place), this.reach(type) * this.view.unit);
  }

  down(e) {
    if (this.pointers.has(e.pointerId) || this.pointers.size > 1) return;
    e.preventDefault();
    this.element.focus({ preventScroll: true });
    this.tap = false; // the space bar pans
    const place = this.place(e);
    this.pointers.set(e.pointerId, place);
    this.element.setPointerCapture(e.pointerId);
    const second = this.pointers.size === 2;
    if (second) this.takeBack(e); // the first finger's gesture was none
    this.start = place;
    this.mode = second || e.button === 1 || (e.button === 0 && this.space) ? "pan" : "hand";
    if (this.mode === "pan") return this.shape();
    const found = this.find(place, e.pointerType);
    const left = e.button === 0;
    const mark = found?.mark;
    if (left && !e.shiftKey && mark !== undefined) {
      this.grip = { from: this.view.toWorld(place), points: this.canvas.held(found) };
    }
    this.pans = left && this.canvas.pans?.(found);
    this.encloses = left && !this.canvas.painting && this.canvas.encloses?.(found, e);
    this.path = left ? [this.view.toWorld(place)] : [];
    this.send("down", place, e, { part: found?.part });
    if (e.pointerType === "touch" && this.canvas.menu && !this.canvas.painting)
      this.longPress = setTimeout(() => this.pressedLong(e, place), LONG_PRESS);
    this.shape();
    this.canvas.changed();
  }

  pressedLong(e, place) {
    // A busy page may have earlier moves waiting, which cancel this.
    this.longPress = setTimeout(() => {
      this.takeBack(e);
      this.mode = null;
      this.menu(place, "touch");
    }, LONG_PRESS_GRACE);
  }

  menu(place, type) {
    this.canvas.menu?.(place, this.find(place, type));
  }

  // Cancels the gesture that the kernel knows of.
  takeBack(e) {
    if (this.mode === "hand") this.send("cancel", this.start, e);
    this.drop();
  }

  move(e) {
    const place = this.place(e);
    const touch = e.pointerType === "touch";
    if (!this.pointers.has(e.pointerId)) return void (touch || this.hover(place));
    if (!touch) this.rests = place;
    const far = distance(place, this.start);
    if (far > LONG_PRESS_SLACK) clearTimeout(this.longPress);
    if (this.mode === "hand" && this.pans && far > CLICK) {
      this.takeBack(e);
      this.mode = "pan";
      this.shape();
    }
    if (this.mode === "pan") return this.view.follow(this.pointers, e.pointerId, place);
    this.pointers.set(e.pointerId, place);
    if (this.mode === "hand") this.handMoved(place, e, far);
  }

  handMoved(place, e, far) {
    const point = this.view.toWorld(place);
    if (this.encloses === "box") {
      const [corner] = this.path;
      this.path = far > CLICK ? rectangle(corner, point) : [corner];
    } else if (this.path.length) {
      const last = this.view.toScreen(this.path.at(-1));
      if (distance(place, last) >= PATH_STEP) this.path.push(point);
    }
    if (!this.encloses && !this.canvas.painting)
      this.send("move", place, e, { replaces: `move ${e.pointerId}` });
    if (this.grip) {
      const [dx, dy] = [point[0] - this.grip.from[0], point[1] - this.grip.from[1]];
      for (const [mark, [x, y]] of this.grip.points) this.held.set(mark, [x + dx, y + dy]);
    }
    this.canvas.changed();
  }

  up(e, type) {
    if (!this.pointers.has(e.pointerId)) return;
    const place = this.place(e);
    this.pointers.delete(e.pointerId);
    if (this.mode === "hand") {
      const { path } = this; // also without a brush: the kernel may just give one
      this.send(type, place, e, { path, encloses: Boolean(this.encloses) }).then(() => {
        if (!this.grip) this.held.clear(); // from now on the kernel's places are drawn
        if (this.path === path) this.path = [];
        this.canvas.changed();
      });
    }
    this.letGo();
    if (!this.pointers.size) this.mode = null;
    this.shape();
  }

  letGo() {
    clearTimeout(this.longPress);
    this.grip = null;
    this.canvas.changed();
  }

  // Lets go of what is held and forgets where it was moved.
  drop() {
    this.letGo();
    this.held.clear();
    this.path = [];
  }

  wheel(e) {
    if (this.canvas.wheelNeedsFocus && !this.focused && !e.ctrlKey) return;
    e.stopPropagation();
    this.view.wheel(e, this.place(e));
  }

  keydown(e) {
    const command = e.ctrlKey || e.metaKey;
    const action = !command && this.canvas.actions[e.key.toLowerCase()];
    const history = undoOrRedo(e);
    if (!history && !action && e.key !== " ") {
      if (e.altKey || !this.canvas.keys.test(e.key) || (command && e.key !== "a")) return;
    }
    e.preventDefault();
    e.stopPropagation();
    if (e.key === " ") {
      this.tap ||= !e.repeat;
      return this.setSpace(true);
    }
    if (action) return action();
    if (e.key === "Escape" || history) this.drop();
    this.press(history ?? e.key, e);
  }

  // Has the kernel do what a key does.
  press(key, e) {
    this.send("key", [this.view.width / 2, this.view.height / 2], e, { key });
  }

  // Updates what is below the pointer.
  hover(place = this.rests) {
    this.rests = place;
    if (this.mode !== null) return;
    this.found = place && this.find(place, "mouse");
    this.shape();
    this.canvas.changed();
  }

  setSpace(pressed) {
    this.space = pressed;
    this.shape();
  }

  shape() {
    const held = this.mode === "pan" || this.grip;
    this.element.style.cursor = held
      ? "grabbing"
      : this.space
        ? "grab"
        : this.canvas.cursor(this.found);
  }
}
