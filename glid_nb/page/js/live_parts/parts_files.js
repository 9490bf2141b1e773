// What may be taken from a page of several shapes: one picture of all, a file or lines for each of them.

import { copy, downloadPicture, downloadProof } from "../live_page/files.js";
import { pythonCode } from "../live_page/python.js";
import { plain } from "./joint_map.js";
import { partNames } from "./part_names.js";

/** @import { Pin } from "../live_page/data.js" */
/** @import { Taken } from "../live_page/files.js" */
/** @import { PartsData } from "./data.js" */
/** @import { JointSolving } from "./joint_solving.js" */

/**
 * @param {PartsData} data
 * @returns {Taken}
 */
export function takenOf({ title, parts }) {
  const names = namesOf(title, parts);
  return {
    "Copy the pose as Python": ({ editing }) => copy(partsCode(editing.pins, parts)),
    "Download the picture": downloadPicture,
    "Download the maps and their proofs": async (page) => {
      const { solvers } = /** @type {JointSolving} */ (await page.solverOfShown());
      for (const [i, { outline }] of parts.entries()) {
        await downloadProof({ title: names[i], outline }, solvers[i]);
      }
      return `There are two files for each of ${parts.length} parts. Check each: glid-check MAP PROOF`;
    },
  };
}

/**
 * The lines of each part; its map is in the dictionary `maps`.
 * @param {readonly Pin[]} pins
 * @param {PartsData["parts"]} parts
 */
export function partsCode(pins, parts) {
  const blocks = parts.map((part, i) => {
    const own = pins.filter(({ handle }) => handle[2] === i);
    const flat = own.map((pin) => ({ ...pin, handle: plain(pin.handle) }));
    const name = JSON.stringify(part.name);
    const code = pythonCode(flat, part);
    return `${code}maps[${name}] = result.map\n`;
  });
  return ["maps = {}\n", ...blocks].join("\n");
}

/**
 * @param {string} title
 * @param {PartsData["parts"]} parts
 */
function namesOf(title, parts) {
  return partNames(
    title,
    parts.map(({ name }) => name),
  );
}
