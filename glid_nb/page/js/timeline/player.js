// Shows a motion at a time and plays it. What is not proved is not shown: where an interval ends
// early, its last proved instant stays.

import { Motion } from "../motion/motion.js";

export class Player {
  // show(floats, time): draws coefficients, or, where floats is null, has the kernel draw the time and
  // resolves when it has; show(null): the pose that is edited. moved(): the playhead is elsewhere.
  constructor(show, moved) {
    Object.assign(this, { show, moved, spans: [], clock: null, time: 0, seen: false, frame: 0 });
  }

  // spans: start, end, times and floats of the knots as far as they are proved.
  set(spans, repeat) {
    this.spans = spans.map((span) => ({
      ...span,
      motion: span.floats.length
        ? new Motion({ times: span.times, repeat: "once" }, span.floats)
        : null,
    }));
    const ends = spans.length ? [spans[0].start, spans.at(-1).end] : null;
    this.clock = ends && new Motion({ times: ends, repeat }, new Float32Array(0));
    if (this.seen && !this.frame) this.seek(this.time);
  }

  get playing() {
    return this.frame !== 0;
  }

  // Where the playhead is, from the first keyframe to the last: a ping-pong runs back.
  get place() {
    const last = this.clock?.times[1];
    return this.time > last ? 2 * last - this.time : this.time;
  }

  seek(time) {
    if (!this.clock) return this.release(0);
    this.time = time === this.clock.end ? time : this.clock.within(time);
    this.seen = true;
    const { place } = this;
    const span = this.spans.find(({ end }) => place <= end) ?? this.spans.at(-1);
    const shown = this.show(span.motion?.at(place) ?? null, place);
    this.moved();
    return shown;
  }

  // Goes to a time from the first keyframe to the last, and stays there.
  scrub(time) {
    this.pause();
    if (this.clock) this.seek(Math.min(Math.max(time, this.clock.start), this.clock.times[1]));
  }

  play() {
    if (this.playing || !this.clock) return this.pause();
    const { start, end, repeat } = this.clock;
    if (repeat === "once" && this.time >= end) this.time = start;
    let last = null;
    const step = async (now) => {
      const time = this.time + (last === null ? 0 : (now - last) / 1000);
      last = now;
      await this.seek(time);
      if (!this.playing) return;
      if (repeat === "once" && time >= end) this.pause();
      else this.frame = requestAnimationFrame(step);
    };
    this.frame = requestAnimationFrame(step);
    this.moved();
  }

  pause() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.moved();
  }

  // Back to the pose that is edited, which is at this time.
  release(time) {
    this.pause();
    this.time = time;
    if (this.seen) {
      this.seen = false;
      this.show(null);
    }
    this.moved();
  }
}
