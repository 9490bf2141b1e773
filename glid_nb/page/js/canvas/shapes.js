// Puts the kernel's coefficients and the page's view into pythreejs's objects.

import { make, penOf, toFloats } from "../pad/dom.js";
import { Detail } from "./detail.js";
import { MovedShape } from "./moved_shape.js";
import { movedByPage } from "./vertices.js";

/** @import { Model, Point } from "../types.js" */
/** @import { Lead } from "./ahead.js" */
/** @import { View } from "../pad/view.js" */
/** @import { PartSeen } from "./moved_shape.js" */
/** @import { CanvasTraits, Outlined } from "./traits.js" */

/**
 * What the timeline shows instead of the pose that is edited: coefficients, or true where the kernel
 * sends the frames; null for that pose.
 *
 * @typedef {Float32Array | true | null} Seen
 */

const NEAR = 8; // pixels: a cage lies a little outside of what is drawn
const LEAD = "glid:lead"; // an event of the renderer's model
const N_TIMED = 3; // drawings, after a first one that compiles the shaders
const MOST_FRAMES = 100; // until there is a renderer to be timed

export class Shapes {
  /** @type {Seen} */
  motion = null;
  /** @type {Record<string, PartSeen>} the motions of the shapes around the edited one, by their keys */
  partMotions = {};
  /** @type {Lead | null} a map of the page's own solver, ahead of the kernel's */
  lead = null;
  /** Called when the lead has changed. */
  led = () => {};

  #edited = new MovedShape();
  /** @type {Map<string, MovedShape>} the shapes around the edited one, by their keys */
  #around = new Map();
  /** @type {any} */
  #camera = null;
  /** @type {any} */
  #renderer = null;
  #loading = 0; // counts the loads, to tell the newest
  #loaded = ""; // the references of the materials that are loaded
  #detail = new Detail(() => Object.values(this.#renderer?.views ?? {}));

  /**
   * @param {Model<CanvasTraits>} model
   * @param {View} view
   */
  constructor(model, view) {
    this.model = model;
    this.view = view;
    const loaded = "change:materials change:part_shapes change:camera change:renderer";
    model.on(loaded, () => this.load());
  }

  async load() {
    this.#loading += 1;
    const turn = this.#loading;
    const { model } = this;
    const parts = model.get("part_shapes") ?? [];
    const [[camera, renderer], materials, ...others] = await Promise.all([
      this.#models([model.get("camera"), model.get("renderer")]),
      this.#models(model.get("materials")),
      ...parts.map((part) => this.#models(part.materials)),
    ]);
    if (turn !== this.#loading) return; // there are newer ones
    this.#forget();
    this.#camera = camera;
    this.#renderer = renderer;
    this.#edited = shapeOf(model.get("outline"), materials);
    this.#around = new Map(parts.map((part, i) => [part.key, shapeOf(part, others[i])]));
    this.#loaded = this.#references;
    // When the kernel changes a uniform, pythreejs replaces them all, on the event "change".
    for (const material of this.#materials) material.on("change", this.refresh, this);
    renderer.get("scene").off("beforeRender", keepLittle).on("beforeRender", keepLittle);
    for (const view of Object.values(renderer.views)) view.then(drawNoMore);
    renderer.on(LEAD, this.#takeLead, this);
    this.refresh();
  }

  /**
   * The models of some references, once they have three.js's objects.
   *
   * @param {string[]} references
   * @returns {Promise<any[]>}
   */
  async #models(references) {
    const { widget_manager: manager } = this.model;
    const models = await Promise.all(
      references.map((one) => manager.get_model(one.replace("IPY_MODEL_", ""))),
    );
    await Promise.all(models.map((one) => one.initPromise));
    return models;
  }

  /** @type {any[]} pythreejs's models of the materials of all shapes */
  get #materials() {
    return [this.#edited, ...this.#around.values()].flatMap(({ materials }) => materials);
  }

  #forget() {
    this.#detail.restore();
    this.#renderer?.off(null, null, this);
    for (const material of this.#materials) material.off(null, null, this);
    this.#edited = new MovedShape();
    this.#around.clear();
    this.#loaded = "";
  }

  /** Which materials the kernel says belong to which shape. */
  get #references() {
    const parts = this.model.get("part_shapes") ?? [];
    return JSON.stringify([this.model.get("materials"), parts.map(({ materials }) => materials)]);
  }

  /**
   * Has all views of this canvas in the page show a lead, or the kernel's map for null: they share
   * three.js's objects.
   *
   * @param {Lead | null} lead
   */
  showLead(lead) {
    this.#renderer?.trigger(LEAD, lead);
  }

  /** @param {Lead | null} lead */
  #takeLead(lead) {
    this.lead = lead;
    if (lead && this.movesVertices) this.#detail.moved(this.model.get("drawing_time"));
    this.refresh();
    this.led();
  }

  /** Whether the page's script moves vertices, which is so where there is no graphics processor. */
  get movesVertices() {
    return this.#meshes.some(movedByPage);
  }

  /** @type {any[]} three.js's */
  get #meshes() {
    return this.#renderer?.get("scene").obj?.children ?? [];
  }

  /** Puts the newest coefficients into every material. */
  refresh() {
    // The maps and materials of another shape come together, but the materials are loaded later.
    if (this.#loaded === this.#references) this.#move();
    this.see();
    this.redraw();
  }

  #move() {
    const { motion } = this;
    const moved = motion instanceof Float32Array && motion.length ? motion : null;
    const floats = moved ?? this.lead?.floats ?? toFloats(this.model.get("coefficients"));
    this.#edited.move(this.#meshes, floats, Boolean(motion));
    for (const [key, shape] of this.#around) {
      const seen = motion instanceof Float32Array ? this.partMotions[key] : undefined;
      if (seen) shape.move(this.#meshes, seen.floats, true);
      else shape.rest(this.#meshes, this.model.get("part_maps")[key]);
    }
  }

  /**
   * Gives the picture's vertices the heights of a motion's time; null gives back those of the pose.
   *
   * @param {Float32Array | null} heights
   */
  lift(heights) {
    this.#edited.lift(this.#meshes, heights);
    for (const [key, shape] of this.#around) {
      shape.lift(this.#meshes, this.partMotions[key]?.heights ?? null);
    }
  }

  /** Shows what the view shows; the camera's renderer draws anew by itself. */
  see() {
    const { x, y, unit, width, height } = this.view;
    const w = (width / 2) * unit;
    const h = (height / 2) * unit;
    for (const { obj } of this.#materials) {
      if (obj?.uniforms?.pixel) obj.uniforms.pixel.value = unit;
    }
    this.#camera?.set({ left: x - w, right: x + w, top: y + h, bottom: y - h });
  }

  redraw() {
    this.#renderer?.trigger("rerender", this.#renderer, {});
  }

  close() {
    this.#loading += 1;
    this.#forget();
  }
}

/**
 * @param {Outlined} outlined
 * @param {any[]} materials pythreejs's models
 */
function shapeOf(outlined, materials) {
  const shape = new MovedShape(outlined);
  shape.materials = materials;
  return shape;
}

/** @type {WeakSet<object>} renderers of three.js that end with their contexts */
const ending = new WeakSet();

/**
 * pythreejs keeps three.js's renderers for later, and those keep lists of all that they ever drew. If
 * one does not fit a later view, pythreejs ends it, but not its context; browsers allow few.
 *
 * @param {unknown} _scene
 * @param {any} renderer three.js's
 */
function keepLittle(_scene, renderer) {
  renderer.renderLists.dispose();
  if (ending.has(renderer)) return;
  ending.add(renderer);
  const { dispose } = renderer;
  renderer.dispose = () => {
    dispose.call(renderer);
    renderer.forceContextLoss();
  };
}

/**
 * pythreejs draws a removed view once more if that was asked for before, and then keeps a renderer
 * for it for good.
 *
 * @param {any} view
 */
function drawNoMore(view) {
  view.once("remove", () => {
    view.renderScene = () => {};
  });
}

/**
 * The canvas that pythreejs draws on, below a pad.
 *
 * @param {HTMLElement} pad
 * @returns {HTMLCanvasElement | null | undefined}
 */
function drawnBelow(pad) {
  return pad.closest(".glid-pane")?.querySelector(".jupyter-threejs canvas");
}

/**
 * Whether something is drawn near a place of the pad.
 *
 * @param {HTMLElement} pad
 * @param {Point} place
 */
export function coveredNear(pad, [x, y]) {
  const drawn = drawnBelow(pad);
  if (!drawn) return false;
  const size = 2 * NEAR;
  const pen = penOf(make("canvas", { width: size, height: size }));
  const ratio = drawn.width / pad.clientWidth;
  pen.drawImage(drawn, NEAR - Math.floor(x * ratio), NEAR - Math.floor(y * ratio));
  const { data } = pen.getImageData(0, 0, size, size);
  return data.some((value, i) => i % 4 === 3 && value > 0);
}

/** How many vectors of uniforms a vertex shader may have here; 0 without WebGL. */
export function uniformVectors() {
  const canvas = make("canvas");
  const gl = canvas.getContext("webgl2") || canvas.getContext("webgl");
  if (!gl) return 0;
  const count = gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return count;
}

/**
 * The fastest of some drawings of the present map in milliseconds, with moving its vertices; 0
 * without WebGL.
 *
 * @param {HTMLElement} pad
 * @param {Shapes} shapes
 */
export async function drawingTime(pad, shapes) {
  const times = [];
  for (let i = 0; i < MOST_FRAMES && times.length <= N_TIMED; i++) {
    const moving = performance.now();
    shapes.refresh(); // the renderer draws in the next frame, before what is below
    const moved = performance.now() - moving;
    await new Promise((go) => requestAnimationFrame(go));
    const canvas = drawnBelow(pad);
    const gl = canvas?.getContext("webgl") || canvas?.getContext("webgl2");
    if (!gl) continue;
    const start = performance.now();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for all of it
    times.push(moved + performance.now() - start);
  }
  return times.length > 1 ? Math.min(...times.slice(1)) : 0;
}
