// What a live page edits, joined to a program that hears of its maps and gives it others.

/** @import { Coefficients } from "../live/types.js" */
/** @import { Pin } from "../live_page/data.js" */

/**
 * A map at which the page came to rest, or one to go on with.
 * @typedef {{ pins: Pin[], coefficients: number[] }} Edit
 */

/**
 * What the page edits, as far as this needs to know it.
 * @typedef {object} Edited
 * @property {readonly Pin[]} pins
 * @property {{ id: number, coefficients: Coefficients }} frame
 * @property {boolean} settled
 * @property {boolean} inGesture
 * @property {() => void} told called after every change
 * @property {(pins: readonly Pin[], coefficients: Coefficients) => void} replace
 */

/**
 * @param {Edited} editing
 * @param {(edit: Edit) => void} tell called when the page is at rest and no hand is on it
 * @returns {(edit: Edit, quiet: boolean) => void} shows another map; then `tell` hears of the map that
 *   the page finds from there, unless it is quiet
 */
export function joined(editing, tell) {
  let known = editing.frame.id;
  /** @type {readonly Pin[] | null} */
  let unanswered = null;
  const { told } = editing;
  editing.told = () => {
    told();
    const { pins, frame } = editing;
    if (!editing.settled || editing.inGesture || frame.id === known) return;
    known = frame.id;
    const answers = pins !== unanswered;
    unanswered = null;
    if (answers) tell({ pins: [...pins], coefficients: [...frame.coefficients] });
  };
  return ({ pins, coefficients }, quiet) => {
    unanswered = quiet ? pins : null;
    editing.replace(pins, Float64Array.from(coefficients));
  };
}
