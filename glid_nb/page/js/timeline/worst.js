// The proofs of several shapes as one: at each instant the worst of them counts.

/** @import { Span } from "./traits.js" */

/** @typedef {{ start: number, end: number, sigma2: number, part: string }} Piece between two knots */

/**
 * The motion from one keyframe to the next, of all shapes together.
 *
 * @typedef {object} Segment
 * @property {number} start
 * @property {number} end
 * @property {Span["status"]} status the worst of all shapes
 * @property {string} reason why it is not proved
 * @property {number} until the last instant that is proved for all
 * @property {Piece[]} pieces what is proved, each with the worst bound and the shape that has it
 * @property {string} part the shape that is not proved; empty if all are, or if there is only one
 */

/** @typedef {{ name: string, spans: Span[] }} Part a shape; the name of the only one is empty */

const BADNESS = { proved: 0, computing: 1, fails: 2, refused: 2 };

/**
 * The segments of all shapes together. They have the same keyframes; where the kernel has not told
 * a segment of a shape yet, it is not proved.
 *
 * @param {Part[]} parts the edited one first
 * @returns {Segment[]}
 */
export function worstOf([own, ...others]) {
  return own.spans.map((span, i) => {
    const all = [{ name: own.name, span }];
    for (const { name, spans } of others) {
      all.push({ name, span: spans[i] ?? untold(span) });
    }
    return worst(all);
  });
}

/**
 * @param {Span} span of another shape
 * @returns {Span}
 */
function untold(span) {
  return { ...span, status: "computing", reason: "", until: span.start, sigma2: [] };
}

/** @typedef {{ name: string, span: Span }} Named */

/**
 * @param {Named[]} all
 * @returns {Segment}
 */
function worst(all) {
  const until = Math.min(...all.map(({ span }) => provedUntil(span)));
  const bad = all.reduce((one, next) => (isWorse(next.span, one.span) ? next : one));
  const { start, end, status, reason } = bad.span;
  const part = status === "proved" ? "" : bad.name;
  return { start, end, status, reason, until, part, pieces: piecesOf(all, until) };
}

/**
 * @param {Span} span
 * @param {Span} other
 */
function isWorse(span, other) {
  const more = BADNESS[span.status] - BADNESS[other.status];
  return more > 0 || (more === 0 && provedUntil(span) < provedUntil(other));
}

/** @param {Span} span */
function provedUntil({ status, end, until }) {
  return status === "proved" ? end : until;
}

/**
 * @param {Named[]} all
 * @param {number} until
 * @returns {Piece[]}
 */
function piecesOf(all, until) {
  const knots = all.flatMap(({ span }) => span.times.slice(0, span.sigma2.length + 1));
  const known = new Set([...knots.filter((time) => time <= until), until]);
  const times = [...known].sort((a, b) => a - b);
  return times.slice(1).flatMap((end, i) => {
    const start = times[i];
    const bounds = all.map(({ name, span }) => ({
      name,
      sigma2: boundAt(span, (start + end) / 2),
    }));
    const { name, sigma2 } = bounds.reduce((a, b) => (b.sigma2 < a.sigma2 ? b : a));
    // Up to the instant where a proof fails there is no bound on a piece.
    return sigma2 > 0 ? [{ start, end, sigma2, part: name }] : [];
  });
}

/**
 * The bound at an instant; 0 where there is none.
 *
 * @param {Span} span
 * @param {number} time
 */
function boundAt({ times, sigma2 }, time) {
  const piece = times.findIndex((knot, i) => knot <= time && time <= times[i + 1]);
  return sigma2[piece] ?? 0;
}
