// A motion as `playing` in `glid_nb.export.page` describes it: arrays at knots in time, and mixed ones
// in between. A map depends linearly on its coefficients, so they show exactly what is proved.

/** @typedef {"once" | "loop" | "ping-pong"} Repeat */

/** @template {Float32Array | Float64Array} [Numbers=Float32Array] */
export class Motion {
  /**
   * @param {{ times: number[], repeat: Repeat }} values the knots' times; of a ping-pong, those of
   *   the way there
   * @param {Numbers} floats the arrays of all knots, one after the other
   */
  constructor({ times, repeat }, floats) {
    this.times = times;
    this.repeat = repeat;
    this.floats = floats;
    this.mixed = /** @type {Numbers} */ (floats.slice(0, floats.length / times.length));
    this.start = times[0];
    this.last = times[times.length - 1]; // knot
    this.end = repeat === "ping-pong" ? 2 * this.last - this.start : this.last;
  }

  /**
   * The time from start to end that shows what any time shows: loops and ping-pongs go on for ever.
   *
   * @param {number} time
   */
  within(time) {
    const { start, end } = this;
    if (this.repeat === "once") return Math.min(Math.max(time, start), end);
    const span = end - start;
    return start + ((((time - start) % span) + span) % span);
  }

  /**
   * The piece between two knots at a time, and the share of it that has passed.
   *
   * @param {number} time
   */
  place(time) {
    const { times, last } = this;
    const within = this.within(time);
    const there = within > last ? 2 * last - within : within; // a ping-pong's way back
    const next = times.findIndex((knot, i) => i > 0 && there < knot); // -1 at the end
    const high = next < 0 ? times.length - 1 : next;
    const low = high - 1;
    return { piece: low, share: (there - times[low]) / (times[high] - times[low]) };
  }

  /**
   * The array at a time. Every call returns the same one, with other numbers.
   *
   * @param {number} time
   */
  at(time) {
    const { piece, share } = this.place(time);
    const { floats, mixed } = this;
    const low = piece * mixed.length;
    const high = low + mixed.length;
    for (let i = 0; i < mixed.length; i++) {
      mixed[i] = (1 - share) * floats[low + i] + share * floats[high + i];
    }
    return mixed;
  }
}
