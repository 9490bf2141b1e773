// Shows a motion at a time and plays it. What is not proved is not shown: where an interval ends
// early, its last proved instant stays.

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
    if (this.seen && !this.playing) this.#seek(this.time);
  }

  get playing() {
    return this.#frame !== 0;
  }

  /** Where the playhead is, from the first keyframe to the last: a ping-pong runs back. */
  get place() {
    const last = this.clock?.last ?? Infinity;
    return this.time > last ? 2 * last - this.time : this.time;
  }

  /**
   * Goes to a time from the first keyframe to the last, and stays there.
   *
   * @param {number} time
   */
  scrub(time) {
    this.pause();
    if (this.clock) this.#seek(Math.min(Math.max(time, this.clock.start), this.clock.last));
  }

  /** Plays, or pauses. */
  play() {
    const { clock } = this;
    if (this.playing || !clock) {
      this.pause();
      return;
    }
    const once = clock.repeat === "once";
    if (once && this.time >= clock.end) this.time = clock.start;
    /** @type {number | null} */
    let last = null;
    const step = async (/** @type {number} */ now) => {
      const time = this.time + (last === null ? 0 : (now - last) / 1000);
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
    if (this.seen) {
      this.seen = false;
      this.show(null);
    }
    this.moved();
  }

  /** @param {number} time */
  #seek(time) {
    const { clock } = this;
    if (!clock) {
      this.release(0);
      return;
    }
    this.time = time === clock.end ? time : clock.within(time);
    this.seen = true;
    const { place } = this;
    const interval = this.#intervals.find(({ end }) => place <= end) ?? this.#intervals.at(-1);
    const shown = this.show(interval?.motion?.at(place) ?? null, place);
    this.moved();
    return shown;
  }
}
