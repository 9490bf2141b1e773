// Messages to the kernel, one at a time: while one is under way, what comes next waits, and a later
// message of the same gesture takes the place of the one that waits. So the kernel sets the pace.

const BUSY_AFTER = 250; // ms without an answer, from when on the page says that it waits

export class Link {
  // report({busy, refusal}): busy is whether an answer is overdue, refusal the kernel's sentence
  // when it could not do what was asked. idle(flag): whether everything has been answered.
  constructor(model, report, idle) {
    this.model = model;
    this.report = report;
    this.showIdle = idle;
    this.view = crypto.randomUUID?.() ?? `${Date.now()}-${Math.random()}`;
    this.waiting = [];
    this.underway = null;
    this.sent = 0;
    this.receive = (message) => {
      if (message.view !== this.view || message.ack !== this.underway?.id) return;
      clearTimeout(this.timer);
      const { done } = this.underway;
      this.underway = null;
      this.report({ busy: false, refusal: message.refusal });
      done?.(message.refusal);
      this.next();
      this.showIdle(this.idle);
    };
    model.on("msg:custom", this.receive);
  }

  // A gesture's name that no other view and no other gesture has.
  gesture() {
    this.gestures = (this.gestures ?? 0) + 1;
    return `${this.view}/${this.gestures}`;
  }

  // done(refusal) is called when the kernel has answered; not for a message that was overtaken.
  send(content, { buffers = [], done = null } = {}) {
    const last = this.waiting.at(-1);
    const entry = { content, buffers, done };
    if (last && content.gesture && last.content.gesture === content.gesture) {
      this.waiting[this.waiting.length - 1] = entry;
    } else {
      this.waiting.push(entry);
    }
    this.showIdle(false);
    this.next();
  }

  next() {
    if (this.underway || !this.waiting.length) return;
    const { content, buffers, done } = this.waiting.shift();
    this.underway = { id: ++this.sent, done };
    this.timer = setTimeout(() => this.report({ busy: true, refusal: null }), BUSY_AFTER);
    this.model.send({ ...content, view: this.view, id: this.sent }, undefined, buffers);
  }

  get idle() {
    return !this.underway && !this.waiting.length;
  }

  close() {
    clearTimeout(this.timer);
    this.model.off("msg:custom", this.receive);
  }
}
