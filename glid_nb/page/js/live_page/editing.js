// The pose that is edited: its pins, the certified map that follows them, and its history.

import { History } from "./history.js";
import { sourceAt } from "./mesh.js";
import { allowedScale, changed, nextPin, pinAt, poseOf, without, wrapped } from "./pins.js";

/** @import { Mesh } from "../exported/renderer.js" */
/** @import { Marks, Ring } from "../canvas/traits.js" */
/** @import { LiveMap } from "../live/types.js" */
/** @import { Point } from "../types.js" */
/** @import { Edit, Handle, Pin } from "./data.js" */
/** @import { Solver } from "../live/solving_types.js" */

/** World units between a target and the shape, above which the pin is not reached. */
const MISSED = 0.15;

export class Editing {
  /** @type {readonly Pin[]} */
  pins = [];
  /** @type {readonly number[]} */
  selected = [];
  /** Whether a gesture goes on; all its changes are one step of the history. */
  inGesture = false;

  /** @type {History<Edit>} */
  #history = new History();
  #oldest = 0; // maps of earlier requests are of a pose that is no more
  #aimed = 0; // the number of the last request

  /**
   * @param {Solver} solving
   * @param {Mesh} mesh for the points below a pointer
   * @param {LiveMap} frame the map to begin with
   * @param {Edit["coefficients"]} rest those of the undeformed shape
   */
  constructor(solving, mesh, frame, rest = frame.coefficients) {
    this.solving = solving;
    this.mesh = mesh;
    this.rest = rest;
    /** The newest certified map. */
    this.frame = frame;
    /** Called after every change. */
    this.told = () => {};
    solving.onmap = (map) => this.#take(map);
  }

  /**
   * Begins with pins that the map has, or nearly has.
   * @param {readonly Pin[]} pins
   */
  begin(pins) {
    this.#restore({ pins, selected: [], coefficients: this.frame.coefficients });
  }

  /** @returns {Edit} */
  get now() {
    const { pins, selected, frame } = this;
    return { pins, selected, coefficients: frame.coefficients };
  }

  get canUndo() {
    return this.#history.canUndo;
  }

  get canRedo() {
    return this.#history.canRedo;
  }

  /** Whether the newest map is the last one for these pins. */
  get settled() {
    return this.frame.settled && this.frame.id >= this.#aimed;
  }

  /**
   * What is to be drawn of the pins.
   * @returns {Marks}
   */
  get marks() {
    const targets = this.pins.map(({ target }) => target);
    const images = this.pins.map((_, i) => this.imageOf(i));
    return { targets, images, selected: [...this.selected], hidden: [], ring: this.#ring() };
  }

  /**
   * Where the shape has got to with a pin.
   * @param {number} i
   * @returns {Point}
   */
  imageOf(i) {
    const { images } = this.frame.pins;
    return this.#isKnown ? [images[2 * i], images[2 * i + 1]] : this.pins[i].target;
  }

  /** The numbers of pins that the shape cannot follow; none before it is at rest. */
  get missed() {
    if (!this.settled) return [];
    return [...this.pins.keys()].filter((i) => {
      const [x, y] = this.imageOf(i);
      const [u, v] = this.pins[i].target;
      return Math.hypot(x - u, y - v) > MISSED;
    });
  }

  /** Whether the shape cannot follow because no shorter step was proved. */
  get refused() {
    return this.frame.outcome === "refused";
  }

  /** @returns {Ring | []} */
  #ring() {
    const last = this.selected.at(-1);
    if (last === undefined) return [];
    const { angle, scale } = this.turnOf(last);
    const pin = this.pins[last];
    return [angle, scale, pin.angle !== null, pin.scale !== null];
  }

  /**
   * The angle and scale that a pin asks for, or else those that the shape has there.
   * @param {number} i
   */
  turnOf(i) {
    const { samples } = this.frame.pins;
    const count = samples.length / 4;
    const [x, y] = this.#isKnown ? [samples[i], samples[count + i]] : [1, 0];
    const { angle, scale } = this.pins[i];
    return { angle: angle ?? Math.atan2(y, x), scale: scale ?? Math.hypot(x, y) };
  }

  /** Whether the newest map was evaluated at these pins. */
  get #isKnown() {
    return this.frame.pins.images.length === 2 * this.pins.length;
  }

  /**
   * The point of the undeformed shape at a place; null beside the shape.
   * @param {Point} place
   * @returns {Handle | null}
   */
  sourceAt(place) {
    return sourceAt(this.mesh, this.frame.images ?? [], place);
  }

  /** @param {readonly number[]} selected */
  select(selected) {
    this.selected = [...new Set(selected)];
    this.told();
  }

  /** @param {number} step 1 or -1 */
  selectNext(step) {
    const next = nextPin(this.pins.length, this.selected.at(-1), step);
    if (next >= 0) this.select([next]);
  }

  /**
   * Pins and selects the point of the shape at a place. Returns whether there is one.
   * @param {Point} place
   */
  pin(place) {
    const handle = this.sourceAt(place);
    if (!handle) return false;
    this.#change([...this.pins, pinAt(handle, place)], [this.pins.length]);
    return true;
  }

  /** Removes the selected pins. */
  remove() {
    if (this.selected.length) this.#change(without(this.pins, this.selected), []);
  }

  /**
   * Moves the targets of some pins.
   * @param {Map<number, Point>} targets
   */
  move(targets) {
    const change = (/** @type {Pin} */ pin, /** @type {number} */ i) => ({
      target: targets.get(i) ?? pin.target,
    });
    this.#change(changed(this.pins, [...targets.keys()], change), this.selected);
  }

  /** @param {Point} by world units */
  nudge([dx, dy]) {
    const move = (/** @type {Pin} */ { target: [x, y] }) => ({
      target: /** @type {Point} */ ([x + dx, y + dy]),
    });
    this.#change(changed(this.pins, this.selected, move), this.selected);
  }

  /**
   * Sets angles or scales of the selected pins.
   * @param {(i: number) => Partial<Pick<Pin, "angle" | "scale">>} change
   */
  turn(change) {
    const allowed = (/** @type {Pin} */ _, /** @type {number} */ i) => {
      const { angle, scale } = change(i);
      return {
        ...(angle === undefined ? {} : { angle: angle === null ? null : wrapped(angle) }),
        ...(scale === undefined ? {} : { scale: scale === null ? null : allowedScale(scale) }),
      };
    };
    if (!this.selected.length) return;
    this.#change(changed(this.pins, this.selected, allowed), this.selected);
  }

  beginGesture() {
    if (this.inGesture) return;
    this.#history.note(this.now);
    this.inGesture = true;
  }

  endGesture() {
    if (!this.inGesture) return;
    this.inGesture = false;
    this.told();
  }

  /** Goes back to where the gesture began. */
  cancelGesture() {
    if (!this.inGesture) return;
    this.inGesture = false;
    const before = this.#history.drop();
    if (before) this.#restore(before);
  }

  undo() {
    const before = this.#history.undo(this.now);
    if (before) this.#restore(before);
  }

  redo() {
    const after = this.#history.redo(this.now);
    if (after) this.#restore(after);
  }

  /**
   * Goes on with another map and its pins. Undo comes back.
   * @param {readonly Pin[]} pins
   * @param {Edit["coefficients"]} coefficients
   */
  replace(pins, coefficients) {
    this.#history.note(this.now);
    this.#restore({ pins, selected: [], coefficients });
  }

  /**
   * @param {readonly Pin[]} pins
   * @param {readonly number[]} selected
   */
  #change(pins, selected) {
    if (!this.inGesture) this.#history.note(this.now);
    const fewer = pins.length < this.pins.length;
    this.pins = pins;
    this.selected = selected;
    if (pins.length) this.#aimed = this.solving.drag(poseOf(pins));
    else this.#place(this.rest); // without pins nothing says where the shape is
    // Maps on their way have other pins.
    if (fewer) this.#oldest = this.#aimed;
    this.told();
  }

  /** @param {Edit} edit */
  #restore({ pins, selected, coefficients }) {
    this.pins = pins;
    this.selected = selected.filter((i) => i < pins.length);
    this.#place(coefficients);
    if (pins.length) this.#aimed = this.solving.drag(poseOf(pins));
    this.told();
  }

  /** @param {Edit["coefficients"]} coefficients */
  #place(coefficients) {
    const asked = this.solving.place(poseOf(this.pins), coefficients);
    this.#aimed = asked;
    this.#oldest = asked;
  }

  /** @param {LiveMap} map */
  #take(map) {
    if (map.id < this.#oldest || !map.certificate.certified) return;
    this.frame = map;
    this.told();
  }
}
