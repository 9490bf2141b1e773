// The picture with the cage over it: what is below the pointer, and what is drawn.

import { make } from "../pad/dom.js";
import { holeAt, nearestEdge, nearestVertex } from "../pad/hit.js";
import { Pad } from "../pad/pad.js";
import { clearedContext } from "../pad/pen.js";
import { View } from "../pad/view.js";
import { drawStage } from "./draw.js";

const REACH = { mouse: 9, pen: 12, touch: 18 }; // CSS pixels around the pointer
const ZOOM = 1.25; // by a button or a key
const MARGIN = 24; // CSS pixels around a picture that fits
const MOST_ZOOM = 40; // CSS pixels per pixel of the picture
const COLORS = ["accent", "accentSoft", "warn", "warnSoft", "faint", "veil", "foreground", "background", "checkLight", "checkDark"];
const HINTS = {
  edit: "Drag a vertex · double-click an edge to add one · right-click a vertex to delete it · click a hole to drop it",
  foreground: "Paint over the shape",
  background: "Paint over what is around the shape",
  color: "Click a pixel that shows the background's colour",
  component: "Click the part of the picture to trace",
  polygon: "Click corner after corner, or draw around the shape · double-click or Enter closes it · Esc starts anew",
  rectangle: "Drag a rectangle over the shape",
};
const KEYS = new Set([
  "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Delete", "Backspace", "Escape", "Enter", "[", "]",
  ..."vbnicprVBNICPR",
]);

export class Stage {
  // root defines the colours as CSS variables; upload(file) takes a dropped picture.
  constructor(root, link, upload) {
    this.root = root;
    this.link = link;
    this.canvas = make("canvas", { className: "glid-canvas", role: "application", "aria-label": "Picture and cage" });
    this.callout = make("div", { className: "glid-callout", role: "alert", hidden: true });
    this.hintText = make("div", { className: "glid-hint" });
    this.drop = make("div", { className: "glid-drop", hidden: true }, "Drop a picture here");
    this.empty = make("div", { className: "glid-empty" }, make("p", {}, "Drop a picture here, or open one from a file."));
    this.element = make("div", { className: "glid-stage" }, this.canvas, this.empty, this.callout, this.hintText, this.drop);
    this.shown = this.bitmap = null;
    this.tool = "edit";
    this.changed = () => this.redraw();
    this.listed = null; // the hole below the pointer in the list
    this.fitted = true; // until a hand moves the view
    this.view = new View(() => {
      this.fitted = false;
      this.redraw();
    }, { up: -1, nearest: 1 / MOST_ZOOM, farthest: 1e3 });
    this.pad = new Pad(this.canvas, this.view, link, this);
    this.takeFiles(upload);
    this.resizer = new ResizeObserver(() => this.resize());
    this.resizer.observe(this.element);
    // JupyterLab changes its theme by attributes of the body.
    this.themeChanged = () => this.redraw(true);
    this.themes = new MutationObserver(this.themeChanged);
    this.themes.observe(document.body, { attributes: true });
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", this.themeChanged);
  }

  close() {
    this.pad.close();
    this.resizer.disconnect();
    this.themes.disconnect();
    this.dark.removeEventListener("change", this.themeChanged);
    cancelAnimationFrame(this.frame);
    this.turn = null; // a picture that is still decoded comes too late
    this.bitmap = this.bitmap?.close(); // none: a redraw may still come
  }

  takeFiles(upload) {
    const on = (name, act) => this.element.addEventListener(name, (e) => {
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
    this.redraw();
  }

  setTool(tool) {
    this.tool = tool;
    this.pad.hover();
  }

  highlightHole(index) {
    this.listed = index === null ? null : { hole: index };
    this.redraw();
  }

  fit() {
    const { view, element } = this;
    if (!this.shown?.size) return;
    const [w, h] = this.shown.size;
    const room = [element.clientWidth, element.clientHeight].map((n) => Math.max(n - 2 * MARGIN, 1));
    const unit = Math.min(Math.max(w / room[0], h / room[1]), 1e3);
    Object.assign(view, { x: w / 2, y: h / 2, unit, farthest: 4 * unit });
    this.fitted = true;
    this.redraw();
  }

  zoom(closer) {
    this.view.zoom(closer ? 1 / ZOOM : ZOOM);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    if (this.fitted) this.fit();
    Object.assign(this, { width, height });
    Object.assign(this.view, { width, height });
    this.redraw();
  }

  // The loops, with vertices that are dragged where the pointer is.
  get loops() {
    const loops = this.shown?.loops ?? [];
    if (!this.pad.held.size) return loops;
    return loops.map((loop, i) => loop.map((point, j) => this.pad.held.get(`${i}:${j}`) ?? point));
  }

  get painting() {
    return this.tool === "foreground" || this.tool === "background" || this.drawing;
  }

  get drawing() {
    return this.tool === "polygon" || this.tool === "rectangle";
  }

  // The pad's options

  reach = REACH;
  keys = KEYS;
  wheelNeedsFocus = true;
  actions = {
    "+": () => this.zoom(true), "=": () => this.zoom(true), "-": () => this.zoom(false),
    f: () => this.fit(), F: () => this.fit(),
  };

  find(point, reach) {
    if (this.tool !== "edit" || !this.shown?.size) return null;
    const { holes, reach_shares: shares } = this.shown, hole = holeAt(holes, point);
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
    return found?.vertex ? "grab" : found?.edge ? "copy" : found?.hole !== undefined ? "pointer" : "default";
  }

  // Drawing, at most once per frame.

  redraw(colors = false) {
    if (colors) this.colors = null;
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      if (this.shown && this.width) this.draw();
    });
  }

  draw() {
    this.colors ??= this.readColors();
    const { shown, painting, pad, view } = this;
    const hover = this.listed ?? (pad.mode === "pan" ? null : pad.found);
    drawStage(clearedContext(this.canvas, this), {
      view,
      colors: this.colors,
      ...shown,
      bitmap: this.bitmap,
      loops: this.loops,
      stroke: painting && !this.drawing && pad.path.length ? { brush: this.tool, points: pad.path } : null,
      drawing: this.drawing,
      outline: this.drawing ? this.drawn() : [],
      showStrokes: (painting && !this.drawing) || shown.options.method === "scribbles",
      showVertices: !painting,
      hover,
      selected: new Set(shown.selected.map(([loop, index]) => `${loop}:${index}`)),
    });
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
    const [[[left, top]], [[right, bottom]]] = [path, now];
    return [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
  }

  hint(hover) {
    const hole = this.shown.holes[hover?.hole];
    if (hole) return hole.kept ? "Click to drop this hole" : "Click to keep this hole";
    if (hover?.edge) return "Double-click to add a vertex here";
    if (hover?.vertex) return "Drag to move · right-click or Delete to delete";
    return HINTS[this.tool];
  }

  // The theme's colours, as a canvas takes them.
  readColors() {
    const probe = this.root.appendChild(make("span"));
    const dashed = (name) => name.replace(/[A-Z]/g, (c) => `-${c.toLowerCase()}`);
    const color = (name) => {
      probe.style.color = `var(--glid-${dashed(name)})`;
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
    const at = problem.point ? this.view.toScreen(problem.point) : [this.width / 2, -16];
    const { offsetWidth: w, offsetHeight: h } = this.callout;
    const below = problem.point && at[1] + 24 + h > this.height ? at[1] - 24 - h : at[1] + 24;
    const left = Math.min(Math.max(at[0] - w / 2, 8), this.width - w - 8);
    const top = Math.min(Math.max(below, 8), this.height - h - 8);
    this.callout.style.transform = `translate(${left}px, ${top}px)`;
  }
}
