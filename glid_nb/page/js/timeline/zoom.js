// The track in its scroll box: how far it is zoomed, and which part of it is seen.

import { make } from "../pad/dom.js";
import { scaleOf } from "../pad/place.js";
import { turnOf } from "../pad/view.js";

export const INSET = 34; // CSS pixels before and after the time: --glid-inset of the style sheet
export const STEP = 1.5; // of a button
const MOST = 40;
const WHEEL_SPEED = 0.004;
const LEADS = 0.25; // of the room, where the playhead comes back into sight

/**
 * The scroll position at which a time stays below a pointer.
 *
 * @param {number} share of the time that the track shows, from 0 to 1
 * @param {number} at of the pointer, CSS pixels from the left of the box
 * @param {number} width of the zoomed track, CSS pixels
 */
export function scrolledTo(share, at, width) {
  return Math.max(INSET + share * (width - 2 * INSET) - at, 0);
}

export class Zoom {
  factor = 1;

  /**
   * @param {HTMLElement} track
   * @param {() => void} changed
   */
  constructor(track, changed) {
    this.track = track;
    this.changed = changed;
    this.box = make("div", { className: "glid-track-view" }, track);
    this.box.addEventListener("wheel", (e) => this.#wheel(e), { passive: false });
  }

  /**
   * Zooms about a place, by default the middle of what is seen.
   *
   * @param {number} by
   * @param {number} at CSS pixels from the left of the box
   */
  zoom(by, at = this.box.clientWidth / 2) {
    const { box, track } = this;
    const share = (box.scrollLeft + at - INSET) / (track.offsetWidth - 2 * INSET);
    this.factor = Math.min(Math.max(this.factor * by, 1), MOST);
    track.style.width = `${100 * this.factor}%`;
    box.scrollLeft = scrolledTo(share, at, track.offsetWidth);
    this.changed();
  }

  /**
   * Scrolls until a place on the track is seen.
   *
   * @param {number} at CSS pixels from the left of the track
   */
  reveal(at) {
    const { box } = this;
    if (this.factor === 1) return;
    const seen = at >= box.scrollLeft && at <= box.scrollLeft + box.clientWidth;
    if (!seen) box.scrollLeft = at - LEADS * box.clientWidth;
  }

  /** @param {WheelEvent} e */
  #wheel(e) {
    const { box } = this;
    const step = turnOf(e);
    if (e.ctrlKey || e.metaKey) {
      e.preventDefault();
      const at = (e.clientX - box.getBoundingClientRect().left) / scaleOf(box).across;
      this.zoom(Math.exp(-step * WHEEL_SPEED), at);
      return;
    }
    const before = box.scrollLeft;
    if (!e.deltaX) box.scrollLeft += step;
    if (box.scrollLeft !== before) e.preventDefault(); // at its ends, the page scrolls
  }
}
