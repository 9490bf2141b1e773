// The picture with the cage over it: what is below the pointer, and what is drawn.

import { make } from "../pad/dom.js";
import { holeAt, nearestEdge, nearestVertex } from "../pad/hit.js";
import { Pad } from "../pad/pad.js";
import { painter, rectangle } from "../pad/pen.js";
import { View } from "../pad/view.js";
import { drawStage } from "./draw.js";

const REACH = { mouse: 9, pen: 12, touch: 18 }; // CSS pixels around the pointer
const ZOOM = 1.25; // by a button or a key
const MARGIN = 24;
const HINT = 8; // CSS pixels around a picture that fits, and below the hint
const MOST_ZOOM = 40; // CSS pixels per pixel of the picture
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
export const TOOLS = {
  // what their buttons say, and a hint over the picture
  edit: [
    "Edit vertices and holes (V)",
    "Drag a vertex · double-click an edge to add one · right-click a vertex to delete it · click a hole to drop it",
  ],
  foreground: ["Paint over the shape (B)", "Paint over the shape"],
  background: ["Paint over the background (N)", "Paint over what is around the shape"],
  color: ["Pick the background's colour (I)", "Click a pixel that shows the background's colour"],
  component: ["Pick the component to trace (C)", "Click the part of the picture to trace"],
  polygon: [
    "Draw the outline by hand (P)",
    "Click corner after corner, or draw around the shape · double-click or Enter closes it · Esc starts anew",
  ],
  rectangle: ["Draw a rectangle (R)", "Drag a rectangle over the shape"],
};
const KEYS = /^(Arrow\w+|Delete|Backspace|Escape|Enter|[[\]vbnicpr])$/i;

export class Stage {
  // root defines the colours as CSS variables; upload(file) takes a dropped picture.
  constructor(root, link, upload, signal) {
    this.root = root;
    this.canvas = make("canvas", {
      className: "glid-canvas",
      role: "application",
      "aria-label": "Picture and cage",
    });
    this.callout = make("div", { className: "glid-callout", role: "alert", hidden: true });
    this.hintText = make("div", { className: "glid-hint" });
    this.drop = make("div", { className: "glid-drop", hidden: true }, "Drop a picture here");
    this.empty = make(
      "div",
      { className: "glid-empty" },
      make("p", {}, "Drop a picture here, or open one from a file."),
    );
    this.element = make(
      "div",
      { className: "glid-stage" },
      this.canvas,
      this.empty,
      this.callout,
      this.hintText,
      this.drop,
    );
    this.shown = this.bitmap = null;
    this.tool = "edit";
    this.listed = null; // the hole below the pointer in the list
    this.fitted = true; // until a hand moves the view
    this.view = new View(
      () => {
        this.fitted = false;
        this.changed();
      },
      { up: -1, nearest: 1 / MOST_ZOOM, farthest: 1e3 },
    );
    this.changed = painter(this.canvas, this.view, signal, (ctx) => this.draw(ctx));
    this.pad = new Pad(this.canvas, this.view, link, this);
    this.takeFiles(upload);
    this.resizer = new ResizeObserver(() => this.resize());
    this.resizer.observe(this.element);
    // JupyterLab changes its theme by attributes of the body.
    const themeChanged = () => {
      this.colors = null;
      this.changed();
    };
    this.themes = new MutationObserver(themeChanged);
    this.themes.observe(document.body, { attributes: true });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", themeChanged, { signal });
  }

  close() {
    this.resizer.disconnect();
    this.themes.disconnect();
    this.turn = null; // a picture that is still decoded comes too late
    this.bitmap = this.bitmap?.close(); // none: a redraw may still come
  }

  takeFiles(upload) {
    const on = (name, act) =>
      this.element.addEventListener(name, (e) => {
        e.preventDefault();
        e.stopPropagation();
        act(e);
      });
    for (const name of ["dragenter", "dragover"]) on(name, () => (this.drop.hidden = false));
    on("dragleave", (e) => (this.drop.hidden ||= !this.element.contains(e.relatedTarget)));
    on("drop", (e) => {
      this.drop.hidden = true;
      const file = e.dataTransfer.files[0];
      if (file) upload(file);
    });
  }

  update(shown) {
    const before = this.shown?.size;
    this.shown = shown;
    this.empty.hidden = Boolean(shown.size);
    if (shown.size && String(before) !== String(shown.size)) this.fit();
    this.pad.hover(); // something else may lie below the pointer now
  }

  async setPicture(bytes) {
    const turn = (this.turn = (this.turn ?? 0) + 1);
    const bitmap = bytes?.byteLength ? await createImageBitmap(new Blob([bytes])) : null;
    if (turn !== this.turn) return bitmap?.close(); // a newer one has come
    this.bitmap?.close();
    this.bitmap = bitmap;
    this.changed();
  }

  setTool(tool) {
    this.tool = tool;
    this.pad.hover();
  }

  highlightHole(index) {
    this.listed = index === null ? null : { hole: index };
    this.changed();
  }

  fit() {
    const { view, element } = this;
    if (!this.shown?.size) return;
    const [w, h] = this.shown.size;
    this.hintText.textContent = this.hint(); // it takes two lines where it is narrow
    const below = Math.max(this.hintText.offsetHeight + 2 * HINT, MARGIN);
    const room = [element.clientWidth - 2 * MARGIN, element.clientHeight - MARGIN - below].map(
      (n) => Math.max(n, 1),
    );
    const unit = Math.min(Math.max(w / room[0], h / room[1]), 1e3);
    Object.assign(view, {
      x: w / 2,
      y: h / 2 + (unit * (below - MARGIN)) / 2,
      unit,
      farthest: 4 * unit,
    });
    this.fitted = true;
    this.changed();
  }

  zoom(closer) {
    this.view.zoom(closer ? 1 / ZOOM : ZOOM);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    if (this.fitted) this.fit();
    Object.assign(this.view, { width, height });
    this.changed();
  }

  // The loops, with vertices that are dragged where the pointer is.
  get loops() {
    const loops = this.shown?.loops ?? [];
    if (!this.pad.held.size) return loops;
    return loops.map((loop, i) => loop.map((point, j) => this.pad.held.get(`${i}:${j}`) ?? point));
  }

  get brushing() {
    return this.tool === "foreground" || this.tool === "background";
  }

  get drawing() {
    return this.tool === "polygon" || this.tool === "rectangle";
  }

  get painting() {
    return this.brushing || this.drawing;
  }

  // The pad's options

  reach = REACH;
  keys = KEYS;
  wheelNeedsFocus = true;
  actions = {
    "+": () => this.zoom(true),
    "=": () => this.zoom(true),
    "-": () => this.zoom(false),
    f: () => this.fit(),
  };

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

  held({ vertex: { loop, index }, mark }) {
    return new Map([[mark, this.loops[loop][index]]]);
  }

  pans(found) {
    return !found?.vertex && !this.painting;
  }

  cursor(found) {
    if (this.tool !== "edit") return this.tool === "component" ? "pointer" : "crosshair";
    return found?.vertex
      ? "grab"
      : found?.edge
        ? "copy"
        : found?.hole !== undefined
          ? "pointer"
          : "default";
  }

  // Drawing

  draw(ctx) {
    const { shown, pad, view } = this;
    if (!shown || !view.width) return;
    this.colors ??= this.readColors();
    const hover = this.listed ?? (pad.mode === "pan" ? null : pad.found);
    if (shown.size) drawStage(ctx, this, hover);
    const [left, top] = view.toScreen([0, 0]);
    this.element.dataset.viewport = `${1 / view.unit} ${left} ${top}`; // for tests and assistive tools
    this.placeCallout();
    this.hintText.textContent = shown.size ? this.hint(hover) : "";
  }

  // The outline that is being drawn, as far as it goes.
  drawn() {
    const { path, rests } = this.pad;
    const now = rests ? [this.view.toWorld(rests)] : [];
    if (this.tool === "polygon") return this.shown.corners.concat(path.length ? path : now);
    if (!path.length || !now.length) return [];
    return [...rectangle(path[0], now[0]), path[0]];
  }

  hint(hover) {
    const hole = this.shown.holes[hover?.hole];
    if (hole) return hole.kept ? "Click to drop this hole" : "Click to keep this hole";
    if (hover?.edge) return "Double-click to add a vertex here";
    if (hover?.vertex) return "Drag to move · right-click or Delete to delete";
    return TOOLS[this.tool][1];
  }

  // The theme's colours, as a canvas takes them.
  readColors() {
    const probe = this.root.appendChild(make("span"));
    const color = (name) => {
      probe.style.color = `var(--glid-${name})`;
      return getComputedStyle(probe).color;
    };
    const colors = Object.fromEntries(COLORS.map((name) => [name, color(name)]));
    probe.remove();
    return colors;
  }

  // The first problem's message, beside its place.
  placeCallout() {
    const problem = this.shown.problems[0];
    this.callout.hidden = !problem || this.pad.mode === "pan";
    if (!problem) return;
    this.callout.textContent = problem.message;
    const { width, height } = this.view;
    const { offsetWidth: w, offsetHeight: h } = this.callout;
    const [x, y] = problem.point ? this.view.toScreen(problem.point) : [width / 2, -16];
    const below = problem.point && y + 24 + h > height ? y - 24 - h : y + 24;
    const left = Math.min(Math.max(x - w / 2, 8), width - w - 8);
    const top = Math.min(Math.max(below, 8), height - h - 8);
    this.callout.style.transform = `translate(${left}px, ${top}px)`;
  }
}
