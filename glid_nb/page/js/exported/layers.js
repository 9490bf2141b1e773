// Draws several shapes over each other, in one WebGL context.

import { Bound } from "./bound.js";
import { Renderer } from "./renderer.js";

/** @import { PageData } from "./data.js" */
/** @import { Frame } from "./renderer.js" */
/** @import { Shape, State } from "./shape.js" */

export class Layers {
  #layers;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WebGL2RenderingContext} gl
   * @param {PageData} data
   * @param {Shape[]} shapes the rearmost first
   */
  constructor(canvas, gl, data, shapes) {
    this.#layers = shapes.map(({ vertex, mesh, cage, picture }) => {
      const bound = new Bound(gl);
      const renderer = new Renderer(canvas, gl, { ...data, vertex }, mesh, cage);
      renderer.setPicture(picture);
      bound.note();
      return { renderer, bound };
    });
  }

  /**
   * @param {Omit<Frame, keyof State>} view
   * @param {State[]} states of the shapes
   */
  draw(view, states) {
    for (const [i, { renderer, bound }] of this.#layers.entries()) {
      bound.restore();
      renderer.draw({ ...view, ...states[i], above: i > 0 });
    }
  }
}
