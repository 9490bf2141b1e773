// Messages to the kernel. Events wait while the last batch is not answered, or its frame not drawn.
// {view, events} goes to the kernel with buffers, {view, ack, refusal} comes back: `ack` is the number
// of the last event, `refusal` says why it was refused.

/** @import { KernelEvent, Model } from "../types.js" */

/** @typedef {{ view: string, ack: number, refusal: string | null }} Answer */
/** @typedef {{ number: number, resolve: (refusal: string | null) => void }} Promised */

const BUSY_AFTER = 250; // ms without an answer until the page says that it waits
const ACKNOWLEDGE_TIMEOUT = 2000; // ms until events are sent without an answer

export class Link {
  busy = false; // an answer is overdue
  /** @type {string | null} why the kernel refused the last batch */
  refusal = null;

  view = Math.random().toString(36).slice(2);
  /** @type {(KernelEvent & { seq: number })[]} */
  #queue = [];
  /** @type {ArrayBuffer[]} */
  #buffers = [];
  /** @type {Promised[]} */
  #promised = [];
  #waiting = false; // for the answer to a batch, or for its frame
  #awaited = 0; // the number of the last event of that batch
  #number = 0; // of the last event
  #acknowledged = 0; // the number of the last event that was answered
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #overdue;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timeout;
  #drawing = 0;

  /**
   * @param {Model<any>} model
   * @param {HTMLElement} element its `data-idle` says whether all is answered
   * @param {AbortSignal} signal ends it
   * @param {() => void} report called when an answer came, or is overdue
   */
  constructor(model, element, signal, report) {
    this.model = model;
    this.element = element;
    this.signal = signal;
    this.report = report;
    connectNoMoreComms(model.widget_manager.kernel);
    element.dataset.idle = "true";
    signal.addEventListener("abort", () => this.#stop());
    model.on("msg:custom", (/** @type {Answer} */ message) => {
      if (message.view === this.view) this.#answered(message);
    });
  }

  /** Whether all events were answered. */
  get idle() {
    return this.#acknowledged === this.#number;
  }

  /**
   * Sends an event, or has it wait. It replaces the last one that waits if both have the same
   * `replaces`.
   *
   * @param {KernelEvent} event
   * @param {ArrayBuffer[]} buffers
   * @returns {Promise<string | null>} the kernel's refusal, or null, when the event was handled
   */
  put(event, buffers = []) {
    this.#number += 1;
    const number = this.#number;
    const last = this.#queue.at(-1);
    if (last?.replaces && last.replaces === event.replaces) this.#queue.pop();
    this.#queue.push({ ...event, seq: number });
    this.#buffers.push(...buffers);
    this.element.dataset.idle = "false";
    this.#flush();
    return new Promise((resolve) => this.#promised.push({ number, resolve }));
  }

  #flush() {
    if (this.#waiting || !this.#queue.length) return;
    this.#waiting = true;
    this.#awaited = this.#number;
    try {
      const { kernel } = this.model.widget_manager; // undefined where the page does not tell
      if (kernel === null || kernel?.isDisposed) throw new Error("the kernel was shut down");
      this.model.send({ view: this.view, events: this.#queue }, undefined, this.#buffers);
    } catch {
      this.#markDisconnected();
      return;
    }
    this.#queue = [];
    this.#buffers = [];
    this.#overdue = setTimeout(() => {
      this.busy = true;
      this.report();
    }, BUSY_AFTER);
    this.#timeout = setTimeout(() => this.#release(), ACKNOWLEDGE_TIMEOUT);
  }

  // The kernel is gone. Nothing is sent any more, and the page says so if it does not yet.
  #markDisconnected() {
    const around = this.element.closest(".glid-editor") ?? this.element.closest(".glid-host");
    around?.classList.add("jupyter-widgets-disconnected");
  }

  /** @param {Answer} answer */
  #answered({ ack, refusal }) {
    if (ack === this.#awaited) clearTimeout(this.#overdue);
    this.#acknowledged = Math.max(this.#acknowledged, ack);
    this.busy = false;
    this.refusal = refusal;
    this.element.dataset.idle = String(this.idle);
    const due = this.#promised.filter(({ number }) => number <= ack);
    this.#promised = this.#promised.filter(({ number }) => number > ack);
    for (const { resolve } of due) resolve(refusal);
    this.report();
    if (ack < this.#awaited) return;
    // The frame arrived before this answer; the page's next drawing shows it.
    if (document.hidden) this.#release();
    else this.#drawing = requestAnimationFrame(() => this.#release());
  }

  #release() {
    this.#stop();
    this.#waiting = false;
    this.#flush();
  }

  #stop() {
    clearTimeout(this.#overdue);
    clearTimeout(this.#timeout);
    cancelAnimationFrame(this.#drawing);
  }
}

/**
 * Keeps comms from connecting to their kernel's status for good.
 *
 * Each comm of JupyterLab connects (CommHandler in @jupyterlab/services), which keeps closed widgets,
 * their views and elements in the page. All of them do the same then, so those of now are enough.
 *
 * @param {any} kernel
 */
function connectNoMoreComms(kernel) {
  const status = kernel?.statusChanged;
  const connect = status?.connect;
  if (!connect || Object.hasOwn(status, "connect")) return;
  status.connect = (/** @type {unknown} */ slot, /** @type {unknown} */ receiver) =>
    !String(slot).includes("_cleanSubshells") && connect.call(status, slot, receiver);
}
