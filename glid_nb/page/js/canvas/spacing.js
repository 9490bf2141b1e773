// Moves of the pointer for the kernel, spaced while the page's own solver leads and the page draws
// without a graphics processor: the kernel's solver would take the processor from the drawing.

/** @import { KernelEvent } from "../types.js" */

/** @typedef {(event: KernelEvent) => Promise<string | null>} Put */

const PAUSE = 500; // ms between two moves; certificate, energy and plots follow these

export class Spacing {
  #put;
  /** @type {KernelEvent | null} the newest move that waits */
  #waits = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} while it runs, a move waits */
  #timer;

  /** @param {Put} put */
  constructor(put) {
    this.#put = put;
  }

  /**
   * Sends an event. If it may wait, the newest of those that do goes on a little later; before any
   * other event, what waits goes first.
   *
   * @param {KernelEvent} event
   * @param {boolean} mayWait
   * @returns {Promise<string | null>} the kernel's refusal, or null
   */
  put(event, mayWait) {
    if (mayWait && this.#timer !== undefined) {
      this.#waits = event;
      return Promise.resolve(null);
    }
    this.#flush();
    if (mayWait) this.#pause();
    return this.#put(event);
  }

  close() {
    clearTimeout(this.#timer);
  }

  #pause() {
    this.#timer = setTimeout(() => {
      if (this.#flush()) this.#pause();
    }, PAUSE);
  }

  /** Sends what waits, if something does. */
  #flush() {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    const event = this.#waits;
    this.#waits = null;
    if (event) void this.#put(event);
    return event !== null;
  }
}
