// The picture with the cage over it: what is below the pointer, and what is drawn.

import { make } from "../pad/dom.js";
import { holeAt, nearestEdge, nearestVertex } from "../pad/hit.js";
import { Pad } from "../pad/pad.js";
import { painter, rectangle } from "../pad/pen.js";
import { View, ZOOM } from "../pad/view.js";
import { drawStage } from "./draw.js";
import { TOOLS } from "./tools.js";

/** @import { Found, Mark, Point } from "../types.js" */
/** @import { Link } from "../pad/link.js" */
/** @import { Behaviour } from "../pad/pad.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { Shown, Tool } from "./traits.js" */

const REACH = { mouse: 9, pen: 12, touch: 18 }; // CSS pixels around the pointer
const MARGIN = 24; // CSS pixels around a picture that fits
const HINT = 8; // CSS pixels above and below the hint
const CALLOUT = 24; // CSS pixels between a problem's place and its message
const EDGE = 8; // CSS pixels between the message and the edge
const MOST_ZOOM = 40; // CSS pixels per pixel of the picture
const FARTHEST = 1e3; // pixels of the picture per CSS pixel
const COLORS = [
  "accent",
  "accent-soft",
  "warn",
  "warn-soft",
  "faint",
  "veil",
  "foreground",
  "background",
  "check-light",
  "check-dark",
];
const KEYS = /^(Arrow\w+|Delete|Backspace|Escape|Enter|[[\]])$/;

/** @implements {Behaviour} */
export class Stage {
  canvas = make("canvas", {
    className: "glid-canvas",
    role: "application",
    "aria-label": "Picture and cage",
  });
  callout = make("div", { className: "glid-callout", role: "alert", hidden: true });
  hintText = make("div", { className: "glid-hint" });
  drop = make("div", { className: "glid-drop", hidden: true }, "Drop a picture here");
  empty = make(
    "div",
    { className: "glid-empty" },
    make("p", {}, "Drop a picture here, or open one from a file."),
  );

  /** @type {Shown | null} */
  shown = null;
  /** @type {ImageBitmap | null} */
  bitmap = null;
  /** @type {Tool} */
  tool = "edit";
  /** @type {Record<string, string> | null} the theme's, as a canvas takes them */
  colors = null;

  #turn = 0; // counts the pictures, to tell the newest
  #closed = false;
  /** @type {Found | null} the hole below the pointer in the list */
  #listed = null;
  #fitted = true; // until a hand moves the view

  /**
   * @param {HTMLElement} root defines the colours as CSS variables
   * @param {Link} link
   * @param {(file: File) => void} upload takes a dropped picture
   * @param {AbortSignal} signal
   */
  constructor(root, link, upload, signal) {
    this.root = root;
    const parts = [this.canvas, this.empty, this.callout, this.hintText, this.drop];
    this.element = make("div", { className: "glid-stage" }, ...parts);
    const moved = () => {
      this.#fitted = false;
      this.changed();
    };
    this.view = new View(moved, { up: -1, nearest: 1 / MOST_ZOOM, farthest: FARTHEST });
    this.changed = painter(this.canvas, this.view, signal, (pen) => this.#draw(pen));
    this.pad = new Pad(this.canvas, this.view, link, this);
    this.#takeFiles(upload);
    this.resizer = new ResizeObserver(() => this.#resize());
    this.resizer.observe(this.element);
    // JupyterLab changes its theme by attributes of the body.
    const themeChanged = () => {
      this.colors = null;
      this.changed();
    };
    this.themes = new MutationObserver(themeChanged);
    this.themes.observe(document.body, { attributes: true });
    for (const theme of ["(prefers-color-scheme: dark)", "(forced-colors: active)"]) {
      matchMedia(theme).addEventListener("change", themeChanged, { signal });
    }
  }

  close() {
    this.resizer.disconnect();
    this.themes.disconnect();
    this.#closed = true; // a picture that is still decoded comes too late
    this.bitmap?.close();
    this.bitmap = null; // a redraw may still come
  }

  /** @param {(file: File) => void} upload */
  #takeFiles(upload) {
    const { drop, element } = this;
    const on = (
      /** @type {"dragenter" | "dragover" | "dragleave" | "drop"} */ name,
      /** @type {(e: DragEvent) => void} */ act,
    ) =>
      element.addEventListener(name, (e) => {
        e.preventDefault();
        e.stopPropagation();
        act(e);
      });
    const invite = () => {
      drop.hidden = false;
    };
    on("dragenter", invite);
    on("dragover", invite);
    on("dragleave", (e) => {
      const inside = element.contains(/** @type {Node | null} */ (e.relatedTarget));
      if (!inside) drop.hidden = true;
    });
    on("drop", (e) => {
      drop.hidden = true;
      const file = e.dataTransfer?.files[0];
      if (file) upload(file);
    });
  }

  /** @param {Shown} shown */
  update(shown) {
    const before = this.shown?.size;
    this.shown = shown;
    this.empty.hidden = Boolean(shown.size);
    if (shown.size && String(before) !== String(shown.size)) this.fit();
    this.pad.hover(); // something else may lie below the pointer now
  }

  /** @param {DataView<ArrayBuffer> | null} bytes */
  async setPicture(bytes) {
    this.#turn += 1;
    const turn = this.#turn;
    const bitmap = bytes?.byteLength ? await createImageBitmap(new Blob([bytes])) : null;
    if (turn !== this.#turn || this.#closed) {
      bitmap?.close(); // a newer one has come
      return;
    }
    this.bitmap?.close();
    this.bitmap = bitmap;
    this.changed();
  }

  /** @param {Tool} tool */
  setTool(tool) {
    this.tool = tool;
    this.pad.hover();
  }

  /** @param {number | null} index */
  highlightHole(index) {
    this.#listed = index === null ? null : { hole: index };
    this.changed();
  }

  fit() {
    const { view, element } = this;
    if (!this.shown?.size) return;
    const [w, h] = this.shown.size;
    this.hintText.textContent = this.#hint(null); // it takes two lines where it is narrow
    const below = Math.max(this.hintText.offsetHeight + 2 * HINT, MARGIN);
    const wide = Math.max(element.clientWidth - 2 * MARGIN, 1);
    const high = Math.max(element.clientHeight - MARGIN - below, 1);
    const unit = Math.min(Math.max(w / wide, h / high), FARTHEST);
    view.x = w / 2;
    view.y = h / 2 + (unit * (below - MARGIN)) / 2;
    view.unit = unit;
    view.farthest = 4 * unit;
    this.#fitted = true;
    this.changed();
  }

  /** @param {boolean} closer */
  zoom(closer) {
    this.view.zoom(closer ? 1 / ZOOM : ZOOM);
  }

  #resize() {
    const { clientWidth, clientHeight } = this.element;
    if (!clientWidth || !clientHeight) return;
    if (this.#fitted) this.fit();
    this.view.width = clientWidth;
    this.view.height = clientHeight;
    this.changed();
  }

  /** The loops, with vertices that are dragged where the pointer is. */
  get loops() {
    const loops = this.shown?.loops ?? [];
    const { held } = this.pad;
    if (!held.size) return loops;
    return loops.map((loop, i) => loop.map((point, j) => held.get(`${i}:${j}`) ?? point));
  }

  get brushing() {
    return this.tool === "foreground" || this.tool === "background";
  }

  get drawing() {
    return this.tool === "polygon" || this.tool === "rectangle";
  }

  get cutting() {
    return this.tool === "knife";
  }

  // The pad's behaviour

  reach = REACH;
  keys = KEYS;
  /** @type {Record<string, () => void>} */
  actions = {
    "+": () => this.zoom(true),
    "=": () => this.zoom(true),
    "-": () => this.zoom(false),
    f: () => this.fit(),
  };

  get painting() {
    return this.brushing || this.drawing || this.cutting;
  }

  /**
   * @param {Point} point
   * @param {number} reach
   * @returns {Found | null}
   */
  find(point, reach) {
    if (this.tool !== "edit" || !this.shown?.size) return null;
    const { holes, reach_shares: shares } = this.shown;
    const hole = holeAt(holes, point);
    const near = hole < 0 ? reach : shares.in_hole * reach;
    const vertex = nearestVertex(this.loops, point, near);
    if (vertex) return { vertex, mark: `${vertex.loop}:${vertex.index}` };
    const edge = nearestEdge(this.loops, point, shares.edge * near);
    if (edge) return { edge };
    return hole < 0 ? null : { hole };
  }

  /**
   * @param {Found} found
   * @returns {Map<Mark, Point>}
   */
  held({ vertex, mark }) {
    if (!vertex || mark === undefined) return new Map();
    return new Map([[mark, this.loops[vertex.loop][vertex.index]]]);
  }

  /** @param {Found | null} found */
  pans(found) {
    return !found?.vertex && !this.painting;
  }

  /** @param {Found | null} found */
  cursor(found) {
    if (this.tool === "component") return "pointer";
    if (this.tool !== "edit") return "crosshair";
    if (found?.vertex) return "grab";
    if (found?.edge) return "copy";
    return found?.hole === undefined ? "default" : "pointer";
  }

  // Drawing

  /** @param {Pen} pen */
  #draw(pen) {
    const { shown, pad, view } = this;
    if (!shown || !view.width) return;
    this.colors ??= this.#readColors();
    const below = pad.mode === "pan" ? null : pad.found;
    const hover = this.#listed ?? below;
    if (shown.size) drawStage(pen, this, this.#scene(shown, this.colors), hover);
    const [left, top] = view.toScreen([0, 0]);
    // For tests and assistive tools.
    this.element.dataset.viewport = `${1 / view.unit} ${left} ${top}`;
    this.#placeCallout(shown);
    this.hintText.textContent = shown.size ? this.#hint(hover) : "";
  }

  /**
   * @param {Shown} shown
   * @param {Record<string, string>} colors
   */
  #scene(shown, colors) {
    return { shown, colors, loops: this.loops.map((loop) => this.view.line(loop)) };
  }

  /** The outline that is being drawn, as far as it goes. */
  drawn() {
    const { path, rests } = this.pad;
    const inside = this.shown?.inside ?? [];
    if (inside.length) return [...inside, inside[0]];
    const now = rests ? [this.view.toWorld(rests)] : [];
    if (this.tool === "polygon") {
      const corners = this.shown?.corners ?? [];
      return corners.concat(path.length ? path : now);
    }
    if (!path.length || !now.length) return [];
    return [...rectangle(path[0], now[0]), path[0]];
  }

  /** @param {Found | null} hover */
  #hint(hover) {
    const hole = hover?.hole === undefined ? undefined : this.shown?.holes[hover.hole];
    if (hole) return hole.kept ? "Click to drop this hole" : "Click to keep this hole";
    if (hover?.edge) return "Double-click to add a vertex here";
    if (hover?.vertex) return "Drag to move · right-click or Delete to delete";
    return TOOLS[this.tool].hint;
  }

  #readColors() {
    const probe = this.root.appendChild(make("span"));
    // Colours that the system forces are opaque: the veil would hide what lies below it.
    probe.style.setProperty("forced-color-adjust", "none");
    const color = (/** @type {string} */ name) => {
      probe.style.color = `var(--glid-${name})`;
      return getComputedStyle(probe).color;
    };
    const colors = Object.fromEntries(COLORS.map((name) => [name, color(name)]));
    probe.remove();
    return colors;
  }

  /**
   * The first problem's message, beside its place.
   *
   * @param {Shown} shown
   */
  #placeCallout(shown) {
    const { callout, view } = this;
    const problem = shown.problems[0];
    callout.hidden = !problem || this.pad.mode === "pan";
    if (!problem) return;
    callout.textContent = problem.message;
    const { offsetWidth: w, offsetHeight: h } = callout;
    const [x, y] = problem.point ? view.toScreen(problem.point) : [view.width / 2, -16];
    const fitsBelow = !problem.point || y + CALLOUT + h <= view.height;
    const beside = fitsBelow ? y + CALLOUT : y - CALLOUT - h;
    const left = Math.min(Math.max(x - w / 2, EDGE), view.width - w - EDGE);
    const top = Math.min(Math.max(beside, EDGE), view.height - h - EDGE);
    callout.style.transform = `translate(${left}px, ${top}px)`;
  }
}
