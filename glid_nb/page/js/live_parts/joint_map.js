// The maps of several shapes as one: their coefficients and points one after the other.

/** @import { Certificate, Coefficients, Field, LiveMap, Pose } from "../live/types.js" */
/** @import { Handle } from "../live_page/data.js" */
/** @import { JointMap } from "./data.js" */
/** @import { Point } from "../types.js" */

/**
 * Numbers one after the other.
 * @param {ArrayLike<number>[]} arrays
 */
export function chained(arrays) {
  const all = new Float64Array(arrays.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const one of arrays) {
    all.set(one, at);
    at += one.length;
  }
  return all;
}

/**
 * Undoes `chained`.
 * @param {Coefficients} all
 * @param {number[]} lengths
 */
export function parted(all, lengths) {
  let at = 0;
  return lengths.map((length) => {
    at += length;
    return all.slice(at - length, at);
  });
}

/**
 * Which part each handle belongs to.
 * @param {Pose} pose
 */
export function ownersOf({ handles }) {
  return handles.map((handle) => /** @type {Handle} */ (handle)[2] ?? 0);
}

/**
 * The pins of each part.
 * @param {Pose} pose
 * @param {number} count of the parts
 * @returns {Pose[]}
 */
export function posesOf(pose, count) {
  const owners = ownersOf(pose);
  const { handles, targets, weights, angles, scales } = pose;
  return Array.from({ length: count }, (_, part) => {
    /** @type {<T>(values: T[]) => T[]} */
    const own = (values) => values.filter((_, i) => owners[i] === part);
    return {
      handles: own(handles).map(plain),
      targets: own(targets).map(plain),
      weights: weights && own(weights),
      angles: angles && own(angles),
      scales: scales && own(scales),
    };
  });
}

/**
 * A point without the number of its part.
 * @param {Handle} handle
 * @returns {Point}
 */
export function plain([x, y]) {
  return [x, y];
}

/**
 * @param {LiveMap[]} maps
 * @param {number[]} owners the part of each pin
 * @param {number} id
 * @param {boolean} settled
 * @returns {JointMap}
 */
export function jointMap(maps, owners, id, settled) {
  const sum = (/** @type {"energy" | "steps" | "took" | "evaluated"} */ key) =>
    maps.reduce((total, map) => total + map[key], 0);
  return {
    type: "map",
    id,
    settled,
    outcome: maps.some(({ outcome }) => outcome === "refused") ? "refused" : maps[0].outcome,
    energy: sum("energy"),
    coefficients: chained(maps.map(({ coefficients }) => coefficients)),
    certificate: worstOf(maps.map(({ certificate }) => certificate)),
    images: chained(maps.map(({ images }) => images ?? [])),
    samples: null, // those of each part are in `parts`
    pins: pinsOf(maps, owners),
    steps: sum("steps"),
    took: sum("took"),
    evaluated: sum("evaluated"),
    parts: maps,
  };
}

/**
 * What is proved of all maps.
 * @param {Certificate[]} all
 * @returns {Certificate}
 */
export function worstOf(all) {
  return {
    certified: all.every(({ certified }) => certified),
    sigma2_lower: Math.min(...all.map(({ sigma2_lower }) => sigma2_lower)),
    sigma1_upper: Math.max(...all.map(({ sigma1_upper }) => sigma1_upper)),
    k_upper: Math.max(...all.map(({ k_upper }) => k_upper)),
    windings: all.flatMap(({ windings }) => windings),
    halved: all.reduce((sum, { halved }) => sum + halved, 0),
    refused: all.find(({ refused }) => refused >= 0)?.refused ?? -1,
  };
}

/**
 * Where the maps take the pins; nothing if one of them was not evaluated at its present pins.
 * @param {LiveMap[]} maps
 * @param {number[]} owners the part of each pin
 * @returns {Field}
 */
function pinsOf(maps, owners) {
  const counts = maps.map(({ pins }) => pins.images.length / 2);
  const known = counts.every((count, part) => count === owners.filter((p) => p === part).length);
  const images = new Float64Array(known ? 2 * owners.length : 0);
  const samples = new Float64Array(known ? 4 * owners.length : 0);
  const next = counts.map(() => 0);
  for (const [i, part] of known ? owners.entries() : []) {
    const { pins } = maps[part];
    const k = next[part]++;
    images.set(pins.images.subarray(2 * k, 2 * k + 2), 2 * i);
    for (let c = 0; c < 4; c++) {
      samples[c * owners.length + i] = pins.samples[c * counts[part] + k];
    }
  }
  return { images, samples };
}
