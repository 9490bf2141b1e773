// What the canvas says in words: a refusal, or what the hand can do now. A thin bar below the picture
// shows how far the solver is prepared; the status line says the same in words.

import { make } from "../pad/dom.js";

const FIRST = "Click the shape to pin a point, then drag the pin · ? shows all keys";
const PAINT = "Paint stiff areas · E erases · Esc when done";

export class Notices {
  notice = make("div", { className: "glid-notice", role: "status" });
  prepared = make("div", {
    className: "glid-prepared",
    role: "progressbar",
    "aria-label": "Preparing the solver",
    hidden: true,
  });

  /**
   * @param {string} refusal
   * @param {boolean} painting
   * @param {boolean} first whether there are no pins yet
   */
  tell(refusal, painting, first) {
    const advice = painting ? PAINT : first && FIRST;
    const { notice } = this;
    notice.textContent = refusal || advice || "";
    notice.hidden = !notice.textContent;
    notice.classList.toggle("glid-first", !refusal);
    notice.classList.toggle("glid-invites", !refusal && !painting); // in an editor the footer does
  }

  /** @param {number} share how much of what the first solve needs is done, from 0 to 1 */
  prepare(share) {
    const { prepared } = this;
    prepared.hidden = share >= 1;
    prepared.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    prepared.style.setProperty("--glid-share", String(share));
  }
}
