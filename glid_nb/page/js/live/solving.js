// The worker that solves: requests go out, certified maps come back.

/** @import { Coefficients, LiveAnswer, LiveMap, LiveRequest, Pose } from "./types.js" */
/** @typedef {import("./solving_types.js").Unnumbered} Unnumbered */

/**
 * What is needed of a worker.
 * @typedef {object} Port
 * @property {(request: LiveRequest) => void} postMessage
 * @property {((event: { data: LiveAnswer }) => void) | null} onmessage
 * @property {() => void} [terminate]
 */

export class Solving {
  #worker;
  #number = 0;
  /** @type {Map<number, { resolve: (answer: LiveAnswer) => void, reject: (error: Error) => void }>} */
  #asked = new Map();

  /**
   * @param {Port} worker
   * @param {(map: LiveMap) => void} onmap called with every map
   */
  constructor(worker, onmap = () => {}) {
    this.#worker = worker;
    this.onmap = onmap;
    worker.onmessage = ({ data }) => this.#answered(data);
  }

  /**
   * Sends a request. Resolves with the last answer to it; a map is the last one if it is settled.
   * Rejects with the worker's message if that failed.
   * @param {Unnumbered} request
   * @returns {Promise<LiveAnswer>}
   */
  ask(request) {
    const id = this.#send(request);
    return new Promise((resolve, reject) => this.#asked.set(id, { resolve, reject }));
  }

  /**
   * As `ask`, of a request that is answered with a map.
   * @param {Unnumbered} request
   */
  async map(request) {
    const answer = await this.ask(request);
    if (answer.type !== "map") throw new Error(`the answer is no map but of type ${answer.type}`);
    return answer;
  }

  /**
   * Follows moved pins. Later ones may replace this request; maps come to `onmap`.
   * @param {Pose} pose
   * @returns {number} the request's number, which its maps repeat
   */
  drag(pose) {
    return this.#send({ type: "drag", pose });
  }

  /**
   * Takes up another map.
   * @param {Pose} pose
   * @param {Coefficients} coefficients
   * @returns {number} the request's number
   */
  place(pose, coefficients) {
    return this.#send({ type: "place", pose, coefficients });
  }

  /**
   * @param {Unnumbered} request
   * @returns {number}
   */
  #send(request) {
    this.#number += 1;
    this.#worker.postMessage(/** @type {LiveRequest} */ ({ ...request, id: this.#number }));
    return this.#number;
  }

  /** @param {LiveAnswer} answer */
  #answered(answer) {
    const asked = this.#asked.get(answer.id);
    if (answer.type === "map") this.onmap(answer);
    if (answer.type === "map" && !answer.settled) return;
    this.#asked.delete(answer.id);
    if (answer.type === "failed") asked?.reject(new Error(answer.message));
    else asked?.resolve(answer);
  }
}

/**
 * A worker that runs a script.
 * @param {string} script
 * @returns {Port}
 */
export function startedWorker(script) {
  const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  const worker = new Worker(address);
  URL.revokeObjectURL(address);
  return /** @type {Port} */ (/** @type {unknown} */ (worker));
}
