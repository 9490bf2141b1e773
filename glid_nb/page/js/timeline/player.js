// Shows a motion at a time and plays it. What is not proved is not shown: where an interval ends
// early, its last proved instant stays. After the last keyframe its pose stays, until a keyframe is
// made there.

import { Motion } from "../motion/motion.js";

/** @import { Repeat } from "../motion/motion.js" */

/**
 * The motion between two keyframes, as far as it is proved.
 *
 * @typedef {object} Interval
 * @property {number} start
 * @property {number} end
 * @property {number[]} times of the knots
 * @property {Float32Array} floats coefficients at the knots; empty where the kernel evaluates
 */

/**
 * Draws coefficients, or, where they are null, has the kernel draw the time, and resolves when it
 * has. Without a time: the pose that is edited.
 *
 * @typedef {(floats: Float32Array | null, time?: number) => Promise<unknown> | void} Show
 */

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

  /** @type {{ end: number, motion: Motion | null }[]} */
  #intervals = [];
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
   */
  set(intervals, repeat) {
    this.#intervals = intervals.map(({ end, times, floats }) => ({
      end,
      motion: floats.length ? new Motion({ times, repeat: "once" }, floats) : null,
    }));
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
    this.pause();
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

  pause() {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.moved();
  }

  /**
   * Back to the pose that is edited.
   *
   * @param {number} time of that pose
   */
  release(time) {
    this.pause();
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
    this.show(this.#intervals.at(-1)?.motion?.at(this.time) ?? null, time);
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
    const interval = this.#intervals.find(({ end }) => place <= end) ?? this.#intervals.at(-1);
    const shown = this.show(interval?.motion?.at(place) ?? null, place);
    this.moved();
    return shown;
  }
}
