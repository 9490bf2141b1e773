// motion/motion.js
var Motion = class {
  /**
   * @param {{ times: number[], repeat: Repeat }} values the knots' times, of a ping-pong's way there
   * @param {Float32Array} floats the arrays of all knots, one after the other
   */
  constructor({ times, repeat }, floats) {
    this.times = times;
    this.repeat = repeat;
    this.floats = floats;
    this.mixed = new Float32Array(floats.length / times.length);
    this.start = times[0];
    this.last = times[times.length - 1];
    this.end = repeat === "ping-pong" ? 2 * this.last - this.start : this.last;
  }
  /**
   * The time from start to end that shows what any time shows: loops and ping-pongs go on for ever.
   *
   * @param {number} time
   */
  within(time) {
    const { start, end } = this;
    if (this.repeat === "once") return Math.min(Math.max(time, start), end);
    const span = end - start;
    return start + ((time - start) % span + span) % span;
  }
  /**
   * The piece between two knots at a time, and the share of it that has passed.
   *
   * @param {number} time
   */
  place(time) {
    const { times, last } = this;
    const within = this.within(time);
    const there = within > last ? 2 * last - within : within;
    const next = times.findIndex((knot, i) => i > 0 && there < knot);
    const high = next < 0 ? times.length - 1 : next;
    const low = high - 1;
    return { piece: low, share: (there - times[low]) / (times[high] - times[low]) };
  }
  /**
   * The array at a time. Every call returns the same one, with other numbers.
   *
   * @param {number} time
   */
  at(time) {
    const { piece, share } = this.place(time);
    const { floats, mixed } = this;
    const low = piece * mixed.length;
    const high = low + mixed.length;
    for (let i = 0; i < mixed.length; i++) {
      mixed[i] = (1 - share) * floats[low + i] + share * floats[high + i];
    }
    return mixed;
  }
};

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
function undoOrRedo(e) {
  if (!e.ctrlKey && !e.metaKey) return null;
  const key = e.key.toLowerCase();
  if (key === "z") return e.shiftKey ? "redo" : "undo";
  return key === "y" ? "redo" : null;
}

// timeline/player.js
var Player = class {
  // show(floats, time): draws coefficients, or, where floats is null, has the kernel draw the time and
  // resolves when it has; show(null): the pose that is edited. moved(): the playhead is elsewhere.
  constructor(show, moved) {
    Object.assign(this, { show, moved, spans: [], clock: null, time: 0, seen: false, frame: 0 });
  }
  // spans: start, end, times and floats of the knots as far as they are proved.
  set(spans, repeat) {
    this.spans = spans.map((span) => ({
      ...span,
      motion: span.floats.length ? new Motion({ times: span.times, repeat: "once" }, span.floats) : null
    }));
    const ends = spans.length ? [spans[0].start, spans.at(-1).end] : null;
    this.clock = ends && new Motion({ times: ends, repeat }, new Float32Array(0));
    if (this.seen && !this.frame) this.seek(this.time);
  }
  get playing() {
    return this.frame !== 0;
  }
  // Where the playhead is, from the first keyframe to the last: a ping-pong runs back.
  get place() {
    const last = this.clock?.times[1];
    return this.time > last ? 2 * last - this.time : this.time;
  }
  seek(time) {
    if (!this.clock) return this.release(0);
    this.time = time === this.clock.end ? time : this.clock.within(time);
    this.seen = true;
    const { place } = this;
    const span = this.spans.find(({ end }) => place <= end) ?? this.spans.at(-1);
    const shown = this.show(span.motion?.at(place) ?? null, place);
    this.moved();
    return shown;
  }
  // Goes to a time from the first keyframe to the last, and stays there.
  scrub(time) {
    this.pause();
    if (this.clock) this.seek(Math.min(Math.max(time, this.clock.start), this.clock.times[1]));
  }
  play() {
    if (this.playing || !this.clock) return this.pause();
    const { start, end, repeat } = this.clock;
    if (repeat === "once" && this.time >= end) this.time = start;
    let last = null;
    const step = async (now) => {
      const time = this.time + (last === null ? 0 : (now - last) / 1e3);
      last = now;
      await this.seek(time);
      if (!this.playing) return;
      if (repeat === "once" && time >= end) this.pause();
      else this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
    this.moved();
  }
  pause() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.moved();
  }
  // Back to the pose that is edited, which is at this time.
  release(time) {
    this.pause();
    this.time = time;
    if (this.seen) {
      this.seen = false;
      this.show(null);
    }
    this.moved();
  }
};

// timeline/main.js
var EASINGS = [
  ["linear", "Even"],
  ["in", "Ease in"],
  ["out", "Ease out"],
  ["in-out", "Ease in, out"]
];
var REPEATS = [
  ["once", "Once"],
  ["loop", "Loop"],
  ["ping-pong", "Ping-pong"]
];
var STEP = 1 / 30;
var NUDGE = 0.1;
var SNAP = 6;
var STILL = 4;
var SLIM = 8;
var LATER = 1.15;
var KERNEL = "Played by the kernel (too large for shaders). ";
var seconds = (time) => `${time.toFixed(2)} s`;
function menu(label, rows, act) {
  const look = { "aria-label": label, title: label, onchange: (e) => act(e.target.value) };
  return make("select", look, ...rows.map(([value, text]) => new Option(text, value)));
}
function render({ model, el, signal }) {
  const shown = () => model.get("shown");
  let stage = null;
  let hovered = "";
  let span = 1;
  let drag = null;
  let layers = null;
  const whole = { className: "glid-skin glid-timeline", role: "group", "aria-label": "Timeline" };
  const root = make("div", whole);
  const link = new Link(model, root, signal, () => tell());
  const act = (type, content = {}) => link.put({ type, ...content });
  const player = new Player(
    (floats, time) => {
      const shows = time === void 0 ? null : floats ?? true;
      stage?.trigger("glid:motion", shows, release, shows && (layers?.at(time) ?? null));
      if (shown().kernel && stage) return act("frame", { time: time ?? null, replaces: "frame" });
    },
    () => showHead()
  );
  const active = () => shown().keyframes[shown().active];
  const release = () => player.release(active().time);
  const atKey = (time) => shown().keyframes.findIndex((key) => Math.abs(key.time - time) < 1e-9);
  const select = (index) => {
    if (index === shown().active) release();
    else act("go_to_pose", { index });
  };
  const edit = (type, content = {}) => act(type, { index: shown().active, ...content });
  const play = iconButton("play", "Play, pause (Space)", () => player.play());
  const repeat = menu(
    "Play once, in a loop, or there and back",
    REPEATS,
    (value) => act("set_repeat", { repeat: value })
  );
  const clock = make("span", { className: "glid-time", role: "timer" });
  const record = iconButton(
    "record",
    "Record: keep the next drag as keyframes",
    () => act("record", { on: !shown().recording })
  );
  const onion = iconButton(
    "onion",
    "Onion skin of the pose that is edited: outlines of those before (blue) and after (orange)",
    () => act("onion", { on: !shown().onion })
  );
  const keep = make("button", {
    className: "glid-keep",
    title: "Keep this pose and go on with a copy; between poses, keep what is seen",
    onclick: () => act("keep", { time: player.seen ? player.place : active().time })
  });
  const copy = iconButton("copy", "Duplicate this pose", () => edit("duplicate_pose"));
  const remove = iconButton("trash", "Delete this pose (Delete)", () => edit("delete_pose"));
  const name = make("input", {
    type: "text",
    "aria-label": "Name of the pose",
    title: "Name of the pose",
    maxLength: 200,
    onchange: () => edit("rename_pose", { name: name.value })
  });
  const easing = menu(
    "How the motion leaves this pose",
    EASINGS,
    (value) => edit("set_easing", { easing: value })
  );
  const save = iconButton("export", "Export the motion", () => act("export"));
  const gap = () => make("span", { className: "glid-gap" });
  const bar = make(
    "div",
    { className: "glid-bar", role: "toolbar", "aria-label": "Motion" },
    play,
    repeat,
    clock,
    gap(),
    record,
    onion,
    gap(),
    keep,
    copy,
    remove,
    name,
    easing,
    save
  );
  const ruler = make("div", {
    className: "glid-ruler",
    tabIndex: 0,
    role: "slider",
    "aria-label": "Time",
    "aria-valuemin": 0
  });
  const keys = make("div", { className: "glid-keys" });
  const strip = make("div", {
    className: "glid-strip",
    role: "img",
    onpointerleave: () => hover("")
  });
  const head = make("div", { className: "glid-playhead" });
  const track = make("div", { className: "glid-track" }, ruler, keys, strip, head);
  const note = make("div", {
    className: "glid-timeline-note",
    role: "status",
    "aria-live": "polite"
  });
  root.append(bar, track, note);
  root.dataset.lmSuppressShortcuts = "true";
  el.classList.add("glid-host");
  el.append(root);
  const wide = (time) => `${time / span} * (100% - 2 * var(--glid-inset))`;
  const at = (time) => `calc(var(--glid-inset) + ${wide(time)})`;
  const inside = () => {
    const { left, width } = track.getBoundingClientRect();
    const inset = parseFloat(getComputedStyle(root).getPropertyValue("--glid-inset"));
    return { left: left + inset, width: width - 2 * inset };
  };
  function tell() {
    const { keyframes, recording, kernel } = shown();
    const { spans } = model.get("motion");
    const bad = spans.find(({ reason }) => reason);
    const least = Math.min(...spans.flatMap(({ sigma2 }) => sigma2));
    let text = keyframes.length < 2 ? "Keep a second pose to see what lies between." : "";
    if (recording) text = "Recording: drag a pin; what it does becomes keyframes.";
    else if (bad) text = bad.reason;
    else if (spans.some(({ status }) => status === "computing"))
      text = "Proving what lies between…";
    else if (spans.length)
      text = `Proved at every instant of ${seconds(spans.at(-1).end - spans[0].start)}: σ₂ ≥ ${least.toFixed(3)}.`;
    if (kernel && spans.length && !bad) text = KERNEL + text;
    note.title = note.textContent = link.refusal || hovered || text;
    note.dataset.tone = link.refusal || bad && !hovered ? "bad" : "";
  }
  function hover(text) {
    hovered = text;
    tell();
  }
  function showHead() {
    if (!shown().keyframes) return;
    const { place, seen, playing } = player;
    const { keyframes } = shown();
    const end = model.get("motion").spans.at(-1)?.end ?? keyframes.at(-1).time;
    head.style.left = at(place);
    head.classList.toggle("glid-seen", seen);
    const does = playing ? "pause" : "play";
    if (play.dataset.does !== does) play.innerHTML = icon(does);
    play.dataset.does = does;
    clock.textContent = `${place.toFixed(2)} / ${seconds(end)}`;
    Object.assign(track.dataset, { time: place, span });
    ruler.setAttribute("aria-valuenow", place.toFixed(2));
    ruler.setAttribute("aria-valuetext", seconds(place));
    keep.textContent = seen && atKey(place) < 0 ? "Keep it" : "Keep";
  }
  function showKeys() {
    if (drag) return;
    const { keyframes, active: index, repeat: repeats, back } = shown();
    const thumbnails = model.get("thumbnails");
    const ends = repeats === "loop" && keyframes.length > 1 ? [
      {
        ...keyframes[0],
        time: keyframes.at(-1).time + back,
        name: `Back to ${keyframes[0].name}`
      }
    ] : [];
    const all = [...keyframes, ...ends];
    const room = (i) => Math.min(
      ...[i, i + 1].map((j) => all[j - 1] && all[j] ? all[j].time - all[j - 1].time : span)
    );
    span = Math.max(1, all.at(-1).time) * LATER;
    ruler.setAttribute("aria-valuemax", span.toFixed(2));
    const focused = [...keys.children].indexOf(keys.getRootNode().activeElement);
    keys.replaceChildren(
      ...all.map((key, i) => {
        const picture = thumbnails[key.thumbnail];
        const title = `${key.name} at ${seconds(key.time)}`;
        return make(
          "button",
          {
            className: i < keyframes.length ? "glid-key" : "glid-key glid-return",
            title: `${title}; drag it to another time`,
            "aria-label": title,
            "aria-pressed": i === index,
            style: `left: ${at(key.time)}; width: clamp(${SLIM}px, ${wide(room(i))} - 2px, 60px)`,
            onpointerdown: (e) => grab(e, i),
            onclick: (e) => e.detail || select(i % keyframes.length)
          },
          ...picture ? [make("img", { src: picture, alt: "", draggable: false })] : []
        );
      })
    );
    keys.children[focused]?.focus();
  }
  function showSpans() {
    const { spans } = model.get("motion");
    const part = (start, end, kind, text, height = 1) => make("div", {
      className: `glid-piece glid-${kind}`,
      title: text,
      onpointerenter: () => hover(text),
      style: `left: ${at(start)}; width: calc(${wide(end - start)}); --glid-height: ${height}`
    });
    strip.replaceChildren(
      ...spans.flatMap(({ start, end, status, reason, times, sigma2 }) => {
        const proved = sigma2.map(
          (value, i) => part(
            times[i],
            times[i + 1],
            "proved",
            `σ₂ ≥ ${value.toFixed(3)} from ${seconds(times[i])} to ${seconds(times[i + 1])}`,
            Math.min(Math.max(value, 0.06), 1)
          )
        );
        const from = status === "fails" ? times.at(-1) : start;
        const rest = status === "proved" ? [] : [
          part(
            from,
            end,
            status,
            reason || `Not proved yet from ${seconds(start)} to ${seconds(end)}`
          )
        ];
        return [...proved, ...rest];
      })
    );
    const every = [0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60, 300, 600].find((step2) => span / step2 <= 12) ?? 1800;
    ruler.replaceChildren(
      ...Array.from(
        { length: Math.floor(span / every) + 1 },
        (_, i) => make("span", { style: `left: ${at(i * every)}` }, `${Number((i * every).toFixed(1))}`)
      )
    );
    strip.setAttribute("aria-label", note.textContent);
  }
  function showState() {
    const {
      keyframes,
      active: index,
      repeat: repeats,
      recording,
      onion: on,
      exports: exported
    } = shown();
    const moved = root.dataset.active !== `${index}/${keyframes.length}`;
    root.dataset.active = `${index}/${keyframes.length}`;
    repeat.value = repeats;
    easing.value = active().easing;
    if (document.activeElement !== name || moved) name.value = active().name;
    remove.disabled = keyframes.length === 1;
    play.disabled = save.disabled = repeat.disabled = easing.disabled = keyframes.length < 2;
    save.hidden = !exported;
    record.ariaPressed = recording;
    onion.ariaPressed = on;
    showKeys();
    showMotion();
    if (moved || !player.seen) release();
  }
  function showMotion() {
    const { spans } = model.get("motion");
    player.set(
      spans.map((one) => ({ ...one, floats: toFloats(one.floats) })),
      shown().repeat
    );
    if (shown().kernel && !player.playing && player.seen && spans.some(({ status }) => status === "computing"))
      release();
    tell();
    showSpans();
    showHead();
  }
  function showHeights() {
    const { times, floats } = model.get("heights");
    layers = times.length ? new Motion({ times, repeat: "once" }, toFloats(floats)) : null;
  }
  function landing(index, time) {
    const { keyframes } = shown();
    const others = keyframes.filter((_, i) => i !== index).map((key) => key.time);
    const gap2 = Math.ceil(100 * (SLIM / inside().width) * span) / 100;
    const least = index < keyframes.length ? 0 : others.at(-1) + gap2;
    const free = (t) => t >= least && others.every((other) => Math.abs(t - other) > gap2 - 6e-3);
    const places = [
      Math.max(time, least),
      ...others.flatMap((other) => [other - gap2, other + gap2])
    ].map((t) => Math.round(100 * t) / 100);
    return places.filter(free).sort((a, b) => Math.abs(a - time) - Math.abs(b - time))[0];
  }
  function grab(e, index) {
    if (e.button !== 0) return;
    e.stopPropagation();
    const button = e.currentTarget;
    const { keyframes, back } = shown();
    const count = keyframes.length;
    const from = index < count ? keyframes[index].time : keyframes.at(-1).time + back;
    drag = { x: e.clientX, moved: false };
    button.setPointerCapture(e.pointerId);
    button.focus({ preventScroll: true });
    button.onpointermove = (move) => {
      drag.moved ||= Math.abs(move.clientX - drag.x) > STILL;
      if (!drag.moved) return;
      drag.time = landing(index, from + (move.clientX - drag.x) / inside().width * span);
      button.style.left = head.style.left = at(drag.time);
      hover(`to ${seconds(drag.time)}`);
    };
    button.onlostpointercapture = () => {
      if (!drag) return;
      const { moved, time } = drag;
      drop();
      if (moved) ruler.focus({ preventScroll: true });
      if (moved) act("move_pose", { index, time });
      else if (index < count) select(index);
    };
  }
  function drop() {
    drag = null;
    hover("");
    showKeys();
    showHead();
  }
  function scrub(e) {
    if (drag?.scrubs !== e.pointerId) return;
    const { left, width } = inside();
    const time = (e.clientX - left) / width * span;
    const near = SNAP / width * span;
    const key = shown().keyframes.find((one) => Math.abs(one.time - time) < near);
    player.scrub(key?.time ?? time);
  }
  track.addEventListener("pointerdown", (e) => {
    if (e.button !== 0 || !player.clock) return;
    drag = { scrubs: e.pointerId };
    track.setPointerCapture(e.pointerId);
    scrub(e);
  });
  track.addEventListener("pointermove", scrub);
  track.addEventListener("lostpointercapture", (e) => {
    if (drag?.scrubs !== e.pointerId) return;
    drop();
    if (atKey(player.place) >= 0) select(atKey(player.place));
  });
  function step(e) {
    const sign = e.key === "ArrowLeft" ? -1 : 1;
    const { keyframes, active: index } = shown();
    if (e.altKey) return edit("move_pose", { time: landing(index, active().time + sign * NUDGE) });
    if (!e.shiftKey) return player.scrub(player.place + sign * STEP);
    const time = player.place;
    const order = keyframes.map((key, i) => [key.time, i]).filter(([t]) => sign * (t - time) > 1e-9);
    select((sign > 0 ? order[0] : order.at(-1))?.[1] ?? index);
  }
  const KEYS = {
    " ": () => player.play(),
    ArrowLeft: step,
    ArrowRight: step,
    Delete: () => edit("delete_pose"),
    Backspace: () => edit("delete_pose"),
    Home: () => select(0),
    End: () => select(shown().keyframes.length - 1),
    Escape: () => {
      drop();
      release();
    }
  };
  root.addEventListener("keydown", (e) => {
    const typing = bar.contains(e.target);
    if (undoOrRedo(e) && e.target !== name) act(undoOrRedo(e));
    else if (e.ctrlKey || e.metaKey) return;
    else if (!typing && KEYS[e.key]) e.repeat && e.key === " " || KEYS[e.key](e);
    else return e.stopPropagation();
    e.preventDefault();
    e.stopPropagation();
  });
  root.addEventListener(
    "keyup",
    (e) => e.key === " " && !bar.contains(e.target) && e.preventDefault()
  );
  bar.addEventListener(
    "click",
    (e) => e.detail && e.target.closest("button") && ruler.focus({ preventScroll: true })
  );
  const tapped = (e) => {
    if (e.target.closest(".glid-editor") === el.closest(".glid-editor")) player.play();
  };
  window.addEventListener("glid:play", tapped, { signal });
  const edited = () => player.seen && release();
  follow(model, {
    "change:shown": showState,
    "change:motion": showMotion,
    "change:heights": showHeights,
    "change:thumbnails": showKeys
  });
  model.widget_manager.get_model(model.get("stage")).then((found) => {
    if (signal.aborted) return;
    stage = found;
    stage.on("change:coefficients", edited);
  });
  return () => {
    player.pause();
    stage?.off("change:coefficients", edited);
  };
}
var main_default = { render };
export {
  main_default as default
};
