// The loop of a Web Worker: it takes requests, solves a few steps at a time, and posts certified maps.
//
// Between two turns it reads what has come in, so that a hand's newest position counts.

import { FieldPoints } from "./fields.js";
import { bisections } from "./panels.js";
import { Shape } from "./shape.js";
import { Solver } from "./solver.js";

/** @import { Coefficients, LiveAnswer, LiveMap, LiveRequest } from "./types.js" */
/** @import { Outline, Pose, SolverOptions } from "./types.js" */
/** @import { Point } from "../types.js" */

const SETTLED = 1e-7; // a drag ends when a step promises less than this share of the energy

/**
 * What a worker's global scope has of a port.
 * @typedef {object} Scope
 * @property {((event: { data: LiveRequest }) => void) | null} onmessage
 * @property {(answer: LiveAnswer) => void} postMessage
 */

export class LiveWorker {
  #post;
  #later;
  /** @type {LiveRequest[]} */
  #waiting = [];
  #scheduled = false;
  /** @type {Solver | null} */
  #solver = null;
  /** @type {FieldPoints | null} */
  #points = null;
  /** @type {{ handles: Point[], points: FieldPoints } | null} */
  #pins = null;
  /**
   * The drag that is not settled yet.
   * @type {{ id: number, pose: Pose } | null}
   */
  #drag = null;

  /**
   * @param {(answer: LiveAnswer) => void} post
   * @param {(turn: () => void) => void} later runs a function after messages that have come in
   */
  constructor(post, later) {
    this.#post = post;
    this.#later = later;
  }

  /** @param {LiveRequest} request */
  receive(request) {
    const last = this.#waiting.at(-1);
    if (request.type === "drag" && last?.type === "drag") {
      this.#waiting.pop();
    }
    this.#waiting.push(request);
    this.#schedule();
  }

  #schedule() {
    if (this.#scheduled) {
      return;
    }
    this.#scheduled = true;
    this.#later(() => {
      this.#scheduled = false;
      this.#turn();
    });
  }

  #turn() {
    const request = this.#waiting.shift();
    const id = request?.id ?? this.#drag?.id ?? 0;
    try {
      if (request) {
        this.#answer(request);
      } else if (this.#drag) {
        this.#follow(this.#drag.id, this.#drag.pose);
      }
    } catch (error) {
      this.#drag = null;
      this.#post({ type: "failed", id, message: String(error) });
    }
    if (this.#waiting.length > 0 || this.#drag) {
      this.#schedule();
    }
  }

  /** @param {LiveRequest} request */
  #answer(request) {
    this.#drag = null;
    switch (request.type) {
      case "shape":
        return this.#prepare(request.id, request.outline, request.points, request.options);
      case "options":
        return this.#change(request.id, request.options);
      case "solve":
        return this.#solve(request.id, request.pose);
      case "drag":
        return this.#follow(request.id, request.pose);
      case "place":
        return this.#place(request.id, request.pose, request.coefficients);
      case "points":
        return this.#evaluateAt(request.id, request.points);
      case "claim":
        return this.#claim(request.id);
    }
  }

  /**
   * @param {number} id
   * @param {Outline} outline
   * @param {Point[]} [points]
   * @param {SolverOptions} [options]
   */
  #prepare(id, outline, points, options) {
    const shape = new Shape(outline);
    this.#solver = new Solver(shape, options);
    this.#points = points ? new FieldPoints(shape.domain, points) : null;
    const { panels, domain } = shape;
    this.#post({ type: "ready", id, panels: panels.count, columns: domain.columns });
  }

  /**
   * @param {number} id
   * @param {SolverOptions} options
   */
  #change(id, options) {
    this.#solver = this.#ready().withOptions(options);
    this.#postMap(id, "minimal", true);
  }

  /**
   * @param {number} id
   * @param {Pose} pose
   */
  #solve(id, pose) {
    const solver = this.#ready();
    const began = performance.now();
    const before = solver.steps;
    const outcome = solver.solve(pose);
    this.#postMap(id, outcome, true, solver.steps - before, performance.now() - began);
  }

  /**
   * @param {number} id
   * @param {Pose} pose
   */
  #follow(id, pose) {
    const solver = this.#ready();
    const began = performance.now();
    const before = solver.steps;
    const outcome = solver.drag(pose);
    const settled = outcome !== "stepped" || solver.promised < SETTLED;
    this.#drag = settled ? null : { id, pose };
    this.#postMap(id, outcome, settled, solver.steps - before, performance.now() - began);
  }

  /**
   * @param {number} id
   * @param {Pose} pose
   * @param {Coefficients} coefficients
   */
  #place(id, pose, coefficients) {
    this.#ready().place(pose, coefficients);
    this.#postMap(id, "placed", true);
  }

  /**
   * @param {number} id
   * @param {Point[]} points
   */
  #evaluateAt(id, points) {
    this.#points = new FieldPoints(this.#ready().shape.domain, points);
    this.#postMap(id, "placed", true);
  }

  /** @param {number} id */
  #claim(id) {
    const { state, shape } = this.#ready();
    const { coefficients, certificate } = state;
    const panels = bisections(shape.domain);
    this.#post({ type: "claim", id, claim: { coefficients, certificate, panels } });
  }

  #ready() {
    if (!this.#solver) {
      throw new Error("there is no shape yet; send a request of the type shape first");
    }
    return this.#solver;
  }

  /**
   * @param {number} id
   * @param {string} outcome
   * @param {boolean} settled
   * @param {number} [steps]
   * @param {number} [took] ms
   */
  #postMap(id, outcome, settled, steps = 0, took = 0) {
    const { state, energy } = this.#ready();
    const coefficients = state.coefficients.slice();
    const began = performance.now();
    const field = this.#points?.evaluate(coefficients);
    const evaluated = performance.now() - began;
    /** @type {LiveMap} */
    const map = {
      type: "map",
      id,
      settled,
      outcome,
      energy,
      coefficients,
      certificate: state.certificate,
      images: field?.images ?? null,
      samples: field?.samples ?? null,
      pins: this.#pinned().evaluate(coefficients),
      steps,
      took,
      evaluated,
    };
    this.#post(map);
  }

  /** The pins' places, with the rows of the basis there. */
  #pinned() {
    const { shape, pins } = this.#ready();
    const { handles } = pins.pose;
    if (!this.#pins || JSON.stringify(this.#pins.handles) !== JSON.stringify(handles)) {
      this.#pins = { handles, points: new FieldPoints(shape.domain, handles) };
    }
    return this.#pins.points;
  }
}

/**
 * Serves a worker's scope.
 * @param {Scope} scope
 */
export function serve(scope) {
  const turns = new MessageChannel();
  /** @type {(() => void)[]} */
  const queue = [];
  turns.port1.onmessage = () => queue.shift()?.();
  const worker = new LiveWorker(
    (answer) => scope.postMessage(answer),
    (turn) => {
      queue.push(turn);
      turns.port2.postMessage(null);
    },
  );
  scope.onmessage = ({ data }) => worker.receive(data);
}
