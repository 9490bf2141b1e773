// What the page says of the map that is shown: bounds, plots, notices, and words for screen readers.

import { downSmall, up } from "../exported/numbers.js";
import { byId } from "./elements.js";
import { Plot } from "./plots.js";

/** @import { LiveMap } from "../live/types.js" */
/** @import { Editing } from "./editing.js" */

const SAID = 5000; // ms
const BESIDE = 0.02; // of the range, so that a line at an end is seen

export class Report {
  #bound = new Plot(
    "Certificate",
    "The least stretch anywhere, as proved. The map folds nowhere while this is above 0",
    [0, 1 + BESIDE],
    (x) => `σ₂ ≥ ${downSmall(x)}`,
  );
  #energy = new Plot("Energy", "The distortion of the shape, and of the pins", null, (x) =>
    x.toPrecision(4),
  );
  #time = new Plot("Step", "Time of a certified step", null, (x) => `${x.toFixed(1)} ms`);
  #last = -1; // the number of the map that was plotted last
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #saying;

  constructor() {
    byId("plots").append(this.#bound.element, this.#energy.element, this.#time.element);
  }

  /**
   * Adds to the plots; `draw` shows it.
   * @param {LiveMap} map that the solver has reached
   */
  plot({ id, certificate, energy, steps, took }) {
    if (id === this.#last && !steps) return;
    this.#last = id;
    this.#bound.add(certificate.sigma2_lower);
    this.#energy.add(energy);
    if (steps) this.#time.add(took / steps);
  }

  draw() {
    for (const plot of [this.#bound, this.#energy, this.#time]) plot.draw();
  }

  /** @param {LiveMap} map that is shown */
  proved({ certificate: { sigma2_lower, sigma1_upper, k_upper } }) {
    const bounds = `σ₂ ≥ ${downSmall(sigma2_lower)}, σ₁ ≤ ${up(sigma1_upper)}, k ≤ ${up(k_upper)}`;
    byId("proved").title = `Proved in this page for the map that is shown: ${bounds}`;
    byId("bound").textContent = bounds;
  }

  /** @param {Editing} editing */
  pins(editing) {
    const text = spokenOf(editing);
    if (text) this.tell(text);
  }

  /**
   * Tells screen readers.
   * @param {string} text
   */
  tell(text) {
    const status = byId("status");
    if (status.textContent !== text) status.textContent = text;
  }

  /**
   * Tells everybody, for a while.
   * @param {string} text
   */
  say(text) {
    const notice = byId("notice");
    notice.textContent = text;
    notice.hidden = false;
    clearTimeout(this.#saying);
    this.#saying = setTimeout(() => {
      notice.hidden = true;
    }, SAID);
  }
}

/**
 * The pins in words: those that are not reached, or else the selected one.
 * @param {Pick<Editing, "pins" | "selected" | "missed" | "inGesture">} editing
 */
export function spokenOf({ pins, selected, missed, inGesture }) {
  if (missed.length && !inGesture) {
    const numbers = missed.map((i) => i + 1).join(", ");
    return `The shape does not reach pin ${numbers}`;
  }
  const last = selected.at(-1);
  if (last === undefined) return pins.length ? "" : "No pins";
  const [x, y] = pins[last].target;
  return `Pin ${last + 1} of ${pins.length}, at ${tenths(x)}, ${tenths(y)}`;
}

/** @param {number} x */
function tenths(x) {
  return (Math.round(10 * x) / 10 + 0).toFixed(1); // no -0.0
}
