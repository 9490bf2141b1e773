// What a reader takes away: lines of Python, the picture, the map with its proof.

import { copied } from "../pad/clipboard.js";
import { make } from "../pad/dom.js";
import { boxOf } from "./mesh.js";
import { proofFiles } from "./proof_file.js";
import { pythonCode } from "./python.js";

/** @import { Solving } from "../live/solving.js" */
/** @import { LiveData } from "./data.js" */
/** @import { LivePage } from "./page.js" */

/**
 * What may be taken from a page, by the labels of its menu. Returns what is to be said.
 * @typedef {Record<string, (page: LivePage) => Promise<string> | void>} Taken
 */

const MOST_PIXELS = 4096; // of a side of the picture
const KEPT = 60_000; // ms for which the browser may still read a file
export const LONGEST = 80; // characters of a name
const PLAIN = "0"; // the picture without colours

/**
 * A name for files, which no command takes for an option.
 * @param {Pick<LiveData, "title">} data
 */
export function nameOf({ title }) {
  const words = title.match(/[\p{L}\p{M}\p{N}_]+/gu) ?? ["picture"];
  return words.join("-").slice(0, LONGEST);
}

/** @type {Taken} of a page with one shape */
export const TAKEN = {
  "Copy the pose as Python": ({ data, editing: { pins } }) => copy(pythonCode(pins, data)),
  "Download the picture": downloadPicture,
  "Download the map and its proof": async (page) =>
    downloadProof(page.data, /** @type {Solving} */ (await page.solverOfShown())),
};

/**
 * Copies text; returns what is to be said.
 * @param {string} text
 */
export async function copy(text) {
  const allowed = await copied(text);
  return allowed ? "The lines are in the clipboard." : "The browser did not allow copying.";
}

/**
 * Saves the deformed picture, with the pixels of the original.
 * @param {LivePage} page
 */
export function downloadPicture({ data, stage, shown }) {
  const [left, bottom, right, top] = boxOf(shown.images ?? []);
  const perUnit = data.size[0] / (data.frame[2] - data.frame[0]); // pixels
  const most = MOST_PIXELS / Math.max(right - left, top - bottom);
  const density = Math.min(perUnit, most) / (window.devicePixelRatio || 1);
  const width = Math.ceil((right - left) * density);
  const height = Math.ceil((top - bottom) * density);
  const middle = { x: (left + right) / 2, y: (bottom + top) / 2 };
  stage.paint(shown, { width, height, unit: 1 / density, ...middle }, PLAIN);
  stage.canvas.toBlob((picture) => picture && save(`${nameOf(data)}-posed.png`, picture));
}

/**
 * Saves the map that a solver has, and its proof; returns what is to be said.
 * @param {Pick<LiveData, "title" | "outline">} data
 * @param {Pick<Solving, "ask">} solving
 */
export async function downloadProof(data, solving) {
  const answer = await solving.ask({ type: "claim" });
  if (answer.type !== "claim") throw new Error("the worker did not answer with a claim");
  const { map, proof } = proofFiles(data.outline, answer.claim);
  const name = nameOf(data);
  save(`${name}.map.json`, new Blob([map]));
  save(`${name}.proof.json`, new Blob([proof]));
  return `Check them: glid-check ${name}.map.json ${name}.proof.json`;
}

/**
 * @param {string} name
 * @param {Blob} content
 */
function save(name, content) {
  const href = URL.createObjectURL(content);
  make("a", { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), KEPT);
}
