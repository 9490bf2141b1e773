// One shape of the page: its mesh and picture, and its map at every time.

import { Motion } from "../motion/motion.js";
import { CannotShow } from "./renderer.js";
import { bytesOf, cornersOf, restored, unpacked } from "./unpack.js";

/** @import { PartData } from "./data.js" */
/** @import { Frame, Mesh } from "./renderer.js" */

/** What is drawn of a shape. @typedef {Pick<Frame, "coefficients" | "heights">} State */

export class Shape {
  #identity;
  #layers;

  /**
   * @param {PartData} data
   * @param {Mesh} mesh with the heights at the first keyframe
   * @param {HTMLImageElement} picture
   * @param {Float32Array} rows coefficients: the undeformed shape's, then those at the knots
   * @param {Float32Array} heights of the vertices, at the keyframes
   */
  constructor(data, mesh, picture, rows, heights) {
    this.vertex = data.vertex;
    this.cage = new Float32Array(bytesOf(data.cage));
    this.mesh = mesh;
    this.picture = picture;
    this.proof = data.motion;
    this.motion = new Motion(data.motion, rows.subarray(data.width));
    this.#identity = rows.subarray(0, data.width);
    const { height_times: times } = data;
    const { repeat } = this.motion;
    this.#layers = times.length > 1 ? new Motion({ times, repeat }, heights) : null;
  }

  /** @param {PartData} data */
  static async loaded(data) {
    const source = await unpacked(data.source, 2);
    const rows = await restored(data.coefficients, data.width);
    const heights = await restored(data.heights, source.length / 2);
    const triangles = await cornersOf(data.triangles);
    const mesh = { source, heights: heights.subarray(0, source.length / 2), triangles };
    return new Shape(data, mesh, await loadedPicture(data.picture), rows, heights);
  }

  /**
   * @param {number} time
   * @param {boolean} undeformed whether the picture lies as it was
   * @returns {State}
   */
  at(time, undeformed = false) {
    const coefficients = undeformed ? this.#identity : this.motion.at(time);
    return { coefficients, heights: this.#layers?.at(time) ?? null };
  }
}

/**
 * @param {string} address
 * @returns {Promise<HTMLImageElement>}
 */
function loadedPicture(address) {
  return new Promise((resolve, reject) => {
    const picture = new Image();
    picture.onerror = () => reject(new CannotShow("The picture in this page is damaged."));
    picture.onload = () => resolve(picture);
    picture.src = address;
  });
}
