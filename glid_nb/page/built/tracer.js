// pad/dom.js
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  if (element instanceof HTMLButtonElement) element.type = "button";
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") Reflect.set(element, name, value);
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}
function penOf(canvas) {
  const pen = canvas.getContext("2d");
  if (!pen) throw new Error("this browser does not draw on canvases");
  return pen;
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
  const table = shield(
    make(
      "div",
      { className: "glid-help", popover: "auto", autofocus: true, tabIndex: -1 },
      ...sections.map(section)
    )
  );
  table.addEventListener("click", () => table.hidePopover());
  const title = "Keys and gestures (?)";
  const look = { className: "glid-help-button", title, "aria-label": title };
  const button = shield(make("button", { ...look, popoverTargetElement: table }, "?"));
  return { table, button, toggle: () => void table.togglePopover() };
}
function section([title, rows]) {
  return make("section", {}, make("h4", {}, title), make("table", {}, ...rows.map(row)));
}
function row([keys, what]) {
  return make("tr", {}, make("th", {}, keys), make("td", {}, what));
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
var Link = class {
  busy = false;
  // an answer is overdue
  /** @type {string | null} why the kernel refused the last batch */
  refusal = null;
  view = Math.random().toString(36).slice(2);
  /** @type {(KernelEvent & { seq: number })[]} */
  #queue = [];
  /** @type {ArrayBuffer[]} */
  #buffers = [];
  /** @type {Promised[]} */
  #promised = [];
  #waiting = false;
  // for the answer to a batch, or for its frame
  #awaited = 0;
  // the number of the last event of that batch
  #number = 0;
  // of the last event
  #acknowledged = 0;
  // the number of the last event that was answered
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #overdue;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timeout;
  #drawing = 0;
  /**
   * @param {Model<any>} model
   * @param {HTMLElement} element its `data-idle` says whether all is answered
   * @param {AbortSignal} signal ends it
   * @param {() => void} report called when an answer came, or is overdue
   */
  constructor(model, element, signal, report) {
    this.model = model;
    this.element = element;
    this.signal = signal;
    this.report = report;
    connectNoMoreComms(model.widget_manager.kernel);
    element.dataset.idle = "true";
    signal.addEventListener("abort", () => this.#stop());
    model.on("msg:custom", (message) => {
      if (message.view === this.view) this.#answered(message);
    });
  }
  /** Whether all events were answered. */
  get idle() {
    return this.#acknowledged === this.#number;
  }
  /**
   * Sends an event, or has it wait. It replaces the last one that waits if both have the same
   * `replaces`.
   *
   * @param {KernelEvent} event
   * @param {ArrayBuffer[]} buffers
   * @returns {Promise<string | null>} the kernel's refusal, or null, when the event was handled
   */
  put(event, buffers = []) {
    this.#number += 1;
    const number = this.#number;
    const last = this.#queue.at(-1);
    if (last?.replaces && last.replaces === event.replaces) this.#queue.pop();
    this.#queue.push({ ...event, seq: number });
    this.#buffers.push(...buffers);
    this.element.dataset.idle = "false";
    this.#flush();
    return new Promise((resolve) => this.#promised.push({ number, resolve }));
  }
  #flush() {
    if (this.#waiting || !this.#queue.length) return;
    this.#waiting = true;
    this.#awaited = this.#number;
    try {
      const { kernel } = this.model.widget_manager;
      if (kernel === null || kernel?.isDisposed) throw new Error("the kernel was shut down");
      this.model.send({ view: this.view, events: this.#queue }, void 0, this.#buffers);
    } catch {
      this.#markDisconnected();
      return;
    }
    this.#queue = [];
    this.#buffers = [];
    this.#overdue = setTimeout(() => {
      this.busy = true;
      this.report();
    }, BUSY_AFTER);
    this.#timeout = setTimeout(() => this.#release(), ACKNOWLEDGE_TIMEOUT);
  }
  // The kernel is gone. Nothing is sent any more, and the page says so if it does not yet.
  #markDisconnected() {
    const around = this.element.closest(".glid-editor") ?? this.element.closest(".glid-host");
    around?.classList.add("jupyter-widgets-disconnected");
  }
  /** @param {Answer} answer */
  #answered({ ack, refusal }) {
    if (ack === this.#awaited) clearTimeout(this.#overdue);
    this.#acknowledged = Math.max(this.#acknowledged, ack);
    this.busy = false;
    this.refusal = refusal;
    this.element.dataset.idle = String(this.idle);
    const due = this.#promised.filter(({ number }) => number <= ack);
    this.#promised = this.#promised.filter(({ number }) => number > ack);
    for (const { resolve } of due) resolve(refusal);
    this.report();
    if (ack < this.#awaited) return;
    if (document.hidden) this.#release();
    else this.#drawing = requestAnimationFrame(() => this.#release());
  }
  #release() {
    this.#stop();
    this.#waiting = false;
    this.#flush();
  }
  #stop() {
    clearTimeout(this.#overdue);
    clearTimeout(this.#timeout);
    cancelAnimationFrame(this.#drawing);
  }
};
function connectNoMoreComms(kernel) {
  const status = kernel?.statusChanged;
  const connect = status?.connect;
  if (!connect || Object.hasOwn(status, "connect")) return;
  status.connect = (slot, receiver) => !String(slot).includes("_cleanSubshells") && connect.call(status, slot, receiver);
}

// pad/keys.js
var TEXT = "textarea, [contenteditable], input:not([type=checkbox], [type=range], [type=radio])";
function undoOrRedo(e) {
  if (!e.ctrlKey && !e.metaKey) return null;
  const key = e.key.toLowerCase();
  if (key === "z") return e.shiftKey ? "redo" : "undo";
  return key === "y" ? "redo" : null;
}
function keysAround(element, act, signal, whole = element) {
  const editorAround = (e) => {
    const editor = (
      /** @type {HTMLElement} */
      element.closest(".glid-editor") ?? whole
    );
    const inside = editor.contains(
      /** @type {Node} */
      e.target
    ) && element.checkVisibility();
    return inside ? editor : null;
  };
  const refocus = (e) => {
    const editor = editorAround(e);
    if (!editor) return;
    editor.tabIndex = -1;
    const target = (
      /** @type {HTMLButtonElement} */
      e.target
    );
    const lost = e.type === "focusout" ? target.disabled : target.closest("[role=tab]");
    if (lost) editor.focus({ preventScroll: true });
  };
  const keydown = (e) => {
    const editor = editorAround(e);
    if (!editor) return;
    const target = (
      /** @type {Element} */
      e.target
    );
    const command = e.ctrlKey || e.metaKey;
    const outside = !element.contains(target);
    const runsTheCell = outside && e.shiftKey && e.key === "Enter";
    const ours = undoOrRedo(e) !== null || !(command || runsTheCell);
    target.toggleAttribute("data-lm-suppress-shortcuts", ours);
    editor.onkeydown = ours ? (bubbled) => bubbled.stopPropagation() : null;
    if (outside && !target.matches(TEXT) && isForThePad(e, target)) act(e);
  };
  const options = { capture: true, signal };
  window.addEventListener("pointerdown", refocus, options);
  window.addEventListener("focusout", refocus, options);
  window.addEventListener("keydown", keydown, options);
}
function isForThePad(e, target) {
  if (undoOrRedo(e)) return !e.altKey;
  if (e.ctrlKey || e.metaKey || target.matches("select")) return false;
  const free = target.closest(".glid-timeline") ? /^[^ ]$/ : /^([^ ]|Escape|Delete)$/;
  return free.test(e.key);
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
  let most = 1;
  let gesture = null;
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
    const value = options[name];
    const seen = value ?? automatic?.[name] ?? null;
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
  const row2 = (...parts) => make("div", { className: "glid-row" }, ...parts);
  const numbers = NUMBERS.map((one) => numberControl(one, choose));
  const [threshold, smoothing, offset, simplify, leastHole] = numbers.map(({ element: element2 }) => element2);
  const methods = METHODS.map(([method, label, title]) => {
    const onclick = () => choose({ method });
    return make("button", { title, role: "radio", "data-value": method, onclick }, label);
  });
  const swap = () => choose({ invert: invert.checked });
  const invert = make("input", { type: "checkbox", onchange: swap });
  const inverts = make(
    "label",
    { className: "glid-row" },
    invert,
    "Swap foreground and background"
  );
  const pickColor = make("button", { "data-tool": "color" }, "Pick the background's colour");
  const brush = (name, label) => make("button", { className: `glid-brush glid-${name}`, "data-tool": name }, label);
  const scribbles = row2(
    brush("foreground", "Shape"),
    brush("background", "Background"),
    make("button", { onclick: () => act("clear_scribbles") }, "Clear")
  );
  const component = make("select", {
    "aria-label": "Component",
    onchange: () => choose({ component: Number(component.value), component_at: null })
  });
  const components = row2(
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
  const holes = make("div", { className: "glid-holes" });
  const holesTitle = make("h4");
  const notes = make("ul");
  const summary = make("summary", {}, "Notes");
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
    const { method } = options;
    const used = method === "auto" ? automatic?.method : method;
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
    const rows = listed.map(holeRow);
    const left = count - listed.length;
    if (left) rows.push(make("div", { className: "glid-unit" }, `and ${left} smaller ones`));
    const focused = holes.getRootNode().activeElement;
    const at = [...holes.children].findIndex((one) => one.contains(focused));
    holes.replaceChildren(...rows);
    rows[at]?.querySelector("input")?.focus();
  }
  return { element, update };
}

// pad/view.js
var WHEEL_SPEED = 15e-4;
var WHEEL_LINE = 33;
var LINES = 1;
var PINCH = 5;
function distance([x, y], [u, v]) {
  return Math.hypot(x - u, y - v);
}
var View = class {
  x = 0;
  // the centre, world units
  y = 0;
  unit = 1;
  // world units per CSS pixel
  width = 0;
  // CSS pixels
  height = 0;
  /**
   * @param {() => void} changed called after every change by a hand
   * @param {object} options
   * @param {1 | -1} [options.up] 1 if the world's y points up, -1 if down
   * @param {number} options.nearest the least unit
   * @param {number} options.farthest the greatest unit
   */
  constructor(changed, { up = 1, nearest: nearest2, farthest }) {
    this.changed = changed;
    this.up = up;
    this.nearest = nearest2;
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
    const py = this.up * (this.y - y) / this.unit + this.height / 2;
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
    const step = e.deltaMode === LINES ? e.deltaY * WHEEL_LINE : e.deltaY;
    this.zoom(Math.exp(step * WHEEL_SPEED * (e.ctrlKey ? PINCH : 1)), place);
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
    const share = other ? 0.5 : 1;
    pointers.set(id, place);
    this.pan(share * (place[0] - before[0]), share * (place[1] - before[1]));
    if (!other) return;
    const apart = (one) => Math.max(distance(one, other), 1);
    const middle = (
      /** @type {Point} */
      [(place[0] + other[0]) / 2, (place[1] + other[1]) / 2]
    );
    this.zoom(apart(before) / apart(place), middle);
  }
};

// pad/hit.js
function nearest(things, reach) {
  let best = null;
  let least = Infinity;
  for (const thing of things) {
    const far = thing.d + (thing.loss ?? 0);
    if (thing.d > reach || far >= least) continue;
    best = thing;
    least = far;
  }
  return best;
}
function nearestVertex(loops, point, reach) {
  const vertices = loops.flatMap(
    (loop, i) => loop.map((vertex, j) => ({ loop: i, index: j, d: distance(vertex, point) }))
  );
  return nearest(vertices, reach);
}
function nearestEdge(loops, point, reach) {
  const edges = loops.flatMap(
    (loop) => loop.map((start, j) => {
      const foot = footOn(start, loop[(j + 1) % loop.length], point);
      return { foot, d: distance(foot, point) };
    })
  );
  return nearest(edges, reach);
}
function footOn(start, end, point) {
  const along = [end[0] - start[0], end[1] - start[1]];
  const dot = (point[0] - start[0]) * along[0] + (point[1] - start[1]) * along[1];
  const share = Math.min(Math.max(dot / (distance(start, end) ** 2 || 1e-30), 0), 1);
  return [start[0] + share * along[0], start[1] + share * along[1]];
}
function holeAt(holes, point) {
  let found = -1;
  holes.forEach((hole, i) => {
    if ((found < 0 || hole.area < holes[found].area) && encloses(hole.loop, point)) found = i;
  });
  return found;
}
function encloses(loop, [x, y]) {
  let winding = 0;
  loop.forEach(([x0, y0], i) => {
    const [x1, y1] = loop[(i + 1) % loop.length];
    const left = (x1 - x0) * (y - y0) - (x - x0) * (y1 - y0);
    if (y0 <= y && y1 > y && left > 0) winding += 1;
    if (y0 > y && y1 <= y && left < 0) winding -= 1;
  });
  return winding !== 0;
}

// pad/pen.js
function painter(canvas, view, signal, draw) {
  let due = 0;
  signal.addEventListener("abort", () => cancelAnimationFrame(due));
  return () => {
    if (due) return;
    due = requestAnimationFrame(() => {
      due = 0;
      draw(clearedPen(canvas, view));
    });
  };
}
function clearedPen(canvas, { width, height }) {
  const ratio = window.devicePixelRatio || 1;
  const wide = Math.round(width * ratio);
  const high = Math.round(height * ratio);
  if (canvas.width !== wide || canvas.height !== high) {
    canvas.width = wide;
    canvas.height = high;
  }
  const pen = penOf(canvas);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return pen;
}
function circle(pen, [x, y], radius, strokes, dash) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
  strokePath(pen, strokes, dash);
}
function disk(pen, place, radius, fill, stroke, width = 1) {
  circle(pen, place, radius, []);
  pen.fillStyle = fill;
  pen.fill();
  if (stroke) strokePath(pen, [[width, stroke]]);
}
function tracePath(pen, lines, closed = true) {
  pen.beginPath();
  for (const line of lines) {
    line.forEach(([x, y], i) => {
      if (i) pen.lineTo(x, y);
      else pen.moveTo(x, y);
    });
    if (closed) pen.closePath();
  }
}
function rectangle([left, top], [right, bottom]) {
  return [
    [left, top],
    [right, top],
    [right, bottom],
    [left, bottom]
  ];
}
function fillPath(pen, lines, style, rule = "evenodd") {
  tracePath(pen, lines);
  pen.fillStyle = style;
  pen.fill(rule);
}
function strokePath(pen, strokes, dash = []) {
  pen.setLineDash(dash);
  for (const [width, style] of strokes) {
    pen.lineWidth = width;
    pen.strokeStyle = style;
    pen.stroke();
  }
  pen.setLineDash([]);
}

// pad/pad.js
var CLICK = 4;
var LONG_PRESS = 600;
var LONG_PRESS_GRACE = 100;
var LONG_PRESS_SLACK = 8;
var PATH_STEP = 3;
var Pad = class {
  /** @type {Map<number, Point>} last places of pressed pointers */
  pointers = /* @__PURE__ */ new Map();
  /** @type {"hand" | "pan" | null} what pressed pointers do */
  mode = null;
  /** @type {{ from: Point, points: Map<Mark, Point> } | null} where a drag began, what it moves */
  grip = null;
  /** @type {Map<Mark, Point>} places of dragged marks */
  held = /* @__PURE__ */ new Map();
  /** @type {Point[]} of the left button, world points */
  path = [];
  /** @type {"box" | "lasso" | null | undefined} what the path draws around things */
  encloses = null;
  /** @type {Found | null} what is below a pointer that hovers */
  found = null;
  /** @type {Point | null} where it hovers */
  rests = null;
  /** @type {Point} where the present gesture began */
  #start = [0, 0];
  #pans = false;
  // moving farther moves the view
  #space = false;
  // the space bar is pressed
  #tap = false;
  // and nothing was dragged since
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #longPress;
  /**
   * @param {HTMLElement} element
   * @param {View} view
   * @param {Link} link
   * @param {Behaviour} behaviour
   */
  constructor(element, view, link, behaviour) {
    this.element = element;
    this.view = view;
    this.link = link;
    this.behaviour = behaviour;
    element.tabIndex = 0;
    link.signal.addEventListener("abort", () => clearTimeout(this.#longPress));
    element.addEventListener("pointerdown", (e) => this.#down(e));
    element.addEventListener("pointermove", (e) => this.#move(e));
    element.addEventListener("pointerup", (e) => this.#up(e, "up"));
    element.addEventListener("pointercancel", (e) => this.#up(e, "cancel"));
    element.addEventListener("lostpointercapture", (e) => this.#up(e, "cancel"));
    element.addEventListener("pointerleave", () => this.hover(null));
    element.addEventListener("wheel", (e) => this.#wheel(e), { passive: false });
    element.addEventListener("contextmenu", (e) => this.#contextMenu(e));
    element.addEventListener("keydown", (e) => this.keydown(e));
    element.addEventListener("keyup", (e) => this.#keyup(e));
    element.addEventListener("focus", () => behaviour.changed());
    element.addEventListener("blur", () => {
      this.#setSpace(false);
      behaviour.changed();
    });
  }
  get focused() {
    return this.element.matches(":focus");
  }
  /**
   * Where a pointer is, in CSS pixels of the element.
   *
   * @param {MouseEvent} e
   * @returns {Point}
   */
  place(e) {
    const box = this.element.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }
  /**
   * Sends the kernel an event at a place on the screen.
   *
   * @param {string} type
   * @param {Point} place
   * @param {Pressed} e
   * @param {Record<string, unknown>} more
   */
  send(type, place, e = {}, more = {}) {
    const [x, y] = this.view.toWorld(place);
    const { unit } = this.view;
    return this.link.put({
      type,
      x,
      y,
      unit,
      reach: this.#reach(e.pointerType) * unit,
      button: e.button ?? 0,
      shift: Boolean(e.shiftKey),
      time: e.timeStamp ?? performance.now(),
      ...more
    });
  }
  /**
   * Has the kernel do what a key does.
   *
   * @param {string} key
   * @param {Pressed} [e]
   */
  press(key, e) {
    this.send("key", [this.view.width / 2, this.view.height / 2], e, { key });
  }
  /**
   * Updates what is below the pointer.
   *
   * @param {Point | null} place
   */
  hover(place = this.rests) {
    this.rests = place;
    if (this.mode !== null) return;
    this.found = place && this.#find(place, "mouse");
    this.#showCursor();
    this.behaviour.changed();
  }
  /** @param {KeyboardEvent} e */
  keydown(e) {
    const command = e.ctrlKey || e.metaKey;
    const action = command ? void 0 : this.behaviour.actions[e.key.toLowerCase()];
    const history = undoOrRedo(e);
    if (!history && !action && e.key !== " ") {
      if (e.altKey || !this.behaviour.keys.test(e.key) || command && e.key !== "a") return;
    }
    e.preventDefault();
    e.stopPropagation();
    if (e.key === " ") {
      if (!e.repeat) this.#tap = true;
      this.#setSpace(true);
    } else if (action) {
      action();
    } else {
      if (e.key === "Escape" || history) this.#drop();
      this.press(history ?? e.key, e);
    }
  }
  /** @param {KeyboardEvent} e */
  #keyup(e) {
    if (e.key !== " ") return;
    this.#setSpace(false);
    if (this.#tap) this.behaviour.tapped?.();
  }
  /** @param {string} [type] of the pointer */
  #reach(type) {
    return this.behaviour.reach[type ?? "mouse"] ?? this.behaviour.reach.mouse;
  }
  /**
   * @param {Point} place
   * @param {string} type of the pointer
   */
  #find(place, type) {
    return this.behaviour.find(this.view.toWorld(place), this.#reach(type) * this.view.unit);
  }
  /** @param {PointerEvent} e */
  #down(e) {
    if (this.pointers.has(e.pointerId) || this.pointers.size > 1) return;
    e.preventDefault();
    this.element.focus({ preventScroll: true });
    this.#tap = false;
    const place = this.place(e);
    this.pointers.set(e.pointerId, place);
    this.element.setPointerCapture(e.pointerId);
    const second = this.pointers.size === 2;
    if (second) this.#takeBack(e);
    this.#start = place;
    this.mode = second || e.button === 1 || e.button === 0 && this.#space ? "pan" : "hand";
    if (this.mode === "hand") this.#handDown(place, e);
    this.#showCursor();
  }
  /**
   * @param {Point} place
   * @param {PointerEvent} e
   */
  #handDown(place, e) {
    const { behaviour } = this;
    const found = this.#find(place, e.pointerType);
    const left = e.button === 0;
    if (left && !e.shiftKey && found?.mark !== void 0) {
      this.grip = { from: this.view.toWorld(place), points: behaviour.held(found) };
    }
    this.#pans = left && Boolean(behaviour.pans?.(found));
    this.encloses = left && !behaviour.painting ? behaviour.encloses?.(found, e) : null;
    this.path = left ? [this.view.toWorld(place)] : [];
    this.send("down", place, e, { part: found?.part });
    if (e.pointerType === "touch" && behaviour.menu && !behaviour.painting) {
      this.#longPress = setTimeout(() => this.#pressedLong(e, place), LONG_PRESS);
    }
    behaviour.changed();
  }
  /**
   * @param {PointerEvent} e
   * @param {Point} place
   */
  #pressedLong(e, place) {
    this.#longPress = setTimeout(() => {
      this.#takeBack(e);
      this.mode = null;
      this.#menu(place, "touch");
    }, LONG_PRESS_GRACE);
  }
  /**
   * @param {Point} place
   * @param {string} type of the pointer
   */
  #menu(place, type) {
    this.behaviour.menu?.(place, this.#find(place, type));
  }
  /** @param {MouseEvent} e */
  #contextMenu(e) {
    e.preventDefault();
    e.stopPropagation();
    const touch = e instanceof PointerEvent && e.pointerType === "touch";
    if (e.button === 2 && !touch) this.#menu(this.place(e), "mouse");
  }
  /**
   * Cancels the gesture that the kernel knows of.
   *
   * @param {PointerEvent} e
   */
  #takeBack(e) {
    if (this.mode === "hand") this.send("cancel", this.#start, e);
    this.#drop();
  }
  /** @param {PointerEvent} e */
  #move(e) {
    const place = this.place(e);
    const touch = e.pointerType === "touch";
    if (!this.pointers.has(e.pointerId)) {
      if (!touch) this.hover(place);
      return;
    }
    if (!touch) this.rests = place;
    const far = distance(place, this.#start);
    if (far > LONG_PRESS_SLACK) clearTimeout(this.#longPress);
    if (this.mode === "hand" && this.#pans && far > CLICK) {
      this.#takeBack(e);
      this.mode = "pan";
      this.#showCursor();
    }
    if (this.mode === "pan") {
      this.view.follow(this.pointers, e.pointerId, place);
      return;
    }
    this.pointers.set(e.pointerId, place);
    if (this.mode === "hand") this.#handMoved(place, e, far);
  }
  /**
   * @param {Point} place
   * @param {PointerEvent} e
   * @param {number} far from where it was pressed, CSS pixels
   */
  #handMoved(place, e, far) {
    const point = this.view.toWorld(place);
    this.#lengthenPath(place, point, far);
    if (!this.encloses && !this.behaviour.painting) {
      this.send("move", place, e, { replaces: `move ${e.pointerId}` });
    }
    if (this.grip) {
      const dx = point[0] - this.grip.from[0];
      const dy = point[1] - this.grip.from[1];
      for (const [mark, [x, y]] of this.grip.points) this.held.set(mark, [x + dx, y + dy]);
    }
    this.behaviour.changed();
  }
  /**
   * @param {Point} place
   * @param {Point} point the same in the world
   * @param {number} far
   */
  #lengthenPath(place, point, far) {
    if (this.encloses === "box") {
      const [corner] = this.path;
      this.path = far > CLICK ? rectangle(corner, point) : [corner];
      return;
    }
    const last = this.path.at(-1);
    if (last && distance(place, this.view.toScreen(last)) >= PATH_STEP) this.path.push(point);
  }
  /**
   * @param {PointerEvent} e
   * @param {"up" | "cancel"} type
   */
  #up(e, type) {
    if (!this.pointers.has(e.pointerId)) return;
    const place = this.place(e);
    this.pointers.delete(e.pointerId);
    if (this.mode === "hand") {
      const { path } = this;
      this.send(type, place, e, { path, encloses: Boolean(this.encloses) }).then(() => {
        if (!this.grip) this.held.clear();
        if (this.path === path) this.path = [];
        this.behaviour.changed();
      });
    }
    this.#letGo();
    if (!this.pointers.size) this.mode = null;
    this.#showCursor();
  }
  #letGo() {
    clearTimeout(this.#longPress);
    this.grip = null;
    this.behaviour.changed();
  }
  // Lets go of what is held and forgets where it was moved.
  #drop() {
    this.#letGo();
    this.held.clear();
    this.path = [];
  }
  /** @param {WheelEvent} e */
  #wheel(e) {
    if (this.behaviour.wheelNeedsFocus && !this.focused && !e.ctrlKey) return;
    e.stopPropagation();
    this.view.wheel(e, this.place(e));
  }
  /** @param {boolean} pressed */
  #setSpace(pressed) {
    this.#space = pressed;
    this.#showCursor();
  }
  #showCursor() {
    this.element.style.cursor = this.#cursor();
  }
  #cursor() {
    if (this.mode === "pan" || this.grip) return "grabbing";
    return this.#space ? "grab" : this.behaviour.cursor(this.found);
  }
};

// tracer/draw.js
var HALO = "rgba(255, 255, 255, 0.9)";
var SPECK = 12;
var CHECK = 8;
function drawStage(ctx, stage, hover) {
  const { view, colors, shown, bitmap, painting } = stage;
  const corner = view.toScreen([0, 0]);
  const extent = shown.size.map((n) => n / view.unit);
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
    if (problem.point)
      circle(ctx, view.toScreen(problem.point), 13, [
        [5, HALO],
        [2.25, colors.warn]
      ]);
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
      strokePath(ctx, [
        [8, HALO],
        [5, color]
      ]);
    }
  }
}
function drawOutline(ctx, stage) {
  const { view, shown } = stage;
  const color = stage.colors.foreground;
  tracePath(ctx, [view.line(stage.drawn())], false);
  strokePath(ctx, [
    [4.5, HALO],
    [2, color]
  ]);
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
      const seen = strong.has(`${i}:${j}`);
      const r = seen ? radius + 1.75 : radius;
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
  tracePath(
    ctx,
    [
      [
        [x - 3.5, y],
        [x + 3.5, y]
      ],
      [
        [x, y - 3.5],
        [x, y + 3.5]
      ]
    ],
    false
  );
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
    this.canvas = make("canvas", {
      className: "glid-canvas",
      role: "application",
      "aria-label": "Picture and cage"
    });
    this.callout = make("div", { className: "glid-callout", role: "alert", hidden: true });
    this.hintText = make("div", { className: "glid-hint" });
    this.drop = make("div", { className: "glid-drop", hidden: true }, "Drop a picture here");
    this.empty = make(
      "div",
      { className: "glid-empty" },
      make("p", {}, "Drop a picture here, or open one from a file.")
    );
    this.element = make(
      "div",
      { className: "glid-stage" },
      this.canvas,
      this.empty,
      this.callout,
      this.hintText,
      this.drop
    );
    this.shown = this.bitmap = null;
    this.tool = "edit";
    this.listed = null;
    this.fitted = true;
    this.view = new View(
      () => {
        this.fitted = false;
        this.changed();
      },
      { up: -1, nearest: 1 / MOST_ZOOM, farthest: 1e3 }
    );
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
    const room = [element.clientWidth - 2 * MARGIN, element.clientHeight - MARGIN - below].map(
      (n) => Math.max(n, 1)
    );
    const unit = Math.min(Math.max(w / room[0], h / room[1]), 1e3);
    Object.assign(view, {
      x: w / 2,
      y: h / 2 + unit * (below - MARGIN) / 2,
      unit,
      farthest: 4 * unit
    });
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
    const { holes, reach_shares: shares } = this.shown;
    const hole = holeAt(holes, point);
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
    const probe = this.root.appendChild(make("span"));
    const color = (name) => {
      probe.style.color = `var(--glid-${name})`;
      return getComputedStyle(probe).color;
    };
    const colors = Object.fromEntries(COLORS.map((name) => [name, color(name)]));
    probe.remove();
    return colors;
  }
  // The first problem's message, beside its place.
  placeCallout() {
    const problem = this.shown.problems[0];
    this.callout.hidden = !problem || this.pad.mode === "pan";
    if (!problem) return;
    this.callout.textContent = problem.message;
    const { width, height } = this.view;
    const { offsetWidth: w, offsetHeight: h } = this.callout;
    const [x, y] = problem.point ? this.view.toScreen(problem.point) : [width / 2, -16];
    const below = problem.point && y + 24 + h > height ? y - 24 - h : y + 24;
    const left = Math.min(Math.max(x - w / 2, 8), width - w - 8);
    const top = Math.min(Math.max(below, 8), height - h - 8);
    this.callout.style.transform = `translate(${left}px, ${top}px)`;
  }
};

// tracer/main.js
var HELP = [
  [
    "Outline",
    [
      [
        "V",
        "edit: drag a vertex, double-click an edge to add one, click a hole to drop or keep it"
      ],
      ["Right-click, Delete", "remove a vertex"],
      ["[ ]", "select the vertex before, the next vertex"],
      ["Arrow keys", "nudge the selected vertex, with Shift farther"],
      ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"]
    ]
  ],
  [
    "By hand",
    [
      ["B, N", "paint over the shape, over the background"],
      ["I, C", "pick the background's colour, the component"],
      ["P, R", "draw the outline, a rectangle; Enter closes an outline, Esc gives it up"]
    ]
  ],
  [
    "View",
    [
      ["Wheel, + -, F", "zoom after a click on the picture, fit the picture"],
      ["Drag beside the outline", "move the view"]
    ]
  ]
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
    let start = 0;
    let refused = null;
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
  const input = make("input", {
    type: "file",
    accept: "image/*",
    hidden: true,
    onchange: () => input.files[0] && upload(input.files[0])
  });
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
  root.append(
    toolbar,
    make("div", { className: "glid-body" }, stage.element, panel.element),
    status
  );
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
    const n = loops.flat().length;
    const count = model.get("shown").n_components;
    const holes = Math.max(loops.length - 1, 0);
    let kind = "ok";
    let text = `Cage with ${n} vertices and ${holes || "no"} ${holes === 1 ? "hole" : "holes"}`;
    if (link.refusal) [kind, text] = ["bad", link.refusal];
    else if (link.busy) [kind, text] = ["busy", "Working…"];
    else if (!size) [kind, text] = ["idle", "No picture yet"];
    else if (problems.length) {
      [kind, text] = [
        "bad",
        loops.length ? "This is not a valid cage; the last valid cage is kept" : "There is no cage yet"
      ];
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
