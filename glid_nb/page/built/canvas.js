// pad/clipboard.js
async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copiedBySelection(text);
  }
}
function copiedBySelection(text) {
  const focused = document.activeElement;
  const area = document.createElement("textarea");
  area.value = text;
  area.setAttribute("readonly", "");
  Object.assign(area.style, { position: "fixed", top: "0", left: "0", opacity: "0" });
  document.body.append(area);
  area.select();
  try {
    return document.execCommand("copy");
  } catch {
    return false;
  } finally {
    area.remove();
    focused?.focus({ preventScroll: true });
  }
}

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
function save(model, changes) {
  for (const [name, value] of Object.entries(changes)) model.set(name, value);
  model.save_changes();
}
function toFloats(view) {
  if (!view) return new Float32Array();
  return new Float32Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
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

// pad/menu.js
function openMenu(element, [x, y], rows) {
  const ending = new AbortController();
  const close = () => {
    ending.abort();
    menu.remove();
    element.focus({ preventScroll: true });
  };
  let pressed = false;
  const step = (by) => {
    const items = [...menu.querySelectorAll("button")];
    items.at((items.indexOf(document.activeElement) + by) % items.length).focus();
  };
  const keys = { ArrowDown: () => step(1), ArrowUp: () => step(-1), Escape: close, Tab: close };
  const row = ([label, key, act]) => {
    const onclick = (e) => (pressed || !e.detail) && [close(), act()];
    return make("button", { role: "menuitem", onclick }, label, make("kbd", {}, key));
  };
  const menu = shield(make("div", {
    className: "glid-menu",
    role: "menu",
    onpointerdown: () => pressed = true,
    oncontextmenu: (e) => e.preventDefault(),
    onkeydown: (e) => keys[e.key] && [e.preventDefault(), keys[e.key]()]
  }, ...rows.map((one) => one ? row(one) : make("hr"))));
  element.querySelector(".glid-menu")?.remove();
  element.append(menu);
  const within = (at, room) => `${Math.max(0, Math.min(at, room))}px`;
  menu.style.left = within(x, element.clientWidth - menu.offsetWidth);
  menu.style.top = within(y, element.clientHeight - menu.offsetHeight);
  window.addEventListener("pointerdown", (e) => {
    if (menu.contains(e.target)) return;
    close();
    if (e.button === 0 && element.contains(e.target)) e.stopPropagation();
  }, { capture: true, signal: ending.signal });
  step(1);
}

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
function tracePath(ctx, lines2, closed = true) {
  ctx.beginPath();
  for (const line of lines2) {
    line.forEach(([x, y], i) => i ? ctx.lineTo(x, y) : ctx.moveTo(x, y));
    if (closed) ctx.closePath();
  }
}
function rectangle([left, top], [right, bottom]) {
  return [[left, top], [right, top], [right, bottom], [left, bottom]];
}
function fillPath(ctx, lines2, style, rule = "evenodd") {
  tracePath(ctx, lines2);
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

// pad/hit.js
var probe = document.createElement("canvas").getContext("2d");
function nearest(things, reach) {
  const far = ({ d, loss = 0 }) => d + loss;
  return things.filter(({ d }) => d <= reach).sort((a, b) => far(a) - far(b))[0] ?? null;
}

// canvas/marks.js
var TARGET = 7.5;
var IMAGE = 3.5;
var RING = 12;
var DIAL = 42;
var KNOB = 6;
var EDGE = 14;
var CORNER = [36, 112];
var WANTED = "#d55e00";
var FREE = "rgba(40,40,40,0.75)";
var BORDER = "rgba(255,255,255,0.85)";
function lines(pen, pairs, styles) {
  pen.lineCap = "round";
  tracePath(pen, pairs, false);
  strokePath(pen, styles);
}
function drawOnion(pen, view, outlines) {
  for (const [color, loops] of outlines) {
    tracePath(pen, loops.map((loop) => view.line(loop)));
    strokePath(pen, [[3.6, BORDER], [1.8, color]]);
  }
}
var STIFF = "#4b0f7a";
function hatching(pen, strength) {
  const size = Math.round(16 - 9 * strength);
  const tile = make("canvas", { width: size, height: size }), ink = tile.getContext("2d");
  tracePath(ink, [[[0, size], [size, 0]], [[-1, 1], [1, -1]], [[size - 1, size + 1], [size + 1, size - 1]]], false);
  strokePath(ink, [[3, "rgba(255,255,255,0.75)"], [1.5, STIFF]]);
  return pen.createPattern(tile, "repeat");
}
function drawStiff(pen, view, areas, brush) {
  pen.globalAlpha = brush ? 1 : 0.4;
  for (const [strength, loops] of areas) {
    fillPath(pen, loops.map((loop) => view.line(loop)), brush ? hatching(pen, strength) : "transparent", "nonzero");
    strokePath(pen, [[3.4, BORDER], [1.5, STIFF]]);
  }
  pen.globalAlpha = 1;
}
function drawBrush(pen, view, { radius, strength }, { path, rests }) {
  const wide = radius / view.unit, color = strength ? STIFF : "#ffffff";
  if (path.length) {
    tracePath(pen, [view.line([...path, path.at(-1)])], false);
    Object.assign(pen, { lineCap: "round", lineJoin: "round", globalAlpha: 0.45 });
    strokePath(pen, [[2 * wide, color]]);
    pen.globalAlpha = 1;
  }
  if (!rests) return;
  circle(pen, rests, wide, [[3.4, BORDER], [1.4, STIFF]]);
}
function dial(view, marks, held) {
  const last = marks.selected.at(-1), [angle, scale] = marks.ring;
  if (angle === void 0 || !marks.targets[last]) return null;
  const centre = view.toScreen(held?.get(last) || marks.targets[last]), [x, y] = centre;
  const radius = DIAL * Math.min(2.5, Math.max(0.5, scale));
  return { centre, radius, knob: [x + radius * Math.cos(angle), y - radius * Math.sin(angle)] };
}
function knobInCorner(view, marks, held) {
  const [x, y] = dial(view, marks, held)?.knob ?? [0, 0];
  return x > view.width - CORNER[0] - KNOB && y < CORNER[1] + KNOB;
}
function ringAt(view, marks, place, reach) {
  const ring = dial(view, marks);
  if (!ring) return null;
  if (distance(place, ring.knob) <= Math.max(KNOB + 4, reach)) return { part: "scale" };
  const far = Math.abs(distance(place, ring.centre) - ring.radius);
  return far <= reach ? { part: "turn" } : null;
}
function drawRing(pen, view, marks, held) {
  const ring = dial(view, marks, held);
  if (!ring) return;
  const [, , turned, scaled] = marks.ring, { centre, radius, knob } = ring, [x, y] = knob;
  const color = turned ? WANTED : FREE;
  circle(pen, centre, radius, [[4, BORDER]]);
  circle(pen, centre, radius, [[2, color]], turned ? [] : [6, 4]);
  lines(pen, [[centre, knob]], [[3, BORDER], [1.2, color]]);
  fillPath(pen, [rectangle([x - KNOB, y - KNOB], [x + KNOB, y + KNOB])], scaled ? WANTED : "#fff");
  strokePath(pen, [[1.6, scaled ? "#fff" : FREE]]);
}
function lostMarks(view, marks) {
  return marks.targets.flatMap((target) => {
    const place = view.toScreen(target), [x, y] = place;
    if (x >= 0 && y >= 0 && x <= view.width && y <= view.height) return [];
    const within = (value, size) => Math.min(size - EDGE, Math.max(EDGE, value));
    const height = within(y, view.height), at = [within(x, view.width - (height < CORNER[1] ? CORNER[0] : 0)), height];
    return [{ at, target, angle: Math.atan2(y - at[1], x - at[0]) }];
  });
}
function drawLost(pen, view, marks) {
  for (const { at: [x, y], angle } of lostMarks(view, marks)) {
    const corner = (turn, r) => [x + r * Math.cos(angle + turn), y + r * Math.sin(angle + turn)];
    fillPath(pen, [[corner(0, 11), corner(2.4, 9), corner(-2.4, 9)]], "#00d5e0");
    strokePath(pen, [[1.6, "#063f45"]]);
  }
}
function drawLasso(pen, view, path) {
  fillPath(pen, [view.line(path)], "rgba(0,114,178,0.12)");
  strokePath(pen, [[3, BORDER], [1.4, "#0072b2"]], [5, 3]);
}
function drawMarks(pen, view, marks, { hovered, held, cursor }) {
  const targets = view.line(marks.targets.map((p, i) => held.get(i) || p)), images = view.line(marks.images);
  const apart = targets.map((target, i) => [images[i], target]).filter(([a, b]) => a && distance(a, b) >= 2);
  lines(pen, apart, [[3.6, BORDER], [1.6, "#2b2b2b"]]);
  targets.forEach((target, i) => {
    if (marks.selected.includes(i)) disk(pen, target, RING, "rgba(0,114,178,0.28)", "#0072b2", 2);
    else if (i === hovered) disk(pen, target, RING, "rgba(0,114,178,0.14)");
    if (marks.hidden.includes(i)) circle(pen, target, TARGET, [[3.4, BORDER], [1.6, "#067a82"]], [3.5, 2.4]);
    else disk(pen, target, TARGET, "#00d5e0", "#063f45", 1.4);
  });
  drawRing(pen, view, marks, held);
  drawLost(pen, view, marks);
  images.forEach((image, i) => {
    if (marks.hidden.includes(i)) return;
    disk(pen, image, IMAGE + 1, "rgba(255,255,255,0.9)");
    disk(pen, image, IMAGE, "#111");
  });
  if (!cursor) return;
  const [x, y] = view.toScreen(cursor);
  const arms = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([dx, dy]) => [[x + 4 * dx, y + 4 * dy], [x + 13 * dx, y + 13 * dy]]);
  lines(pen, arms, [[4, "rgba(255,255,255,0.9)"], [1.6, "#d55e00"]]);
}
function markAt(marks, point, reach) {
  const at = (points, reached) => nearest(points.map((place, mark) => {
    const loss = marks.hidden.includes(mark) ? reach / 3 : 0;
    return { mark, reached, d: distance(place, point), loss };
  }), reach);
  return at(marks.targets, false) ?? at(marks.images, true);
}

// canvas/room.js
var PAGE = 120;
var PARTS = 330;
var LEAST = 480;
var GAP = 16;
var SLACK = 20;
var SETTLE = 80;
var Room = class {
  // The signal ends it.
  constructor(pad, model, signal) {
    Object.assign(this, { pad, model, root: null, last: [0, 0, 0] });
    this.later = () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.measure(), SETTLE);
    };
    this.observer = new ResizeObserver(this.later);
    this.observer.observe(pad);
    const escape = (e) => {
      if (e.key !== "Escape" || !this.last[2] || pad.matches(":active, :has(.glid-menu, :popover-open)")) return;
      e.stopPropagation();
      this.alone(false);
    };
    window.addEventListener("resize", this.later, { signal });
    window.addEventListener("keydown", escape, { signal, capture: true });
    document.addEventListener("fullscreenchange", () => {
      if (!document.fullscreenElement) this.alone(false);
    }, { signal });
    signal.addEventListener("abort", () => {
      clearTimeout(this.timer);
      this.observer.disconnect();
    });
  }
  measure() {
    const { pad, last } = this, root = pad.closest(".glid-editor"), column = pad.closest(".glid-column");
    if (!column?.clientWidth) return;
    if (!this.root) this.observer.observe(column.parentElement);
    this.root = root;
    const whole = column.parentElement.clientWidth, beside = whole - column.nextElementSibling.offsetWidth - GAP;
    const alone = Number(root.classList.contains("glid-alone")), page = document.fullscreenElement === root ? 0 : PAGE;
    const room = alone ? [root.clientWidth, window.innerHeight - page, 1] : [beside >= LEAST ? beside : whole, Math.max(LEAST, window.innerHeight - page - PARTS), 0];
    const wider = room[0] - last[0];
    if (wider >= 0 && wider < SLACK && room[1] === last[1] && alone === last[2]) return;
    this.last = room;
    save(this.model, { room: room.map(Math.floor) });
  }
  // Shows nothing but the picture, or everything again.
  alone(on = !this.last[2]) {
    const { root, pad, last } = this;
    if (!root || !on && !last[2]) return this.later();
    root.classList.toggle("glid-alone", on);
    this.measure();
    root.scrollIntoView({ block: on ? "start" : "nearest" });
    pad.focus({ preventScroll: true });
    if (!on && document.fullscreenElement) document.exitFullscreen();
  }
  fullScreen() {
    const say = (why) => save(this.model, { notice: `There is no full screen here: ${why}` });
    if (document.fullscreenElement) document.exitFullscreen();
    else this.root?.requestFullscreen().catch((error) => say(error.message));
  }
};

// canvas/shapes.js
var clearLists = (scene, { renderLists }) => renderLists.dispose();
var drawNoMore = (view) => view.once("remove", () => view.renderScene = () => {
});
var Shapes = class {
  constructor(model, view) {
    Object.assign(this, { model, view, materials: [] });
    this.motion = null;
    this.loading = 0;
    model.on("change:materials change:camera change:renderer", () => this.load());
  }
  async load() {
    const turn = ++this.loading;
    const { model } = this;
    const references = [model.get("camera"), model.get("renderer"), ...model.get("materials")];
    const [camera, renderer, ...materials] = await Promise.all(
      references.map((r) => model.widget_manager.get_model(r.replace("IPY_MODEL_", "")))
    );
    await Promise.all([camera, renderer, ...materials].map((m) => m.initPromise));
    if (turn !== this.loading) return;
    this.forget();
    Object.assign(this, { camera, renderer, materials });
    for (const material of materials) material.on("change", this.refresh, this);
    renderer.get("scene").off("beforeRender", clearLists).on("beforeRender", clearLists);
    for (const view of Object.values(renderer.views)) view.then(drawNoMore);
    this.refresh();
  }
  forget() {
    for (const material of this.materials) material.off(null, null, this);
    this.materials = [];
  }
  // Puts the newest coefficients into every material.
  refresh() {
    const floats = this.motion?.length ? this.motion : toFloats(this.model.get("coefficients"));
    for (const { obj } of this.materials) {
      const { cage, coefficients, holes, by_margin } = obj?.uniforms ?? {};
      if (by_margin?.value) by_margin.value = this.motion ? 2 : 1;
      if (!coefficients) continue;
      const chain = cage.value.length;
      if (floats.length !== chain + holes.value.length) continue;
      coefficients.value = floats.subarray(0, chain);
      holes.value = floats.subarray(chain);
    }
    this.see();
    this.redraw();
  }
  // Gives the picture's vertices the heights of a motion's time; null gives back those of the pose.
  lift(heights) {
    const position = this.renderer?.get("scene").obj?.children[0]?.geometry.attributes.position;
    if (!position) return;
    if (position.array !== this.lifted) this.resting = position.array;
    const moves = heights?.length === position.count;
    if (!moves && position.array === this.resting) return;
    if (!moves) position.setArray(this.resting);
    else if (position.array === this.resting) position.setArray(this.lifted = this.resting.slice());
    if (moves) heights.forEach((z, i) => {
      this.lifted[3 * i + 2] = z;
    });
    position.needsUpdate = true;
  }
  // Shows what the view shows; the camera's renderer draws anew by itself.
  see() {
    const { x, y, unit, width, height } = this.view;
    const w = width / 2 * unit, h = height / 2 * unit;
    for (const { obj } of this.materials) {
      if (obj?.uniforms?.pixel) obj.uniforms.pixel.value = unit;
    }
    this.camera?.set({ left: x - w, right: x + w, top: y + h, bottom: y - h });
  }
  redraw() {
    this.renderer?.trigger("rerender", this.renderer, {});
  }
  close() {
    this.loading++;
    this.forget();
  }
};
var NEAR = 8;
function coveredNear(pad, place) {
  const drawn = pad.closest(".glid-pane").querySelector(".jupyter-threejs canvas"), size = 2 * NEAR;
  const pen = make("canvas", { width: size, height: size }).getContext("2d");
  pen.drawImage(drawn, ...place.map((at) => NEAR - Math.floor(at * drawn.width / pad.clientWidth)));
  return pen.getImageData(0, 0, size, size).data.some((value, i) => i % 4 === 3 && value);
}
function uniformVectors() {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2") || canvas.getContext("webgl");
  if (!gl) return 0;
  const count = gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return count;
}
var N_TIMED = 3;
async function drawingTime(pad, shapes) {
  const times = [];
  for (let i = 0; i <= N_TIMED; i++) {
    shapes.redraw();
    await new Promise((go) => requestAnimationFrame(go));
    const canvas = pad.closest(".glid-pane")?.querySelector(".jupyter-threejs canvas");
    const gl = canvas && (canvas.getContext("webgl") || canvas.getContext("webgl2"));
    if (!gl) continue;
    const start = performance.now();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    times.push(performance.now() - start);
  }
  return times.length > 1 ? Math.min(...times.slice(1)) : 0;
}

// canvas/main.js
var REACH = { mouse: 13, pen: 16, touch: 26 };
var KEYS = /^(Arrow\w+|Page\w+|Delete|Backspace|Escape|Enter|[0fa,.[\]<>+=xmbe-])$/i;
var HELP = [
  ["Pins", [
    ["Click the shape", "pin a point"],
    ["Drag a pin, or the shape", "move it there; the shape follows, and never folds"],
    ["Right-click, long touch, Menu key", "what can be done with a pin, or with the shape there"],
    ["Delete", "remove the selected pins; with Shift keep the shape"],
    ["Ring around a pin: drag it, or its knob", "turn the shape there, scale it there"],
    ["< >, + -, X", "turn, scale; leave both free again"],
    ["Page Down, Page Up, [ ]", "selected pins and what is around them go back, come forward"],
    ["Arrow keys", "nudge selected pins, with Shift farther; else move a cursor"],
    ["Enter", "show the cursor; pin or select there"]
  ]],
  ["Selecting", [
    ["Shift-click, A", "select several pins, all pins"],
    ["Shift and drag, Ctrl and drag", "select the pins in a box, in a lasso"],
    [", .", "select the pin before, the next pin, and bring it into view; so does a click on an arrow at the edge"],
    ["Esc", "cancel a drag; select nothing"]
  ]],
  ["Poses", [
    ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
    ["Ctrl+C, Ctrl+V", "copy the pose, put it on this or a similar shape"],
    ["M", "swap left and right"],
    ["0", "back to the undeformed shape"]
  ]],
  ["Stiff areas", [["B, E", "paint what should stay as it is, erase it; Esc lays the brush down"]]],
  ["View", [
    ["Wheel, two fingers", "zoom"],
    ["Middle button, Space and drag", "move the view"],
    ["F", "see everything"],
    ["P", "the picture alone, for lectures; Esc brings the rest back"],
    ["W", "the whole screen"]
  ]],
  ["Timeline", [
    ["Space", "play the motion through the poses, pause; on the canvas too"],
    ["Arrow keys, Home, End", "step in time, with Shift to the next pose; first, last pose"],
    ["Alt and arrow keys", "move the pose in time; Delete removes it"]
  ]]
];
var FIRST = "Click the shape to pin a point, then drag the pin · ? shows all keys";
var PAINT = "Paint what should stay as it is · E erases · Esc when done";
var TIPS = [
  "where it should be. Drag it; a right click shows what else; Shift-click selects several",
  "where the shape has got to. The cyan disk is where it should be"
];
var COVERED = ". Another part of the shape covers it";
var RING_TIPS = {
  turn: "Drag around the pin to turn the shape there; X leaves it free again",
  scale: "Drag away from the pin or towards it to scale the shape there; X leaves it free again"
};
var COPIED = "The pose is in the clipboard; Ctrl+V on a canvas puts it there";
var NOT_COPIED = "The browser does not give access to the clipboard; use Ctrl+C and Ctrl+V";
var SAVE_VIEW_AFTER = 250;
var LEAST_SIZE = 240;
function colorBar({ title, colors, ticks, about }) {
  const gradient = `background: linear-gradient(to right, ${colors.join(", ")})`;
  const labels = ticks.map((tick) => make("span", {}, tick));
  return make(
    "div",
    { className: "glid-legend-part", title: about },
    make("div", { className: "glid-legend-title" }, title),
    make("div", { className: "glid-legend-bar", style: gradient }),
    make("div", { className: "glid-legend-ticks" }, ...labels)
  );
}
function resizeGrip(model) {
  let from = null;
  return shield(make("div", {
    className: "glid-resize",
    title: "Drag to resize",
    onpointerdown: (e) => {
      e.preventDefault();
      e.target.setPointerCapture(e.pointerId);
      from = [model.get("width") - e.clientX, model.get("height") - e.clientY];
    },
    onpointermove: (e) => {
      if (!from) return;
      const [width, height] = [from[0] + e.clientX, from[1] + e.clientY].map((side) => Math.max(LEAST_SIZE, Math.round(side)));
      save(model, { width, height });
    },
    onlostpointercapture: () => from = null
  }));
}
function render({ model, el, signal }) {
  el.classList.add("glid-host", "glid-pad-host");
  const interactive = model.get("interactive");
  const paper = make("canvas", { className: "glid-paper" });
  const bars = make("div", { className: "glid-legend" });
  const notice = make("div", { className: "glid-notice", role: "status" });
  const prepared = make("div", { className: "glid-prepared", role: "status" });
  const label = "Deformation canvas: arrow keys move, Enter pins a point";
  const look = { className: "glid-pad", role: "application", "aria-label": label };
  const parts = [paper, bars, notice, prepared];
  const box = make("div", { ...look, inert: !interactive }, ...parts);
  const keys = help(HELP);
  box.dataset.lmSuppressShortcuts = "true";
  el.append(box);
  let saving;
  const view = new View(() => {
    see();
    clearTimeout(saving);
    saving = setTimeout(() => save(model, { view: [view.x, view.y, view.unit] }), SAVE_VIEW_AFTER);
  }, { nearest: 1e-4, farthest: 1 });
  const shapes = new Shapes(model, view);
  const soon = painter(paper, view, signal, (pen) => {
    const { found, held, focused } = pad, cursor = focused ? model.get("cursor") : null;
    corner.classList.toggle("glid-through", !shapes.motion && knobInCorner(view, marks(), held));
    if (shapes.motion) return;
    drawOnion(pen, view, model.get("onion"));
    drawStiff(pen, view, model.get("stiff"), paints());
    drawMarks(pen, view, model.get("marks"), { hovered: found?.mark, held, cursor });
    if (paints()) drawBrush(pen, view, model.get("brush"), pad);
    if (pad.encloses && pad.path.length > 2) drawLasso(pen, view, pad.path);
  });
  const see = () => {
    shapes.see();
    soon();
  };
  const say = (notice2) => save(model, { notice: notice2 });
  const link = new Link(model, box, signal, () => {
    if (!link.busy && link.refusal && link.refusal !== model.get("notice")) say(link.refusal);
  });
  const marks = () => model.get("marks");
  const paints = () => "radius" in model.get("brush");
  const showMenu = (place, found = { mark: marks().selected.at(-1) }) => {
    const mark = found?.mark, { selected, targets } = marks();
    const point = mark === void 0 ? model.get("cursor") ?? [view.x, view.y] : targets[mark];
    const press = (key, e) => () => pad.press(key, e);
    place ??= view.toScreen(point);
    const pin = ["Add a pin here", "Click", () => pad.send("pin", place)];
    const all = selected.includes(mark) && selected.length > 1 ? ` ${selected.length} pins` : "";
    openMenu(box, place, [
      ...mark === void 0 ? coveredNear(box, place) ? [pin, null] : [] : [
        ["Bring forward", "Page Up", press("PageUp")],
        ["Send back", "Page Down", press("PageDown")],
        null,
        [`Remove${all}`, "Delete", press("Delete")],
        ["Remove, keep the shape", "Shift+Delete", press("Delete", { shiftKey: true })],
        ["Leave angle and scale free", "X", press("x")],
        null
      ],
      ["Copy the pose", "Ctrl+C", press("copy")],
      ["Paste a pose", "Ctrl+V", () => pasted().then(paste, () => say(NOT_COPIED))],
      ["Swap left and right", "M", press("m")],
      ["Select all pins", "A", press("a")],
      ["The undeformed shape", "0", press("0")],
      ["See everything", "F", press("f")],
      ["Paint stiff areas", "B", press("b")],
      ["The picture alone", "P", alone],
      ["Full screen", "W", whole],
      ["All keys", "?", keys.toggle]
    ]);
  };
  const room = interactive && new Room(box, model, signal);
  const alone = () => room.alone(), whole = () => room.fullScreen();
  const pad = new Pad(box, view, link, {
    reach: REACH,
    keys: KEYS,
    actions: { "?": keys.toggle, contextmenu: () => showMenu(), p: alone, w: whole },
    menu: showMenu,
    tapped: () => box.dispatchEvent(new CustomEvent("glid:play", { bubbles: true })),
    get painting() {
      return paints();
    },
    find: (point, reach) => shapes.motion || paints() ? null : markAt(marks(), point, reach) ?? ringAt(view, marks(), view.toScreen(point), reach / view.unit / 2),
    encloses: (found, e) => found ? null : e.shiftKey ? "box" : e.ctrlKey || e.metaKey ? "lasso" : null,
    held: ({ mark }) => {
      const { selected, targets } = marks();
      return new Map((selected.includes(mark) ? selected : [mark]).map((i) => [i, targets[i]]));
    },
    cursor: (found) => {
      if (found?.part) {
        box.title = RING_TIPS[found.part];
        return "grab";
      }
      box.title = "";
      if (!found) return "crosshair";
      const name = ["Pin", found.mark + 1, model.get("names")[found.mark]].join(" ").trim();
      const covered = marks().hidden.includes(found.mark) ? COVERED : "";
      box.title = `${name}: ${TIPS[Number(found.reached)]}${covered}`;
      return "grab";
    },
    changed: soon
  });
  const button = (...look2) => iconButton(...look2, "glid-help-button");
  const corner = make(
    "div",
    { className: "glid-corner" },
    keys.button,
    button("fit", "Full screen (W)", whole),
    button("rectangle", "The picture alone (P)", alone)
  );
  if (interactive) {
    box.append(shield(corner), keys.table, resizeGrip(model));
    keysAround(box, (e) => pad.keydown(e), signal);
  }
  let back = null;
  const showMotion = (motion, release, heights) => {
    back = release;
    shapes.motion = motion;
    shapes.lift(heights);
    showLegend();
    shapes.refresh();
    soon();
  };
  for (const name of ["pointerdown", "keydown"]) {
    box.addEventListener(name, (e) => {
      const other = e.key && (e.ctrlKey || e.metaKey || !KEYS.test(e.key));
      if (!shapes.motion || e.button === 1 || other) return;
      e.stopImmediatePropagation();
      e.preventDefault();
      back();
    }, true);
  }
  const pasted = async () => navigator.clipboard.readText();
  const paste = (text) => link.put({ type: "paste_pose", text });
  model.on("msg:custom", async ({ copy: text }) => {
    if (text && pad.focused) say(await copied(text) ? COPIED : NOT_COPIED);
  });
  box.addEventListener("copy", (e) => {
    if (!pad.focused) return;
    e.preventDefault();
    pad.press("copy");
  });
  box.addEventListener("paste", (e) => {
    e.preventDefault();
    paste(e.clipboardData.getData("text"));
  });
  box.addEventListener("pointerdown", (e) => {
    const lost = lostMarks(view, marks()).find(({ at }) => distance(at, pad.place(e)) < 12);
    if (!lost || e.target !== box) return;
    [view.x, view.y] = lost.target;
    view.changed();
    e.stopImmediatePropagation();
  }, true);
  let chosen;
  const reveal = () => {
    const { selected: [first, ...others], targets, images } = marks();
    const now = others.length ? void 0 : first;
    if (now === chosen) return;
    chosen = now;
    if (now === void 0 || pad.mode) return;
    if (lostMarks(view, { targets: [targets[now], images[now]] }).length < 2) return;
    [view.x, view.y] = targets[now];
    view.changed();
  };
  const fit = () => {
    Object.assign(view, { width: model.get("width"), height: model.get("height") });
    [view.x, view.y, view.unit] = model.get("view");
    Object.assign(box.style, { width: `${view.width}px`, height: `${view.height}px` });
    see();
  };
  const tell = () => {
    const refusal = model.get("notice"), first = interactive && !marks().targets.length;
    notice.textContent = refusal || (paints() ? PAINT : first ? FIRST : "");
    notice.hidden = !notice.textContent;
    notice.classList.toggle("glid-first", !refusal);
  };
  const prepare = () => {
    const share = model.get("prepared");
    prepared.hidden = share >= 1;
    prepared.textContent = `Warming up: ${Math.round(100 * share)} %`;
    prepared.style.backgroundSize = `${100 * share}% 100%, auto`;
  };
  const showLegend = () => {
    const shown = [model.get("legend"), model.get("panel_legend")].filter((bar) => bar.title).map((bar) => ({ ...bar, title: shapes.motion && bar.moving || bar.title }));
    bars.replaceChildren(...shown.map(colorBar));
    bars.hidden = !shown.length;
    bars.dataset.corner = model.get("legend_corner");
  };
  follow(model, {
    "change:width change:height change:view": fit,
    "change:coefficients": () => shapes.refresh(),
    "change:marks change:cursor change:onion change:stiff change:brush": soon,
    "glid:motion": showMotion,
    "change:legend change:panel_legend change:legend_corner": showLegend,
    "change:notice change:marks change:brush": tell,
    "change:marks": reveal,
    "change:prepared": prepare
  });
  shapes.load().then(() => drawingTime(box, shapes)).then((time) => {
    if (!signal.aborted) save(model, { drawn: true, drawing_time: time });
  });
  if (model.get("uniform_vectors") === 0) save(model, { uniform_vectors: uniformVectors() || -1 });
  return () => {
    clearTimeout(saving);
    shapes.close();
  };
}
var main_default = { render };
export {
  main_default as default
};
