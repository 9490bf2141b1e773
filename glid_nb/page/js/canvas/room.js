// The room that an editor has for its canvas, full screen, and the picture alone.

import { save } from "../pad/dom.js";

const PAGE = 120;
const PARTS = 330; // CSS pixels: what a notebook's page and an editor's parts need above and below
const LEAST = 480;
const GAP = 16; // CSS pixels: of the height, and of the width beside the plots
const SLACK = 20; // CSS pixels: a scroll bar that comes and goes changes nothing
const SETTLE = 80; // ms

export class Room {
  // The signal ends it.
  constructor(pad, model, signal) {
    Object.assign(this, { pad, model, root: null, last: [0, 0, 0] }); // width, height, alone
    this.later = () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.measure(), SETTLE);
    };
    this.observer = new ResizeObserver(this.later);
    this.observer.observe(pad);
    const escape = (e) => {
      if (
        e.key !== "Escape" ||
        !this.last[2] ||
        pad.matches(":active, :has(.glid-menu, :popover-open)")
      )
        return;
      e.stopPropagation();
      this.alone(false);
    };
    window.addEventListener("resize", this.later, { signal });
    window.addEventListener("keydown", escape, { signal, capture: true });
    document.addEventListener(
      "fullscreenchange",
      () => {
        if (!document.fullscreenElement) this.alone(false);
      },
      { signal },
    );
    signal.addEventListener("abort", () => {
      clearTimeout(this.timer);
      this.observer.disconnect();
    });
  }

  measure() {
    const { pad, last } = this;
    const root = pad.closest(".glid-editor");
    const column = pad.closest(".glid-column");
    if (!column?.clientWidth) return;
    if (!this.root) this.observer.observe(column.parentElement);
    this.root = root;
    const whole = column.parentElement.clientWidth;
    const beside = whole - column.nextElementSibling.offsetWidth - GAP;
    const alone = Number(root.classList.contains("glid-alone"));
    const page = document.fullscreenElement === root ? 0 : PAGE;
    const room = alone
      ? [root.clientWidth, window.innerHeight - page, 1]
      : [beside >= LEAST ? beside : whole, Math.max(LEAST, window.innerHeight - page - PARTS), 0];
    const wider = room[0] - last[0];
    if (wider >= 0 && wider < SLACK && room[1] === last[1] && alone === last[2]) return;
    this.last = room;
    save(this.model, { room: room.map(Math.floor) });
  }

  // Shows nothing but the picture, or everything again.
  alone(on = !this.last[2]) {
    const { root, pad, last } = this;
    if (!root || (!on && !last[2])) return this.later();
    root.classList.toggle("glid-alone", on);
    this.measure();
    root.scrollIntoView({ block: on ? "start" : "nearest" });
    pad.focus({ preventScroll: true });
    if (!on && document.fullscreenElement) document.exitFullscreen();
  }

  fullScreen() {
    const say = (why) => save(this.model, { notice: `There is no full screen here: ${why}` });
    if (document.fullscreenElement) document.exitFullscreen();
    else this.root?.requestFullscreen().catch((error) => say(error.message));
  }
}
