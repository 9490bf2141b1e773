// A slider with a number beside it; null, shown as "auto", lets the tracer choose.

import { make } from "../pad/dom.js";

/** @import { Shown } from "./traits.js" */

/**
 * @typedef {object} NumberOption
 * @property {string} name
 * @property {string} label
 * @property {"0–1" | "px" | "px²"} unit
 * @property {string} title
 * @property {number} end of the slider: a share of the longer side for px, of the component's area
 *   for px²
 * @property {number} power of the slider's scale
 * @property {number} digits
 */

/** @type {NumberOption[]} */
export const NUMBERS = [
  {
    name: "threshold",
    label: "Threshold",
    unit: "0–1",
    title: "Smallest value of the foreground",
    end: 1,
    power: 1,
    digits: 3,
  },
  {
    name: "smoothing",
    label: "Smoothing",
    unit: "px",
    title: "Blur before tracing the outline",
    end: 0.01,
    power: 2,
    digits: 1,
  },
  {
    name: "offset",
    label: "Offset",
    unit: "px",
    title: "How far the cage stays from the shape",
    end: 0.05,
    power: 1.5,
    digits: 1,
  },
  {
    name: "simplify",
    label: "Simplify",
    unit: "px",
    title: "How far simplification may move the outline",
    end: 0.03,
    power: 1.5,
    digits: 1,
  },
  {
    name: "min_hole_area",
    label: "Smallest hole",
    unit: "px²",
    title: "Smaller holes are filled",
    end: 0.1,
    power: 4,
    digits: 0,
  },
];

const STEPS = 1000; // of a slider

export class NumberControl {
  #most = 1; // the value at the slider's end
  /** @type {string | null} the name of the gesture that drags the slider, unique among views */
  #gesture = null;

  /**
   * @param {NumberOption} option
   * @param {(changes: Record<string, unknown>, gesture?: string) => void} choose
   */
  constructor(option, choose) {
    const { name, label, unit, title, digits } = option;
    this.option = option;
    this.slider = make("input", {
      type: "range",
      className: "glid-slider",
      min: 0,
      max: STEPS,
      step: 1,
      "aria-label": label,
    });
    this.number = make("input", {
      type: "number",
      className: "glid-number",
      min: 0,
      step: "any",
      placeholder: "auto",
      "aria-label": `${label} (${unit})`,
    });
    this.auto = make("button", { className: "glid-auto", title: "Let the tracer choose" }, "auto");
    this.element = make(
      "div",
      { className: "glid-control", title, "data-name": name },
      make("label", {}, label),
      this.auto,
      this.number,
      make("span", { className: "glid-unit" }, unit),
      this.slider,
    );
    this.slider.addEventListener("input", () => {
      this.#gesture ??= Math.random().toString(36);
      const value = valueAt(this.#share, this.#most, option);
      this.number.value = value.toFixed(digits);
      this.auto.ariaPressed = "false";
      choose({ [name]: value }, this.#gesture);
    });
    this.slider.addEventListener("change", () => {
      this.#gesture = null;
    });
    this.number.addEventListener("change", () => {
      const { value } = this.number;
      choose({ [name]: value === "" ? null : Number(value) });
    });
    this.auto.addEventListener("click", () => choose({ [name]: null }));
  }

  get #share() {
    return Number(this.slider.value) / STEPS;
  }

  /** @param {Shown} shown */
  update(shown) {
    const { name, digits } = this.option;
    const value = shown.options[name];
    const seen = value ?? shown.automatic?.[name] ?? null;
    this.#most = endOf(this.option, shown);
    this.auto.ariaPressed = String(value === null);
    if (this.#gesture) return; // it is being dragged
    this.number.value = seen === null ? "" : String(Number(seen.toFixed(digits)));
    if (seen === valueAt(this.#share, this.#most, this.option)) return; // rounding would move it
    this.slider.value = String(Math.round(STEPS * shareAt(seen, this.#most, this.option)));
  }
}

/**
 * The value at the slider's end.
 *
 * @param {NumberOption} option
 * @param {Shown} shown
 */
export function endOf({ unit, end }, { size, component_area: area }) {
  const whole = { "0–1": 1, px: Math.max(...(size ?? [0])), "px²": area }[unit];
  return Math.max(end * whole, 1e-9);
}

/**
 * @param {number} share of the slider's length
 * @param {number} most
 * @param {NumberOption} option
 */
export function valueAt(share, most, { power, digits }) {
  return Number((most * share ** power).toFixed(digits));
}

/**
 * @param {number} value
 * @param {number} most
 * @param {NumberOption} option
 */
export function shareAt(value, most, { power }) {
  return Math.min(Math.max(value / most, 0), 1) ** (1 / power);
}
