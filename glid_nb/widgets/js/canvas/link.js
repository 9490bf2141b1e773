// Messages to the kernel, paced by it and by the page: while one batch is on its way, or what it led
// to has yet to be drawn, the next one gathers.

// ms; a kernel that died must not silence the page for ever, nor a page that is hidden
const ACKNOWLEDGE_TIMEOUT = 2000;

export class Link {
  constructor(model) {
    this.model = model;
    this.view = Math.random().toString(36).slice(2);
    this.queue = [];
    this.waiting = false;
    this.number = 0;
    this.onMessage = (message) => {
      // The frame came before this: it is drawn when the page draws next.
      if (message.view === this.view && message.ack >= this.awaited) {
        this.drawing = requestAnimationFrame(() => this.release());
      }
    };
    model.on("msg:custom", this.onMessage);
  }

  // Moves of the same pointer replace one another; everything else keeps its place.
  put(event) {
    event.seq = ++this.number;
    const last = this.queue[this.queue.length - 1];
    const follows = last && event.type === "move" && last.type === "move" && last.id === event.id;
    if (follows) this.queue[this.queue.length - 1] = event;
    else this.queue.push(event);
    this.flush();
  }

  // The first picture is there: what the kernel put off until then can begin.
  drawn() {
    this.model.send({ view: this.view, drawn: true });
  }

  flush() {
    if (this.waiting || !this.queue.length) return;
    this.waiting = true;
    this.awaited = this.queue[this.queue.length - 1].seq;
    this.model.send({ view: this.view, events: this.queue });
    this.queue = [];
    this.timer = setTimeout(() => this.release(), ACKNOWLEDGE_TIMEOUT);
  }

  release() {
    clearTimeout(this.timer);
    cancelAnimationFrame(this.drawing);
    this.waiting = false;
    this.flush();
  }

  close() {
    clearTimeout(this.timer);
    cancelAnimationFrame(this.drawing);
    this.model.off("msg:custom", this.onMessage);
  }
}
