// pad/dom.js
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  if (tag === "button") element.type = "button";
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}
function follow(model, listeners) {
  for (const [names, listener] of Object.entries(listeners)) {
    model.on(names, listener);
    listener();
  }
}

// pad/help.js
var OF_THE_PAD = ["pointerdown", "pointermove", "wheel", "keydown", "keyup", "contextmenu"];
function shield(element) {
  for (const name of OF_THE_PAD) element.addEventListener(name, (e) => e.stopPropagation());
  return element;
}
function help(sections) {
  const row = ([keys, what]) => make("tr", {}, make("th", {}, keys), make("td", {}, what));
  const section = ([title2, rows]) => make("section", {}, make("h4", {}, title2), make("table", {}, ...rows.map(row)));
  const shown = { className: "glid-help", popover: "auto", autofocus: true, tabIndex: -1 };
  const table = shield(make("div", shown, ...sections.map(section)));
  const title = "Keys and gestures (?)";
  const look = { className: "glid-help-button", title, "aria-label": title };
  const button = shield(make("button", { ...look, popoverTargetElement: table }, "?"));
  table.addEventListener("click", () => table.hidePopover());
  return { table, button, toggle: () => table.togglePopover() };
}

// pad/link.js
var BUSY_AFTER = 250;
var ACKNOWLEDGE_TIMEOUT = 2e3;
function connectNoMoreComms(kernel) {
  const status = kernel?.statusChanged, { connect } = status ?? {};
  if (!connect || Object.hasOwn(status, "connect")) return;
  status.connect = (slot, receiver) => !String(slot).includes("_cleanSubshells") && connect.call(status, slot, receiver);
}
var Link = class {
  // report(): an answer came, or is overdue: `busy`, `refusal` and `idle` are others.
  constructor(model, element, signal, report) {
    Object.assign(this, { model, element, signal, report, busy: false, refusal: null });
    connectNoMoreComms(model.widget_manager.kernel);
    this.view = Math.random().toString(36).slice(2);
    this.queue = [];
    this.buffers = [];
    this.answers = [];
    this.waiting = false;
    this.number = this.acknowledged = 0;
    element.dataset.idle = true;
    signal.addEventListener("abort", () => this.stop());
    model.on("msg:custom", (message) => message.view === this.view && this.answered(message));
  }
  get idle() {
    return this.acknowledged === this.number;
  }
  // An event replaces the last one that waits if both have the same `replaces`. Resolves to the
  // kernel's refusal, or null, when the event was handled.
  put(event, buffers = []) {
    const seq = ++this.number;
    const last = this.queue.at(-1);
    if (last?.replaces && last.replaces === event.replaces) this.queue.pop();
    this.queue.push({ ...event, seq });
    this.buffers.push(...buffers);
    this.element.dataset.idle = false;
    this.flush();
    return new Promise((resolve) => this.answers.push({ seq, resolve }));
  }
  flush() {
    if (this.waiting || !this.queue.length) return;
    this.waiting = true;
    this.awaited = this.number;
    try {
      const { kernel } = this.model.widget_manager;
      if (kernel === null || kernel?.isDisposed) throw new Error("the kernel was shut down");
      this.model.send({ view: this.view, events: this.queue }, void 0, this.buffers);
    } catch {
      const [host, editor] = [".glid-host", ".glid-editor"].map((one) => this.element.closest(one));
      (editor ?? host).classList.add("jupyter-widgets-disconnected");
      return;
    }
    [this.queue, this.buffers] = [[], []];
    this.overdue = setTimeout(() => {
      this.busy = true;
      this.report();
    }, BUSY_AFTER);
    this.timeout = setTimeout(() => this.release(), ACKNOWLEDGE_TIMEOUT);
  }
  answered({ ack, refusal }) {
    if (ack === this.awaited) clearTimeout(this.overdue);
    this.acknowledged = Math.max(this.acknowledged, ack);
    Object.assign(this, { busy: false, refusal });
    this.element.dataset.idle = this.idle;
    const due = this.answers.filter(({ seq }) => seq <= ack);
    this.answers = this.answers.filter(({ seq }) => seq > ack);
    for (const { resolve } of due) resolve(refusal);
    this.report();
    if (ack < this.awaited) return;
    if (document.hidden) this.release();
    else this.drawing = requestAnimationFrame(() => this.release());
  }
  release() {
    this.stop();
    this.waiting = false;
    this.flush();
  }
  stop() {
    clearTimeout(this.overdue);
    clearTimeout(this.timeout);
    cancelAnimationFrame(this.drawing);
  }
};

// pad/pen.js
function painter(canvas, view, signal, draw) {
  let due = 0;
  signal.addEventListener("abort", () => cancelAnimationFrame(due));
  return () => {
    due ||= requestAnimationFrame(() => {
      due = 0;
      draw(clearedContext(canvas, view));
    });
  };
}
function clearedContext(canvas, { width, height }) {
  const ratio = window.devicePixelRatio || 1;
  const size = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const ctx = canvas.getContext("2d");
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  return ctx;
}
function circle(ctx, [x, y], radius, styles, dash) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  strokePath(ctx, styles, dash);
}
function disk(ctx, place, radius, fill, stroke, width) {
  circle(ctx, place, radius, []);
  ctx.fillStyle = fill;
  ctx.fill();
  if (stroke) strokePath(ctx, [[width, stroke]]);
}
function tracePath(ctx, lines, closed = true) {
  ctx.beginPath();
  for (const line of lines) {
    line.forEach(([x, y], i) => i ? ctx.lineTo(x, y) : ctx.moveTo(x, y));
    if (closed) ctx.closePath();
  }
}
function rectangle([left, top], [right, bottom]) {
  return [[left, top], [right, top], [right, bottom], [left, bottom]];
}
function fillPath(ctx, lines, style, rule = "evenodd") {
  tracePath(ctx, lines);
  ctx.fillStyle = style;
  ctx.fill(rule);
}
function strokePath(ctx, styles, dash = []) {
  ctx.setLineDash(dash);
  for (const [lineWidth, strokeStyle] of styles) {
    Object.assign(ctx, { lineWidth, strokeStyle });
    ctx.stroke();
  }
  ctx.setLineDash([]);
}

// pad/view.js
var WHEEL_SPEED = 15e-4;
var WHEEL_LINE = 33;
var distance = ([x, y], [u, v]) => Math.hypot(x - u, y - v);
var View = class {
  // up: 1 if the world's y points up, -1 if down. changed(): called after every change.
  constructor(changed, { up = 1, nearest: nearest2, farthest }) {
    Object.assign(this, { changed, up, nearest: nearest2, farthest });
    Object.assign(this, { x: 0, y: 0, unit: 1, width: 0, height: 0 });
  }
  toWorld([px, py]) {
    const { x, y, unit, up } = this;
    return [x + (px - this.width / 2) * unit, y - up * (py - this.height / 2) * unit];
  }
  toScreen([x, y]) {
    const { unit, up } = this;
    return [(x - this.x) / unit + this.width / 2, up * (this.y - y) / unit + this.height / 2];
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
    const before = pointers.get(id), other = [...pointers].find(([one]) => one !== id)?.[1];
    const share = other ? 0.5 : 1;
    pointers.set(id, place);
    this.pan(share * (place[0] - before[0]), share * (place[1] - before[1]));
    if (!other) return;
    const apart = (one) => Math.max(distance(one, other), 1);
    this.zoom(apart(before) / apart(place), [(place[0] + other[0]) / 2, (place[1] + other[1]) / 2]);
  }
};

// pad/pad.js
var CLICK = 4;
var LONG_PRESS = 600;
var LONG_PRESS_GRACE = 100;
var LONG_PRESS_SLACK = 8;
var PATH_STEP = 3;
function undoOrRedo(e) {
  const key = (e.ctrlKey || e.metaKey) && e.key.toLowerCase();
  if (key === "z" || key === "y") return key === "z" && !e.shiftKey ? "undo" : "redo";
}
var TEXT = "textarea, [contenteditable], input:not([type=checkbox], [type=range], [type=radio])";
function keysAround(element, act, signal, whole = element) {
  const on = (e) => {
    const editor = element.closest(".glid-editor") ?? whole, { target } = e;
    if (!editor.contains(target) || !element.checkVisibility()) return;
    if (e.type !== "keydown") {
      editor.tabIndex = -1;
      const lost = e.type === "focusout" ? target.disabled : target.closest("[role=tab]");
      return void (lost && editor.focus({ preventScroll: true }));
    }
    const command = e.ctrlKey || e.metaKey, outside = !element.contains(target);
    const ours = undoOrRedo(e) || !(command || outside && e.shiftKey && e.key === "Enter");
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
var Pad = class {
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
    this.pointers = /* @__PURE__ */ new Map();
    this.mode = null;
    this.grip = null;
    this.held = /* @__PURE__ */ new Map();
    this.path = [];
    this.found = this.rests = null;
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
      }
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
      ...more
    });
  }
  find(place, type) {
    return this.canvas.find(this.view.toWorld(place), this.reach(type) * this.view.unit);
  }
  down(e) {
    if (this.pointers.has(e.pointerId) || this.pointers.size > 1) return;
    e.preventDefault();
    this.element.focus({ preventScroll: true });
    this.tap = false;
    const place = this.place(e);
    this.pointers.set(e.pointerId, place);
    this.element.setPointerCapture(e.pointerId);
    const second = this.pointers.size === 2;
    if (second) this.takeBack(e);
    this.start = place;
    this.mode = second || e.button === 1 || e.button === 0 && this.space ? "pan" : "hand";
    if (this.mode === "pan") return this.shape();
    const found = this.find(place, e.pointerType), left = e.button === 0;
    const mark = found?.mark;
    if (left && !e.shiftKey && mark !== void 0) {
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
    const place = this.place(e), touch = e.pointerType === "touch";
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
      const { path } = this;
      this.send(type, place, e, { path, encloses: Boolean(this.encloses) }).then(() => {
        if (!this.grip) this.held.clear();
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
    const action = !command && this.canvas.actions[e.key.toLowerCase()], history = undoOrRedo(e);
    if (!history && !action && e.key !== " ") {
      if (e.altKey || !this.canvas.keys.test(e.key) || command && e.key !== "a") return;
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
    this.element.style.cursor = held ? "grabbing" : this.space ? "grab" : this.canvas.cursor(this.found);
  }
};

// pad/icons.js
var PATHS = {
  edit: "M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",
  foreground: "M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z M9.5 12.5h5 M12 10v5",
  background: "M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z M9.5 12.5h5",
  color: "M9 4l3 3 M10 3.2l1-1a1.6 1.6 0 0 1 2.8 2.2l-1.1 1.1 M9.6 5.2L3.4 11.4 2.5 13.5l2.1-.9 6.2-6.2",
  component: "M8 1.5v3 M8 11.5v3 M1.5 8h3 M11.5 8h3 M8 5.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6z",
  polygon: "M8 2l5.5 4-2 7h-7l-2-7z",
  rectangle: "M2.5 4h11v8h-11z",
  undo: "M5.5 3L2.5 6l3 3 M3 6h6.2a3.6 3.6 0 0 1 0 7.2H6",
  redo: "M10.5 3l3 3-3 3 M13 6H6.8a3.6 3.6 0 0 0 0 7.2H10",
  fit: "M2 5.5V2h3.5 M10.5 2H14v3.5 M14 10.5V14h-3.5 M5.5 14H2v-3.5",
  plus: "M8 3v10 M3 8h10",
  minus: "M3 8h10",
  open: "M2 12.5v-9h4l1.5 2H14v7z",
  play: "M5 3l8 5-8 5z",
  pause: "M5.5 3v10 M10.5 3v10",
  record: "M8 4.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6z",
  onion: "M6.2 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8z M9.8 4a4 4 0 1 1 0 8",
  copy: "M5.5 5.5h8v8h-8z M3 10.5v-8h8",
  export: "M8 2v8 M4.8 6.8L8 10l3.2-3.2 M3 13.5h10",
  trash: "M3 4.5h10 M6.5 4.5v-2h3v2 M4.5 4.5l.6 9h5.8l.6-9"
};
function icon(name) {
  return `<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${PATHS[name]}"/></svg>`;
}
function iconButton(name, title, onclick, className = "glid-icon") {
  return make("button", { title, "aria-label": title, className, onclick, innerHTML: icon(name) });
}

// tracer/panel.js
var METHODS = [
  ["auto", "Auto", "Chosen for the picture"],
  ["alpha", "Alpha", "What is not transparent"],
  ["threshold", "Brightness", "What is darker, or brighter, than a threshold"],
  ["color", "Colour", "What differs from the background's colour"],
  ["scribbles", "Scribbles", "What painted strokes mark"]
];
var NUMBERS = [
  ["threshold", "Threshold", "0–1", "Least value of what is foreground", 1, 1, 3],
  ["smoothing", "Smoothing", "px", "Blur before the outline is taken", 0.01, 2, 1],
  ["offset", "Offset", "px", "How far the cage stays from the shape", 0.05, 1.5, 1],
  ["simplify", "Simplify", "px", "How far simplification may move the outline", 0.03, 1.5, 1],
  ["min_hole_area", "Least hole", "px²", "Smaller holes are filled", 0.1, 4, 0]
];
var OUTLINES = [
  ["foreground", "Paint over it", "A few strokes over the shape, then over what is around it"],
  ["polygon", "Draw its outline", "Click corner after corner, or draw around the shape"],
  ["rectangle", "Rectangle", "Drag a rectangle"],
  [null, "Whole picture", "Everything, the background too"]
];
var STEPS = 1e3;
var MOST_LISTED = 50;
function numberControl([name, label, unit, title, share, power, digits], choose) {
  let most = 1, gesture = null;
  const slider = make("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": label });
  const number = make("input", {
    type: "number",
    className: "glid-number",
    min: 0,
    step: "any",
    placeholder: "auto",
    "aria-label": `${label} (${unit})`
  });
  const auto = make("button", { className: "glid-auto", title: "Let the tracer choose" }, "auto");
  const slid = () => Number((most * (slider.value / STEPS) ** power).toFixed(digits));
  slider.oninput = () => {
    gesture ??= Math.random().toString(36);
    number.value = slid();
    auto.ariaPressed = false;
    choose({ [name]: slid() }, gesture);
  };
  slider.onchange = () => gesture = null;
  number.onchange = () => choose({ [name]: number.value === "" ? null : Number(number.value) });
  auto.onclick = () => choose({ [name]: null });
  function update({ options, automatic, size, component_area: area }) {
    const value = options[name], seen = value ?? automatic?.[name] ?? null;
    most = Math.max(share * { "0–1": 1, px: Math.max(...size), "px²": area }[unit], 1e-9);
    auto.ariaPressed = value === null;
    if (gesture) return;
    number.value = seen === null ? "" : Number(seen.toFixed(digits));
    if (seen === slid()) return;
    const part = Math.min(Math.max(seen / most, 0), 1);
    slider.value = Math.round(STEPS * part ** (1 / power));
  }
  const element = make(
    "div",
    { className: "glid-control", title, "data-name": name },
    make("label", {}, label),
    auto,
    number,
    make("span", { className: "glid-unit" }, unit),
    slider
  );
  return { element, update };
}
function makePanel(act, stage) {
  const choose = (changes, gesture) => act("set_options", { changes, gesture, replaces: gesture });
  const row = (...parts) => make("div", { className: "glid-row" }, ...parts);
  const numbers = NUMBERS.map((one) => numberControl(one, choose));
  const [threshold, smoothing, offset, simplify, leastHole] = numbers.map(({ element: element2 }) => element2);
  const methods = METHODS.map(([method, label, title]) => {
    const onclick = () => choose({ method });
    return make("button", { title, role: "radio", "data-value": method, onclick }, label);
  });
  const swap = () => choose({ invert: invert.checked });
  const invert = make("input", { type: "checkbox", onchange: swap });
  const inverts = make("label", { className: "glid-row" }, invert, "Swap foreground and background");
  const pickColor = make("button", { "data-tool": "color" }, "Pick the background's colour");
  const brush = (name, label) => make("button", { className: `glid-brush glid-${name}`, "data-tool": name }, label);
  const scribbles = row(
    brush("foreground", "Shape"),
    brush("background", "Background"),
    make("button", { onclick: () => act("clear_scribbles") }, "Clear")
  );
  const component = make("select", {
    "aria-label": "Component",
    onchange: () => choose({ component: Number(component.value), component_at: null })
  });
  const components = row(
    make("span", { className: "glid-grow" }, "Component"),
    component,
    make("button", { "data-tool": "component" }, "Pick")
  );
  const hand = OUTLINES.map(([tool, label, title]) => {
    const does = tool ? { "data-tool": tool } : { onclick: () => act("draw") };
    return make("button", { title, ...does }, label);
  });
  const doubt = make("p");
  const byHand = make("div", { className: "glid-by-hand" }, doubt, ...hand);
  const holes = make("div", { className: "glid-holes" }), holesTitle = make("h4");
  const notes = make("ul"), summary = make("summary", {}, "Notes");
  const notesBox = make("details", { className: "glid-notes" }, summary, notes);
  const group = { className: "glid-methods", role: "radiogroup", "aria-label": "Method" };
  const element = make(
    "div",
    { className: "glid-panel" },
    make("h4", {}, "By hand"),
    byHand,
    make("h4", {}, "Foreground"),
    make("div", group, ...methods),
    scribbles,
    pickColor,
    threshold,
    inverts,
    smoothing,
    components,
    make("h4", {}, "Outline"),
    offset,
    simplify,
    holesTitle,
    leastHole,
    holes,
    notesBox
  );
  function update(shown) {
    const { options, automatic, loops, n_components: count } = shown;
    element.hidden = !shown.size;
    if (!shown.size) return;
    for (const control of numbers) control.update(shown);
    const { method } = options, used = method === "auto" ? automatic?.method : method;
    for (const button of methods) {
      button.ariaChecked = button.dataset.value === method;
      button.classList.toggle("glid-used", button.dataset.value === used);
    }
    scribbles.hidden = used !== "scribbles";
    pickColor.hidden = used !== "color";
    inverts.hidden = used !== "color" && used !== "threshold";
    invert.checked = options.invert === true;
    invert.indeterminate = options.invert === null && used === "threshold";
    const guess = Boolean(shown.doubt) || !loops.length;
    byHand.classList.toggle("glid-guess", guess);
    doubt.hidden = !guess;
    const why = shown.doubt ? `This outline is a guess: ${shown.doubt}. ` : "";
    doubt.textContent = `${why}Show it the shape:`;
    components.hidden = count < 2;
    const listed = Math.min(count, MOST_LISTED);
    if (component.length !== listed) {
      const option = (_, i) => new Option(i ? `${i + 1}.` : "Largest", i);
      component.replaceChildren(...Array.from({ length: listed }, option));
    }
    component.value = shown.component;
    showHoles(shown);
    notesBox.hidden = !shown.notes.length;
    notes.replaceChildren(...shown.notes.map((note) => make("li", {}, note)));
  }
  function holeRow(hole, i) {
    const onchange = () => act("toggle_hole", { number: i });
    const [size, unit] = hole.area >= 1e4 ? [hole.area / 1e3, "k px²"] : [hole.area, " px²"];
    const made = hole.by_offset ? " (made by the offset)" : "";
    const point = (index) => () => stage.highlightHole(index);
    return make(
      "label",
      { className: "glid-hole", onpointerenter: point(i), onpointerleave: point(null) },
      make("input", { type: "checkbox", checked: hole.kept, onchange }),
      make("span", { className: "glid-grow" }, `Hole ${i + 1}${made}`),
      make("span", { className: "glid-unit" }, `${size.toFixed(0)}${unit}`)
    );
  }
  function showHoles({ holes: listed, n_holes: count, n_filled: filled, loops }) {
    const kept = Math.max(loops.length - 1, 0) || "no";
    const small = filled ? `, ${filled} small filled` : "";
    holesTitle.textContent = `${kept} ${kept === 1 ? "hole" : "holes"} in the cage${small}`;
    const rows = listed.map(holeRow), left = count - listed.length;
    if (left) rows.push(make("div", { className: "glid-unit" }, `and ${left} smaller ones`));
    const focused = holes.getRootNode().activeElement;
    const at = [...holes.children].findIndex((one) => one.contains(focused));
    holes.replaceChildren(...rows);
    rows[at]?.querySelector("input")?.focus();
  }
  return { element, update };
}

// pad/hit.js
var probe = document.createElement("canvas").getContext("2d");
function nearest(things, reach) {
  const far = ({ d, loss = 0 }) => d + loss;
  return things.filter(({ d }) => d <= reach).sort((a, b) => far(a) - far(b))[0] ?? null;
}
function nearestVertex(loops, point, reach) {
  const vertices = loops.flatMap((loop, i) => loop.map((vertex, j) => ({ loop: i, index: j, d: distance(vertex, point) })));
  return nearest(vertices, reach);
}
function nearestEdge(loops, point, reach) {
  const edges = loops.flatMap((loop) => loop.map((a, j) => {
    const b = loop[(j + 1) % loop.length], along = [b[0] - a[0], b[1] - a[1]];
    const dot = (point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1];
    const t = Math.min(Math.max(dot / (distance(a, b) ** 2 || 1e-30), 0), 1);
    const foot = [a[0] + t * along[0], a[1] + t * along[1]];
    return { foot, d: distance(foot, point) };
  }));
  return nearest(edges, reach);
}
function holeAt(holes, [x, y]) {
  const around = holes.filter((hole) => {
    tracePath(probe, [hole.loop]);
    return probe.isPointInPath(x, y);
  });
  return holes.indexOf(around.sort((a, b) => a.area - b.area)[0]);
}

// tracer/draw.js
var HALO = "rgba(255, 255, 255, 0.9)";
var SPECK = 12;
var CHECK = 8;
function drawStage(ctx, stage, hover) {
  const { view, colors, shown, bitmap, painting } = stage;
  const corner = view.toScreen([0, 0]), extent = shown.size.map((n) => n / view.unit);
  ctx.fillStyle = checks(ctx, colors);
  ctx.fillRect(...corner, ...extent);
  if (bitmap) {
    ctx.imageSmoothingEnabled = 6 * view.unit > 1;
    ctx.imageSmoothingQuality = "high";
    ctx.drawImage(bitmap, ...corner, ...extent);
  }
  const loops = stage.loops.map((loop) => view.line(loop));
  if (loops.length && !painting) {
    fillPath(ctx, [...loops, rectangle(corner, view.toScreen(shown.size))], colors.veil);
  }
  shown.holes.forEach((hole, i) => {
    const loop = view.line(hole.loop);
    const hovered = hover?.hole === i;
    if (hovered) fillPath(ctx, [loop], colors[hole.kept ? "warn-soft" : "accent-soft"]);
    const visible = Math.sqrt(hole.area) > SPECK * view.unit;
    if (hovered || !hole.kept && visible) strokeLoops(ctx, [loop], colors.faint, 1.25, [4, 3]);
  });
  if (stage.brushing || shown.options.method === "scribbles") drawStrokes(ctx, stage);
  if (loops.length && !(stage.drawing && shown.doubt)) drawCage(ctx, stage, loops, hover);
  if (stage.drawing) drawOutline(ctx, stage);
  for (const problem of shown.problems) {
    if (problem.point) circle(ctx, view.toScreen(problem.point), 13, [[5, HALO], [2.25, colors.warn]]);
  }
}
function checks(ctx, colors) {
  const tile = make("canvas", { width: 2 * CHECK, height: 2 * CHECK });
  const pen = tile.getContext("2d");
  pen.fillStyle = colors["check-light"];
  pen.fillRect(0, 0, tile.width, tile.height);
  pen.fillStyle = colors["check-dark"];
  for (const at of [0, CHECK]) pen.fillRect(at, at, CHECK, CHECK);
  return ctx.createPattern(tile, "repeat");
}
function strokeLoops(ctx, loops, style, width, dash = []) {
  ctx.lineJoin = "round";
  tracePath(ctx, loops);
  strokePath(ctx, [[width + 2.25, HALO]]);
  strokePath(ctx, [[width, style]], dash);
}
function drawStrokes(ctx, { view, colors, shown, brushing, tool, pad: { path } }) {
  const pairs = ["background", "foreground"].map((brush) => [shown.strokes[brush], colors[brush]]);
  if (brushing && path.length) pairs.push([[path], colors[tool]]);
  ctx.lineCap = ctx.lineJoin = "round";
  for (const [lines, color] of pairs) {
    for (const line of lines) {
      tracePath(ctx, [view.line([...line, line.at(-1)])], false);
      strokePath(ctx, [[8, HALO], [5, color]]);
    }
  }
}
function drawOutline(ctx, stage) {
  const { view, shown } = stage, color = stage.colors.foreground;
  tracePath(ctx, [view.line(stage.drawn())], false);
  strokePath(ctx, [[4.5, HALO], [2, color]]);
  for (const corner of shown.corners) disk(ctx, view.toScreen(corner), 4, "white", color, 2);
}
function drawCage(ctx, { view, colors, shown, painting }, loops, hover) {
  const color = shown.problems.length ? colors.warn : colors.accent;
  strokeLoops(ctx, loops, color, 1.75);
  if (painting) return;
  const radius = vertexRadius(loops);
  const strong = /* @__PURE__ */ new Set([hover?.mark, ...shown.selected.map((vertex) => vertex.join(":"))]);
  loops.forEach(
    (loop, i) => loop.forEach((vertex, j) => {
      const seen = strong.has(`${i}:${j}`), r = seen ? radius + 1.75 : radius;
      disk(ctx, vertex, r + 1, HALO);
      disk(ctx, vertex, r, seen ? color : "white", color, 1.5);
    })
  );
  if (hover?.edge) drawPlus(ctx, view.toScreen(hover.edge.foot), color);
}
function vertexRadius(loops) {
  const edges = loops.flatMap((loop) => loop.map((a, i) => [a, loop[(i + 1) % loop.length]]));
  const total = edges.reduce((sum, [[x, y], [u, v]]) => sum + Math.hypot(u - x, v - y), 0);
  return Math.min(4, Math.max(1.75, total / Math.max(edges.length, 1) * 0.16));
}
function drawPlus(ctx, [x, y], color) {
  disk(ctx, [x, y], 7, "white", color, 1.5);
  tracePath(ctx, [[[x - 3.5, y], [x + 3.5, y]], [[x, y - 3.5], [x, y + 3.5]]], false);
  ctx.stroke();
}

// tracer/stage.js
var REACH = { mouse: 9, pen: 12, touch: 18 };
var ZOOM = 1.25;
var MARGIN = 24;
var HINT = 8;
var MOST_ZOOM = 40;
var COLORS = [
  "accent",
  "accent-soft",
  "warn",
  "warn-soft",
  "faint",
  "veil",
  "foreground",
  "background",
  "check-light",
  "check-dark"
];
var TOOLS = {
  // what their buttons say, and a hint over the picture
  edit: [
    "Edit vertices and holes (V)",
    "Drag a vertex · double-click an edge to add one · right-click a vertex to delete it · click a hole to drop it"
  ],
  foreground: ["Paint over the shape (B)", "Paint over the shape"],
  background: ["Paint over the background (N)", "Paint over what is around the shape"],
  color: ["Pick the background's colour (I)", "Click a pixel that shows the background's colour"],
  component: ["Pick the component to trace (C)", "Click the part of the picture to trace"],
  polygon: [
    "Draw the outline by hand (P)",
    "Click corner after corner, or draw around the shape · double-click or Enter closes it · Esc starts anew"
  ],
  rectangle: ["Draw a rectangle (R)", "Drag a rectangle over the shape"]
};
var KEYS = /^(Arrow\w+|Delete|Backspace|Escape|Enter|[[\]vbnicpr])$/i;
var Stage = class {
  // root defines the colours as CSS variables; upload(file) takes a dropped picture.
  constructor(root, link, upload, signal) {
    this.root = root;
    this.canvas = make("canvas", { className: "glid-canvas", role: "application", "aria-label": "Picture and cage" });
    this.callout = make("div", { className: "glid-callout", role: "alert", hidden: true });
    this.hintText = make("div", { className: "glid-hint" });
    this.drop = make("div", { className: "glid-drop", hidden: true }, "Drop a picture here");
    this.empty = make("div", { className: "glid-empty" }, make("p", {}, "Drop a picture here, or open one from a file."));
    this.element = make("div", { className: "glid-stage" }, this.canvas, this.empty, this.callout, this.hintText, this.drop);
    this.shown = this.bitmap = null;
    this.tool = "edit";
    this.listed = null;
    this.fitted = true;
    this.view = new View(() => {
      this.fitted = false;
      this.changed();
    }, { up: -1, nearest: 1 / MOST_ZOOM, farthest: 1e3 });
    this.changed = painter(this.canvas, this.view, signal, (ctx) => this.draw(ctx));
    this.pad = new Pad(this.canvas, this.view, link, this);
    this.takeFiles(upload);
    this.resizer = new ResizeObserver(() => this.resize());
    this.resizer.observe(this.element);
    const themeChanged = () => {
      this.colors = null;
      this.changed();
    };
    this.themes = new MutationObserver(themeChanged);
    this.themes.observe(document.body, { attributes: true });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", themeChanged, { signal });
  }
  close() {
    this.resizer.disconnect();
    this.themes.disconnect();
    this.turn = null;
    this.bitmap = this.bitmap?.close();
  }
  takeFiles(upload) {
    const on = (name, act) => this.element.addEventListener(name, (e) => {
      e.preventDefault();
      e.stopPropagation();
      act(e);
    });
    for (const name of ["dragenter", "dragover"]) on(name, () => this.drop.hidden = false);
    on("dragleave", (e) => this.drop.hidden ||= !this.element.contains(e.relatedTarget));
    on("drop", (e) => {
      this.drop.hidden = true;
      const file = e.dataTransfer.files[0];
      if (file) upload(file);
    });
  }
  update(shown) {
    const before = this.shown?.size;
    this.shown = shown;
    this.empty.hidden = Boolean(shown.size);
    if (shown.size && String(before) !== String(shown.size)) this.fit();
    this.pad.hover();
  }
  async setPicture(bytes) {
    const turn = this.turn = (this.turn ?? 0) + 1;
    const bitmap = bytes?.byteLength ? await createImageBitmap(new Blob([bytes])) : null;
    if (turn !== this.turn) return bitmap?.close();
    this.bitmap?.close();
    this.bitmap = bitmap;
    this.changed();
  }
  setTool(tool) {
    this.tool = tool;
    this.pad.hover();
  }
  highlightHole(index) {
    this.listed = index === null ? null : { hole: index };
    this.changed();
  }
  fit() {
    const { view, element } = this;
    if (!this.shown?.size) return;
    const [w, h] = this.shown.size;
    this.hintText.textContent = this.hint();
    const below = Math.max(this.hintText.offsetHeight + 2 * HINT, MARGIN);
    const room = [element.clientWidth - 2 * MARGIN, element.clientHeight - MARGIN - below].map((n) => Math.max(n, 1));
    const unit = Math.min(Math.max(w / room[0], h / room[1]), 1e3);
    Object.assign(view, { x: w / 2, y: h / 2 + unit * (below - MARGIN) / 2, unit, farthest: 4 * unit });
    this.fitted = true;
    this.changed();
  }
  zoom(closer) {
    this.view.zoom(closer ? 1 / ZOOM : ZOOM);
  }
  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    if (this.fitted) this.fit();
    Object.assign(this.view, { width, height });
    this.changed();
  }
  // The loops, with vertices that are dragged where the pointer is.
  get loops() {
    const loops = this.shown?.loops ?? [];
    if (!this.pad.held.size) return loops;
    return loops.map((loop, i) => loop.map((point, j) => this.pad.held.get(`${i}:${j}`) ?? point));
  }
  get brushing() {
    return this.tool === "foreground" || this.tool === "background";
  }
  get drawing() {
    return this.tool === "polygon" || this.tool === "rectangle";
  }
  get painting() {
    return this.brushing || this.drawing;
  }
  // The pad's options
  reach = REACH;
  keys = KEYS;
  wheelNeedsFocus = true;
  actions = {
    "+": () => this.zoom(true),
    "=": () => this.zoom(true),
    "-": () => this.zoom(false),
    f: () => this.fit()
  };
  find(point, reach) {
    if (this.tool !== "edit" || !this.shown?.size) return null;
    const { holes, reach_shares: shares } = this.shown, hole = holeAt(holes, point);
    const near = hole < 0 ? reach : shares.in_hole * reach;
    const vertex = nearestVertex(this.loops, point, near);
    if (vertex) return { vertex, mark: `${vertex.loop}:${vertex.index}` };
    const edge = nearestEdge(this.loops, point, shares.edge * near);
    if (edge) return { edge };
    return hole < 0 ? null : { hole };
  }
  held({ vertex: { loop, index }, mark }) {
    return /* @__PURE__ */ new Map([[mark, this.loops[loop][index]]]);
  }
  pans(found) {
    return !found?.vertex && !this.painting;
  }
  cursor(found) {
    if (this.tool !== "edit") return this.tool === "component" ? "pointer" : "crosshair";
    return found?.vertex ? "grab" : found?.edge ? "copy" : found?.hole !== void 0 ? "pointer" : "default";
  }
  // Drawing
  draw(ctx) {
    const { shown, pad, view } = this;
    if (!shown || !view.width) return;
    this.colors ??= this.readColors();
    const hover = this.listed ?? (pad.mode === "pan" ? null : pad.found);
    if (shown.size) drawStage(ctx, this, hover);
    const [left, top] = view.toScreen([0, 0]);
    this.element.dataset.viewport = `${1 / view.unit} ${left} ${top}`;
    this.placeCallout();
    this.hintText.textContent = shown.size ? this.hint(hover) : "";
  }
  // The outline that is being drawn, as far as it goes.
  drawn() {
    const { path, rests } = this.pad;
    const now = rests ? [this.view.toWorld(rests)] : [];
    if (this.tool === "polygon") return this.shown.corners.concat(path.length ? path : now);
    if (!path.length || !now.length) return [];
    return [...rectangle(path[0], now[0]), path[0]];
  }
  hint(hover) {
    const hole = this.shown.holes[hover?.hole];
    if (hole) return hole.kept ? "Click to drop this hole" : "Click to keep this hole";
    if (hover?.edge) return "Double-click to add a vertex here";
    if (hover?.vertex) return "Drag to move · right-click or Delete to delete";
    return TOOLS[this.tool][1];
  }
  // The theme's colours, as a canvas takes them.
  readColors() {
    const probe2 = this.root.appendChild(make("span"));
    const color = (name) => {
      probe2.style.color = `var(--glid-${name})`;
      return getComputedStyle(probe2).color;
    };
    const colors = Object.fromEntries(COLORS.map((name) => [name, color(name)]));
    probe2.remove();
    return colors;
  }
  // The first problem's message, beside its place.
  placeCallout() {
    const problem = this.shown.problems[0];
    this.callout.hidden = !problem || this.pad.mode === "pan";
    if (!problem) return;
    this.callout.textContent = problem.message;
    const { width, height } = this.view, { offsetWidth: w, offsetHeight: h } = this.callout;
    const [x, y] = problem.point ? this.view.toScreen(problem.point) : [width / 2, -16];
    const below = problem.point && y + 24 + h > height ? y - 24 - h : y + 24;
    const left = Math.min(Math.max(x - w / 2, 8), width - w - 8);
    const top = Math.min(Math.max(below, 8), height - h - 8);
    this.callout.style.transform = `translate(${left}px, ${top}px)`;
  }
};

// tracer/main.js
var HELP = [
  ["Outline", [
    ["V", "edit: drag a vertex, double-click an edge to add one, click a hole to drop or keep it"],
    ["Right-click, Delete", "remove a vertex"],
    ["[ ]", "select the vertex before, the next vertex"],
    ["Arrow keys", "nudge the selected vertex, with Shift farther"],
    ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"]
  ]],
  ["By hand", [
    ["B, N", "paint over the shape, over the background"],
    ["I, C", "pick the background's colour, the component"],
    ["P, R", "draw the outline, a rectangle; Enter closes an outline, Esc gives it up"]
  ]],
  ["View", [
    ["Wheel, + -, F", "zoom after a click on the picture, fit the picture"],
    ["Drag beside the outline", "move the view"]
  ]]
];
var PART = 1 << 20;
function render({ model, el, signal }) {
  const root = make("div", { className: "glid-skin glid-tracer" });
  const link = new Link(model, root, signal, () => {
    showStatus();
    if (link.idle) showTool(model.get("shown").tool);
  });
  const act = (type, content = {}, buffers = []) => link.put({ type, ...content }, buffers);
  async function upload(file) {
    const name = file.name || "the picture";
    let start = 0, refused = null;
    do {
      const data = await file.slice(start, start + PART).arrayBuffer();
      refused = await act("upload", { name, size: file.size, start, buffered: true }, [data]);
      start += PART;
    } while (!refused && start < file.size);
  }
  const stage = new Stage(root, link, upload, signal);
  const panel = makePanel(act, stage);
  const tools = Object.entries(TOOLS).map(([name, [label]]) => iconButton(name, label));
  Object.keys(TOOLS).forEach((name, i) => tools[i].dataset.tool = name);
  const undo = iconButton("undo", "Undo (Ctrl+Z)", () => act("undo"));
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => act("redo"));
  const back = { title: "Go back to the outline as traced", onclick: () => act("discard_edits") };
  const discard = make("button", back, "Discard edits");
  const input = make("input", { type: "file", accept: "image/*", hidden: true, onchange: () => input.files[0] && upload(input.files[0]) });
  const open = iconButton("open", "Open a picture", () => {
    input.value = "";
    input.click();
  });
  const keys = help(HELP);
  stage.element.append(keys.table);
  stage.actions["?"] = keys.toggle;
  const gap = () => make("span", { className: "glid-gap" });
  const toolbar = make(
    "div",
    { className: "glid-toolbar", role: "toolbar", "aria-label": "Tracer" },
    open,
    input,
    gap(),
    ...tools,
    gap(),
    undo,
    redo,
    discard,
    make("span", { className: "glid-grow" }),
    iconButton("minus", "Zoom out (-)", () => stage.zoom(false)),
    iconButton("plus", "Zoom in (+)", () => stage.zoom(true)),
    iconButton("fit", "Fit the picture (F)", () => stage.fit()),
    keys.button
  );
  const status = make("div", { className: "glid-status", role: "status", "aria-live": "polite" });
  root.append(toolbar, make("div", { className: "glid-body" }, stage.element, panel.element), status);
  keysAround(stage.element, (e) => stage.pad.keydown(e), signal, root);
  el.classList.add("glid-host");
  el.append(root);
  root.addEventListener("click", (e) => {
    const name = e.target.closest("[data-tool]")?.dataset.tool;
    if (!name) return;
    showTool(name);
    act("tool", { name });
  });
  function showTool(name) {
    if (name !== stage.tool) stage.setTool(name);
    for (const button of root.querySelectorAll("[data-tool]")) {
      button.ariaPressed = button.dataset.tool === name;
    }
  }
  function showStatus() {
    const { size, loops, problems, component, discarded, doubt } = model.get("shown");
    if (!loops) return;
    const n = loops.flat().length, count = model.get("shown").n_components;
    const holes = Math.max(loops.length - 1, 0);
    let kind = "ok", text = `Cage with ${n} vertices and ${holes || "no"} ${holes === 1 ? "hole" : "holes"}`;
    if (link.refusal) [kind, text] = ["bad", link.refusal];
    else if (link.busy) [kind, text] = ["busy", "Working…"];
    else if (!size) [kind, text] = ["idle", "No picture yet"];
    else if (problems.length) {
      [kind, text] = ["bad", loops.length ? "This is not a valid cage; the last valid cage is kept" : "There is no cage yet"];
    } else if (discarded) {
      text += " · your edits were lost with the old outline; Undo brings them back";
    } else if (count > 1) {
      const which = component ? `component ${component + 1}` : "the largest";
      text += ` · ${which} of ${count} components`;
    }
    if (kind === "ok" && doubt) [kind, text] = ["guess", `A guess, as ${doubt} · ${text}`];
    root.dataset.status = kind;
    status.textContent = text;
  }
  function showState() {
    const shown = model.get("shown");
    if (!shown.loops) return;
    stage.update(shown);
    panel.update(shown);
    undo.disabled = !shown.can_undo;
    redo.disabled = !shown.can_redo;
    discard.hidden = !shown.edited;
    tools.forEach((button) => button.disabled = !shown.size);
    if (link.idle) showTool(shown.tool);
    showStatus();
  }
  function showPicture() {
    stage.setPicture(model.get("picture")).catch((error) => {
      link.refusal = `The picture cannot be shown: ${error.message}`;
      showStatus();
    });
  }
  const setHeight = () => {
    const height = model.get("height");
    root.style.setProperty("--glid-height", height ? `${height}px` : "");
  };
  follow(model, {
    "change:height": setHeight,
    "change:shown": showState,
    "change:picture": showPicture
  });
  return () => stage.close();
}
var main_default = { render };
export {
  main_default as default
};
