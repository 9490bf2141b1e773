// Pointers, wheel and keys over a picture. The kernel decides what they mean; the page pans and
// zooms, and draws what is dragged at the pointer before the kernel answers.

const WHEEL_SPEED = 0.0015, WHEEL_LINE = 33;
const CLICK = 4; // CSS pixels that a click may move
const LONG_PRESS = 600, LONG_PRESS_GRACE = 100, LONG_PRESS_SLACK = 8; // ms, ms, CSS pixels
const PATH_STEP = 3; // CSS pixels between the points of a path

export function isUndo(e) {
  return (e.ctrlKey || e.metaKey) && ["z", "y"].includes(e.key.toLowerCase());
}

export function undoOrRedo(e) {
  return e.key.toLowerCase() === "z" && !e.shiftKey ? "undo" : "redo";
}

const TEXT = "textarea, [contenteditable], input:not([type=checkbox], [type=range], [type=radio])";

// Keys in the editor around an element (or in `whole`, where there is no editor): undo, redo, single characters, Escape
// and Delete go to act(e) while the element is seen, unless it has the focus itself, or a field that takes them.
// Jupyter takes none: its X cuts the cell, its M makes it text. Returns a function that ends this.
export function keysAround(element, act, whole = element) {
  const on = (e) => {
    const editor = element.closest(".glid-editor") ?? whole, { target } = e;
    if (!editor.contains(target) || !element.checkVisibility()) return;
    if (e.type === "pointerdown") { // a click on any part of it focuses it; after one on a tab, so does this
      editor.tabIndex = -1;
      return void (target.closest("[role=tab]") && editor.focus({ preventScroll: true }));
    }
    const command = e.ctrlKey || e.metaKey, outside = !element.contains(target);
    const ours = isUndo(e) || !(command || (outside && e.shiftKey && e.key === "Enter"));
    target.toggleAttribute("data-lm-suppress-shortcuts", ours);
    editor.onkeydown = ours && ((bubbled) => bubbled.stopPropagation());
    if (!outside || target.matches(TEXT)) return;
    const free = target.closest(".glid-timeline") ? /^[^ ]$/ : /^([^ ]|Escape|Delete)$/;
    if (isUndo(e) ? !e.altKey : !command && free.test(e.key) && !target.matches("select")) act(e);
  };
  for (const name of ["pointerdown", "keydown"]) window.addEventListener(name, on, true);
  return () => {
    for (const name of ["pointerdown", "keydown"]) window.removeEventListener(name, on, true);
  };
}

export class Pad {
  // Options in `canvas`:
  //   reach: the radius that a pointer hits, CSS pixels, by its type
  //   keys: those that go to the kernel; the others go on to the notebook
  //   actions: functions of the page, by their key
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
    this.mode = null; // what the pressed pointer does: "hand", "pan" or "pinch"
    this.grip = null; // where a drag began, and the points that it moves
    this.held = new Map(); // places of dragged marks
    this.path = []; // of the left button, world points
    this.found = this.rests = null; // what is below a pointer that hovers, and its place
    this.space = this.focused = false;
    element.tabIndex = 0;
    this.on("pointerdown", (e) => this.down(e));
    this.on("pointermove", (e) => this.move(e));
    this.on("pointerup", (e) => this.up(e, "up"));
    this.on("pointercancel", (e) => this.up(e, "cancel"));
    this.on("lostpointercapture", (e) => this.up(e, "cancel"));
    this.on("pointerleave", () => this.hover(null));
    this.on("wheel", (e) => this.wheel(e), { passive: false });
    // Neither the browser's nor JupyterLab's menu may open.
    this.on("contextmenu", (e) => {
      e.preventDefault();
      e.stopPropagation();
      if (e.button === 2 && e.pointerType !== "touch") this.menu(this.place(e), "mouse");
    });
    this.on("keydown", (e) => this.keydown(e));
    this.on("keyup", (e) => {
      if (e.key !== " ") return;
      this.setSpace(false);
      if (this.tap) this.canvas.tapped?.();
    });
    this.on("focus", () => this.setFocus(true));
    this.on("blur", () => this.setFocus(false));
  }

  on(name, handler, options) {
    this.element.addEventListener(name, handler, options);
  }

  close() {
    clearTimeout(this.longPress);
  }

  place(e) {
    const box = this.element.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  reach(type) {
    return this.canvas.reach[type] ?? this.canvas.reach.mouse;
  }

  send(type, place, e, more = {}) {
    const [x, y] = this.view.toWorld(place);
    const { unit } = this.view;
    return this.link.put({
      type, x, y, unit, reach: this.reach(e.pointerType) * unit, button: e.button ?? 0,
      shift: e.shiftKey, time: e.timeStamp, ...more,
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
    if (this.pointers.size === 2) {
      this.takeBack(e); // the first finger's gesture was none
      this.mode = "pinch";
      this.span = this.spread();
      return;
    }
    this.start = place;
    if (e.button === 1 || (e.button === 0 && this.space)) {
      this.mode = "pan";
      return this.shape();
    }
    this.mode = "hand";
    const found = this.find(place, e.pointerType), left = e.button === 0;
    const mark = found?.mark;
    if (left && !e.shiftKey && mark !== undefined) {
      this.grip = { from: this.view.toWorld(place), points: this.canvas.held(found) };
    }
    this.pans = left && this.canvas.pans?.(found);
    this.encloses = left && !this.canvas.painting && this.canvas.encloses?.(found, e);
    this.path = left ? [this.view.toWorld(place)] : [];
    this.send("down", place, e, { part: found?.part });
    if (e.pointerType === "touch" && this.canvas.menu && !this.canvas.painting) this.longPress = setTimeout(() => this.pressedLong(e, place), LONG_PRESS);
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
    this.letGo();
    this.held.clear();
    this.path = [];
  }

  move(e) {
    const place = this.place(e);
    if (!this.pointers.has(e.pointerId)) {
      if (e.pointerType !== "touch") this.hover(place);
      return;
    }
    const before = this.pointers.get(e.pointerId);
    if (e.pointerType !== "touch") this.rests = place;
    this.pointers.set(e.pointerId, place);
    const far = Math.hypot(place[0] - this.start[0], place[1] - this.start[1]);
    if (far > LONG_PRESS_SLACK) clearTimeout(this.longPress);
    if (this.mode === "hand" && this.pans && far > CLICK) {
      this.takeBack(e);
      this.mode = "pan";
      this.shape();
    }
    if (this.mode === "pan") this.view.pan(place[0] - before[0], place[1] - before[1]);
    else if (this.mode === "pinch") this.pinch();
    else if (this.mode === "hand") this.handMoved(place, e, far);
  }

  handMoved(place, e, far) {
    const point = this.view.toWorld(place);
    if (this.encloses === "box") {
      const [[x, y]] = this.path, [u, v] = point;
      this.path = far > CLICK ? [[x, y], [u, y], [u, v], [x, v]] : [[x, y]];
    } else if (this.path.length) {
      const [x, y] = this.view.toScreen(this.path.at(-1));
      if (Math.hypot(place[0] - x, place[1] - y) >= PATH_STEP) this.path.push(point);
    }
    if (!this.encloses && !this.canvas.painting) this.send("move", place, e, { replaces: `move ${e.pointerId}` });
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
    if (this.mode !== "pinch" || !this.pointers.size) this.mode = null;
    this.shape();
  }

  letGo() {
    clearTimeout(this.longPress);
    this.grip = null;
    this.canvas.changed();
  }

  spread() {
    const [[ax, ay], [bx, by]] = [...this.pointers.values()];
    return { x: (ax + bx) / 2, y: (ay + by) / 2, length: Math.hypot(ax - bx, ay - by) };
  }

  pinch() {
    if (this.pointers.size < 2) return;
    const now = this.spread();
    this.view.pan(now.x - this.span.x, now.y - this.span.y);
    if (now.length > 0) this.view.zoom(this.span.length / now.length, [now.x, now.y]);
    this.span = now;
  }

  wheel(e) {
    if (this.canvas.wheelNeedsFocus && !this.focused && !e.ctrlKey) return;
    e.preventDefault();
    e.stopPropagation();
    const step = e.deltaMode === 1 ? e.deltaY * WHEEL_LINE : e.deltaY;
    this.view.zoom(Math.exp(step * WHEEL_SPEED * (e.ctrlKey ? 5 : 1)), this.place(e));
  }

  keydown(e) {
    const command = e.ctrlKey || e.metaKey;
    const action = !command && this.canvas.actions?.[e.key];
    if (!isUndo(e) && !action && e.key !== " ") {
      if (e.altKey || !this.canvas.keys.has(e.key) || (command && e.key !== "a")) return;
    }
    e.preventDefault();
    e.stopPropagation();
    if (e.key === " ") {
      this.tap ||= !e.repeat;
      return this.setSpace(true);
    }
    if (action) return action();
    if (e.key === "Escape" || isUndo(e)) {
      this.letGo();
      this.held.clear();
      this.path = [];
    }
    this.press(isUndo(e) ? undoOrRedo(e) : e.key, e);
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

  setFocus(focused) {
    this.focused = focused;
    if (!focused) this.setSpace(false);
    this.canvas.changed();
  }

  setSpace(pressed) {
    this.space = pressed;
    this.shape();
  }

  shape() {
    const held = this.mode === "pan" || this.grip;
    this.element.style.cursor = held ? "grabbing" : this.space ? "grab" : this.canvas.cursor(this.found);
  }
}
