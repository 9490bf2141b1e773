// The pad over the renderer: it sends pointers and keys, and draws pins, colour bars and notices.

import { make, save } from "../pad/dom.js";
import { help, shield } from "../pad/help.js";
import { iconButton } from "../pad/icons.js";
import { keyOf, keysAround } from "../pad/keys.js";
import { Link } from "../pad/link.js";
import { openMenu } from "../pad/menu.js";
import { Pad } from "../pad/pad.js";
import { painter } from "../pad/pen.js";
import { View } from "../pad/view.js";
import { Ahead, marksOf } from "./ahead.js";
import { menuRows, pinsOfMenu } from "./context_menu.js";
import { drawBetween, drawBrush, drawLasso, drawMarks, drawOnion, drawStiff } from "./draw.js";
import { FollowedNumbers } from "./followed.js";
import { Ghosts } from "./ghosts.js";
import { HELP } from "./help_table.js";
import { Legend } from "./legend.js";
import { arrowAt, inSight, knobInCorner } from "./marks.js";
import { Notices } from "./notices.js";
import { drawAxis, drawNumbers, movedPin } from "./numbers.js";
import { KEYS, PinBehaviour } from "./pin_behaviour.js";
import { drawLocks, withoutHidden } from "./pin_marks.js";
import { PoseClipboard } from "./pose_clipboard.js";
import { Reference } from "./reference.js";
import { resizeGrip } from "./resize_grip.js";
import { Room } from "./room.js";
import { coveredNear, Shapes } from "./shapes.js";
import { Spacing } from "./spacing.js";

/** @import { Context, Found, Point } from "../types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { PartSeen } from "./moved_shape.js" */
/** @import { Seen } from "./shapes.js" */
/** @import { Brush, CanvasTraits, PinsBetween, Tool } from "./traits.js" */

/**
 * The motion that the timeline shows.
 *
 * @typedef {object} Playing
 * @property {() => void} release goes back to the pose that is edited
 * @property {() => number | undefined} pause returns the time that is shown
 * @property {() => void} reach goes back to the pose that is edited if that is the one of this time
 */

const SAVE_VIEW_AFTER = 250; // ms
/** @type {Playing} */
const STILL = { release() {}, pause: () => undefined, reach() {} };
/** @type {PinsBetween} */
const NO_PINS = { places: [], locked: [] };

export class Canvas {
  legend = new Legend();
  notices = new Notices();
  help = help(HELP);
  ghosts = new Ghosts();
  /** The pins of a motion that is seen; none while it plays. */
  between = NO_PINS;

  /** @type {number | undefined} the pin that was selected alone when marks came last */
  #chosen;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #saving;
  /** @type {Playing} */
  #playing = STILL;
  /** @type {Tool | undefined} that a key chose, until the kernel has answered */
  #tool;
  #painted = false; // whether there was a brush when it changed last
  #presses = false; // a press into a motion is on its way to the kernel

  /** @param {Context<CanvasTraits>} context */
  constructor({ model, el, signal }) {
    this.model = model;
    this.interactive = model.get("interactive"); // else all pointers and keys pass by
    const paper = make("canvas", { className: "glid-paper" });
    this.box = make(
      "div",
      {
        className: "glid-pad",
        role: "application",
        "aria-label": "Deformation canvas: arrow keys move, Enter pins a point",
        inert: !this.interactive,
      },
      paper,
      this.legend.element,
      this.notices.notice,
      this.notices.prepared,
    );
    this.box.dataset.lmSuppressShortcuts = "true"; // JupyterLab must not take the keys first
    el.classList.add("glid-host", "glid-pad-host");
    el.append(this.box);

    this.view = new View(() => this.#viewMoved(), { nearest: 1e-4, farthest: 1 });
    this.shapes = new Shapes(model, this.view);
    this.shapes.led = () => this.redraw();
    this.ahead = new Ahead(model, (lead) => this.shapes.showLead(lead));
    this.reference = new Reference(this.box, model, this.view);
    this.redraw = painter(paper, this.view, signal, (pen) => this.#draw(pen));
    this.link = new Link(model, this.box, signal, () => this.#report());
    this.room = this.interactive ? new Room(this.box, model, signal) : null;
    this.behaviour = new PinBehaviour(this);
    this.pad = new Pad(this.box, this.view, this.#listener(signal), this.behaviour);
    this.numbers = new FollowedNumbers(this.box);
    this.clipboard = new PoseClipboard(this);
    this.corner = this.#makeCorner();
    if (this.interactive) {
      this.box.append(shield(this.corner), this.help.table, resizeGrip(model));
      keysAround(this.box, (e) => this.pad.keydown(e), signal);
      this.box.addEventListener("glid:press", (e) => this.#pressed(e)); // from the bar
    }
    this.#takeFirst();
  }

  close() {
    clearTimeout(this.#saving);
    this.ahead.close();
    this.shapes.close();
    this.reference.close();
  }

  /** Targets and images, of pins that the user hid as well. */
  get allMarks() {
    return marksOf(this.model.get("marks"), this.shapes.lead);
  }

  /** What is drawn. */
  get marks() {
    return withoutHidden(this.allMarks, this.model.get("pins"), Number.NaN);
  }

  /** What the pointer reaches. */
  get reachable() {
    return withoutHidden(this.allMarks, this.model.get("pins"), Infinity);
  }

  /** Starts the page's own solver anew, for what is edited now. */
  prepareSolver() {
    if (this.interactive) void this.ahead.prepare();
  }

  /** Goes over to the kernel's map, unless a drag goes on; a drag of the shape has a pin by now. */
  rested() {
    if (this.pad.grip) return;
    const made = this.behaviour.madePin();
    if (made === undefined) this.ahead.giveBack();
    else this.#hold(made);
  }

  /**
   * Holds a pin that the present drag has made, where the pointer is.
   *
   * @param {number} made
   */
  #hold(made) {
    const { pad, view, behaviour } = this;
    const [from] = pad.path;
    const [place] = pad.pointers.values();
    pad.grip = { from, points: new Map([[made, from]]) };
    if (!behaviour.constrains) pad.held.set(made, view.toWorld(place)); // else with the next move
    this.followHand();
  }

  /** Has the page's own solver follow what is dragged. */
  followHand() {
    if (this.pad.grip && !this.shapes.motion) this.ahead.follow(this.pad.held);
  }

  /**
   * Events go to the kernel. Gestures that only the kernel knows end what the page shows ahead of it.
   * Where the page's drawing needs the processor, the kernel hears of a few moves only.
   *
   * @param {AbortSignal} signal
   * @returns {import("../pad/pad.js").Listener}
   */
  #listener(signal) {
    const put = (/** @type {import("../types.js").KernelEvent} */ event) => {
      const drags = event.type === "up" || (this.pad.grip && /^(down|move)$/.test(event.type));
      if (!drags) this.ahead.giveBack();
      const leads = this.ahead.leads && this.shapes.movesVertices;
      return spacing.put(event, leads && event.type === "move");
    };
    const spacing = new Spacing((event) => this.link.put(event));
    signal.addEventListener("abort", () => spacing.close());
    return { put, signal };
  }

  /** The brush that paints stiff areas; null for none. */
  get brush() {
    const { radius, strength } = this.model.get("brush");
    const { tool } = this;
    return tool
      ? /** @type {Brush} */ ({ radius, strength: tool === "stiff" ? strength : 0 })
      : null;
  }

  get tool() {
    const told = this.model.get("brush").tool;
    return told === undefined ? "" : (this.#tool ?? told);
  }

  /**
   * Takes a tool of the brush, or puts it away. The page has it at once, so that a stroke right after
   * the key drags nothing.
   *
   * @param {"stiff" | "erase"} tool
   */
  toggleTool(tool) {
    this.takeTool(this.tool === tool ? "" : tool);
  }

  /** @param {Tool} name "" for none */
  takeTool(name) {
    this.pad.link.put({ type: "tool", name });
    this.#showTool(name);
  }

  /** Puts the brush away in the page; the kernel does it too. */
  putBrushAway() {
    if (this.painting) this.#showTool("");
  }

  /** @param {Tool | undefined} tool undefined for the kernel's */
  #showTool(tool) {
    if (tool === this.#tool) return;
    this.#tool = tool;
    this.box.dispatchEvent(new CustomEvent("glid:tool", { bubbles: true, detail: this.tool }));
    this.takeFocus();
    this.showNotice();
    this.pad.hover();
    this.redraw();
  }

  get painting() {
    return this.brush !== null;
  }

  /** @param {string} notice */
  say(notice) {
    save(this.model, { notice });
  }

  /**
   * Opens the menu of a pin or of the shape; by default that of the pin selected last.
   *
   * @param {Point} [place]
   * @param {Found | null} found
   */
  openMenu(place, found = { mark: this.marks.selected.at(-1) }) {
    const { selected, targets } = this.marks;
    const mark = found?.mark === undefined ? null : Number(found.mark);
    const centre = /** @type {Point} */ ([this.view.x, this.view.y]);
    const pinned = mark !== null && Number.isFinite(targets[mark]?.[0]);
    const point = pinned ? targets[mark] : (this.model.get("cursor") ?? centre);
    const at = place ?? this.view.toScreen(point);
    const does = {
      press: (/** @type {string} */ key, shift = false) => {
        return () => this.#press(key, shift);
      },
      pin: () => void this.pad.send("pin", at),
      paste: () => void this.clipboard.paste(),
      alone: () => this.room?.alone(),
      fullScreen: () => this.room?.fullScreen(),
      showKeys: this.help.toggle,
    };
    const covered = mark === null && coveredNear(this.box, at);
    const pins = mark === null ? null : pinsOfMenu(mark, selected);
    openMenu(this.box, at, menuRows(does, pins, covered, this.model.get("pins")));
  }

  /**
   * Shows a motion instead of the pose that is edited.
   *
   * @param {Seen} motion null for the pose that is edited
   * @param {Playing} playing
   * @param {Float32Array | null} heights of the picture's vertices
   * @param {Record<string, PartSeen>} parts what is seen of the shapes around, by their keys
   * @param {PinsBetween | null} pins that a drag takes
   */
  showMotion(motion = null, playing = STILL, heights = null, parts = {}, pins = null) {
    this.between = pins ?? NO_PINS;
    this.#playing = playing;
    this.shapes.motion = motion;
    this.shapes.partMotions = parts;
    this.shapes.lift(heights);
    this.showLegend();
    this.shapes.refresh();
    this.pad.hover();
    this.redraw();
  }

  /** Shows the pose that is edited, not a motion. */
  leaveMotion() {
    if (this.shapes.motion) this.#playing.release();
  }

  showLegend() {
    this.legend.show(this.model, Boolean(this.shapes.motion));
  }

  /** Takes the focus from the inspector, which shows another section when a brush is chosen. */
  takeFocus() {
    const { painting } = this;
    const chosen = painting && !this.#painted;
    this.#painted = painting;
    const side = this.box.closest(".glid-editor")?.querySelector(".glid-side");
    if (chosen && side?.contains(document.activeElement)) this.box.focus({ preventScroll: true });
  }

  showNotice() {
    const first = this.interactive && !this.marks.targets.length;
    this.notices.tell(this.model.get("notice"), this.painting, first);
  }

  /** Takes size and view from the kernel. */
  fit() {
    const { model, view, box } = this;
    view.width = model.get("width");
    view.height = model.get("height");
    [view.x, view.y, view.unit] = model.get("view");
    box.style.width = `${view.width}px`;
    box.style.height = `${view.height}px`;
    this.room?.shrink();
    this.#see();
  }

  /** Brings a pin that was selected alone, though not by the pointer, into view. */
  reveal() {
    const { selected, targets, images } = this.marks;
    const now = selected.length === 1 ? selected[0] : undefined;
    if (now === this.#chosen) return;
    this.#chosen = now;
    if (now === undefined || this.pad.mode) return;
    if (!Number.isFinite(targets[now]?.[0])) return; // hidden
    if (inSight(this.view, targets[now]) || inSight(this.view, images[now])) return;
    this.view.centreOn(targets[now]);
  }

  /** The time at which a motion was pressed; undefined for the pose that is edited. */
  pressedAt() {
    if (!this.shapes.motion) return undefined;
    this.#presses = true;
    return this.#playing.pause();
  }

  /** @param {Event} e */
  #pressed(e) {
    this.#press(/** @type {CustomEvent<string>} */ (e).detail);
  }

  /**
   * Does what a key does, in the page or in the kernel.
   *
   * @param {string} key
   * @param {boolean} [shift]
   */
  #press(key, shift = false) {
    const act = this.behaviour.actions[key];
    if (act) act();
    else this.pad.press(key, { shiftKey: shift });
  }

  // Handles two kinds of input before the pad does. While a motion is seen, keys go back to the pose
  // that is edited, because they act on it. A drag edits the pose that is seen; a click leaves the
  // time as it is, and there is no menu. A click on an arrow at the edge brings its pin into view.
  #takeFirst() {
    const take = (/** @type {Event} */ e) => {
      if (!this.shapes.motion) return false;
      e.stopImmediatePropagation();
      e.preventDefault();
      return true;
    };
    const goBack = (/** @type {Event} */ e) => take(e) && this.#playing.release();
    const capture = true;
    this.box.addEventListener("pointerdown", (e) => e.button === 2 && take(e), { capture });
    this.box.addEventListener("contextmenu", take, { capture });
    const ours = (/** @type {KeyboardEvent} */ e) =>
      !e.ctrlKey && !e.metaKey && KEYS.test(keyOf(e));
    this.box.addEventListener("keydown", (e) => ours(e) && goBack(e), { capture });
    const openedByKeys = (/** @type {KeyboardEvent} */ e) => {
      if (e.key !== "F10" || !e.shiftKey) return; // a keyboard without a menu key
      e.stopImmediatePropagation();
      e.preventDefault();
      this.openMenu();
    };
    this.box.addEventListener("keydown", openedByKeys, { capture });
    const followArrow = (/** @type {PointerEvent} */ e) => {
      const target = arrowAt(this.view, this.marks, this.pad.place(e));
      if (!target || e.target !== this.box || this.shapes.motion) return;
      this.view.centreOn(target);
      e.stopImmediatePropagation();
    };
    this.box.addEventListener("pointerdown", followArrow, { capture });
  }

  #makeCorner() {
    const look = "glid-help-button";
    return make(
      "div",
      { className: "glid-corner" },
      this.help.button,
      iconButton("screen", "Full screen (W)", () => this.room?.fullScreen(), look),
      iconButton("rectangle", "The picture alone (P)", () => this.room?.alone(), look),
    );
  }

  // Shows a refusal as the notice. After a press into a motion, shows the pose that is edited, if the
  // press was a drag and made a keyframe of this time.
  #report() {
    const { busy, refusal } = this.link;
    if (this.link.idle) this.#showTool(undefined);
    this.#settleNumbers();
    if (this.#presses && this.link.idle && this.pad.mode === null) {
      this.#presses = false;
      this.#playing.reach();
      this.behaviour.motionLeft();
    }
    if (!busy && refusal && refusal !== this.model.get("notice")) this.say(refusal);
  }

  #viewMoved() {
    this.#see();
    clearTimeout(this.#saving);
    this.#saving = setTimeout(() => {
      const { x, y, unit } = this.view;
      save(this.model, { view: [x, y, unit] });
    }, SAVE_VIEW_AFTER);
  }

  #see() {
    this.shapes.see();
    this.reference.place();
    this.redraw();
  }

  get #drags() {
    const { mode, path, encloses } = this.pad;
    return mode === "hand" && path.length > 1 && !encloses && !this.painting;
  }

  // The kernel's numbers count again, once it has answered all that the hand did.
  #settleNumbers() {
    if (this.link.idle && !this.#drags) this.numbers.settle(this.model.get("marks"));
  }

  /** @param {Pen} pen */
  #drawNumbers(pen) {
    const { model, view, pad, marks } = this;
    const { pressed } = this.behaviour;
    const drags = this.#drags && pressed;
    const moved = drags && movedPin(pressed, marks, pad.held, model.get("picture_size"));
    if (!moved) return;
    this.numbers.follow(this.allMarks, pad.held);
    const { start, keys } = pressed;
    if (start && keys?.axis) drawAxis(pen, view, start, moved.at);
    drawNumbers(pen, view, moved);
  }

  /** @param {Pen} pen */
  #draw(pen) {
    const { model, view, pad, marks, brush } = this;
    const { motion } = this.shapes;
    const through = !motion && knobInCorner(view, marks, pad.held);
    this.corner.classList.toggle("glid-through", through);
    if (motion) {
      const { places } = this.between;
      drawBetween(pen, view, places, { hovered: pad.found?.mark, held: pad.held });
      return; // the other pins belong to the pose that is edited
    }
    drawOnion(pen, view, model.get("onion"));
    drawStiff(pen, view, model.get("stiff"), this.painting);
    if (this.interactive && !this.painting) {
      this.ghosts.draw(pen, view, model.get("outline").outline, marks.targets.length > 0);
    }
    const cursor = pad.focused ? model.get("cursor") : null;
    const pins = model.get("pins");
    const held = new Map([...pad.held].filter(([mark]) => !pins.away.includes(Number(mark))));
    drawMarks(pen, view, marks, { hovered: pad.found?.mark, held, cursor });
    drawLocks(pen, view, marks, pins);
    if (brush) drawBrush(pen, view, brush, pad);
    else this.#drawNumbers(pen);
    if (pad.encloses && pad.path.length > 2) drawLasso(pen, view, pad.path);
  }
}
