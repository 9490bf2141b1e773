// How the pad behaves over a shape with pins.

import { ZOOM } from "../pad/view.js";
import { constrained } from "./constrain.js";
import { markAt, pinBetweenAt, ringAt } from "./marks.js";
import { turnWords } from "./numbers.js";
import { movedWith } from "./pin_marks.js";

/** @import { Found, Mark, Point } from "../types.js" */
/** @import { Behaviour } from "../pad/pad.js" */
/** @import { Pressing } from "./numbers.js" */
/** @import { PinsBetween } from "./traits.js" */
/** @import { Canvas } from "./canvas.js" */

const REACH = { mouse: 13, pen: 16, touch: 26 }; // CSS pixels
export const KEYS = /^(Arrow\w+|Page\w+|Delete|Backspace|Escape|Enter|[0fa,.[\]<>+=xmbelhgn-])$/i;
const TARGET_TIP =
  "where it should be. Drag it; Alt turns it; a right click shows more; Shift-click selects several";
const IMAGE_TIP = "where the shape is now. The cyan disk is where it should be";
const LOCKED_TIP = "locked where it is; L unlocks it when it is selected";
const BETWEEN_TIP = "where it is at this time. A drag makes a keyframe here";
const BETWEEN_LOCKED = "locked; unlock it at a keyframe (L)";
const COVERED = ". Another part of the shape covers it";
const RING_TIPS = {
  turn: "Drag around the pin to turn the shape there; X frees it again",
  knob: "Drag around the pin to turn the shape there, away from it to scale it; X frees it again",
};

/** @implements {Behaviour} */
export class PinBehaviour {
  reach = REACH;
  keys = KEYS;
  /** @type {Pressing | null} the last press of the left button, unless it paints */
  pressed = null;
  /** @type {{ mark: number, places: Point[] } | null} the pin of a motion that is dragged */
  #between = null;

  /** @param {Canvas} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** @type {Record<string, () => void>} */
    this.actions = {
      "?": canvas.help.toggle,
      b: () => canvas.toggleTool("stiff"),
      e: () => canvas.toggleTool("erase"),
      contextmenu: () => canvas.openMenu(),
      i: () => canvas.room?.toggleInspector(),
      k: () => void canvas.box.dispatchEvent(new CustomEvent("glid:key", { bubbles: true })),
      p: () => canvas.room?.alone(),
      reference: () => canvas.reference.toggle(), // of the bar's menu; no key is called so
      w: () => canvas.room?.fullScreen(),
      // The buttons of the bar.
      "tool:": () => canvas.takeTool(""),
      "tool:stiff": () => canvas.takeTool("stiff"),
      "tool:erase": () => canvas.takeTool("erase"),
      "zoom:in": () => canvas.view.zoom(1 / ZOOM),
      "zoom:out": () => canvas.view.zoom(ZOOM),
    };
  }

  /** @param {string} key */
  pressing(key) {
    if (key === "Escape") this.canvas.putBrushAway();
  }

  get painting() {
    return this.canvas.painting;
  }

  changed() {
    const { pad } = this.canvas;
    // What a box or a lasso selects are pins of the pose that is edited.
    if (pad.encloses && pad.path.length > 2) this.canvas.leaveMotion();
    this.canvas.followHand();
    this.canvas.redraw();
  }

  /**
   * @param {Point} place
   * @param {Found | null} found
   */
  menu(place, found) {
    // Its rows act on the pose that is edited, which must be the one that is seen.
    if (!this.canvas.shapes.motion) this.canvas.openMenu(place, found);
  }

  pressedAt() {
    return this.canvas.pressedAt();
  }

  tapped() {
    this.canvas.box.dispatchEvent(new CustomEvent("glid:play", { bubbles: true }));
  }

  /**
   * @param {Point} point
   * @param {number} reach
   */
  find(point, reach) {
    const { view, marks, reachable, shapes, painting } = this.canvas;
    if (painting) return null;
    if (shapes.motion) return pinBetweenAt(this.canvas.between.places, point, reach);
    const mark = markAt(reachable, point, reach);
    return mark ?? ringAt(view, marks, view.toScreen(point), reach / view.unit / 2);
  }

  /**
   * @param {Found | null} found
   * @param {PointerEvent} e
   */
  encloses(found, e) {
    const start = this.canvas.pad.grip?.points.get(found?.mark ?? "");
    this.pressed = { found, start, pins: this.canvas.marks.targets.length };
    if (found) return null;
    if (e.shiftKey) return "box";
    return e.ctrlKey || e.metaKey ? "lasso" : null;
  }

  /** Whether a key constrains the present drag. */
  get constrains() {
    const { axis, whole } = this.pressed?.keys ?? {};
    return Boolean(axis || whole);
  }

  /** The pin that the kernel has made of the present drag of the shape; undefined for none. */
  madePin() {
    const { pad, model } = this.canvas;
    const { pressed } = this;
    if (!pressed || pressed.found || this.painting || pad.mode !== "hand") return undefined;
    const count = model.get("rest").pose?.targets.length ?? 0;
    return count === pressed.pins + 1 && !pad.encloses ? pressed.pins : undefined;
  }

  /**
   * @param {Found} found
   * @returns {Map<Mark, Point>}
   */
  held({ mark }) {
    const { shapes, between } = this.canvas;
    if (shapes.motion) return this.#heldBetween(Number(mark), between);
    this.#between = null;
    const { selected, targets } = this.canvas.allMarks;
    const moved = movedWith(Number(mark), selected, this.canvas.model.get("pins"));
    return new Map(moved.map((i) => [i, targets[i]]));
  }

  /**
   * Holds one pin of a motion. Which others move with it is known at the keyframe that the drag makes.
   *
   * @param {number} mark
   * @param {PinsBetween} between
   * @returns {Map<Mark, Point>}
   */
  #heldBetween(mark, { places, locked }) {
    this.#between = { mark, places };
    return new Map(locked.includes(mark) ? [] : [[mark, places[mark]]]);
  }

  /** The keyframe that a drag into a motion made is edited: the drag goes on there. */
  motionLeft() {
    const { pad, shapes, allMarks, model } = this.canvas;
    const between = this.#between;
    if (!between || !pad.grip || shapes.motion) return;
    const { mark, places } = between;
    const all = movedWith(mark, allMarks.selected, model.get("pins"));
    const moved = all.filter((i) => i in places);
    pad.grip.points = new Map(moved.map((i) => [i, places[i]]));
    this.canvas.followHand();
  }

  /**
   * Shift keeps a drag on an axis, Ctrl the pin on whole pixels. The ring's turns are the kernel's.
   *
   * @param {Point} point
   * @param {PointerEvent} e
   * @returns {Point}
   */
  constrain(point, e) {
    const { model, pad } = this.canvas;
    const { pressed } = this;
    const [from] = pad.path;
    if (!pressed || !from || pressed.found?.part || pad.encloses || e.altKey) return point;
    pressed.keys = { axis: e.shiftKey, whole: e.ctrlKey || e.metaKey };
    pressed.start ??= from;
    const [x, y] = pressed.start;
    const free = /** @type {Point} */ ([x + point[0] - from[0], y + point[1] - from[1]]);
    const [u, v] = constrained([x, y], free, pressed.keys, model.get("picture_size"));
    return [u - x + from[0], v - y + from[1]];
  }

  /** @param {Found | null} found */
  cursor(found) {
    this.canvas.box.title = this.#tip(found);
    if (found?.mark !== undefined && this.#locked(found)) return "pointer";
    return found ? "grab" : "crosshair";
  }

  /** @param {Found} found */
  #locked({ mark }) {
    const { shapes, between, model } = this.canvas;
    const { locked } = shapes.motion ? between : model.get("pins");
    return locked.includes(Number(mark));
  }

  /** @param {Found | null} found */
  #tip(found) {
    if (!found) return "";
    const { marks, model, shapes } = this.canvas;
    if (found.part) return `${turnWords(marks.ring).join(", ")}. ${RING_TIPS[found.part]}`;
    const mark = Number(found.mark);
    if (shapes.motion) {
      return `Pin ${mark + 1}: ${this.#locked(found) ? BETWEEN_LOCKED : BETWEEN_TIP}`;
    }
    const name = ["Pin", mark + 1, model.get("names")[mark]].join(" ").trim();
    if (this.#locked(found)) return `${name}: ${LOCKED_TIP}`;
    const tip = found.reached ? IMAGE_TIP : TARGET_TIP;
    return `${name}: ${tip}${marks.hidden.includes(mark) ? COVERED : ""}`;
  }
}
