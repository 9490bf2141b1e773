// The loop range: two marks on the ruler, between which the motion plays over and over.

import { make } from "../pad/dom.js";
import { seconds } from "./words.js";

/** @typedef {[start: number, end: number]} Range */
/** @typedef {0 | 1} Which the start or the end */

const SAME = 1e-6; // s

/**
 * A range with its start or end at another time, at least a frame long; null for all of the motion.
 *
 * @param {Range} range
 * @param {Range} whole the motion's start and end
 * @param {Which} which
 * @param {number} time
 * @param {number} frame s
 * @returns {Range | null}
 */
export function withEnd(range, whole, which, time, frame) {
  const [start, end] = range;
  const least = Math.min(frame, whole[1] - whole[0]);
  /** @type {Range} */
  const made =
    which === 0
      ? [Math.max(Math.min(time, end - least), whole[0]), end]
      : [start, Math.min(Math.max(time, start + least), whole[1])];
  return made.every((one, i) => Math.abs(one - whole[i]) < SAME) ? null : made;
}

/**
 * The range that a key sets at the playhead. Beyond the other end, that one is where the motion ends;
 * where an end already is, it is taken away.
 *
 * @param {Range | null} range
 * @param {Range} whole
 * @param {Which} which
 * @param {number} time
 * @param {number} frame s
 */
export function keyedEnd(range, whole, which, time, frame) {
  /** @type {Range} */
  const from = range ? [...range] : [...whole];
  if (range && Math.abs(from[which] - time) < SAME)
    return withEnd(from, whole, which, whole[which], frame);
  const other = which === 0 ? 1 : 0;
  if (which === 0 ? time >= from[1] : time <= from[0]) from[other] = whole[other];
  return withEnd(from, whole, which, time, frame);
}

/**
 * What the marks need of the track.
 *
 * @typedef {object} Ruler
 * @property {(time: number) => string} at a time's place, as CSS takes it
 * @property {(e: PointerEvent) => number} timeOf the time below a pointer, near a keyframe or a frame
 *   that one's
 * @property {() => number} frame s
 * @property {(range: Range | null) => void} set
 * @property {(text: string) => void} hover
 */

export class RangeMarks {
  band = make("i", { className: "glid-range" });

  /** @type {Range | null} */
  #range = null;
  /** @type {Range | null} the motion's start and end */
  #whole = null;
  /** @type {Range | null | undefined} while an end is dragged, what it will be */
  #dragged = undefined;

  /** @param {Ruler} ruler */
  constructor(ruler) {
    this.ruler = ruler;
    this.marks = [this.#mark(0), this.#mark(1)];
    this.elements = [this.band, ...this.marks];
  }

  /**
   * @param {Range | null} range
   * @param {Range | null} whole null without a motion
   */
  show(range, whole) {
    this.#range = range;
    this.#whole = whole;
    if (this.#dragged === undefined) this.#draw(range);
  }

  /** Forgets a drag. */
  drop() {
    this.#dragged = undefined;
    this.#draw(this.#range);
  }

  /**
   * Sets an end at the playhead, by a key.
   *
   * @param {Which} which
   * @param {number} time
   */
  key(which, time) {
    if (this.#whole) {
      this.#set(keyedEnd(this.#range, this.#whole, which, time, this.ruler.frame()));
    }
  }

  /** @param {Range | null} range */
  #draw(range) {
    const ends = range ?? this.#whole;
    for (const element of this.elements) {
      element.hidden = !ends;
      element.dataset.set = String(range !== null);
    }
    if (!ends || !this.#whole) return;
    const { at } = this.ruler;
    this.band.style.left = at(ends[0]);
    this.band.style.right = `calc(100% - ${at(ends[1])})`;
    for (const [i, mark] of this.marks.entries()) {
      mark.style.left = at(ends[i]);
      mark.ariaValueMin = this.#whole[0].toFixed(2);
      mark.ariaValueMax = this.#whole[1].toFixed(2);
      mark.ariaValueNow = ends[i].toFixed(2);
      mark.ariaValueText = seconds(ends[i]);
    }
  }

  /** @param {Which} which */
  #mark(which) {
    const name = which === 0 ? "Start of the loop range" : "End of the loop range";
    const key = which === 0 ? "Shift+Home" : "Shift+End";
    const mark = make("button", {
      className: "glid-range-mark",
      role: "slider",
      "aria-label": name,
      title: `${name}: drag it, or ${key} at the playhead; Delete plays all`,
    });
    mark.dataset.end = which === 0 ? "start" : "end";
    mark.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      e.preventDefault();
      e.stopPropagation(); // the track would scrub
      mark.focus({ preventScroll: true });
      mark.setPointerCapture(e.pointerId);
      this.#dragged = this.#range;
    });
    mark.addEventListener("pointermove", (e) => {
      if (this.#dragged !== undefined && mark.hasPointerCapture(e.pointerId)) this.#drag(which, e);
    });
    mark.addEventListener("lostpointercapture", () => this.#letGo());
    mark.addEventListener("dblclick", () => this.#set(null));
    mark.addEventListener("keydown", (e) => this.#keydown(e, which));
    return mark;
  }

  /**
   * @param {Which} which
   * @param {PointerEvent} e
   */
  #drag(which, e) {
    if (!this.#whole) return;
    const { ruler } = this;
    const from = this.#range ?? this.#whole;
    this.#dragged = withEnd(from, this.#whole, which, ruler.timeOf(e), ruler.frame());
    this.#draw(this.#dragged);
    const [start, end] = this.#dragged ?? this.#whole;
    ruler.hover(this.#dragged ? `Plays from ${seconds(start)} to ${seconds(end)}` : "Plays all");
  }

  #letGo() {
    const dragged = this.#dragged;
    if (dragged === undefined) return;
    this.#dragged = undefined;
    this.ruler.hover("");
    const same = JSON.stringify(dragged) === JSON.stringify(this.#range);
    if (!same) this.#set(dragged);
  }

  // It is drawn at once, and what is done before the kernel answers goes on from it.
  /** @param {Range | null} range */
  #set(range) {
    this.#range = range;
    this.#draw(range);
    this.ruler.set(range);
  }

  /**
   * @param {KeyboardEvent} e
   * @param {Which} which
   */
  #keydown(e, which) {
    if (e.ctrlKey || e.metaKey || e.altKey || e.shiftKey || !this.#whole) return;
    const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    const clears = e.key === "Delete" || e.key === "Backspace";
    if (!step && !clears) return;
    e.preventDefault();
    e.stopPropagation();
    const { ruler } = this;
    const from = this.#range ?? this.#whole;
    const time = from[which] + (step ?? 0) * ruler.frame();
    this.#set(clears ? null : withEnd(from, this.#whole, which, time, ruler.frame()));
  }
}
