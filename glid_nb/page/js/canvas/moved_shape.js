// One shape of a canvas: takes maps, as the kernel writes them, into three.js's objects.

import { toFloats } from "../pad/dom.js";
import { renew, Vertices } from "./vertices.js";

/** @import { Outlined } from "./traits.js" */

/**
 * What the timeline shows of a shape around the edited one.
 *
 * @typedef {object} PartSeen
 * @property {Float32Array} floats coefficients
 * @property {Float32Array | null} heights of the picture's vertices
 */

export class MovedShape {
  /** @type {any[]} pythreejs's models of its materials, the picture's first */
  materials = [];

  /** @type {Vertices | null} */
  #vertices = null;
  /** @type {DataView | undefined} the map that the kernel told last, and its numbers */
  #told;
  #floats = toFloats();

  /** @param {Outlined} [outlined] the domain, once the kernel has told it */
  constructor(outlined) {
    if (outlined?.outline) this.#vertices = new Vertices(outlined);
  }

  /**
   * Which of the renderer's meshes are this shape's.
   *
   * @param {any[]} meshes three.js's
   */
  of(meshes) {
    return meshes.filter(({ material }) => this.materials.some(({ obj }) => obj === material));
  }

  /**
   * Draws the shape under a map.
   *
   * @param {any[]} meshes the renderer's
   * @param {Float32Array} floats
   * @param {boolean} moving whether a motion is seen
   */
  move(meshes, floats, moving) {
    const still = floats === this.#floats; // then vertices may lie there already
    this.#vertices?.move(this.of(meshes), floats, still);
    for (const { obj } of this.materials) {
      const { cage, coefficients, holes, by_margin: byMargin } = obj?.uniforms ?? {};
      if (byMargin?.value) byMargin.value = moving ? 2 : 1;
      if (!coefficients) continue;
      const chain = cage.value.length;
      // The kernel evaluates, or another domain's coefficients arrive before its materials.
      if (floats.length !== chain + holes.value.length) continue;
      coefficients.value = floats.subarray(0, chain);
      holes.value = floats.subarray(chain);
    }
  }

  /**
   * Draws the shape at rest. What is drawn already costs nothing.
   *
   * @param {any[]} meshes the renderer's
   * @param {DataView} [wire] the map
   */
  rest(meshes, wire) {
    if (this.#told !== wire) this.#floats = toFloats(wire);
    this.#told = wire;
    this.move(meshes, this.#floats, false);
  }

  /**
   * Gives the picture's vertices the heights of a motion's time; null gives back those of the pose.
   *
   * @param {any[]} meshes the renderer's
   * @param {Float32Array | null} heights
   */
  lift(meshes, heights) {
    const geometry = this.of(meshes)[0]?.geometry;
    if (!geometry) return;
    const { position } = geometry.attributes;
    // The geometry keeps what the kernel sent, also for another shape's turn at being edited.
    const kept = geometry.userData;
    if (position.array !== kept.lifted) kept.resting = position.array;
    const { resting } = kept;
    if (heights?.length === position.count) {
      kept.lifted = position.array === resting ? resting.slice() : position.array;
      /** @type {Float32Array} */ (heights).forEach((height, i) => {
        kept.lifted[3 * i + 2] = height;
      });
      if (position.array === resting) position.setArray(kept.lifted);
    } else {
      if (position.array === resting) return;
      position.setArray(resting);
    }
    renew(position);
  }
}
