// Messages to the kernel. Events are gathered while the last batch is not answered, or its frame not
// yet drawn. {view, events, buffers} goes to the kernel, {view, ack, refusal} comes back: ack is the
// number of the last event, refusal says why it was refused.

const BUSY_AFTER = 250; // ms without an answer until the page says that it waits
const ACKNOWLEDGE_TIMEOUT = 2000; // ms until events are sent without an answer

// Each comm of JupyterLab connects to its kernel's status for good (CommHandler in
// @jupyterlab/services), which keeps closed widgets, their views and elements in the page. All of
// them then do the same, so those that are connected already are enough.
function connectNoMoreComms(kernel) {
  const status = kernel?.statusChanged;
  const { connect } = status ?? {};
  if (!connect || Object.hasOwn(status, "connect")) return;
  status.connect = (slot, receiver) =>
    !String(slot).includes("_cleanSubshells") && connect.call(status, slot, receiver);
}

export class Link {
  // report(): an answer came, or is overdue: `busy`, `refusal` and `idle` are others.
  constructor(model, element, signal, report) {
    Object.assign(this, { model, element, signal, report, busy: false, refusal: null });
    connectNoMoreComms(model.widget_manager.kernel);
    this.view = Math.random().toString(36).slice(2);
    this.queue = [];
    this.buffers = [];
    this.answers = [];
    this.waiting = false;
    this.number = this.acknowledged = 0;
    element.dataset.idle = true; // all is answered
    signal.addEventListener("abort", () => this.stop());
    model.on("msg:custom", (message) => message.view === this.view && this.answered(message));
  }

  get idle() {
    return this.acknowledged === this.number;
  }

  // An event replaces the last one that waits if both have the same `replaces`. Resolves to the
  // kernel's refusal, or null, when the event was handled.
  put(event, buffers = []) {
    const seq = ++this.number;
    const last = this.queue.at(-1);
    if (last?.replaces && last.replaces === event.replaces) this.queue.pop();
    this.queue.push({ ...event, seq });
    this.buffers.push(...buffers);
    this.element.dataset.idle = false;
    this.flush();
    return new Promise((resolve) => this.answers.push({ seq, resolve }));
  }

  flush() {
    if (this.waiting || !this.queue.length) return;
    this.waiting = true;
    this.awaited = this.number;
    try {
      const { kernel } = this.model.widget_manager; // undefined where the page does not tell
      if (kernel === null || kernel?.isDisposed) throw new Error("the kernel was shut down");
      this.model.send({ view: this.view, events: this.queue }, undefined, this.buffers);
    } catch {
      // The kernel is gone. Nothing is sent any more, and the page says so if it does not yet.
      const [host, editor] = [".glid-host", ".glid-editor"].map((one) => this.element.closest(one));
      (editor ?? host).classList.add("jupyter-widgets-disconnected");
      return;
    }
    [this.queue, this.buffers] = [[], []];
    this.overdue = setTimeout(() => {
      this.busy = true;
      this.report();
    }, BUSY_AFTER);
    this.timeout = setTimeout(() => this.release(), ACKNOWLEDGE_TIMEOUT);
  }

  answered({ ack, refusal }) {
    if (ack === this.awaited) clearTimeout(this.overdue);
    this.acknowledged = Math.max(this.acknowledged, ack);
    Object.assign(this, { busy: false, refusal });
    this.element.dataset.idle = this.idle;
    const due = this.answers.filter(({ seq }) => seq <= ack);
    this.answers = this.answers.filter(({ seq }) => seq > ack);
    for (const { resolve } of due) resolve(refusal);
    this.report();
    if (ack < this.awaited) return;
    // The frame arrived before this answer; the page's next drawing shows it.
    if (document.hidden) this.release();
    else this.drawing = requestAnimationFrame(() => this.release());
  }

  release() {
    this.stop();
    this.waiting = false;
    this.flush();
  }

  stop() {
    clearTimeout(this.overdue);
    clearTimeout(this.timeout);
    cancelAnimationFrame(this.drawing);
  }
}
