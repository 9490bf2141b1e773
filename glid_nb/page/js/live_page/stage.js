// Draws certified maps. Measured frame times choose who moves the mesh, and how fine it is.

import { Renderer } from "../exported/renderer.js";
import { movedVertices, Wire } from "../live/wire.js";
import { mayBeFiner, median, quicker, shaderSuffices, sharpness } from "./measuring.js";
import { dividedTimes, pointsOf } from "./mesh.js";

/** @import { Mesh } from "../exported/renderer.js" */
/** @import { LiveMap } from "../live/types.js" */
/** @import { LiveData } from "./data.js" */
/** @import { Solving } from "../live/solving.js" */

const COARSE = 1; // how often the mesh is divided where drawing is slow
const FINE = 2;
const TRIALS = 5;

/**
 * The part of the world that is drawn; `above` what is drawn already.
 * @typedef {{ width: number, height: number, unit: number, x: number, y: number, above?: boolean }} Seen
 */

export class Stage {
  /** @type {"shader" | "module"} who moves the mesh's vertices */
  mover = "shader";
  /** ms of a frame when it was measured */
  frameTime = 0;

  #gl;
  #data;
  #base;
  #wire;
  #renderer;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WebGL2RenderingContext} gl
   * @param {LiveData} data
   * @param {Mesh} base the mesh before its triangles are divided
   * @param {HTMLImageElement} picture
   */
  constructor(canvas, gl, data, base, picture) {
    this.canvas = canvas;
    this.#gl = gl;
    this.#data = data;
    this.#base = base;
    this.#wire = new Wire(data.outline, data);
    this.mover = data.vertex ? "shader" : "module";
    this.mesh = base;
    this.#renderer = this.#made(COARSE);
    this.#renderer.setPicture(picture);
  }

  /** @param {number} level */
  #made(level) {
    const { vertex, painting, fragment, frame, colors, grid, ranges } = this.#data;
    const byShader = this.mover === "shader";
    const shown = { vertex: byShader ? vertex : painting, fragment, frame, colors, grid, ranges };
    const mesh = dividedTimes(this.#base, level);
    const cage = byShader ? this.#wire.cage : new Float32Array();
    this.mesh = mesh;
    return new Renderer(this.canvas, this.#gl, shown, mesh, cage);
  }

  /**
   * Measures, and keeps the quicker way to draw.
   * @param {Solving} solving evaluates maps at points
   * @param {Seen} seen
   * @returns {Promise<LiveMap>} the map that is, evaluated at the points that drawing needs
   */
  async choose(solving, seen) {
    const points = (/** @type {Mesh} */ mesh) =>
      solving.map({ type: "points", points: pointsOf(mesh) });
    let frame = await points(this.#base);
    if (this.mover === "shader") {
      const shader = this.#measured(frame, seen);
      if (mayBeFiner(shader)) this.#takeFiner(frame, seen);
      if (shaderSuffices(shader)) return frame;
      this.mover = "module";
      this.#renderer = this.#made(COARSE);
      frame = await points(this.mesh);
      const painting = this.#measured(frame, seen);
      if (quicker(shader, painting, frame.evaluated) === "module") return frame;
      this.mover = "shader";
      this.frameTime = shader;
      this.#renderer = this.#made(COARSE);
      return points(this.#base);
    }
    return points(this.mesh);
  }

  /**
   * @param {LiveMap} frame
   * @param {Seen} seen
   */
  #takeFiner(frame, seen) {
    this.#renderer = this.#made(FINE);
    if (shaderSuffices(this.#measured(frame, seen))) return;
    this.#renderer = this.#made(COARSE);
  }

  /**
   * The median time of a frame, until its pixels are there.
   * @param {LiveMap} frame
   * @param {Seen} seen
   */
  #measured(frame, seen) {
    const gl = this.#gl;
    const pixel = new Uint8Array(4);
    const times = Array.from({ length: TRIALS }, () => {
      const began = performance.now();
      this.paint(frame, seen, "0");
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return performance.now() - began;
    });
    this.frameTime = median(times);
    return this.frameTime;
  }

  /**
   * @param {LiveMap} frame a certified map
   * @param {Seen} seen
   * @param {string} overlay the number of what the colours say
   * @param {boolean} moving whether the next frame follows at once
   */
  paint(frame, seen, overlay, moving = false) {
    const coefficients =
      this.mover === "shader" ? this.#wire.of(frame.coefficients) : movedVertices(frame);
    const sharp = sharpness(this.frameTime, moving);
    this.#renderer.draw({ ...seen, overlay, coefficients, heights: null, sharpness: sharp });
  }

  /** Where maps must be evaluated for the vertices that are drawn, and for pointers. */
  get points() {
    return pointsOf(this.mover === "shader" ? this.#base : this.mesh);
  }
}
