// The room that an editor has for its canvas, full screen, and the picture alone.
//
// All views of a canvas have one size. The view that a hand has used last decides it, or a new one
// with more room; the others are shown smaller where they have less room.

import { save } from "../pad/dom.js";
import { nameControls } from "./names.js";

/** @import { Model } from "../types.js" */
/** @import { CanvasTraits } from "./traits.js" */

// CSS pixels.
const PAGE = 120; // what a notebook's page needs above and below
const PARTS = 330; // what an editor's parts need
const LEAST = 480; // of the height, and of the width beside the plots
const GAP = 16; // between canvas and plots
const SLACK = 20; // a scroll bar that comes and goes changes nothing
const SETTLE = 80; // ms
const NARROW = 600; // an editor with less width, as on a phone, has its canvas first

export class Room {
  /** @type {HTMLElement | null} the editor */
  #root = null;
  #last = { width: 0, height: 0, alone: 0 };
  #decides = false; // the size of all views
  #told = ""; // to the kernel
  /** @type {{ width: number, height: number, alone: number } | null} */
  #room = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer;

  /**
   * @param {HTMLElement} pad
   * @param {Model<CanvasTraits>} model
   * @param {AbortSignal} signal ends it
   */
  constructor(pad, model, signal) {
    this.pad = pad;
    this.model = model;
    this.signal = signal;
    this.observer = new ResizeObserver(() => this.#measureSoon());
    this.observer.observe(pad);
    window.addEventListener("resize", () => this.#measureSoon(), { signal });
    window.addEventListener("keydown", (e) => this.#escape(e), { signal, capture: true });
    model.on("change:room", () => {
      if (String(model.get("room")) !== this.#told) this.#decides = false; // another view does now
    });
    const left = () => {
      if (!document.fullscreenElement) this.alone(false);
    };
    document.addEventListener("fullscreenchange", left, { signal });
    signal.addEventListener("abort", () => {
      clearTimeout(this.#timer);
      this.observer.disconnect();
    });
  }

  /**
   * Shows nothing but the picture, or everything again.
   *
   * @param {boolean} on
   */
  alone(on = !this.#last.alone) {
    const root = this.#root;
    if (!root || (!on && !this.#last.alone)) {
      this.#measureSoon();
      return;
    }
    root.classList.toggle("glid-alone", on);
    this.#decides = true;
    this.#measure();
    root.scrollIntoView({ block: on ? "start" : "nearest" });
    this.pad.focus({ preventScroll: true });
    if (!on && document.fullscreenElement) document.exitFullscreen();
  }

  fullScreen() {
    if (document.fullscreenElement) {
      document.exitFullscreen();
      return;
    }
    this.#root?.requestFullscreen().catch((error) => {
      save(this.model, { notice: `Full screen is not possible here: ${error.message}` });
    });
  }

  /** @param {KeyboardEvent} e */
  #escape(e) {
    if (e.key !== "Escape" || !this.#last.alone) return;
    // Escape ends a drag or closes a menu first.
    if (this.pad.matches(":active, :has(.glid-menu, :popover-open)")) return;
    e.stopPropagation();
    this.alone(false);
  }

  #measureSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#measure(), SETTLE);
  }

  #measure() {
    /** @type {HTMLElement | null} */
    const root = this.pad.closest(".glid-editor");
    const column = this.pad.closest(".glid-column");
    const around = column?.parentElement;
    if (!root || !around || !column.clientWidth) return;
    root.classList.toggle("glid-narrow", root.clientWidth < NARROW);
    const room = this.#roomIn(root, column, around);
    if (!this.#root) this.#begin(root, around, room);
    this.#room = room;
    this.shrink();
    if (!this.#decides) return;
    const last = this.#last;
    const wider = room.width - last.width;
    const same = room.height === last.height && room.alone === last.alone;
    if (same && wider >= 0 && wider < SLACK) return;
    this.#last = room;
    const numbers = [room.width, room.height, room.alone].map(Math.floor);
    this.#told = String(numbers);
    save(this.model, { room: numbers });
  }

  /**
   * @param {HTMLElement} root
   * @param {HTMLElement} around
   * @param {{ width: number }} room
   */
  #begin(root, around, room) {
    this.#root = root;
    this.observer.observe(around);
    nameControls(root, this.signal);
    const [width = 0] = this.model.get("room");
    this.#decides = room.width > width;
    // Not before the hand lets go: a canvas must not change below a drag.
    root.addEventListener("pointerup", () => this.#decide(), { signal: this.signal });
  }

  #decide() {
    if (this.#decides) return;
    this.#decides = true;
    this.#last = { width: 0, height: 0, alone: 0 };
    this.#measureSoon();
  }

  /** Shows the canvas smaller where another view has given it more width than there is room. */
  shrink() {
    /** @type {HTMLElement | null} */
    const whole = this.pad.closest(".glid-deform");
    if (!whole || !this.#room) return;
    const panes = /** @type {NodeListOf<HTMLElement>} */ (whole.querySelectorAll(".glid-pane"));
    const widths = [...panes].map((pane) => Number.parseFloat(pane.style.width) || 0);
    const share = this.#room.width / widths.reduce((sum, width) => sum + width, 0);
    whole.style.zoom = share < 1 && !this.#decides ? String(share) : "";
  }

  /**
   * @param {HTMLElement} root
   * @param {Element} column with the canvas
   * @param {HTMLElement} around the column and the plots
   */
  #roomIn(root, column, around) {
    const page = document.fullscreenElement === root ? 0 : PAGE;
    const below = window.innerHeight - page;
    if (root.classList.contains("glid-alone")) {
      return { width: root.clientWidth, height: below, alone: 1 };
    }
    const plots = /** @type {HTMLElement | null} */ (column.nextElementSibling);
    const beside = around.clientWidth - (plots?.offsetWidth ?? 0) - GAP;
    const width = beside >= LEAST ? beside : around.clientWidth;
    return { width, height: Math.max(LEAST, below - PARTS), alone: 0 };
  }
}
