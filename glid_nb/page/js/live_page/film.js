// Kept poses, and the motion through them. Every frame is a map that the worker has just proved.

import { glideTo, playedFrom } from "../exported/course.js";
import { Poses } from "../exported/poses.js";
import { Motion } from "../motion/motion.js";
import { make } from "../pad/dom.js";
import { iconButton } from "../pad/icons.js";
import { poseOf } from "./pins.js";
import { wayBetween } from "./way.js";

/** @import { Course } from "../exported/course.js" */
/** @import { LiveMap } from "../live/types.js" */
/** @import { Kept, Pin } from "./data.js" */
/** @import { Solver } from "../live/solving_types.js" */
/** @import { Knot } from "./way.js" */
/** @import { Repeat } from "../motion/motion.js" */

const SECONDS = 1; // from one kept pose to the next
const STRIPES = 100; // of the strip below the slider
const STEP = 1 / 25; // s, of the arrow keys on the slider

/**
 * A motion through poses.
 * @typedef {object} Reel
 * @property {number[]} times of the knots
 * @property {Knot[]} knots
 * @property {number[]} keyframes times of the poses
 * @property {Repeat} repeat
 */

/**
 * What the film needs of the page.
 * @typedef {object} Screen
 * @property {(frame: LiveMap | null) => void} show a frame of the motion; null for the pose that is edited
 * @property {(frame: LiveMap) => HTMLCanvasElement} thumbnail draws a small picture
 * @property {() => void} redraw
 * @property {(kept: Kept) => void} take goes on with a kept pose
 * @property {(text: string) => void} say
 */

export class Film {
  /** @type {Kept[]} */
  kept = [];
  /** Whether a frame of the motion is shown, not the pose that is edited. */
  seen = false;

  element = make("div", { className: "film", hidden: true });
  #list = make("div", { className: "poses", role: "group", "aria-label": "Kept poses" });
  #play = make("button", { className: "play", title: "Play or pause (Space)" });
  #slider = make("input", { type: "range", step: String(STEP), "aria-label": "Time, seconds" });
  #strip = make("i", { title: "Certified σ₂ at the knots" });
  #clock = make("output", { className: "clock" });
  #remove = iconButton("trash", "Remove this pose", () => this.#removeCurrent());

  /** @type {WeakMap<Kept, { start: Float64Array, to: Kept, knots: Knot[] }>} */
  #ways = new WeakMap();
  /** @type {Motion<Float64Array> | null} */
  #motion = null;
  /** @type {Knot[]} */
  #knots = [];
  #time = 0;
  #building = 0; // the number of the present build
  /** @type {(Course & { began: number }) | null} */
  #course = null;
  #due = 0;
  /** @type {Promise<Solver> | null} */
  #solving = null;
  #asking = false; // for a frame
  /** @type {number | null} the time of the next frame to ask for */
  #wanted = null;
  #left = true; // the pose that is edited is shown, whatever frame still comes
  /** @type {number[] | null} times of the poses; null while the motion is made */
  #keyframes = null;
  /** @type {Poses | null} */
  #poses = null;

  /**
   * @param {() => Promise<Solver>} start starts a solver of the motion's own, so that the edited
   *   pose stays where it is
   * @param {Screen} screen
   */
  constructor(start, screen) {
    this.start = start;
    this.screen = screen;
    const track = make("div", { className: "track" }, this.#slider, this.#strip);
    const player = make("div", { className: "player" }, this.#play, track, this.#clock);
    this.player = player;
    this.element.append(this.#list, this.#remove, player);
    this.#play.addEventListener("click", () => this.playOrPause());
    this.#slider.addEventListener("input", () => this.#goTo(Number(this.#slider.value)));
    this.#showPlaying();
  }

  solver() {
    this.#solving ??= this.start();
    return this.#solving;
  }

  get playing() {
    return Boolean(this.#course?.plays);
  }

  /** Draws one of the small pictures that wait. */
  drawOne() {
    this.#poses?.drawOne();
  }

  /**
   * A motion that was proved elsewhere; its frames are proved here once more.
   * @param {Reel} reel
   * @param {Pin[][]} poses pins of its poses
   */
  async load(reel, poses) {
    const solving = await this.solver();
    /** @type {Kept[]} */
    const kept = [];
    for (const [i, time] of reel.keyframes.entries()) {
      const { coefficients } = reel.knots[reel.times.indexOf(time)];
      const pins = poses[i] ?? [];
      const frame = await solving.map({ type: "place", pose: poseOf(pins), coefficients });
      kept.push({ pins, frame });
    }
    this.kept = kept;
    this.#take(reel);
    this.#showPoses();
  }

  /** @param {Kept} kept */
  async keep(kept) {
    this.kept = [...this.kept, kept];
    this.#keyframes = null;
    this.#time = this.#times[this.kept.length - 1]; // the kept pose is the one that is shown
    this.#showPoses();
    await this.#build();
  }

  /** Back to the pose that is edited. */
  release() {
    this.#run(null);
    this.#left = true;
    this.#wanted = null;
    if (!this.seen) return;
    this.seen = false;
    this.screen.show(null);
    this.#mark();
  }

  playOrPause() {
    const motion = this.#motion;
    if (!motion) return;
    const from = this.seen ? this.#time : motion.start;
    this.#run(this.playing ? null : playedFrom(motion, from, true));
  }

  #showPoses() {
    const times = this.#times;
    const at = (/** @type {number} */ time) => this.kept[times.indexOf(time)];
    this.#poses = new Poses(
      times,
      (time) => this.#choose(time, at(time)),
      (time) => this.screen.thumbnail(at(time).frame),
      () => this.screen.redraw(),
    );
    this.#list.replaceChildren(...this.#poses.buttons);
    this.element.hidden = this.kept.length === 0;
    this.player.hidden = this.kept.length < 2;
    this.#mark();
    this.screen.redraw();
  }

  get #times() {
    return this.kept.map((_, i) => this.#keyframes?.[i] ?? i * SECONDS);
  }

  /**
   * Goes to a pose along the motion, and continues from there.
   * @param {number} time
   * @param {Kept} kept
   */
  #choose(time, kept) {
    const motion = this.#motion;
    if (!motion || !this.seen) {
      this.#time = time;
      this.screen.take(kept);
      this.#mark();
      return;
    }
    this.#run(glideTo(motion, this.#time, time), () => {
      this.release();
      this.screen.take(kept);
      this.#mark();
    });
  }

  #removeCurrent() {
    const i = this.#current;
    if (i < 0) return;
    this.release();
    this.kept = this.kept.filter((_, j) => j !== i);
    this.#keyframes = null;
    this.#time = 0;
    this.#showPoses();
    this.#build();
  }

  /** The number of the pose at the present time; -1 for none. */
  get #current() {
    return this.#times.findIndex((time) => Math.abs(time - this.#time) < 1e-3);
  }

  /** Solves the ways that are new, and makes the motion. */
  async #build() {
    this.#building += 1;
    const build = this.#building;
    this.#keyframes = null;
    this.#motion = null;
    this.#showPlaying();
    if (this.kept.length < 2) return;
    this.#clock.textContent = "finding the way…";
    try {
      const knots = await this.#allKnots(() => build !== this.#building);
      if (build !== this.#building) return;
      const times = knots.map(
        (_, i) => (i * SECONDS * (this.kept.length - 1)) / (knots.length - 1),
      );
      this.#take({ times, knots, keyframes: this.#times, repeat: "ping-pong" });
    } catch (error) {
      if (build !== this.#building) return;
      this.#clock.textContent = "no way was found";
      this.screen.say(`The poses cannot be joined: ${/** @type {Error} */ (error).message}`);
    }
  }

  /** @param {() => boolean} overtaken */
  async #allKnots(overtaken) {
    const { kept } = this;
    const { coefficients, certificate } = kept[0].frame;
    /** @type {Knot[]} */
    const knots = [{ coefficients, sigma2: certificate.sigma2_lower }];
    for (let i = 0; i + 1 < kept.length && !overtaken(); i++) {
      knots.push(...(await this.#way(kept[i], kept[i + 1], knots[knots.length - 1].coefficients)));
    }
    return knots;
  }

  /**
   * @param {Kept} from
   * @param {Kept} to
   * @param {Float64Array} start
   */
  async #way(from, to, start) {
    const known = this.#ways.get(from);
    if (known?.to === to && known.start === start) return known.knots;
    const knots = await wayBetween(await this.solver(), from, to, start);
    this.#ways.set(from, { start, to, knots });
    return knots;
  }

  /** @param {Reel} reel */
  #take({ times, knots, keyframes, repeat }) {
    const width = knots[0].coefficients.length;
    const numbers = new Float64Array(width * knots.length);
    for (const [i, { coefficients }] of knots.entries()) numbers.set(coefficients, i * width);
    this.#motion = new Motion({ times, repeat }, numbers);
    this.#knots = knots;
    this.#keyframes = keyframes;
    this.#time = Math.min(Math.max(this.#time, this.#motion.start), this.#motion.end);
    this.#slider.min = String(this.#motion.start);
    this.#slider.max = String(this.#motion.end);
    this.#strip.style.background = this.#stripes(this.#motion);
    this.#showTime();
    this.#showPlaying();
  }

  /** @param {Motion<Float64Array>} motion */
  #stripes(motion) {
    const colors = Array.from({ length: STRIPES }, (_, i) => {
      const time = motion.start + ((i + 0.5) / STRIPES) * (motion.end - motion.start);
      const { piece } = motion.place(time);
      const bound = Math.min(this.#knots[piece].sigma2, this.#knots[piece + 1].sigma2);
      return `rgb(0 114 178/${bound}) ${i}% ${i + 1}%`; // the larger the bound, the fuller
    });
    return `linear-gradient(to right, ${colors})`;
  }

  /** @param {number} time */
  #goTo(time) {
    this.#run(null);
    this.#seek(time);
  }

  /** @param {number} time */
  #seek(time) {
    const motion = this.#motion;
    if (!motion) return;
    this.#time = time === motion.end ? time : motion.within(time);
    this.#wanted = this.#time;
    this.#left = false;
    this.#showTime();
    if (!this.#asking) this.#showWanted(motion);
  }

  /**
   * Has the map at the wanted time proved, and shows it then. What cannot be proved is not shown.
   * @param {Motion<Float64Array>} motion
   */
  async #showWanted(motion) {
    this.#asking = true;
    try {
      const solving = await this.solver();
      while (this.#wanted !== null) {
        const coefficients = motion.at(this.#wanted).slice();
        this.#wanted = null; // a newer time may come meanwhile
        const frame = await solving.map({ type: "place", pose: poseOf([]), coefficients });
        if (this.#left) break;
        this.seen = true;
        this.screen.show(frame);
      }
    } catch {
      this.screen.say("This instant is not proved, so the frame before stays.");
    } finally {
      this.#asking = false;
    }
  }

  #showTime() {
    const motion = this.#motion;
    if (!motion) return;
    this.#slider.value = String(this.#time);
    this.#clock.textContent = `${this.#time.toFixed(1)} / ${motion.end.toFixed(1)} s`;
    this.#mark();
  }

  #mark() {
    const { repeat, last = 0 } = this.#motion ?? {};
    const back = repeat === "ping-pong" && this.#time > last;
    this.#poses?.mark(back ? 2 * last - this.#time : this.#time);
    this.#remove.hidden = this.#current < 0;
  }

  /**
   * @param {Course | null} course null pauses
   * @param {() => void} [then] called at its end
   */
  #run(course, then = () => {}) {
    cancelAnimationFrame(this.#due);
    this.#course = course && { ...course, began: performance.now() };
    if (course) this.#due = requestAnimationFrame((now) => this.#tick(now, then));
    this.#showPlaying();
  }

  /**
   * @param {number} now
   * @param {() => void} then
   */
  #tick(now, then) {
    if (!this.#course) return;
    const { began, lasts, at } = this.#course;
    const passed = Math.min(Math.max(now - began, 0), lasts);
    this.#seek(at(passed));
    if (passed < lasts) {
      this.#due = requestAnimationFrame((next) => this.#tick(next, then));
      return;
    }
    this.#run(null);
    then();
  }

  #showPlaying() {
    const { playing } = this;
    this.#play.disabled = !this.#motion;
    this.#slider.disabled = !this.#motion;
    this.#play.textContent = playing ? "❚❚" : "▶";
    this.#play.setAttribute("aria-label", playing ? "Pause" : "Play");
  }
}
