// What a page in a frame and the program around it tell each other (live_editor/main.js).

/** @import { Coefficients } from "../live/types.js" */
/** @import { Pin } from "./data.js" */

/**
 * @typedef {object} Edit a map at which the page came to rest, or one to go on with
 * @property {"edit"} glid
 * @property {Pin[]} pins
 * @property {number[]} coefficients
 * @property {boolean} [quiet] whether the page is not to answer with the map that it finds
 */
/** @typedef {{ glid: "ready" } | Edit} Message */

/**
 * What the page edits, as far as this needs to know it.
 * @typedef {object} Edited
 * @property {readonly Pin[]} pins
 * @property {{ id: number, coefficients: Coefficients }} frame
 * @property {boolean} settled
 * @property {boolean} inGesture
 * @property {(pins: readonly Pin[], coefficients: Coefficients) => void} replace
 */

/**
 * Takes poses from the program around the page, if there is one.
 * @param {Edited} editing
 * @param {Window} page
 * @returns {() => void} tells that program of the map, once the page is at rest
 */
export function joinHost(editing, page = window) {
  const { parent } = page;
  if (parent === page) return () => {};
  let known = editing.frame.id;
  /** @type {readonly Pin[] | null} */
  let quiet = null;
  page.addEventListener("message", ({ source, data }) => {
    if (source !== parent || data?.glid !== "edit") return;
    const { pins, coefficients } = /** @type {Edit} */ (data);
    quiet = data.quiet ? pins : null;
    editing.replace(pins, Float64Array.from(coefficients));
  });
  /** @param {Message} message */
  const post = (message) => parent.postMessage(message, "*");
  post({ glid: "ready" });
  return () => {
    const { pins, frame } = editing;
    if (!editing.settled || editing.inGesture || frame.id === known) return;
    known = frame.id;
    const answers = pins !== quiet;
    quiet = null;
    if (answers) post({ glid: "edit", pins: [...pins], coefficients: [...frame.coefficients] });
  };
}
