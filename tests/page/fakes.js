// A page, as far as the modules under test need one.

/** Runs what waits for the next frame. */
export class Frames {
  /** @type {(((now: number) => void) | null)[]} */
  #waiting = [];

  constructor() {
    Object.assign(globalThis, {
      requestAnimationFrame: (/** @type {(now: number) => void} */ act) => this.#waiting.push(act),
      cancelAnimationFrame: (/** @type {number} */ number) => {
        if (number) this.#waiting[number - 1] = null;
      },
      document: { hidden: false },
    });
  }

  /** @param {number} now ms */
  run(now = 0) {
    const due = this.#waiting;
    this.#waiting = due.map(() => null);
    for (const act of due) act?.(now);
  }
}

/**
 * A widget's model that keeps what it sends.
 *
 * @param {Record<string, unknown>} traits
 */
export function fakeModel(traits = {}) {
  /** @type {[string, (...values: any[]) => void][]} */
  const listeners = [];
  return {
    /** @type {any[]} */
    sent: [],
    widget_manager: { kernel: /** @type {any} */ (undefined) },
    get: (/** @type {string} */ name) => traits[name],
    set: (/** @type {string} */ name, /** @type {unknown} */ value) => {
      traits[name] = value;
    },
    save_changes() {},
    send(/** @type {unknown} */ content) {
      this.sent.push(content);
    },
    on: (/** @type {string} */ names, /** @type {(...values: any[]) => void} */ listener) => {
      listeners.push([names, listener]);
    },
    off() {},
    trigger: (/** @type {string} */ name, /** @type {any[]} */ ...values) => {
      for (const [names, listener] of listeners) {
        if (names.split(" ").includes(name)) listener(...values);
      }
    },
  };
}
