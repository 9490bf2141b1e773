// Shows a motion at a time and plays it. What is not proved is not shown: where an interval ends
// early, its last proved instant stays. After the last keyframe its pose stays, until a keyframe is
// made there. The motions of several shapes have the same intervals; where one of them ends early, all
// stay at the last instant that is proved for all.

import { Motion } from "../motion/motion.js";

/** @import { Repeat } from "../motion/motion.js" */

/**
 * The motion between two keyframes, as far as it is proved.
 *
 * @typedef {object} Interval
 * @property {number} start
 * @property {number} end
 * @property {number} until the last proved instant
 * @property {number[]} times of the knots
 * @property {Float32Array} floats coefficients at the knots; empty where the kernel evaluates
 */

/**
 * Draws coefficients, or, where they are null, has the kernel draw the time, and resolves when it
 * has. Without a time: the pose that is edited. Then come coefficients of other shapes, by their
 * keys, and the time of what is drawn, if that is proved no farther.
 *
 * @typedef {(floats: Float32Array | null, time?: number, others?: Record<string, Float32Array>,
 *   at?: number) => Promise<unknown> | void} Show
 */

/** @typedef {{ end: number, until: number, motion: Motion | null }} Part of a motion */

export class Player {
  /** @type {Motion | null} the times of all intervals, without coefficients */
  clock = null;
  time = 0; // of a ping-pong, on the way back too
  seen = false; // whether the motion is shown, not the pose that is edited
  only = 0; // s, of the keyframe, if there is only one
  /** @type {[start: number, end: number] | null} the part that plays over and over */
  range = null;
  /** @type {number | null} a time after the last keyframe */
  later = null;

  /** @type {Part[]} */
  #intervals = [];
  /** @type {Map<string, Part[]>} those of other shapes, by their keys */
  #others = new Map();
  #frame = 0;

  /**
   * @param {Show} show
   * @param {() => void} moved the playhead is elsewhere
   * @param {() => void} ended a motion that plays once has come to its end
   */
  constructor(show, moved, ended = () => {}) {
    this.show = show;
    this.moved = moved;
    this.ended = ended;
  }

  /**
   * @param {Interval[]} intervals
   * @param {Repeat} repeat
   * @param {Record<string, Interval[]>} others those of other shapes, by their keys
   */
  set(intervals, repeat, others = {}) {
    this.#intervals = intervals.map(partOf);
    const entries = Object.entries(others);
    this.#others = new Map(entries.map(([key, theirs]) => [key, theirs.map(partOf)]));
    const first = intervals[0];
    const last = intervals.at(-1);
    const times = first && last ? [first.start, last.end] : null;
    this.clock = times && new Motion({ times, repeat }, new Float32Array(0));
    if (this.seen && !this.playing) {
      if (this.later === null) this.#seek(this.time);
      else this.scrub(this.later);
    }
  }

  get playing() {
    return this.#frame !== 0;
  }

  /** Where the playhead is, from the first keyframe to the last: a ping-pong runs back. */
  get place() {
    if (this.later !== null) return this.later;
    const last = this.clock?.last ?? Infinity;
    return this.time > last ? 2 * last - this.time : this.time;
  }

  /**
   * Goes to a time, and stays there. The times before the first keyframe, and after the return of a
   * loop, are not those of a pose.
   *
   * @param {number} time
   */
  scrub(time) {
    this.#stop();
    const { clock } = this;
    const last = clock?.last ?? this.only;
    if (time > last && clock?.repeat !== "loop") this.#wait(time);
    else if (clock) this.#seek(Math.min(Math.max(time, clock.start), last));
    else this.release(last);
  }

  /** Plays, or pauses. */
  play() {
    const { clock } = this;
    if (this.playing || !clock) {
      this.pause();
      return;
    }
    this.later = null;
    const once = clock.repeat === "once" && !this.range;
    if (once && this.time >= clock.end) this.time = clock.start;
    /** @type {number | null} */
    let last = null;
    const step = async (/** @type {number} */ now) => {
      const time = this.#inRange(this.time + (last === null ? 0 : (now - last) / 1000));
      last = now;
      await this.#seek(time);
      if (!this.playing) return;
      if (once && time >= clock.end) {
        this.pause();
        this.ended();
      } else this.#frame = requestAnimationFrame(step);
    };
    this.#frame = requestAnimationFrame(step);
    this.moved();
  }

  /**
   * The time that plays instead of one: before or after the range, its start, and round and round.
   *
   * @param {number} time
   */
  #inRange(time) {
    if (!this.range) return time;
    const [start, end] = this.range;
    if (time >= start && time < end) return time;
    return time < start || this.time >= end ? start : start + ((time - start) % (end - start));
  }

  /** Stays where it is. What is seen is shown once more, now that it stands still. */
  pause() {
    const { playing } = this;
    this.#stop();
    if (playing) this.renew();
    this.moved();
  }

  /** Shows what is seen once more, if it stands still. */
  renew() {
    if (!this.seen || this.playing) return;
    if (this.later === null) this.#showAt(this.place, this.place);
    else this.#showAt(this.time, this.later);
  }

  #stop() {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
  }

  /**
   * Back to the pose that is edited.
   *
   * @param {number} time of that pose
   */
  release(time) {
    this.#stop();
    this.time = time;
    this.later = null;
    if (this.seen) {
      this.seen = false;
      this.show(null);
    }
    this.moved();
  }

  /** @param {number} time after the last keyframe */
  #wait(time) {
    this.later = time;
    this.time = this.clock?.last ?? this.only;
    this.seen = true;
    this.#showAt(this.time, time);
    this.moved();
  }

  /** @param {number} time */
  #seek(time) {
    const { clock } = this;
    if (!clock) {
      this.release(0);
      return;
    }
    this.later = null;
    this.time = time === clock.end ? time : clock.within(time);
    this.seen = true;
    const { place } = this;
    const shown = this.#showAt(place, place);
    this.moved();
    return shown;
  }

  /**
   * Shows the motions at a place of theirs, or where they are proved last before it.
   *
   * @param {number} place
   * @param {number} time that is told
   */
  #showAt(place, time) {
    const own = partAt(this.#intervals, place);
    const others = [...this.#others].map(([key, parts]) => ({ key, part: partAt(parts, place) }));
    const untils = others.map(({ part }) => part?.until ?? place);
    const at = Math.min(place, own?.until ?? place, ...untils);
    const moved = others.flatMap(({ key, part }) => {
      const floats = part?.motion?.at(at);
      return floats ? [[key, floats]] : [];
    });
    return this.show(own?.motion?.at(at) ?? null, time, Object.fromEntries(moved), at);
  }
}

/**
 * @param {Interval} interval
 * @returns {Part}
 */
function partOf({ end, until, times, floats }) {
  const motion = floats.length ? new Motion({ times, repeat: "once" }, floats) : null;
  return { end, until, motion };
}

/**
 * The part of a motion that holds a place; the last one after its end.
 *
 * @param {Part[]} parts
 * @param {number} place
 */
function partAt(parts, place) {
  return parts.find(({ end }) => place <= end) ?? parts.at(-1);
}
