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
const NOTEBOOK = 124; // what a notebook's page needs above and below
const PAGE = 48; // what another page needs, as one of Voila
const PARTS = 44 + 110 + 28 + 2; // bar, timeline, line of the state, frame
const NARROW_LEGEND = 42; // of the colour bars below a phone's canvas
const TABS = 34; // of the inspector
const LEAST = 280; // of the height
const NARROW_LEAST = 220; // on a phone
const BESIDE = 340; // least width beside the plots
const PLOTS = 477; // of the plots
const SLACK = 20; // a scroll bar that comes and goes changes nothing
const SETTLE = 80; // ms
const NARROW = 600; // an editor with less width, as on a phone, has its canvas first
const CLOSE = 800; // one with less has the timeline under the inspector too

export class Room {
  /** @type {HTMLElement | null} the editor */
  #root = null;
  #last = { width: 0, height: 0, all: 0 };
  #decides = false; // the size of all views
  #told = ""; // to the kernel
  /** @type {{ width: number, height: number, all: number } | null} all: the canvas fills it */
  #room = null;
  #foot = { layout: "", height: 0 }; // of the line of the state on a phone, the highest so far
  #plotted = true; // whether the plots were seen before; those that come first do not scroll
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
  alone(on = !this.#isAlone) {
    const root = this.#root;
    if (!root || (!on && !this.#isAlone)) {
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

  get #isAlone() {
    return Boolean(this.#root?.classList.contains("glid-alone"));
  }

  /** @param {KeyboardEvent} e */
  #escape(e) {
    if (e.key !== "Escape" || !this.#isAlone) return;
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
    const same = room.height === last.height && room.all === last.all;
    if (same && wider >= 0 && wider < SLACK) return;
    this.#last = room;
    const numbers = [room.width, room.height, room.all].map(Math.floor);
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
    const released = () => {
      this.#decide();
      this.#measureSoon();
    };
    root.addEventListener("pointerup", released, { signal: this.signal });
    // The timeline's export opens a section of the inspector.
    const inspected = () => this.toggleInspector(false);
    root.addEventListener("glid:inspect", inspected, { signal: this.signal });
  }

  #decide() {
    if (this.#decides) return;
    this.#decides = true;
    this.#last = { width: 0, height: 0, all: 0 };
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
    const full = document.fullscreenElement === root;
    const below = window.innerHeight - (full ? 0 : around(root));
    if (this.#isAlone) return { width: root.clientWidth, height: below, all: 1 };
    const narrow = root.classList.contains("glid-narrow");
    const side = /** @type {HTMLElement | null} */ (shell.querySelector(".glid-side"));
    const plots = /** @type {HTMLElement | null} */ (shell.querySelector(".glid-plots-box"));
    const beside = shell.clientWidth - (narrow ? 0 : (side?.offsetWidth ?? 0));
    const plotted = Boolean(plots?.offsetWidth) && !narrow && beside - PLOTS >= BESIDE;
    shell.classList.toggle("glid-beside", plotted);
    this.#showPlots(plots, plotted);
    const width = plotted ? beside - PLOTS : beside;
    const above = shell.getBoundingClientRect().top - root.getBoundingClientRect().top;
    const section = Boolean(side?.offsetWidth);
    const parts = narrow ? this.#partsOnPhone(shell, section, full) : PARTS;
    const free = below - above / scaleOf(root).down - parts;
    const height = Math.max(narrow ? NARROW_LEAST : LEAST, free);
    // A phone's canvas is a square above the inspector. Without that it has the rest of the screen.
    return { width, height, all: Number(narrow && full && !section) };
  }

  /**
   * The height of what a phone's screen has beside the canvas. Words at rest that need more lines
   * than before make the canvas smaller. Fewer lines change nothing, nor do the words during a drag
   * or a solve.
   *
   * @param {HTMLElement} shell
   * @param {boolean} section whether the inspector is seen
   * @param {boolean} full whether the editor has the whole screen
   */
  #partsOnPhone(shell, section, full) {
    /** @param {string} name */
    const heightOf = (name) => {
      const part = /** @type {HTMLElement | null} */ (shell.querySelector(name));
      return part?.offsetHeight ?? 0;
    };
    const bars = shell.querySelector(".glid-legend:not([hidden])") ? NARROW_LEGEND : 0;
    const layout = String([shell.clientWidth, section, full, bars]);
    if (this.#foot.layout !== layout) this.#foot = { layout, height: 0 };
    const moving = this.pad.matches(":active") || shell.querySelector(".glid-foot .glid-working");
    if (!moving || !this.#foot.height) {
      this.#foot.height = Math.max(this.#foot.height, heightOf(".glid-foot"));
    }
    const inspector = section ? TABS + sectionHeight(window.innerHeight) : 0;
    const rows = heightOf(".glid-tools") + heightOf(".glid-timeline");
    return rows + inspector + bars + this.#foot.height + 2;
  }

  /**
   * Plots that come below the editor, where there is no room beside the canvas, are scrolled to.
   *
   * @param {HTMLElement | null} plots
   * @param {boolean} beside
   */
  #showPlots(plots, beside) {
    const seen = Boolean(plots?.offsetWidth);
    if (seen && !beside && !this.#plotted) plots?.scrollIntoView({ block: "nearest" });
    this.#plotted = seen;
  }
}

/**
 * The height of a phone's section of the inspector, as in canvas.css.
 *
 * @param {number} screen
 */
function sectionHeight(screen) {
  return Math.min(Math.max(screen - 730, 120), 300);
}

/**
 * What the page around an editor needs above and below.
 *
 * @param {HTMLElement} root
 */
function around(root) {
  return root.closest(".jp-MainAreaWidget") ? NOTEBOOK : PAGE;
}
