// Draws the certified maps of several shapes over each other, in one WebGL context.

import { Bound } from "../exported/bound.js";
import { Stage } from "../live_page/stage.js";

/** @import { Mesh } from "../exported/renderer.js" */
/** @import { LiveMap } from "../live/types.js" */
/** @import { Solving } from "../live/solving.js" */
/** @import { LiveData } from "../live_page/data.js" */
/** @import { Seen } from "../live_page/stage.js" */
/** @import { JointMap } from "./data.js" */

export class PartsStage {
  #layers;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WebGL2RenderingContext} gl
   * @param {LiveData[]} parts the rearmost first
   * @param {Mesh[]} meshes
   * @param {HTMLImageElement[]} pictures
   */
  constructor(canvas, gl, parts, meshes, pictures) {
    this.canvas = canvas;
    this.#layers = parts.map((part, i) => {
      const bound = new Bound(gl);
      const stage = new Stage(canvas, gl, part, meshes[i], pictures[i]);
      bound.note();
      return { stage, bound };
    });
  }

  /**
   * Measures each shape by itself, and keeps the quicker way to draw it.
   * @param {Solving[]} solvers
   * @param {Seen} seen
   * @returns {Promise<LiveMap[]>} the maps that are
   */
  async choose(solvers, seen) {
    const maps = [];
    // One after the other: while one is measured, its renderer has the context.
    for (const [i, { stage, bound }] of this.#layers.entries()) {
      bound.restore();
      maps.push(await stage.choose(solvers[i], seen));
      bound.note();
    }
    const { frameTime } = this;
    for (const { stage } of this.#layers) stage.frameTime = frameTime; // so that all are equally sharp
    return maps;
  }

  /**
   * @param {LiveMap} frame the certified maps of all
   * @param {Seen} seen
   * @param {string} overlay
   * @param {boolean} [moving]
   */
  paint(frame, seen, overlay, moving) {
    const maps = /** @type {JointMap} */ (frame).parts;
    for (const [i, { stage, bound }] of this.#layers.entries()) {
      bound.restore();
      stage.paint(maps[i], { ...seen, above: i > 0 }, overlay, moving);
    }
  }

  /** Where the maps of each part must be evaluated. */
  get points() {
    return this.#layers.map(({ stage }) => stage.points);
  }

  get mover() {
    return [...new Set(this.#layers.map(({ stage }) => stage.mover))].join();
  }

  /** ms of a frame, when its parts were measured */
  get frameTime() {
    return this.#layers.reduce((sum, { stage }) => sum + stage.frameTime, 0);
  }
}
