// The solvers of several shapes as one. Only those are asked whose pins have changed.

import { jointMap, ownersOf, parted, posesOf } from "./joint_map.js";

/** @import { Coefficients, LiveMap, Pose } from "../live/types.js" */
/** @import { Solver, Unnumbered } from "../live/solving_types.js" */
/** @import { Solving } from "../live/solving.js" */
/** @import { JointMap } from "./data.js" */

/**
 * A request to all, and the numbers of the requests to each that answer it.
 * @typedef {{ number: number, needs: number[] }} Open
 */

/** @implements {Solver} */
export class JointSolving {
  /** @type {(map: LiveMap) => void} */
  onmap = () => {};

  #rests;
  #number = 0;
  #reached = 0; // the last request that all have answered
  /** @type {Open[]} */
  #open = [];
  /** @type {number[]} the last request to each */
  #asked;
  /** @type {LiveMap[]} the newest of each */
  #maps;
  /** @type {string[]} the pins that each follows; "" where it has been placed since */
  #followed;
  /** @type {number[]} the part of each pin */
  #owners = [];

  /**
   * @param {Solving[]} solvers
   * @param {Coefficients[]} rests the undeformed shapes
   * @param {LiveMap[]} maps those that the solvers have
   */
  constructor(solvers, rests, maps) {
    this.solvers = solvers;
    this.#rests = rests;
    this.#maps = [...maps];
    this.#asked = maps.map(({ id }) => id);
    this.#followed = maps.map(() => "");
    for (const [part, solver] of solvers.entries()) {
      solver.onmap = (map) => this.#take(part, map);
    }
  }

  /** The newest maps, as one. */
  get newest() {
    const settled = !this.#open.length && this.#maps.every((map) => map.settled);
    return jointMap(this.#maps, this.#owners, this.#reached, settled);
  }

  /**
   * Follows moved pins. A part whose last pin is gone returns to rest.
   * @param {Pose} pose
   */
  drag(pose) {
    this.#owners = ownersOf(pose);
    for (const [part, own] of posesOf(pose, this.solvers.length).entries()) {
      const pins = JSON.stringify(own);
      const before = this.#followed[part];
      this.#followed[part] = pins;
      const solver = this.solvers[part];
      if (own.handles.length) {
        if (pins !== before) this.#asked[part] = solver.drag(own);
      } else if (before && pins !== before) {
        this.#asked[part] = solver.place(own, this.#rests[part]);
      }
    }
    return this.#noted();
  }

  /**
   * Takes up other maps.
   * @param {Pose} pose
   * @param {Coefficients} coefficients of all parts
   */
  place(pose, coefficients) {
    const all = this.#parted(coefficients);
    this.#owners = ownersOf(pose);
    this.#followed = this.solvers.map(() => "");
    for (const [part, own] of posesOf(pose, this.solvers.length).entries()) {
      this.#asked[part] = this.solvers[part].place(own, all[part]);
    }
    return this.#noted();
  }

  /**
   * Resolves with the maps of all once each is the last one for its pins; rejects if one has failed.
   * @param {Unnumbered} request to place or to drag
   * @returns {Promise<JointMap>}
   */
  async map(request) {
    if (request.type !== "place" && request.type !== "drag") {
      throw new Error(`a request of the type ${request.type} goes to each solver`);
    }
    const { pose } = request;
    const all = request.type === "place" ? this.#parted(request.coefficients) : null;
    const asked = posesOf(pose, this.solvers.length).map((own, part) => {
      // Without pins nothing says where the shape is, so it stays.
      const coefficients = all ? all[part] : this.#maps[part].coefficients;
      const placed = all !== null || own.handles.length === 0;
      return this.solvers[part].map(
        placed ? { type: "place", pose: own, coefficients } : { type: "drag", pose: own },
      );
    });
    this.#number += 1;
    const id = this.#number;
    return jointMap(await Promise.all(asked), ownersOf(pose), id, true);
  }

  /** @param {Coefficients} coefficients of all parts */
  #parted(coefficients) {
    return parted(
      coefficients,
      this.#rests.map(({ length }) => length),
    );
  }

  /** The number of a request that the parts have just been asked. */
  #noted() {
    this.#number += 1;
    this.#open.push({ number: this.#number, needs: [...this.#asked] });
    queueMicrotask(() => this.#tell()); // perhaps nobody had to be asked
    return this.#number;
  }

  /**
   * @param {number} part
   * @param {LiveMap} map
   */
  #take(part, map) {
    this.#maps[part] = map;
    this.#tell(map);
  }

  /**
   * Tells of the newest maps.
   * @param {LiveMap} [fresh] the one that has just come
   */
  #tell(fresh) {
    const before = this.#reached;
    while (this.#open[0]?.needs.every((need, part) => this.#maps[part].id >= need)) {
      this.#reached = /** @type {Open} */ (this.#open.shift()).number;
    }
    if (!fresh && this.#reached === before) return;
    const { steps = 0, took = 0 } = fresh ?? {};
    this.onmap({ ...this.newest, steps, took });
  }
}
