// The room that an editor has for its canvas, full screen, and the picture alone.
//
// All views of a canvas have one size. The view that a hand has used last decides it, or a new one
// with more room; the others are shown smaller where they have less room.

import { save } from "../pad/dom.js";
import { scaleOf } from "../pad/place.js";
import { nameControls } from "./names.js";

/** @import { Model } from "../types.js" */
/** @import { CanvasTraits } from "./traits.js" */

// CSS pixels.
const PAGE = 124; // what a notebook's page needs above and below
const PARTS = 44 + 110 + 28 + 2; // bar, timeline, line of the state, frame
const LEAST = 280; // of the height
const BESIDE = 400; // least width beside the plots
const PLOTS = 477; // of the plots
const SLACK = 20; // a scroll bar that comes and goes changes nothing
const SETTLE = 80; // ms
const NARROW = 600; // an editor with less width, as on a phone, has its canvas first
const CLOSE = 800; // one with less has the timeline under the inspector too

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
      const full = document.fullscreenElement;
      if (!full) this.alone(false);
      if (!full || full === this.#root) this.toggleInspector(Boolean(full));
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

  /**
   * Hides the inspector, which leaves its room to the canvas, or shows it again.
   *
   * @param {boolean} [away]
   */
  toggleInspector(away) {
    const root = this.#root;
    if (!root || root.classList.contains("glid-side-away") === away) return;
    const focused = root.querySelector(".glid-side")?.contains(document.activeElement);
    const hidden = root.classList.toggle("glid-side-away", away);
    if (hidden && focused) this.pad.focus({ preventScroll: true });
    this.#decides = true;
    this.#measureSoon();
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
    /** @type {HTMLElement | null} */
    const shell = this.pad.closest(".glid-shell");
    if (!root || !shell?.clientWidth) return;
    root.classList.toggle("glid-narrow", root.clientWidth < NARROW);
    root.classList.toggle("glid-close", root.clientWidth < CLOSE);
    const room = this.#roomIn(root, shell);
    if (!this.#root) this.#begin(root, shell, room);
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
   * @param {HTMLElement} shell
   * @param {{ width: number }} room
   */
  #begin(root, shell, room) {
    this.#root = root;
    this.observer.observe(root); // an offer of kept work above the tabs comes and goes
    this.observer.observe(shell);
    const plots = shell.querySelector(".glid-plots-box");
    if (plots) this.observer.observe(plots);
    nameControls(root, this.signal);
    const [width = 0] = this.model.get("room");
    this.#decides = room.width > width;
    // Not before the hand lets go: a canvas must not change below a drag.
    root.addEventListener("pointerup", () => this.#decide(), { signal: this.signal });
    // The timeline's export opens a section of the inspector.
    const inspected = () => this.toggleInspector(false);
    root.addEventListener("glid:inspect", inspected, { signal: this.signal });
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
   * @param {HTMLElement} shell the tab with the canvas
   */
  #roomIn(root, shell) {
    const page = document.fullscreenElement === root ? 0 : PAGE;
    const below = window.innerHeight - page;
    if (root.classList.contains("glid-alone")) {
      return { width: root.clientWidth, height: below, alone: 1 };
    }
    const narrow = root.classList.contains("glid-narrow");
    const side = /** @type {HTMLElement | null} */ (shell.querySelector(".glid-side"));
    const plots = /** @type {HTMLElement | null} */ (shell.querySelector(".glid-plots-box"));
    const beside = shell.clientWidth - (narrow ? 0 : (side?.offsetWidth ?? 0));
    const plotted = Boolean(plots?.offsetWidth) && !narrow && beside - PLOTS >= BESIDE;
    shell.classList.toggle("glid-beside", plotted);
    const width = plotted ? beside - PLOTS : beside;
    const above = shell.getBoundingClientRect().top - root.getBoundingClientRect().top;
    return { width, height: Math.max(LEAST, below - above / scaleOf(root).down - PARTS), alone: 0 };
  }
}
