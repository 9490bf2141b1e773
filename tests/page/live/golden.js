// Reads the golden files that tests/page/live/golden.py writes.

import { readFileSync } from "node:fs";
import { rowsAt } from "../../../glid_nb/page/js/live/basis.js";
import { Domain } from "../../../glid_nb/page/js/live/domain.js";
import { gradedPanels } from "../../../glid_nb/page/js/live/panels.js";

/** @import { EnergyName, Outline, Pose } from "../../../glid_nb/page/js/live/types.js" */
/** @import { Point } from "../../../glid_nb/page/js/types.js" */

export const SAMPLES = ["bar", "teapot", "frog", "gecko"];

/**
 * ENERGIES and MINIMA of golden.py: names and parameters.
 * @type {[EnergyName, number][]}
 */
export const ENERGY_CASES = [
  ["iso", 1],
  ["exp", 0.2],
  ["exp", 1],
  ["amips", 0.5],
  ["mips", 1],
  ["arap", 1],
];

/** @type {[EnergyName, number][]} */
export const MINIMUM_CASES = [
  ["iso", 1],
  ["exp", 0.2],
  ["amips", 0.5],
  ["arap", 1],
];

/**
 * @typedef {object} Golden
 * @property {Outline} outline
 * @property {Pose} pose
 * @property {number[]} coefficients
 * @property {number} panels
 * @property {[number, number]} starts the sum of the moduli of the panels' starts, and the perimeter
 * @property {number[]} energies
 * @property {number} sigma2_lower
 * @property {number} sigma1_upper
 * @property {number} k_upper
 * @property {number[]} windings
 * @property {Point[]} points
 * @property {Point[]} images
 * @property {Point[]} fz
 * @property {Point[]} fzbar
 * @property {(number | null)[]} minima
 */

/**
 * @param {string} name
 * @returns {Golden}
 */
export function golden(name) {
  return JSON.parse(readFileSync(new URL(`${name}.json`, import.meta.url), "utf-8"));
}

/** @param {Outline} outline */
export function boundary(outline) {
  const domain = new Domain(outline);
  const panels = gradedPanels(domain);
  return { domain, panels, rows: rowsAt(domain, panels.nodes) };
}

/**
 * A number between -1 and 1, the next of a sequence.
 * @param {number} seed
 */
export function random(seed) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return (2 * state) / 2147483647 - 1;
  };
}
