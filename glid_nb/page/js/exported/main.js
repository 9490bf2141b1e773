// Shows pictures under maps, or plays their motions, from the data in the page.

import { proofStrip } from "../motion/strip.js";
import { make } from "../pad/dom.js";
import { View } from "../pad/view.js";
import { around, viewOn } from "./boxes.js";
import { glideTo, playedFrom } from "./course.js";
import { Layers } from "./layers.js";
import { down, provedNow, sigma2At, up } from "./numbers.js";
import { Poses } from "./poses.js";
import { CannotShow } from "./renderer.js";
import { Shape } from "./shape.js";

/** @import { Point } from "../types.js" */
/** @import { Course } from "./course.js" */
/** @import { PageData } from "./data.js" */

/** @type {Record<string, string>} what the colours say, by the number in picture.frag */
const LABELS = { 2: "Stretch σ₁", 3: "Stretch σ₂", 4: "Dilatation k" };
const LOWER = "3"; // the one whose bound is a lower one
const PLAIN = "0"; // the picture alone
const STEP = 1 / 25; // s, of the arrow keys
const FAST = 5; // times as far with Shift
const THUMBNAIL = 56; // CSS pixels

/**
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} kind
 */
function byId(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${id}`);
  return found;
}

class Page {
  overlay = byId("overlay", HTMLSelectElement);
  undeformed = byId("source", HTMLInputElement);
  slider = byId("time", HTMLInputElement);
  play = byId("play", HTMLButtonElement);
  clock = byId("clock", HTMLOutputElement);
  here = byId("here", HTMLOutputElement);
  view = new View(() => this.draw(), { nearest: 1e-4, farthest: 100 });

  /** @type {(Course & { began: number }) | null} */
  #course = null;
  #due = 0;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {PageData} data
   * @param {Layers} layers
   * @param {Shape[]} shapes the rearmost first; their motions have the same start, end and poses
   */
  constructor(canvas, data, layers, shapes) {
    this.canvas = canvas;
    this.data = data;
    this.layers = layers;
    this.shapes = shapes;
    this.motion = shapes[0].motion;
    this.keyframes = shapes[0].proof.keyframes;
    this.bounds = around(data.parts.map(({ bounds }) => bounds));
    this.sourceBounds = around(data.parts.map(({ source_bounds }) => source_bounds));
    this.time = this.motion.start;
    this.poses = new Poses(
      this.keyframes,
      (time) => this.#run(glideTo(this.motion, this.time, time)),
      (time) => this.#thumbnail(time),
      () => !this.#course && this.draw(),
    );
    this.#hearPointers();
    this.#showColors();
  }

  begin() {
    if (this.keyframes.length) this.#prepareMotion();
    new ResizeObserver(() => this.fit()).observe(this.canvas);
    this.fit();
    document.documentElement.dataset.ready = "true";
  }

  fit() {
    const { clientWidth, clientHeight } = this.canvas;
    const bounds = this.undeformed.checked ? this.sourceBounds : this.bounds;
    Object.assign(this.view, viewOn(bounds, clientWidth, clientHeight, this.data.margin));
    this.draw();
  }

  draw() {
    this.poses.drawOne();
    const { width, height, unit, x, y } = this.view;
    const states = this.shapes.map((one) => one.at(this.time, this.undeformed.checked));
    this.layers.draw({ width, height, unit, x, y, overlay: this.overlay.value }, states);
  }

  /** @param {number} time */
  #thumbnail(time) {
    const view = viewOn(this.bounds, THUMBNAIL, THUMBNAIL, this.data.margin);
    const states = this.shapes.map((one) => one.at(time));
    this.layers.draw({ ...view, overlay: PLAIN }, states);
    return this.canvas;
  }

  #hearPointers() {
    const { canvas, view } = this;
    const place = (/** @type {MouseEvent} */ e) => /** @type {Point} */ ([e.offsetX, e.offsetY]);
    /** @type {Map<number, Point>} */
    const pointers = new Map();
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      pointers.set(e.pointerId, place(e));
    });
    canvas.addEventListener("pointermove", (e) => {
      if (pointers.has(e.pointerId)) view.follow(pointers, e.pointerId, place(e));
    });
    canvas.addEventListener("lostpointercapture", (e) => pointers.delete(e.pointerId));
    canvas.addEventListener("wheel", (e) => view.wheel(e, place(e)), { passive: false });
    byId("fit", HTMLButtonElement).addEventListener("click", () => this.fit());
    this.undeformed.addEventListener("change", () => this.fit());
  }

  /** @param {number} stop of the colour map */
  #css(stop) {
    const color = this.data.colors.slice(3 * stop, 3 * stop + 3);
    return `rgb(${color.map((share) => Math.round(255 * share))})`;
  }

  get #stops() {
    return this.data.colors.length / 3;
  }

  // Colours for the distortion, from an isometry's value to the certified bound, or a tenth off.
  #showColors() {
    const colors = Array.from({ length: this.#stops }, (_, i) => this.#css(i));
    document.documentElement.style.setProperty("--colors", colors.join());
    for (const value of Object.keys(this.data.ranges)) {
      this.overlay.append(new Option(LABELS[value], value));
    }
    this.overlay.addEventListener("change", () => {
      this.draw();
      this.#showLegend();
    });
  }

  #showLegend() {
    const { value } = this.overlay;
    const range = this.data.ranges[value];
    const legend = byId("legend", HTMLParagraphElement);
    legend.hidden = !range;
    if (!range) return;
    const end = value === LOWER ? down(range[1]) : up(range[1]);
    legend.replaceChildren(`${LABELS[value]} ${range[0]}`, make("i"), end);
  }

  #prepareMotion() {
    const { motion, slider } = this;
    const section = document.querySelector("section");
    if (section) section.hidden = false;
    slider.min = String(motion.start);
    slider.max = String(motion.end);
    byId("poses", HTMLDivElement).append(...this.poses.buttons);
    const boundAt = (/** @type {number} */ time) => sigma2At(this.#provedAt(time), time);
    const background = proofStrip(motion, boundAt);
    byId("strip", HTMLDivElement).style.background = background;
    this.play.addEventListener("click", () => this.#playOrPause());
    slider.addEventListener("input", () => this.#goTo(Number(slider.value)));
    document.addEventListener("keydown", (e) => this.#keydown(e));
    this.#seek(motion.start);
    this.#run(null);
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (this.data.loop && !still) this.#playOrPause();
  }

  /** @param {KeyboardEvent} e */
  #keydown(e) {
    const target = /** @type {HTMLElement} */ (e.target);
    if (e.ctrlKey || e.metaKey || e.altKey || target.tagName === "SELECT") return;
    if (e.key === " ") {
      if (target.matches("button, input[type=checkbox]")) return;
      e.preventDefault();
      this.#playOrPause();
      return;
    }
    const to = this.#timeOf(e);
    if (to === null) return;
    e.preventDefault();
    this.#goTo(Math.min(Math.max(to, this.motion.start), this.motion.end));
  }

  /**
   * The time that a key leads to; null for none.
   *
   * @param {KeyboardEvent} e
   */
  #timeOf(e) {
    const step = e.shiftKey ? FAST * STEP : STEP;
    if (e.key === "ArrowLeft") return this.time - step;
    if (e.key === "ArrowRight") return this.time + step;
    if (e.key === "Home") return this.motion.start;
    return e.key === "End" ? this.motion.end : null;
  }

  /** @param {number} time */
  #goTo(time) {
    this.#run(null);
    this.#seek(time);
  }

  /** @param {number} time */
  #seek(time) {
    const { motion } = this;
    this.time = time === motion.end ? time : motion.within(time);
    this.slider.value = String(this.time);
    this.clock.textContent = `${this.time.toFixed(2)} / ${motion.end.toFixed(2)} s`;
    this.here.textContent = provedNow(this.#provedAt(this.time), this.time);
    this.poses.mark(motion.within(this.time));
    this.draw();
  }

  /**
   * The proofs of all shapes, and the pieces with a time.
   *
   * @param {number} time
   */
  #provedAt(time) {
    return this.shapes.map(({ proof, motion }) => ({ proof, piece: motion.place(time).piece }));
  }

  /** @param {Course | null} course null pauses */
  #run(course) {
    cancelAnimationFrame(this.#due);
    this.#course = course && { ...course, began: performance.now() };
    if (course) this.#due = requestAnimationFrame((now) => this.#tick(now));
    this.play.textContent = course?.plays ? "❚❚" : "▶";
    this.play.setAttribute("aria-label", course?.plays ? "Pause" : "Play");
  }

  /** @param {number} now */
  #tick(now) {
    if (!this.#course) return;
    const { began, lasts, at } = this.#course;
    const passed = Math.min(Math.max(now - began, 0), lasts);
    this.#seek(at(passed));
    if (passed === lasts) this.#run(null);
    else this.#due = requestAnimationFrame((next) => this.#tick(next));
  }

  #playOrPause() {
    const playing = this.#course?.plays;
    this.#run(playing ? null : playedFrom(this.motion, this.time, this.data.loop));
  }
}

/** @param {string} message */
function fail(message) {
  const problem = byId("problem", HTMLParagraphElement);
  problem.textContent = message;
  problem.hidden = false;
}

async function show() {
  /** @type {PageData} */
  const data = JSON.parse(byId("data", HTMLScriptElement).text);
  const canvas = document.querySelector("canvas");
  /** @type {WebGLContextAttributes} */
  const options = { antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true };
  const gl = canvas?.getContext("webgl2", options);
  if (!canvas || !gl || !window.DecompressionStream) {
    throw new CannotShow("This page needs WebGL 2 and a browser of 2023 or later.");
  }
  const shapes = await Promise.all(data.parts.map(Shape.loaded));
  new Page(canvas, data, new Layers(canvas, gl, data, shapes), shapes).begin();
}

show().catch((error) => {
  fail(error.message);
  if (!(error instanceof CannotShow)) throw error; // for the console
});
