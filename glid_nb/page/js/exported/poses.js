// The poses of a motion as buttons with small pictures.

import { make, penOf } from "../pad/dom.js";

const SOON = 1e-3; // s: a pose is seen where the time is so near to its own

export class Poses {
  /** @type {HTMLButtonElement[]} */
  buttons = [];
  /** @type {number[]} the numbers of buttons that are seen and not drawn yet */
  #waiting = [];

  /**
   * @param {number[]} times of the poses
   * @param {(time: number) => void} goTo
   * @param {(time: number) => HTMLCanvasElement} draw a small picture of a time
   * @param {() => void} drawNext draws a frame, which begins with `drawOne`
   */
  constructor(times, goTo, draw, drawNext) {
    this.times = times;
    this.draw = draw;
    this.drawNext = drawNext;
    this.buttons = times.map((time, i) => {
      const title = `Pose ${i + 1}, at ${time.toFixed(2)} s`;
      const look = { title, "aria-label": title, onclick: () => goTo(time) };
      return make("button", look, make("canvas"));
    });
    // Pictures that come into sight are drawn one with each frame, so the motion does not wait.
    const seen = new IntersectionObserver((entries) => {
      if (!this.#waiting.length) requestAnimationFrame(() => this.#drawOn());
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting) continue;
        this.#waiting.push(this.buttons.indexOf(/** @type {HTMLButtonElement} */ (target)));
        seen.unobserve(target);
      }
    });
    for (const button of this.buttons) seen.observe(button);
  }

  /** @param {number} time marks the pose of this time */
  mark(time) {
    this.buttons.forEach((button, i) => {
      button.setAttribute("aria-current", String(Math.abs(this.times[i] - time) < SOON));
    });
  }

  /** Draws one of the pictures that wait. */
  drawOne() {
    const next = this.#waiting.shift();
    if (next === undefined) return;
    const picture = this.draw(this.times[next]);
    const small = /** @type {HTMLCanvasElement} */ (this.buttons[next].firstChild);
    small.width = picture.width;
    small.height = picture.height;
    penOf(small).drawImage(picture, 0, 0);
  }

  #drawOn() {
    if (!this.#waiting.length) return;
    this.drawNext();
    requestAnimationFrame(() => this.#drawOn());
  }
}
