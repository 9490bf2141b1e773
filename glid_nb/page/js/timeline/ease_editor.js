// The panel in which the easing of a segment is changed: presets, and a curve with two handles.

import { make } from "../pad/dom.js";
import { placeIn } from "../pad/place.js";
import { handlesOf, nameOf, PRESETS, pathOf, withHandle } from "./ease.js";

/** @import { Point } from "../types.js" */
/** @import { Easing, Handles } from "./ease.js" */

/** @typedef {0 | 1} Which */

const SIZE = 140; // CSS pixels of the square
const MARGIN = 14; // around it, for handles at its sides
const GAP = 6; // to the timeline, or to what the panel belongs to
const STEP = 0.02; // of an arrow key
const LONG_STEP = 0.1; // with Shift

/** @type {[label: string, title: string][]} */
const NUMBERS = [
  ["x1", "How it leaves: share of the time"],
  ["y1", "How it leaves: share of the way"],
  ["x2", "How it arrives: share of the time"],
  ["y2", "How it arrives: share of the way"],
];

/** @type {Record<string, Point>} */
const ARROWS = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowDown: [0, -1],
  ArrowUp: [0, 1],
};

export class EaseEditor {
  index = -1; // of the segment that is shown; -1 while the panel is closed

  /** @type {Easing} */
  #easing = "linear";
  /** @type {Which | null} the handle that is held, by a pointer or a key */
  #held = null;

  /**
   * @param {(index: number, easing: Easing) => void} set
   * @param {(index: number) => void} closed
   */
  constructor(set, closed) {
    this.set = set;
    this.closed = closed;
    this.title = make("h4", {});
    this.curve = make("div", { className: "glid-ease-curve" });
    this.drawing = make("div", { className: "glid-ease-drawing" });
    this.handles = [this.#handle(0), this.#handle(1)];
    this.numbers = NUMBERS.map(([label, title], i) => this.#number(label, title, i));
    this.presets = PRESETS.map(([easing, label]) =>
      make(
        "button",
        { title: label, onclick: () => this.#choose(easing), innerHTML: curveIcon(easing) },
        make("span", {}, label),
      ),
    );
    this.curve.append(this.drawing, ...this.handles);
    this.element = make(
      "div",
      {
        className: "glid-ease",
        role: "dialog",
        popover: "auto",
        "aria-label": "Easing",
      },
      this.title,
      this.curve,
      make("div", { className: "glid-ease-numbers" }, ...this.numbers.map((one) => one.field)),
      make("div", { className: "glid-ease-presets", role: "group" }, ...this.presets),
    );
    this.element.addEventListener("keydown", (e) => this.#keydown(e));
    this.element.addEventListener("keyup", (e) => e.stopPropagation()); // Space presses buttons
    this.element.addEventListener("pointerdown", (e) => e.stopPropagation());
    this.element.addEventListener("toggle", (e) => this.#toggled(/** @type {ToggleEvent} */ (e)));
  }

  /**
   * @param {number} index of the segment
   * @param {string} title
   * @param {Easing} easing
   * @param {HTMLElement} at what it belongs to: it opens above the timeline, if there is room
   */
  open(index, title, easing, at) {
    const { element } = this;
    this.element.hidePopover();
    this.index = index;
    this.show(title, easing);
    element.showPopover();
    const { left, width, top, bottom } = at.getBoundingClientRect();
    const room = element.getBoundingClientRect();
    const over = this.element.parentElement?.getBoundingClientRect().top ?? top;
    const places = [over, top].map((edge) => edge - room.height - GAP);
    const x = Math.min(left + (width - room.width) / 2, window.innerWidth - room.width - GAP);
    element.style.left = `${Math.max(x, GAP)}px`;
    element.style.top = `${places.find((one) => one >= 0) ?? bottom + GAP}px`;
    const pressed = this.presets.find((button) => button.ariaPressed === "true");
    (pressed ?? this.handles[0]).focus({ preventScroll: true });
  }

  /**
   * Shows what the kernel says; not while a handle is held.
   *
   * @param {string} title
   * @param {Easing} easing
   */
  show(title, easing) {
    if (this.#held !== null) return;
    this.title.textContent = title;
    this.#draw(easing);
  }

  close() {
    this.element.hidePopover();
  }

  /** @param {Easing} easing */
  #draw(easing) {
    this.#easing = easing;
    const handles = handlesOf(easing);
    this.drawing.innerHTML = drawing(easing, handles);
    this.handles.forEach((handle, i) => {
      handle.hidden = !handles;
      if (!handles) return;
      const [x, y] = handles.slice(2 * i);
      handle.style.left = `${MARGIN + x * SIZE}px`;
      handle.style.top = `${MARGIN + (1 - y) * SIZE}px`;
      handle.ariaValueNow = `${Math.round(100 * x)}`;
      handle.ariaValueText = `time ${Math.round(100 * x)} %, way ${Math.round(100 * y)} %`;
    });
    for (const [i, { field, input }] of this.numbers.entries()) {
      field.hidden = !handles;
      if (handles) input.value = `${Number(handles[i].toFixed(2))}`;
    }
    for (const [i, [name]] of PRESETS.entries()) {
      this.presets[i].ariaPressed = String(name === easing);
    }
    this.drawing.title = nameOf(easing);
  }

  /** @param {string} easing */
  #choose(easing) {
    this.#draw(easing);
    this.set(this.index, easing);
  }

  /**
   * A field for one coordinate of a handle.
   *
   * @param {string} label
   * @param {string} title
   * @param {number} i which of the four
   */
  #number(label, title, i) {
    const limits = { type: "number", min: "0", max: "1", step: "0.01" };
    const input = make("input", { ...limits, title, "aria-label": title });
    input.addEventListener("change", () => {
      const handles = handlesOf(this.#easing);
      if (!handles || !Number.isFinite(input.valueAsNumber)) return this.#draw(this.#easing);
      const which = /** @type {Which} */ (i >> 1);
      const place = /** @type {Point} */ (handles.slice(2 * which, 2 * which + 2));
      place[i % 2] = input.valueAsNumber;
      this.#draw(withHandle(this.#easing, which, place));
      this.set(this.index, this.#easing);
    });
    return { input, field: make("label", {}, label, input) };
  }

  /** @param {Which} which */
  #handle(which) {
    const name = which === 0 ? "How it leaves" : "How it arrives";
    const handle = make("button", {
      className: "glid-ease-handle",
      role: "slider",
      "aria-label": name,
      "aria-valuemin": 0,
      "aria-valuemax": 100,
      title: `${name}: drag it, or arrow keys`,
    });
    handle.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      e.preventDefault();
      handle.focus({ preventScroll: true });
      handle.setPointerCapture(e.pointerId);
      this.#held = which;
    });
    handle.addEventListener("pointermove", (e) => {
      if (this.#held === which && handle.hasPointerCapture(e.pointerId)) {
        const [x, y] = placeIn(this.curve, e);
        this.#move(which, [(x - MARGIN) / SIZE, 1 - (y - MARGIN) / SIZE]);
      }
    });
    handle.addEventListener("lostpointercapture", () => this.#letGo());
    handle.addEventListener("keydown", (e) => this.#nudge(e, which));
    handle.addEventListener("keyup", () => this.#letGo());
    handle.addEventListener("blur", () => this.#letGo());
    return handle;
  }

  /**
   * @param {Which} which
   * @param {Point} place
   */
  #move(which, place) {
    this.#held = which;
    this.#draw(withHandle(this.#easing, which, place));
  }

  // What a held handle did becomes one step.
  #letGo() {
    if (this.#held === null) return;
    this.#held = null;
    this.set(this.index, this.#easing);
  }

  /**
   * @param {KeyboardEvent} e
   * @param {Which} which
   */
  #nudge(e, which) {
    const arrow = ARROWS[e.key];
    const handles = handlesOf(this.#easing);
    if (!arrow || !handles || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault();
    const step = e.shiftKey ? LONG_STEP : STEP;
    const [x, y] = handles.slice(2 * which);
    this.#move(which, [x + step * arrow[0], y + step * arrow[1]]);
  }

  // The timeline takes undo; its other keys are not for it while the panel is open.
  /** @param {KeyboardEvent} e */
  #keydown(e) {
    if (!e.ctrlKey && !e.metaKey) e.stopPropagation();
  }

  /** @param {ToggleEvent} e */
  #toggled({ newState }) {
    if (newState === "open" || this.element.matches(":popover-open")) return;
    const { index } = this;
    this.index = -1;
    this.closed(index);
  }
}

/**
 * A curve, small enough for a button.
 *
 * @param {Easing} easing
 */
function curveIcon(easing) {
  const path = pathOf(easing, 12);
  return `<svg viewBox="-2 -2 16 16" aria-hidden="true"><path d="${path}"/></svg>`;
}

/**
 * @param {Easing} easing
 * @param {Handles | null} handles
 */
function drawing(easing, handles) {
  const up = (/** @type {number} */ y) => (1 - y) * SIZE;
  const arms = handles && [
    `M0 ${SIZE} L${handles[0] * SIZE} ${up(handles[1])}`,
    `M${SIZE} 0 L${handles[2] * SIZE} ${up(handles[3])}`,
  ];
  const box = [-MARGIN, -MARGIN, SIZE + 2 * MARGIN, SIZE + 2 * MARGIN].join(" ");
  return (
    `<svg viewBox="${box}" aria-hidden="true">` +
    `<rect width="${SIZE}" height="${SIZE}"/>` +
    `<path class="glid-ease-arms" d="${arms ? arms.join(" ") : ""}"/>` +
    `<path d="${pathOf(easing, SIZE)}"/></svg>`
  );
}
