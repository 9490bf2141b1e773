// The page's own solver goes ahead of the kernel, so that the hand does not wait for the network.
//
// While pins are dragged, the worker follows the pointer from the map at which the kernel was at rest,
// and proves every map. Those are shown until the kernel is at rest again; its map is shown from then
// on. Every other gesture is the kernel's alone.

import { Solving, startedWorker } from "../live/solving.js";
import { Wire } from "../live/wire.js";
import { distance } from "../pad/view.js";

/** @import { Port } from "../live/solving.js" */
/** @import { LiveMap, Pose } from "../live/types.js" */
/** @import { Mark, Model, Point } from "../types.js" */
/** @import { CanvasTraits, Marks, Ring } from "./traits.js" */

const SAME = 1e-4; // world units: the kernel's marks are rounded

/**
 * A map ahead of the kernel's, and what is drawn of its pins.
 *
 * @typedef {object} Lead
 * @property {Float32Array} floats the map, as `Wire` has it
 * @property {Pick<Marks, "targets" | "images"> & { samples: Float64Array }} pins
 */

export class Ahead {
  #model;
  #show;
  #makeWorker;
  /** @type {Solving | null} */
  #solving = null;
  /** @type {Port | null} */
  #worker = null;
  /** @type {Wire | null} */
  #wire = null;
  #turn = 0; // counts the preparations, to tell the newest
  #ready = false;
  /** @type {Pose | null} that of the maps that are shown; null if they are the kernel's */
  #pose = null;
  #first = 0; // the first request since they are

  /**
   * @param {Model<CanvasTraits>} model
   * @param {(lead: Lead | null) => void} show
   * @param {(script: string) => Port} makeWorker
   */
  constructor(model, show, makeWorker = startedWorker) {
    this.#model = model;
    this.#show = show;
    this.#makeWorker = makeWorker;
  }

  /** Whether the page is ahead of the kernel. */
  get leads() {
    return this.#pose !== null;
  }

  /** Starts the solver of the present shape; until it is ready, the kernel's maps are shown. */
  async prepare() {
    this.close();
    this.#turn += 1;
    const turn = this.#turn;
    const script = this.#model.get("solver_script");
    const { options } = this.#model.get("solver");
    const outlined = this.#model.get("outline");
    if (!script || !options || !outlined.outline) return;
    const { outline, ...sizes } = outlined;
    this.#wire = new Wire(outline, sizes);
    this.#worker = this.#makeWorker(script);
    this.#solving = new Solving(this.#worker, (map) => this.#take(map));
    await this.#solving.ask({ type: "shape", outline, options });
    this.#ready = turn === this.#turn;
  }

  /**
   * Follows dragged pins.
   *
   * @param {Map<Mark, Point>} held where they should be
   */
  follow(held) {
    if (!this.#ready || !this.#solving || !held.size) return;
    if (!this.#pose && !this.#begin(this.#solving, held)) return;
    const pose = /** @type {Pose} */ (this.#pose);
    const targets = pose.targets.map((target, i) => held.get(i) ?? target);
    if (targets.every((target, i) => distance(target, pose.targets[i]) === 0)) return;
    this.#pose = { ...pose, targets };
    this.#solving.drag(this.#pose);
  }

  /**
   * Goes on from the kernel's map. False if the kernel has another pose by now; it may have moved the
   * pins that are held.
   *
   * @param {Solving} solving
   * @param {Map<Mark, Point>} held
   */
  #begin(solving, held) {
    const { pose, coefficients } = this.#model.get("rest");
    const { targets } = this.#model.get("marks");
    if (pose?.targets.length !== targets.length) return false;
    const elsewhere = (/** @type {Point} */ one, /** @type {number} */ i) =>
      !held.has(i) && distance(one, targets[i]) > SAME;
    if (pose.targets.some(elsewhere)) return false;
    this.#pose = pose;
    const floats = new Float64Array(
      coefficients.buffer.slice(
        coefficients.byteOffset,
        coefficients.byteOffset + coefficients.byteLength,
      ),
    );
    this.#first = solving.place(pose, floats);
    return true;
  }

  /** Shows the kernel's maps again. */
  giveBack() {
    if (!this.#pose) return;
    this.#pose = null;
    this.#show(null);
  }

  close() {
    this.giveBack();
    this.#ready = false;
    this.#worker?.terminate?.();
    this.#worker = null;
    this.#solving = null;
  }

  /** @param {LiveMap} map */
  #take({ id, coefficients, certificate, pins }) {
    const pose = this.#pose;
    if (!pose || !this.#wire || id < this.#first || !certificate.certified) return;
    const at = (/** @type {unknown} */ _, /** @type {number} */ i) =>
      /** @type {Point} */ ([pins.images[2 * i], pins.images[2 * i + 1]]);
    const images = pose.targets.map(at);
    const { targets } = pose;
    const floats = this.#wire.of(coefficients);
    this.#show({ floats, pins: { targets, images, samples: pins.samples } });
  }
}

/**
 * The marks with the pins of a lead, if they are the same ones.
 *
 * @param {Marks} marks
 * @param {Lead | null} lead
 * @returns {Marks}
 */
export function marksOf(marks, lead) {
  const count = marks.targets.length;
  if (lead?.pins.targets.length !== count) return marks;
  const { targets, images, samples } = lead.pins;
  return { ...marks, targets, images, ring: ringOf(marks, samples, count) };
}

/**
 * @param {Marks} marks
 * @param {Float64Array} samples
 * @param {number} count
 * @returns {Ring | []}
 */
function ringOf({ ring, selected }, samples, count) {
  const last = selected.at(-1);
  if (ring.length === 0 || last === undefined) return ring;
  const [angle, scale, turned, scaled] = ring;
  const [x, y] = [samples[last], samples[count + last]];
  return [turned ? angle : Math.atan2(y, x), scaled ? scale : Math.hypot(x, y), turned, scaled];
}
