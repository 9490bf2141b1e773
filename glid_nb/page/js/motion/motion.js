// A motion as `playing` in `glid_nb.export.page` describes it: arrays at knots in time, mixed between them.
// A map depends linearly on its coefficients, so the mixed ones show exactly what is proved.

export class Motion {
  // values: plain JSON; floats: a Float32Array of the arrays of all knots, one after the other.
  constructor(values, floats) {
    Object.assign(this, values); // times, keyframes, repeat, sigma2, ...
    this.floats = floats;
    this.mixed = new Float32Array(floats.length / this.times.length);
  }

  get start() {
    return this.times[0];
  }

  get end() {
    const last = this.times.at(-1);
    return this.repeat === "ping-pong" ? 2 * last - this.start : last;
  }

  // The time from start to end that shows what any time shows: loops and ping-pongs go on for ever.
  within(time) {
    const { start, end } = this;
    if (this.repeat === "once") return Math.min(Math.max(time, start), end);
    const span = end - start;
    return start + ((((time - start) % span) + span) % span);
  }

  // The piece between two knots at a time, and the share of it that has passed.
  place(time) {
    const { times } = this;
    let t = this.within(time);
    if (t > times.at(-1)) t = 2 * times.at(-1) - t; // a ping-pong's way back
    const next = times.findIndex((knot, i) => i && t < knot); // -1 at the end
    const high = next < 0 ? times.length - 1 : next;
    const low = high - 1;
    return { piece: low, share: (t - times[low]) / (times[high] - times[low]) };
  }

  // The array at a time. Every call returns the same one, with other numbers.
  at(time) {
    const { piece, share } = this.place(time);
    const { floats, mixed } = this;
    const n = mixed.length;
    const from = piece * n;
    const to = from + n;
    for (let i = 0; i < n; i++) mixed[i] = (1 - share) * floats[from + i] + share * floats[to + i];
    return mixed;
  }
}
