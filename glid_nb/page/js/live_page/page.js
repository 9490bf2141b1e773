// The live page: the picture under the newest certified map, its pins, and the controls around them.

import { drawLasso, drawMarks } from "../canvas/draw.js";
import { make } from "../pad/dom.js";
import { help } from "../pad/help.js";
import { iconButton } from "../pad/icons.js";
import { undoOrRedo } from "../pad/keys.js";
import { Pad } from "../pad/pad.js";
import { painter } from "../pad/pen.js";
import { byId } from "./elements.js";
import { Film } from "./film.js";
import { Hand } from "./hand.js";
import { HELP } from "./help_table.js";
import { drawMissed } from "./missed.js";
import { poseOf } from "./pins.js";
import { Report } from "./report.js";
import { fitted, roomOn } from "./room.js";

/** @import { LiveMap } from "../live/types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { View } from "../pad/view.js" */
/** @import { LiveData } from "./data.js" */
/** @import { Editing } from "./editing.js" */
/** @import { Taken } from "./files.js" */
/** @import { Solver } from "../live/solving_types.js" */
/** @import { Stage } from "./stage.js" */

/** @typedef {Omit<LiveData, "motion" | "source" | "heights" | "triangles">} Shown */

/**
 * What a page shows and edits, and what may be taken from it.
 * @typedef {object} Parts
 * @property {Pick<Stage, "canvas" | "paint">} stage
 * @property {Editing} editing
 * @property {View} view
 * @property {Taken} taken
 */

/** @type {Record<string, string>} the overlays, by their numbers in picture.frag */
const OVERLAYS = {
  0: "Picture",
  1: "Grid",
  2: "Stretch σ₁",
  3: "Stretch σ₂",
  4: "Dilatation k",
};
const PLAIN = "0";
const THUMBNAIL = 56; // CSS pixels

export class LivePage {
  report = new Report();

  #box = byId("pad");
  #overlay = make("select", { id: "overlay", "aria-label": "What is shown" });
  #undo = iconButton("undo", "Undo (Ctrl+Z)", () => this.#press("undo"));
  #redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => this.#press("redo"));
  #remove = iconButton("trash", "Remove the selected pins (Delete)", () => this.#press("Delete"));
  #help = help(HELP);
  /** @type {LiveMap | null} a frame of the motion, shown instead of the edited pose */
  #moving = null;
  #due = 0;
  #keeps = false; // poses of the reader
  #fitted = ""; // the view that shows everything
  #news = true; // of the pose that is edited, which is to be told
  #paintPins;

  /**
   * @param {Shown} data
   * @param {Parts} parts
   * @param {() => Promise<Solver>} startSecond starts a solver for the motion
   */
  constructor(data, { stage, editing, view, taken }, startSecond) {
    this.data = data;
    this.stage = stage;
    this.editing = editing;
    this.view = view;
    this.film = new Film(startSecond, {
      show: (frame) => this.#showMoving(frame),
      thumbnail: (frame) => this.#thumbnail(frame),
      redraw: () => this.redraw(),
      take: ({ pins, frame }) => editing.replace(pins, frame.coefficients),
      say: (text) => this.report.say(text),
    });
    this.hand = new Hand(editing, view, {
      fit: () => this.fit(),
      reset: () => this.#reset(),
      redraw: () => this.redraw(),
      play: () => this.film.playOrPause(),
      say: (text) => this.report.say(text),
      help: this.#help.toggle,
    });
    this.pad = new Pad(this.#box, view, this.hand, this.hand);
    const paper = make("canvas", { className: "paper" });
    this.#box.append(paper);
    this.#paintPins = painter(paper, view, this.hand.signal, (pen) => this.#drawPins(pen));
    view.changed = () => this.redraw();
    editing.told = () => {
      this.#news = true;
      document.documentElement.dataset.settled = "false"; // until the page tells of it
      this.report.plot(editing.frame);
      this.redraw();
    };
    this.#arrange(taken);
    this.#hear();
    this.redraw();
  }

  /** @param {Taken} taken */
  #arrange(taken) {
    for (const [value, label] of Object.entries(OVERLAYS)) {
      this.#overlay.append(new Option(label, value));
    }
    const menu = make("div", { id: "menu", popover: "auto" }, ...this.#menuRows(taken));
    menu.addEventListener("click", () => menu.hidePopover());
    const more = iconButton("export", "Copy, download, reset", undefined);
    more.popoverTargetElement = menu;
    const buttons = [this.#undo, this.#redo, this.#remove];
    const tools = byId("tools");
    tools.append(...buttons, this.#overlay, more, this.#help.button);
    tools.after(menu, this.#help.table);
    const plus = make("b", { "aria-hidden": "true" }, "+");
    const onclick = () => this.#keepPose();
    const keep = make("button", { className: "keep", title: "Keep this pose", onclick });
    keep.append(plus, "Keep pose");
    byId("dock").prepend(keep, this.film.element);
    if (this.data.poses[0].length) byId("hint").textContent = "Drag a pin.";
    const colors = Array.from({ length: this.#stops }, (_, i) => this.#css(i));
    document.documentElement.style.setProperty("--colors", colors.join());
  }

  /** @param {Taken} taken */
  #menuRows(taken) {
    const row = (/** @type {string} */ label, /** @type {() => unknown} */ onclick) =>
      make("button", { onclick }, label);
    const files = Object.entries(taken).map(([label, take]) =>
      row(label, async () => {
        const said = await take(this);
        if (said) this.report.say(said);
        this.redraw();
      }),
    );
    return [
      ...files,
      row("Fit the window", () => this.fit()),
      row("Back to the undeformed shape", () => this.#reset()),
    ];
  }

  /** A solver that has the map that is shown. */
  async solverOfShown() {
    const frame = this.#moving;
    if (!frame) return this.editing.solving;
    const solving = await this.film.solver();
    solving.place(poseOf([]), frame.coefficients);
    return solving;
  }

  #hear() {
    for (const type of ["dragover", "drop"]) {
      document.addEventListener(type, (e) => e.preventDefault()); // a dropped file replaces no page
    }
    window.addEventListener("beforeunload", (e) => this.#keeps && e.preventDefault());
    this.#overlay.addEventListener("change", () => {
      this.#showLegend();
      this.redraw();
    });
    const goBack = (/** @type {PointerEvent} */ e) => {
      if (!this.film.seen || e.button === 1) return;
      this.film.release(); // the first touch goes back to the pose that is edited
      e.stopImmediatePropagation();
      e.preventDefault();
    };
    this.#box.addEventListener("pointerdown", goBack, { capture: true });
    document.addEventListener("keydown", (e) => this.#keydown(e));
    // Only those who use keys need to see where the focus is.
    const { dataset } = this.#box;
    document.addEventListener("keydown", () => Object.assign(dataset, { keys: "" }), true);
    document.addEventListener("pointerdown", () => delete dataset.keys, true);
    new ResizeObserver(() => this.#resize()).observe(this.#box);
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", () => this.report.draw());
  }

  /**
   * Keys that are pressed elsewhere in the page are the pad's too.
   * @param {KeyboardEvent} e
   */
  #keydown(e) {
    const target = /** @type {HTMLElement} */ (e.target);
    if (this.#box.contains(target) || e.key === "Tab") return;
    const chosen = target.matches("input, select") && !undoOrRedo(e);
    const pressed = target.matches("button") && /^(Enter| )$/.test(e.key);
    const closes = e.key === "Escape" && document.querySelector(":popover-open");
    if (chosen || pressed || closes) return;
    if (e.key !== " ") {
      this.pad.keydown(e);
      return;
    }
    e.preventDefault();
    this.film.playOrPause();
  }

  /** @param {string} key */
  #press(key) {
    this.film.release();
    this.pad.press(key);
  }

  #reset() {
    this.film.release();
    this.editing.replace([], this.editing.rest);
  }

  #keepPose() {
    this.film.release();
    const { pins, frame } = this.editing;
    this.film.keep({ pins, frame });
    this.#keeps = true;
    this.report.tell(`Pose ${this.film.kept.length} is kept`);
    byId("hint").hidden = true;
  }

  /** The certified map that is shown. */
  get shown() {
    return this.#moving ?? this.editing.frame;
  }

  fit() {
    const room = roomOn(this.#box);
    const points = this.shown.images ?? [];
    Object.assign(this.view, room.size, fitted(points, room, this.data.margin));
    this.#fitted = String(this.#seen);
    this.report.draw();
    this.redraw();
  }

  // A view that the reader has chosen stays where it is.
  #resize() {
    if (String(this.#seen) === this.#fitted) this.fit();
    Object.assign(this.view, roomOn(this.#box).size);
    this.report.draw();
    this.redraw();
  }

  get #seen() {
    return [this.view.x, this.view.y, this.view.unit];
  }

  /** Draws in the next frame. */
  redraw() {
    this.#paintPins();
    if (this.#due) return;
    this.#due = requestAnimationFrame(() => {
      this.#due = 0;
      if (this.#news) this.#tell();
      this.film.drawOne();
      const { width, height, unit, x, y } = this.view;
      const seen = { width, height, unit, x, y };
      this.stage.paint(this.shown, seen, this.#overlay.value, this.#moves);
      document.documentElement.dataset.drawn = String(this.shown.id);
    });
  }

  /** Whether the next frame is to follow at once. */
  get #moves() {
    return this.pad.held.size > 0 || this.film.playing || !this.editing.settled;
  }

  /** @param {LiveMap | null} frame */
  #showMoving(frame) {
    this.#moving = frame;
    this.report.proved(this.shown);
    this.redraw();
  }

  /** @param {LiveMap} frame */
  #thumbnail(frame) {
    const size = { width: THUMBNAIL, height: THUMBNAIL };
    const room = { ...size, left: 0, top: 0, size };
    const view = fitted(frame.images ?? [], room, this.data.margin);
    this.stage.paint(frame, { ...size, ...view }, PLAIN);
    return this.stage.canvas;
  }

  /** @param {Pen} pen */
  #drawPins(pen) {
    const { editing, pad, hand, view } = this;
    if (this.#moving) return;
    const cursor = pad.focused ? hand.cursorAt : null;
    const { marks } = editing;
    drawMarks(pen, view, marks, { hovered: pad.found?.mark, held: pad.held, cursor });
    drawMissed(pen, view, marks, editing.missed, editing.refused);
    if (pad.encloses && pad.path.length > 2) drawLasso(pen, view, pad.path);
  }

  // Tells all news of a frame at once: on a slow device several maps come between two frames.
  #tell() {
    const { editing, report } = this;
    this.#news = false;
    this.#undo.disabled = !editing.canUndo;
    this.#redo.disabled = !editing.canRedo;
    this.#remove.disabled = editing.selected.length === 0;
    if (editing.canUndo) byId("hint").hidden = true;
    report.draw();
    report.proved(this.shown);
    report.pins(editing);
    document.documentElement.dataset.settled = String(editing.settled);
  }

  // Colours.

  get #stops() {
    return this.data.colors.length / 3;
  }

  /** @param {number} stop of the colour map */
  #css(stop) {
    const color = this.data.colors.slice(3 * stop, 3 * stop + 3);
    return `rgb(${color.map((share) => Math.round(255 * share))})`;
  }

  #showLegend() {
    const { value } = this.#overlay;
    const range = this.data.ranges[value];
    const legend = byId("legend");
    legend.hidden = !range;
    if (!range) return;
    // All values beyond share the last colour.
    const end = `${range[1] < range[0] ? "≤" : "≥"} ${range[1]}`;
    legend.replaceChildren(`${OVERLAYS[value]} ${range[0]}`, make("i"), end);
  }
}
