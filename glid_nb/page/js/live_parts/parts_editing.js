// The pose that is edited, of several shapes: a press finds the foremost one that is seen there.

import { Editing } from "../live_page/editing.js";
import { sourceAt } from "../live_page/mesh.js";

/** @import { Solver } from "../live/solving_types.js" */
/** @import { Mesh } from "../exported/renderer.js" */
/** @import { Edit, Handle } from "../live_page/data.js" */
/** @import { Point } from "../types.js" */
/** @import { JointMap } from "./data.js" */

/**
 * A shape that can be pressed.
 * @typedef {{ mesh: Mesh, isSeen: (source: Point) => boolean }} Pressed
 */

export class PartsEditing extends Editing {
  /**
   * @param {Solver} solving
   * @param {Pressed[]} shapes the rearmost first
   * @param {JointMap} frame the maps to begin with
   * @param {Edit["coefficients"]} rest those of the undeformed shapes
   */
  constructor(solving, shapes, frame, rest) {
    super(solving, shapes[0].mesh, frame, rest);
    this.shapes = shapes;
  }

  /**
   * The point of an undeformed shape that is seen at a place, or else the foremost one there; null
   * beside all shapes.
   * @override
   * @param {Point} place
   * @returns {Handle | null}
   */
  sourceAt(place) {
    const maps = /** @type {JointMap} */ (this.frame).parts;
    /** @type {Handle | null} */
    let clear = null;
    for (const [part, { mesh, isSeen }] of [...this.shapes.entries()].reverse()) {
      const found = sourceAt(mesh, maps[part].images ?? [], place);
      if (!found) continue;
      /** @type {Handle} */
      const handle = [...found, part];
      if (isSeen(found)) return handle;
      clear ??= handle;
    }
    return clear;
  }
}

/**
 * Whether a picture is opaque at a point of the undeformed shape.
 * @param {HTMLImageElement} picture
 * @param {[left: number, bottom: number, right: number, top: number]} frame its place in the world
 * @returns {(source: Point) => boolean}
 */
export function seenIn(picture, [left, bottom, right, top]) {
  const { naturalWidth: width, naturalHeight: height } = picture;
  const pen = new OffscreenCanvas(width, height).getContext("2d");
  if (!pen) return () => true;
  pen.drawImage(picture, 0, 0);
  const { data } = pen.getImageData(0, 0, width, height);
  return ([x, y]) => {
    const column = Math.floor((width * (x - left)) / (right - left));
    const row = Math.floor((height * (top - y)) / (top - bottom));
    return data[4 * (row * width + column) + 3] > 0;
  };
}
