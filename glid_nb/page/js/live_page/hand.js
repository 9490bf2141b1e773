// The meaning of pointers and keys, as `PinGestures` of glid_nb/widgets/gestures.py has it for the editor.

import { markAt, ringAt } from "../canvas/marks.js";
import { distance } from "../pad/view.js";

/** @import { Behaviour } from "../pad/pad.js" */
/** @import { View } from "../pad/view.js" */
/** @import { Found, KernelEvent, Mark, Point } from "../types.js" */
/** @import { Editing } from "./editing.js" */

const REACH = { mouse: 13, pen: 16, touch: 26 }; // CSS pixels
const KEYS = /^(Arrow\w+|Delete|Backspace|Escape|Enter|[0fax,.<>+=-])$/i;
const SLOP = 2; // a pressed pin that moves fewer CSS pixels is not dragged
const SLOP_ON_SHAPE = 5;
const NUDGE = 0.1; // world units
const NUDGE_SHIFT = 0.5;
const CURSOR = 6; // CSS pixels
const CURSOR_SHIFT = 30;
const LEVER = 12; // CSS pixels from a pin: nearer to it, the pointer gives no direction
// A knob's drag turns, or scales, only beyond these: radians, and the logarithm of a ratio.
const LEAST_TURN = 0.06;
const LEAST_SCALING = 0.12;
const STEP_OF_TURN = Math.PI / 36;
const STEP_OF_SCALE = 1.05;
/** @type {Record<string, Point>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** @type {Record<string, [turn: number, scale: number]>} */
const TURNS = {
  "<": [STEP_OF_TURN, 1],
  ">": [-STEP_OF_TURN, 1],
  "+": [0, STEP_OF_SCALE],
  "=": [0, STEP_OF_SCALE],
  "-": [0, 1 / STEP_OF_SCALE],
};

/** @typedef {{ x: number, y: number, unit: number, reach: number, button: number, shift: boolean, alt?: boolean }} At */
/** @typedef {At & { part?: string, key?: string, path?: Point[], encloses?: boolean }} HandEvent */

/**
 * A pressed pointer.
 * @typedef {object} Press
 * @property {Point} start
 * @property {boolean} onShape whether it would pin what lies below it
 * @property {Map<number, Point>} targets those that it drags, when it was pressed
 * @property {string} part of the ring
 * @property {Map<number, { angle: number, scale: number }>} turns of the selected pins
 * @property {boolean} dragging
 * @property {boolean} turning
 * @property {boolean} scaling
 */

/**
 * What the page does beside the pins.
 * @typedef {object} Around
 * @property {() => void} fit
 * @property {() => void} reset
 * @property {() => void} redraw
 * @property {() => void} play
 * @property {(text: string) => void} say
 * @property {() => void} help
 */

/** @implements {Behaviour} */
export class Hand {
  reach = REACH;
  keys = KEYS;
  ownsWheel = window === window.top; // not in a frame of a page that scrolls
  signal = new AbortController().signal;
  /** @type {Point | null} the keyboard's cursor */
  cursorAt = null;

  /** @type {Press | null} */
  #press = null;
  /** @type {Point} where the pad has asked last what is there */
  #pointed = [0, 0];

  /**
   * @param {Editing} editing
   * @param {View} view
   * @param {Around} around
   */
  constructor(editing, view, around) {
    this.editing = editing;
    this.view = view;
    this.around = around;
    this.actions = { "?": around.help };
  }

  // What the pad asks.

  changed() {
    this.around.redraw();
  }

  tapped() {
    this.around.play();
  }

  /**
   * @param {Point} point
   * @param {number} reach
   * @returns {Found | null}
   */
  find(point, reach) {
    const { marks } = this.editing;
    this.#pointed = point;
    const onRing = () =>
      ringAt(this.view, marks, this.view.toScreen(point), reach / this.view.unit / 2);
    return markAt(marks, point, reach) ?? onRing();
  }

  /**
   * @param {Found} found
   * @returns {Map<Mark, Point>}
   */
  held({ mark }) {
    const { pins, selected } = this.editing;
    const pressed = Number(mark);
    const moved = selected.includes(pressed) ? selected : [pressed];
    return new Map(moved.map((i) => [i, pins[i].target]));
  }

  /**
   * @param {Found | null} _found
   * @param {PointerEvent} e
   */
  encloses(_found, e) {
    return e.shiftKey ? "box" : null;
  }

  /** @param {Found | null} found */
  cursor(found) {
    return found ? "grab" : "crosshair";
  }

  /**
   * Moves the view if neither a pin nor the shape lies below the pointer.
   * @param {Found | null} found
   * @param {PointerEvent} e
   */
  pans(found, e) {
    return !found && !e.shiftKey && this.editing.sourceAt(this.#pointed) === null;
  }

  // What the pad tells.

  /** @param {KernelEvent} event */
  async put(event) {
    const at = /** @type {HandEvent} */ (/** @type {unknown} */ (event));
    if (event.type === "down") this.#down(at);
    if (event.type === "move") this.#move(at);
    if (event.type === "up") this.#up(at);
    if (event.type === "cancel") this.#cancel();
    if (event.type === "key") this.#key(at.key ?? "", at);
    return null;
  }

  /** @param {HandEvent} at */
  #down(at) {
    const { editing } = this;
    this.#cancel();
    this.cursorAt = null;
    if (at.button !== 0) return;
    const start = /** @type {Point} */ ([at.x, at.y]);
    const mark = markAt(editing.marks, start, at.reach)?.mark;
    /** @type {Press} */
    const press = {
      start,
      onShape: false,
      targets: new Map(),
      part: "",
      turns: new Map(),
      dragging: false,
      turning: false,
      scaling: false,
    };
    if (mark !== undefined) {
      const hit = Number(mark);
      if (at.shift) return this.#toggle(hit);
      if (!editing.selected.includes(hit)) editing.select([hit]);
      if (at.alt) this.#pressRing(press, "turn");
      else press.targets = new Map(editing.selected.map((i) => [i, editing.pins[i].target]));
    } else if (at.part) {
      this.#pressRing(press, at.part);
      // A click on the ring's line without a turn pins the point below it.
      press.onShape = at.part === "turn" && editing.sourceAt(start) !== null;
    } else {
      press.onShape = !at.shift && editing.sourceAt(start) !== null;
    }
    this.#press = press;
  }

  /**
   * @param {Press} press
   * @param {string} part of the ring
   */
  #pressRing(press, part) {
    const { editing } = this;
    press.part = part;
    press.turning = part === "turn";
    press.turns = new Map(editing.selected.map((i) => [i, editing.turnOf(i)]));
  }

  /** @param {number} hit */
  #toggle(hit) {
    const { selected } = this.editing;
    const others = selected.filter((i) => i !== hit);
    this.editing.select(selected.includes(hit) ? others : [...selected, hit]);
  }

  /** @param {HandEvent} at */
  #move(at) {
    const { editing } = this;
    const press = this.#press;
    if (!press) return;
    const point = /** @type {Point} */ ([at.x, at.y]);
    const slop = press.part || press.targets.size ? SLOP : SLOP_ON_SHAPE;
    if (!press.dragging && distance(point, press.start) <= slop * at.unit) return;
    if (!press.part && !press.targets.size && !press.onShape) return;
    if (!press.dragging) editing.beginGesture();
    press.dragging = true;
    if (press.part) {
      this.#turn(press, point, LEVER * at.unit);
      return;
    }
    if (!press.targets.size) {
      // Dragging the shape itself pins the point below the pointer.
      editing.pin(press.start);
      press.targets = new Map([[editing.pins.length - 1, press.start]]);
    }
    const [dx, dy] = [point[0] - press.start[0], point[1] - press.start[1]];
    const moved = [...press.targets].map(
      ([i, [x, y]]) => /** @type {[number, Point]} */ ([i, [x + dx, y + dy]]),
    );
    editing.move(new Map(moved));
  }

  /**
   * Turns or scales the selected pins as the pointer moves around the last of them.
   * @param {Press} press
   * @param {Point} point
   * @param {number} lever
   */
  #turn(press, point, lever) {
    const { editing } = this;
    const last = editing.selected.at(-1);
    if (last === undefined) return;
    const [x, y] = editing.pins[last].target;
    const from = [press.start[0] - x, press.start[1] - y];
    const to = [point[0] - x, point[1] - y];
    const before = Math.hypot(from[0], from[1]);
    if (before < lever) {
      press.start = point; // pressed on the pin itself: the drag begins beside it
      return;
    }
    const cross = from[0] * to[1] - from[1] * to[0];
    const turned = Math.atan2(cross, from[0] * to[0] + from[1] * to[1]);
    const scaled = Math.max(Math.hypot(to[0], to[1]) / before, 1e-9);
    if (press.part === "knob") {
      press.turning ||= Math.abs(turned) > LEAST_TURN;
      press.scaling ||= Math.abs(Math.log(scaled)) > LEAST_SCALING;
    }
    if (!press.turning && !press.scaling) return;
    editing.turn((i) => {
      const { angle, scale } = press.turns.get(i) ?? { angle: 0, scale: 1 };
      return {
        ...(press.turning ? { angle: angle + turned } : {}),
        ...(press.scaling ? { scale: scale * scaled } : {}),
      };
    });
  }

  /** @param {HandEvent} at */
  #up({ path = [], encloses }) {
    const { editing } = this;
    const press = this.#press;
    this.#press = null;
    if (encloses && path.length > 2) {
      this.#selectIn(path);
      return;
    }
    if (!press) return;
    if (press.dragging) editing.endGesture();
    else if (press.onShape) this.#pin(press.start);
    else if (!press.targets.size && !press.part) editing.select([]);
  }

  /**
   * Selects the pins in a box as well.
   * @param {Point[]} corners
   */
  #selectIn(corners) {
    const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
    const within = (/** @type {number} */ at, /** @type {number[]} */ ends) =>
      at >= Math.min(...ends) && at <= Math.max(...ends);
    const { pins, selected } = this.editing;
    const inside = [...pins.keys()].filter((i) => {
      const [x, y] = pins[i].target;
      return within(x, xs) && within(y, ys);
    });
    this.editing.select([...selected, ...inside]);
  }

  #cancel() {
    this.#press = null;
    this.editing.cancelGesture();
  }

  /** @param {Point} place */
  #pin(place) {
    if (!this.editing.pin(place)) this.around.say("There is no shape here. Choose a place on it.");
  }

  /**
   * @param {string} key
   * @param {HandEvent} at
   */
  #key(key, at) {
    const { editing, around } = this;
    /** @type {Record<string, () => void>} */
    const acts = {
      undo: () => editing.undo(),
      redo: () => editing.redo(),
      Delete: () => editing.remove(),
      Backspace: () => editing.remove(),
      Escape: () => this.#escape(),
      Enter: () => this.#enter(at),
      0: around.reset,
      f: around.fit,
      a: () => editing.select([...editing.pins.keys()]),
      x: () => editing.turn(() => ({ angle: null, scale: null })),
      ",": () => this.#next(-1),
      ".": () => this.#next(1),
    };
    const turn = TURNS[key];
    if (ARROWS[key]) this.#arrow(ARROWS[key], at);
    else if (turn) this.#turnBy(turn);
    else (acts[key] ?? acts[key.toLowerCase()])?.();
    around.redraw();
  }

  /** @param {[number, number]} turn */
  #turnBy([by, factor]) {
    const { editing } = this;
    editing.turn((i) => {
      const { angle, scale } = editing.turnOf(i);
      return by ? { angle: angle + by } : { scale: scale * factor };
    });
  }

  #escape() {
    if (this.editing.inGesture) {
      this.#cancel();
      return;
    }
    this.editing.select([]);
    this.cursorAt = null;
  }

  /** @param {number} step */
  #next(step) {
    this.editing.selectNext(step);
    this.cursorAt = null;
  }

  /**
   * @param {Point} direction
   * @param {HandEvent} at
   */
  #arrow([dx, dy], { x, y, unit, shift }) {
    const { editing } = this;
    if (editing.selected.length && !this.cursorAt) {
      const step = shift ? NUDGE_SHIFT : NUDGE;
      editing.nudge([step * dx, step * dy]);
      return;
    }
    const step = (shift ? CURSOR_SHIFT : CURSOR) * unit;
    const [cx, cy] = this.cursorAt ?? [x, y];
    this.cursorAt = [cx + step * dx, cy + step * dy];
  }

  /** @param {HandEvent} at */
  #enter({ x, y, reach }) {
    const place = this.cursorAt;
    if (!place) {
      this.cursorAt = [x, y];
      return;
    }
    const mark = markAt(this.editing.marks, place, reach)?.mark;
    this.cursorAt = null;
    if (mark === undefined) this.#pin(place);
    else this.editing.select([Number(mark)]);
  }
}
