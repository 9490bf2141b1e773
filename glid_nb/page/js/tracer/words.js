// What the tracer says of a tracing.

/** @import { Shown } from "./traits.js" */

/** @typedef {{ kind: "ok" | "guess" | "bad" | "busy" | "idle", text: string }} Status */

/**
 * @param {Shown} shown
 * @param {string | null} refusal of the last action
 * @param {boolean} busy whether an answer is overdue
 * @returns {Status}
 */
export function statusOf(shown, refusal, busy) {
  if (refusal) return { kind: "bad", text: refusal };
  if (busy) return { kind: "busy", text: "Working…" };
  if (!shown.size) return { kind: "idle", text: "No picture yet" };
  if (shown.problems.length) {
    const kept = "This is not a valid cage; the last valid cage is kept";
    return { kind: "bad", text: shown.loops.length ? kept : "There is no cage yet" };
  }
  const { doubt } = shown;
  if (doubt) return { kind: "guess", text: `No outline yet, as ${doubt} · paint over the shape` };
  return { kind: "ok", text: cutOf(shown) + cageOf(shown) + moreOn(shown) };
}

/**
 * What the knife did.
 *
 * @param {Shown} shown
 */
function cutOf({ cut }) {
  if (!cut) return "";
  const { shares, kept, in_middle: inMiddle } = cut;
  if (shares.length > 1) {
    const percent = Math.round(100 * shares[kept]);
    const rest = shares.length > 2 ? "the others are left out" : "the other one is left out";
    return `Cut into ${shares.length} pieces: ${percent} % of the shape is kept, ${rest} · `;
  }
  return inMiddle ? "Cut inside the shape, as a thin hole · " : "Cut open along the line · ";
}

/** @param {Shown} shown */
function cageOf({ loops }) {
  return `Cage with ${loops.flat().length} vertices and ${holesIn(loops.length - 1)}`;
}

/** @param {Shown} shown */
function moreOn({ discarded, component, n_components: count }) {
  if (discarded) return " · your edits were lost with the old outline; Undo brings them back";
  if (count < 2) return "";
  const which = component ? `component ${component + 1}` : "the largest";
  return ` · ${which} of ${count} components`;
}

/** @param {number} count */
export function holesIn(count) {
  if (count < 1) return "no holes";
  return count === 1 ? "1 hole" : `${count} holes`;
}
