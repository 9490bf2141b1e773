// The picture with the cage over it: what is under the pointer, and what the hand does with it.

import { make } from "./dom.js";
import { drawStage } from "./draw.js";
import { holeAt, nearestEdge, nearestVertex } from "./hit.js";
import { Viewport } from "./viewport.js";

const REACH = { mouse: 9, pen: 12, touch: 18 }; // CSS pixels around the pointer
const CLICK = 4; // CSS pixels that a click may move
const DOUBLE = 380; // ms between the clicks of a double click
const BURST = 900; // ms without a key that end a burst of nudges
const COLORS = ["accent", "accentSoft", "warn", "warnSoft", "faint", "veil", "foreground", "background", "checkLight", "checkDark"];
const HINTS = {
  edit: "Drag a vertex · double-click an edge to add one · right-click a vertex to delete it · click a hole to drop it",
  foreground: "Paint over the shape",
  background: "Paint over what is around the shape",
  color: "Click a pixel that shows the background's colour",
  component: "Click the part of the picture to trace",
};

export class Stage {
  // act: the actions of the kernel, see main.js. onTool(name): the tool has changed.
  constructor(root, act, onTool) {
    this.root = root;
    this.act = act;
    this.onTool = onTool;
    this.viewport = new Viewport();
    this.canvas = make("canvas", { className: "glid-canvas", tabIndex: 0, role: "application", "aria-label": "Picture and cage" });
    this.callout = make("div", { className: "glid-callout", role: "alert", hidden: true });
    this.hintText = make("div", { className: "glid-hint" });
    this.drop = make("div", { className: "glid-drop", hidden: true }, "Drop a picture here");
    this.empty = make("div", { className: "glid-empty" }, make("p", {}, "Drop a picture here, or open one from a file."));
    this.element = make("div", { className: "glid-stage" }, this.canvas, this.empty, this.callout, this.hintText, this.drop);
    this.shown = null;
    this.bitmap = null;
    this.tool = "edit";
    this.hover = null;
    this.selected = new Set();
    this.moved = null; // a vertex that the kernel has not confirmed yet: {loop, index, to}
    this.drag = null;
    this.pointers = new Map();
    this.rests = null; // where the pointer is
    this.lastClick = { time: -Infinity, at: [0, 0] };
    this.listen();
    this.resizer = new ResizeObserver(() => this.resize());
    this.resizer.observe(this.element);
    // JupyterLab changes its theme by attributes of the body.
    this.themes = new MutationObserver(() => this.redraw(true));
    this.themes.observe(document.body, { attributes: true });
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.themeChanged = () => this.redraw(true);
    this.dark.addEventListener("change", this.themeChanged);
  }

  close() {
    this.resizer.disconnect();
    this.themes.disconnect();
    this.dark.removeEventListener("change", this.themeChanged);
    cancelAnimationFrame(this.frame);
    this.bitmap?.close();
  }

  // The state from the kernel.
  update(shown) {
    const before = this.shown?.size;
    this.shown = shown;
    this.empty.hidden = Boolean(shown.size);
    if (shown.size && String(before) !== String(shown.size)) this.fit();
    for (const key of this.selected) {
      const [loop, index] = key.split(":").map(Number);
      if (!shown.loops[loop]?.[index]) this.selected.delete(key);
    }
    // What lies under the pointer may have become something else.
    if (!this.drag) this.setHover(this.rests && this.tool === "edit" && shown.size ? this.find(this.rests) : null);
    this.redraw();
  }

  async setPicture(bytes) {
    const turn = (this.turn = (this.turn ?? 0) + 1);
    const bitmap = bytes?.byteLength ? await createImageBitmap(new Blob([bytes])) : null;
    if (turn !== this.turn) return bitmap?.close(); // another one came meanwhile
    this.bitmap?.close();
    this.bitmap = bitmap;
    this.redraw();
  }

  setTool(tool) {
    this.tool = tool;
    this.setHover(null);
    this.cursor();
    this.redraw();
    this.onTool(tool);
  }

  highlightHole(index) {
    this.hover = index === null ? null : { hole: index };
    this.redraw();
  }

  fit() {
    if (!this.shown?.size) return;
    this.viewport.fit(this.shown.size, this.element.clientWidth, this.element.clientHeight);
    this.redraw();
  }

  zoom(factor) {
    this.viewport.zoom(factor, [this.element.clientWidth / 2, this.element.clientHeight / 2]);
    this.redraw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    const first = !this.width;
    this.viewport.pan((width - (this.width ?? width)) / 2, (height - (this.height ?? height)) / 2);
    this.width = width;
    this.height = height;
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    if (first) this.fit();
    this.redraw();
  }

  get loops() {
    const loops = this.shown?.loops ?? [];
    if (!this.moved || !loops[this.moved.loop]) return loops;
    const { loop, index, to } = this.moved;
    return loops.map((vertices, i) => (i === loop ? vertices.with(index, to) : vertices));
  }

  // Drawing, at most once per frame.

  redraw(colors = false) {
    if (colors) this.colors = null;
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.draw();
    });
  }

  draw() {
    if (!this.shown || !this.width) return;
    this.colors ??= this.readColors();
    const painting = this.tool === "foreground" || this.tool === "background";
    drawStage(this.canvas.getContext("2d"), {
      width: this.width,
      height: this.height,
      ratio: this.canvas.width / this.width,
      viewport: this.viewport,
      colors: this.colors,
      size: this.shown.size,
      bitmap: this.bitmap,
      loops: this.loops,
      holes: this.shown.holes,
      problems: this.shown.problems,
      strokes: this.shown.strokes,
      stroke: this.drag?.kind === "stroke" ? this.drag : this.painted,
      showStrokes: painting || this.shown.options.method === "scribbles",
      showVertices: !painting,
      veil: !painting,
      hover: this.hover,
      selected: this.selected,
    });
    const { scale, x, y } = this.viewport;
    this.element.dataset.viewport = `${scale} ${x} ${y}`; // for tests and assistive tools
    this.placeCallout();
    this.hintText.textContent = this.shown.size ? (this.hint ?? HINTS[this.tool]) : "";
  }

  readColors() {
    const style = getComputedStyle(this.root);
    const dashed = (name) => name.replace(/[A-Z]/g, (c) => `-${c.toLowerCase()}`);
    return Object.fromEntries(COLORS.map((name) => [name, style.getPropertyValue(`--glid-${dashed(name)}`).trim()]));
  }

  // What is wrong, beside the place where it is.
  placeCallout() {
    const problem = this.shown.problems[0];
    this.callout.hidden = !problem || this.drag?.kind === "pan";
    if (!problem) return;
    this.callout.textContent = problem.message;
    const at = problem.point ? this.viewport.toStage(problem.point) : [this.width / 2, -16];
    const { offsetWidth: w, offsetHeight: h } = this.callout;
    const below = problem.point && at[1] + 24 + h > this.height ? at[1] - 24 - h : at[1] + 24;
    const left = Math.min(Math.max(at[0] - w / 2, 8), this.width - w - 8);
    const top = Math.min(Math.max(below, 8), this.height - h - 8);
    this.callout.style.transform = `translate(${left}px, ${top}px)`;
  }

  cursor() {
    const cursors = { edit: "default", foreground: "crosshair", background: "crosshair", color: "crosshair", component: "pointer" };
    let name = cursors[this.tool];
    if (this.tool === "edit" && this.hover?.vertex) name = "grab";
    else if (this.tool === "edit" && this.hover?.edge) name = "copy";
    else if (this.tool === "edit" && this.hover?.hole !== undefined) name = "pointer";
    if (this.drag?.kind === "vertex") name = "grabbing";
    if (this.drag?.kind === "pan" || this.space) name = "move";
    this.canvas.style.cursor = name;
  }

  // Pointer

  listen() {
    const on = (name, handler, options) => this.canvas.addEventListener(name, handler, options);
    on("pointerdown", (e) => this.down(e));
    on("pointermove", (e) => this.move(e));
    on("pointerup", (e) => this.up(e));
    on("pointercancel", (e) => this.cancel(e));
    on("lostpointercapture", (e) => this.pointers.has(e.pointerId) && this.cancel(e));
    on("pointerleave", () => {
      this.rests = null;
      this.setHover(null);
    });
    // The right button deletes a vertex; neither the browser's nor JupyterLab's menu may open.
    on("contextmenu", (e) => {
      e.preventDefault();
      e.stopPropagation();
    });
    on("keydown", (e) => this.key(e));
    on("keyup", (e) => {
      if (e.key === " ") this.space = false;
      this.cursor();
    });
    on("blur", () => (this.space = false));
    on(
      "wheel",
      (e) => {
        // Without focus the page scrolls on past the picture.
        if (!e.ctrlKey && this.canvas.getRootNode().activeElement !== this.canvas) return;
        e.preventDefault();
        this.viewport.zoom(Math.exp(-e.deltaY * (e.ctrlKey ? 0.01 : 0.0015)), this.position(e));
        this.redraw();
      },
      { passive: false },
    );
    const stop = (e) => {
      e.preventDefault();
      e.stopPropagation();
    };
    for (const name of ["dragenter", "dragover"]) {
      this.element.addEventListener(name, (e) => {
        stop(e);
        this.drop.hidden = false;
      });
    }
    this.element.addEventListener("dragleave", (e) => {
      if (!this.element.contains(e.relatedTarget)) this.drop.hidden = true;
    });
    this.element.addEventListener("drop", (e) => {
      stop(e);
      this.drop.hidden = true;
      const file = e.dataTransfer.files[0];
      if (file) this.act.upload(file);
    });
  }

  position(e) {
    const box = this.canvas.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  find(position, type = "mouse") {
    const point = this.viewport.toPicture(position);
    const hole = holeAt(this.shown.holes, point);
    // In a small hole nothing is far from the loop around it; the middle stays the hole's.
    const reach = ((REACH[type] ?? REACH.mouse) * (hole < 0 ? 1 : 0.6)) / this.viewport.scale;
    const vertex = nearestVertex(this.loops, point, reach);
    if (vertex) return { vertex };
    const edge = nearestEdge(this.loops, point, reach * 0.8);
    if (edge) return { edge };
    return hole < 0 ? null : { hole };
  }

  down(e) {
    if (!this.shown?.size) return;
    this.canvas.focus({ preventScroll: true });
    e.preventDefault();
    const position = this.position(e);
    this.pointers.set(e.pointerId, position);
    this.canvas.setPointerCapture(e.pointerId);
    if (this.pointers.size === 2) return this.beginPinch();
    if (this.pointers.size > 2 || this.drag) return;
    const point = this.viewport.toPicture(position);
    const start = { start: position, last: position, type: e.pointerType };
    if (e.button === 1 || (this.space && e.button === 0)) {
      this.drag = { kind: "pan", ...start };
    } else if (e.button === 2) {
      const { vertex } = this.find(position, e.pointerType) ?? {};
      if (vertex && this.tool === "edit") this.deleteVertices([[vertex.loop, vertex.index]]);
    } else if (e.button !== 0) {
      return;
    } else if (this.tool === "foreground" || this.tool === "background") {
      this.drag = { kind: "stroke", brush: this.tool, points: [point], ...start };
    } else if (this.tool === "edit") {
      const found = this.find(position, e.pointerType);
      if (found?.vertex) this.grab(found.vertex, e.shiftKey, start, point);
      else this.drag = { kind: "pan", click: found, ...start };
    } else {
      this.drag = { kind: "pan", pick: this.tool, ...start };
    }
    this.cursor();
    this.redraw();
  }

  grab({ loop, index }, extend, start, point) {
    const key = `${loop}:${index}`;
    if (extend && this.selected.delete(key)) return;
    if (!extend) this.selected.clear();
    this.selected.add(key);
    const from = this.loops[loop][index];
    const offset = [from[0] - point[0], from[1] - point[1]];
    this.drag = { kind: "vertex", loop, index, from, offset, gesture: this.act.gesture(), ...start };
  }

  move(e) {
    const position = this.position(e);
    const { drag } = this;
    this.rests = e.pointerType === "touch" ? null : position;
    if (this.pointers.has(e.pointerId)) this.pointers.set(e.pointerId, position);
    if (drag?.kind === "pinch") return this.pinch();
    if (!drag) {
      if (e.pointerType !== "touch") this.setHover(this.shown?.size && this.tool === "edit" ? this.find(position) : null);
      return;
    }
    if (!this.pointers.has(e.pointerId)) return;
    const [dx, dy] = [position[0] - drag.last[0], position[1] - drag.last[1]];
    const far = Math.hypot(position[0] - drag.start[0], position[1] - drag.start[1]) > CLICK;
    drag.moved ||= far;
    if (!drag.moved) return;
    drag.last = position;
    const point = this.viewport.toPicture(position);
    if (drag.kind === "pan") {
      this.viewport.pan(dx, dy);
    } else if (drag.kind === "stroke") {
      const last = drag.points.at(-1);
      if (Math.hypot(point[0] - last[0], point[1] - last[1]) * this.viewport.scale >= 3) drag.points.push(point);
    } else if (drag.kind === "vertex") {
      this.moveVertex(drag, [point[0] + drag.offset[0], point[1] + drag.offset[1]]);
    }
    this.cursor();
    this.redraw();
  }

  moveVertex({ loop, index, gesture }, to) {
    this.moved = { loop, index, to };
    this.act.moveVertex(loop, index, to, gesture, () => {
      if (!this.drag) this.moved = null; // what the kernel says counts from here on
      this.redraw();
    });
  }

  up(e) {
    const position = this.position(e);
    this.pointers.delete(e.pointerId);
    const { drag } = this;
    if (!drag || (drag.kind === "pinch" && this.pointers.size)) return;
    this.drag = null;
    if (drag.kind === "stroke") {
      this.painted = drag; // shown until the kernel has it
      this.act.paint(drag.brush, drag.points, () => {
        if (this.painted === drag) this.painted = null;
        this.redraw();
      });
    } else if (drag.kind === "vertex" && this.act.idle) {
      this.moved = null;
    } else if (drag.kind === "pan" && !drag.moved) {
      this.click(position, drag);
    }
    this.cursor();
    this.redraw();
  }

  click(position, drag) {
    const point = this.viewport.toPicture(position);
    if (drag.pick) {
      this.act.pick(drag.pick, point);
      return this.setTool("edit");
    }
    const { time, at } = this.lastClick;
    const now = performance.now();
    const double = now - time < DOUBLE && Math.hypot(position[0] - at[0], position[1] - at[1]) < 3 * CLICK;
    this.lastClick = { time: double ? -Infinity : now, at: position };
    const { click } = drag;
    if (click?.edge) {
      if (double) this.act.insertVertex(point);
    } else if (click?.hole !== undefined) {
      this.act.toggleHole(click.hole);
    } else {
      this.selected.clear();
    }
  }

  cancel(e) {
    this.pointers.delete(e.pointerId);
    this.abandon();
  }

  // End what is under way as if it had not begun.
  abandon() {
    const { drag } = this;
    this.drag = null;
    if (drag?.kind === "vertex" && drag.moved) {
      this.act.undo(() => {
        this.moved = null;
        this.redraw();
      });
    }
    this.cursor();
    this.redraw();
  }

  beginPinch() {
    this.abandon();
    this.drag = { kind: "pinch", ...this.twoPointers() };
  }

  twoPointers() {
    const [a, b] = [...this.pointers.values()];
    return {
      centre: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2],
      apart: Math.max(Math.hypot(a[0] - b[0], a[1] - b[1]), 1),
    };
  }

  pinch() {
    if (this.pointers.size < 2) return;
    const { centre, apart } = this.drag;
    Object.assign(this.drag, this.twoPointers());
    this.viewport.pan(this.drag.centre[0] - centre[0], this.drag.centre[1] - centre[1]);
    this.viewport.zoom(this.drag.apart / apart, this.drag.centre);
    this.redraw();
  }

  setHover(hover) {
    this.hover = hover;
    const hole = this.shown?.holes[hover?.hole];
    if (hole) this.hint = hole.kept ? "Click to drop this hole" : "Click to keep this hole";
    else if (hover?.edge) this.hint = "Double-click to add a vertex here";
    else if (hover?.vertex) this.hint = "Drag to move · right-click or Delete to delete";
    else this.hint = null;
    this.cursor();
    this.redraw();
  }

  // Keyboard

  key(e) {
    const tools = { v: "edit", b: "foreground", n: "background", i: "color", c: "component" };
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    if (e.ctrlKey || e.metaKey || e.altKey || !this.shown?.size) return;
    const chosen = [...this.selected].map((key) => key.split(":").map(Number));
    if (e.key === " ") {
      this.space = true;
      this.cursor();
    } else if (e.key === "Escape") {
      if (this.drag) this.abandon();
      else if (this.tool !== "edit") this.setTool("edit");
      else this.selected.clear();
      this.redraw();
    } else if (e.key === "Delete" || e.key === "Backspace") {
      if (chosen.length) this.deleteVertices(chosen);
    } else if (arrows[e.key] && chosen.length === 1) {
      this.nudge(chosen[0], arrows[e.key], e.shiftKey ? 10 : 1);
    } else if (e.key === "]" || e.key === "[") {
      this.selectNext(chosen.at(-1), e.key === "]" ? 1 : -1);
    } else if (e.key === "+" || e.key === "=") this.zoom(1.25);
    else if (e.key === "-") this.zoom(0.8);
    else if (e.key.toLowerCase() === "f") this.fit();
    else if (tools[e.key.toLowerCase()]) this.setTool(tools[e.key.toLowerCase()]);
    else return;
    e.preventDefault();
    e.stopPropagation();
  }

  nudge([loop, index], [dx, dy], step) {
    const now = performance.now();
    if (!(now - (this.nudged?.time ?? -Infinity) < BURST)) this.nudged = { gesture: this.act.gesture() };
    this.nudged.time = now;
    const [x, y] = this.loops[loop][index];
    this.moveVertex({ loop, index, gesture: this.nudged.gesture }, [x + dx * step, y + dy * step]);
    this.redraw();
  }

  selectNext(current, step) {
    const all = this.loops.flatMap((loop, i) => loop.map((_, j) => `${i}:${j}`));
    if (!all.length) return;
    const at = current ? all.indexOf(current.join(":")) : step > 0 ? -1 : 0;
    this.selected = new Set([all[(at + step + all.length) % all.length]]);
    this.redraw();
  }

  deleteVertices(vertices) {
    this.selected.clear();
    this.hover = null;
    this.act.deleteVertices(vertices);
  }
}
