// Messages to the kernel, paced by it and by the page: while one batch of events is on its way, or
// what it led to has yet to be drawn, the next one gathers. {view, events, buffers} goes to the
// kernel, {view, ack, refusal} comes back: ack is the last event's number, refusal why it was refused.

const BUSY_AFTER = 250; // ms without an answer, from when on the page says that it waits
// ms; a kernel that died must not silence the page for ever, nor a page that is hidden
const ACKNOWLEDGE_TIMEOUT = 2000;

export class Link {
  // report({busy, refusal}): an answer came, or is overdue. idle(flag): whether everything that was
  // sent has been answered.
  constructor(model, report = () => {}, idle = () => {}) {
    Object.assign(this, { model, report, showIdle: idle });
    this.view = Math.random().toString(36).slice(2);
    this.queue = [];
    this.buffers = [];
    this.answers = []; // who waits for which event's answer
    this.waiting = false;
    this.number = this.acknowledged = 0;
    this.receive = (message) => {
      if (message.view === this.view) this.answered(message);
    };
    model.on("msg:custom", this.receive);
  }

  get idle() {
    return this.acknowledged === this.number;
  }

  // Events of one gesture that replace one another have the same `replaces`; everything else keeps
  // its place. The result is the kernel's refusal, or null, once it has dealt with the event.
  put(event, buffers = []) {
    const seq = ++this.number;
    const last = this.queue.at(-1);
    if (last?.replaces && last.replaces === event.replaces) this.queue.pop();
    this.queue.push({ ...event, seq });
    this.buffers.push(...buffers);
    this.showIdle(false);
    this.flush();
    return new Promise((resolve) => this.answers.push({ seq, resolve }));
  }

  flush() {
    if (this.waiting || !this.queue.length) return;
    this.waiting = true;
    this.awaited = this.number;
    this.model.send({ view: this.view, events: this.queue }, undefined, this.buffers);
    [this.queue, this.buffers] = [[], []];
    this.overdue = setTimeout(() => this.report({ busy: true, refusal: null }), BUSY_AFTER);
    this.timeout = setTimeout(() => this.release(), ACKNOWLEDGE_TIMEOUT);
  }

  answered({ ack, refusal }) {
    if (ack === this.awaited) clearTimeout(this.overdue);
    this.acknowledged = Math.max(this.acknowledged, ack);
    this.report({ busy: false, refusal });
    const due = this.answers.filter(({ seq }) => seq <= ack);
    this.answers = this.answers.filter(({ seq }) => seq > ack);
    for (const { resolve } of due) resolve(refusal);
    this.showIdle(this.idle);
    if (ack < this.awaited) return;
    // The frame came before this: it is drawn when the page draws next.
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

  close() {
    this.stop();
    this.model.off("msg:custom", this.receive);
  }
}
