// The room that an editor has for its canvas, full screen, and the picture alone.

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

export class Room {
  /** @type {HTMLElement | null} the editor */
  #root = null;
  #last = { width: 0, height: 0, alone: 0 };
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
    if (!this.#root) {
      this.observer.observe(around);
      nameControls(root, this.signal);
    }
    this.#root = root;
    const room = this.#roomIn(root, column, around);
    const last = this.#last;
    const wider = room.width - last.width;
    const same = room.height === last.height && room.alone === last.alone;
    if (same && wider >= 0 && wider < SLACK) return;
    this.#last = room;
    const numbers = [room.width, room.height, room.alone];
    save(this.model, { room: numbers.map(Math.floor) });
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
