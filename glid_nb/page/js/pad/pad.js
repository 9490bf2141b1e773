// Pointers, wheel and keys over a picture. The kernel decides what they mean; the page pans and
// zooms, and draws what is dragged at the pointer before the kernel answers.

import { keyOf, undoOrRedo } from "./keys.js";
import { rectangle } from "./pen.js";
import { placeIn } from "./place.js";
import { distance } from "./view.js";

/** @import { Found, KernelEvent, Mark, Point } from "../types.js" */
/** @import { View } from "./view.js" */

/**
 * What differs between the canvas and the tracer.
 *
 * @typedef {object} Behaviour
 * @property {Record<string, number>} reach the radius that a pointer hits, CSS pixels, by its type
 * @property {RegExp} keys those that go to the kernel; the others go on to the notebook
 * @property {Record<string, () => void>} actions what the page does, by its key in lower case
 * @property {(point: Point, reach: number) => Found | null} find what is there; with `mark` if it
 *   can be dragged
 * @property {(found: Found) => Map<Mark, Point>} held the points that a drag moves, by their marks
 * @property {(found: Found | null) => string} cursor the pointer's shape
 * @property {() => void} changed called when something is to be drawn again
 * @property {boolean} [painting] whether the left button paints a path
 * @property {(found: Found | null, e: PointerEvent) => boolean} [pans] whether the left button moves the view
 * @property {(found: Found | null, e: PointerEvent) => "box" | "lasso" | null} [encloses] what the
 *   left button draws around things
 * @property {(point: Point, e: PointerEvent) => Point} [constrain] the place that counts in a drag,
 *   when the pointer is at a point; with it, Shift drags too
 * @property {() => number | undefined} [pressedAt] the time of the motion that is pressed, if one is
 * @property {(key: string) => void} [pressing] called before a key goes to the kernel
 * @property {() => void} [tapped] the space bar was pressed and let go, and nothing was dragged
 * @property {(place: Point, found: Found | null) => void} [menu] opens the menu of what is there,
 *   by the right button or a long touch
 * @property {boolean} [ownsWheel] whether the wheel always zooms; else only while the pad has the
 *   focus, so that a page can be scrolled past it
 */

/**
 * Who acts on events: the kernel's `Link`, or a page without a kernel.
 *
 * @typedef {object} Listener
 * @property {(event: KernelEvent) => Promise<string | null>} put
 * @property {AbortSignal} signal ends it
 */

/** @typedef {Partial<PointerEvent & KeyboardEvent>} Pressed what of an event the kernel reads */

const CLICK = 4; // CSS pixels that a click may move
const LONG_PRESS = 600; // ms
const LONG_PRESS_GRACE = 100; // ms
const LONG_PRESS_SLACK = 8; // CSS pixels
const PATH_STEP = 3; // CSS pixels between the points of a path

export class Pad {
  /** @type {Map<number, Point>} last places of pressed pointers */
  pointers = new Map();
  /** @type {"hand" | "pan" | null} what pressed pointers do */
  mode = null;
  /** @type {{ from: Point, points: Map<Mark, Point> } | null} where a drag began, what it moves */
  grip = null;
  /** @type {Map<Mark, Point>} places of dragged marks */
  held = new Map();
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
  #pans = false; // moving farther moves the view
  #space = false; // the space bar is pressed
  #tap = false; // and nothing was dragged since
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #longPress;

  /**
   * @param {HTMLElement} element
   * @param {View} view
   * @param {Listener} link
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
    return placeIn(this.element, e);
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
      alt: Boolean(e.altKey),
      time: e.timeStamp ?? performance.now(),
      ...more,
    });
  }

  /**
   * Has the kernel do what a key does.
   *
   * @param {string} key
   * @param {Pressed} [e]
   */
  press(key, e) {
    this.behaviour.pressing?.(key);
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
    const key = keyOf(e);
    const command = e.ctrlKey || e.metaKey;
    const action = command || e.altKey ? undefined : this.behaviour.actions[key.toLowerCase()];
    const history = undoOrRedo(e);
    if (!history && !action && key !== " ") {
      if (e.altKey || !this.behaviour.keys.test(key) || (command && key !== "a")) return;
    }
    e.preventDefault();
    e.stopPropagation();
    if (key === " ") {
      if (!e.repeat) this.#tap = true;
      this.#setSpace(true);
    } else if (action) {
      action();
    } else {
      if (key === "Escape" || history) this.#drop();
      this.press(history ?? key, e);
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
    this.#tap = false; // the space bar pans
    const place = this.place(e);
    this.pointers.set(e.pointerId, place);
    this.element.setPointerCapture(e.pointerId);
    const second = this.pointers.size === 2;
    if (second) this.#takeBack(e); // the first finger's gesture was none
    this.#start = place;
    this.mode = second || e.button === 1 || (e.button === 0 && this.#space) ? "pan" : "hand";
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
    const drags = left && !e.altKey && (behaviour.constrain || !e.shiftKey);
    if (drags && found?.mark !== undefined) {
      this.grip = { from: this.view.toWorld(place), points: behaviour.held(found) };
    }
    this.#pans = left && Boolean(behaviour.pans?.(found, e));
    this.encloses = left && !behaviour.painting ? behaviour.encloses?.(found, e) : null;
    this.path = left ? [this.view.toWorld(place)] : [];
    this.send("down", place, e, {
      part: found?.part,
      at: left ? behaviour.pressedAt?.() : undefined,
    });
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
    // A busy page may have earlier moves waiting, which cancel this.
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
    e.preventDefault(); // neither the browser's nor JupyterLab's may open
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
    const free = this.view.toWorld(place);
    this.#lengthenPath(place, free, far);
    const [x, y] = this.behaviour.constrain?.(free, e) ?? free;
    if (!this.encloses && !this.behaviour.painting) {
      this.send("move", place, e, { x, y, replaces: `move ${e.pointerId}` });
    }
    if (this.grip) {
      const dx = x - this.grip.from[0];
      const dy = y - this.grip.from[1];
      for (const [mark, [u, v]] of this.grip.points) this.held.set(mark, [u + dx, v + dy]);
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
      const { path } = this; // also without a brush: the kernel may just give one
      this.send(type, place, e, { path, encloses: Boolean(this.encloses) }).then(() => {
        if (!this.grip) this.held.clear(); // from now on the kernel's places are drawn
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
    if (!this.behaviour.ownsWheel && !this.focused && !e.ctrlKey) return;
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
}
