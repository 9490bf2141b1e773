// Moves the vertices of meshes whose shaders only paint, because that is quicker on this page.

import { Domain } from "../live/domain.js";
import { FieldPoints } from "../live/fields.js";
import { Wire } from "../live/wire.js";

/** @import { Outlined } from "./traits.js" */

const MOVED_BY_PAGE = "moved by the page"; // `MOVED_BY_PAGE` of glid_nb/widgets/layers.py

/** @type {WeakMap<object, FieldPoints>} the rows of a shape's basis at a geometry's vertices */
const pointsIn = new WeakMap();
/** @type {WeakMap<object, Float32Array>} the map whose images an array has; pythreejs changes arrays */
const imagesIn = new WeakMap();

export class Vertices {
  #domain;
  #wire;

  /** @param {Outlined} outlined */
  constructor({ outline, ...sizes }) {
    this.#domain = new Domain(outline);
    this.#wire = new Wire(outline, sizes);
  }

  /**
   * Moves the vertices of those meshes that the page moves.
   *
   * @param {any[]} meshes three.js's
   * @param {Float32Array} wire the map
   * @param {boolean} still whether the same array has the same numbers as before
   */
  move(meshes, wire, still = false) {
    const moved = meshes.filter(movedByPage);
    if (!moved.length || wire.length !== this.#wire.length) return;
    const coefficients = this.#wire.coefficients(wire);
    const distorted = new Set(moved.filter(showsDerivatives).map((mesh) => mesh.geometry));
    for (const geometry of new Set(moved.map((mesh) => mesh.geometry))) {
      const { image, derivatives } = geometry.attributes;
      if (still && imagesIn.get(image.array) === wire) continue;
      const points = this.#pointsOf(geometry);
      imagesIn.set(image.array, wire);
      image.array.set(points.images(coefficients));
      renew(image);
      if (distorted.has(geometry)) {
        interleave(points.samples(coefficients), derivatives.array);
        renew(derivatives);
      }
      geometry.userData.wire = wire; // what is drawn, for whoever looks at the page's objects
    }
  }

  /** @param {any} geometry three.js's */
  #pointsOf(geometry) {
    const known = pointsIn.get(geometry);
    if (known) return known;
    const { array, count } = geometry.attributes.position;
    /** @type {import("../types.js").Point[]} */
    const places = Array.from({ length: count }, (_, i) => [array[3 * i], array[3 * i + 1]]);
    const points = new FieldPoints(this.#domain, places);
    pointsIn.set(geometry, points);
    return points;
  }
}

let newest = 0;

/**
 * Has three.js take an attribute anew. pythreejs may set its version back to one that was taken before,
 * so every change gets a number of its own.
 *
 * @param {any} attribute three.js's
 */
export function renew(attribute) {
  newest = Math.max(newest, attribute.version) + 1;
  attribute.version = newest;
}

/**
 * Whether the page moves the vertices of a mesh that is seen.
 *
 * @param {any} mesh three.js's
 */
export function movedByPage({ name, visible }) {
  return name === MOVED_BY_PAGE && visible;
}

/**
 * Whether the map's derivatives are seen: all but the plain picture show them.
 *
 * @param {any} mesh three.js's
 */
function showsDerivatives({ material }) {
  return material.uniforms?.overlay?.value !== 0;
}

/**
 * @param {Float64Array} samples part by part
 * @param {Float32Array} into the four parts of each point in turn
 */
function interleave(samples, into) {
  const count = samples.length / 4;
  for (let part = 0; part < 4; part++) {
    for (let i = 0; i < count; i++) into[4 * i + part] = samples[part * count + i];
  }
}
