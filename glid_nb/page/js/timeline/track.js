// The track below the buttons: a ruler, the keyframes, a strip of what is proved, the playhead.
//
// A keyframe is dragged along time, or clicked; elsewhere a pointer scrubs.

import { heightOf } from "../motion/strip.js";
import { make, showChildren } from "../pad/dom.js";
import { scaleOf } from "../pad/place.js";
import { nameOf, stretchedCurve } from "./ease.js";
import { nameField } from "./name_field.js";
import { RangeMarks } from "./range.js";
import { frameAt, labelledTimes, landing, roomAt, spanOf, withReturn } from "./scale.js";
import { boundOf, reasonOf, seconds } from "./words.js";
import { INSET, Zoom } from "./zoom.js";

/** @import { Keyframe, Shown, TimelineTraits } from "./traits.js" */
/** @import { Segment } from "./worst.js" */

/**
 * What a hand on the track does.
 *
 * @typedef {object} Hand
 * @property {(time: number) => void} scrub
 * @property {() => void} scrubbed the pointer was let go
 * @property {(index: number) => void} select
 * @property {(index: number, time: number) => void} move moves a keyframe
 * @property {(index: number, name: string) => void} rename renames a keyframe
 * @property {(index: number, button: HTMLElement) => void} ease opens the easing of a segment
 * @property {() => void} easePressed a button of `ease` is pressed, and not let go yet
 * @property {(range: Range | null) => void} range sets the part that plays over and over
 * @property {(text: string) => void} hover says what lies below the pointer
 * @property {() => void} dropped what was dragged is let go, so all is shown again
 */

/** @import { Range } from "./range.js" */
/** @typedef {{ index: number, from: number, x: number, time: number | null }} Drag a keyframe's */

const DOUBLE_CLICK = 400; // ms
// CSS pixels.
const SNAP = 6; // around a keyframe, of a pointer that scrubs
const STILL = 4; // that a click may move
const SLIM = 8; // width of a keyframe, at least
const WIDE = 60; // at most
const EASE = 34; // room for the curve of a segment
const LEAST_FRAME = 6; // width of a frame that gets a tick

export class Track {
  span = 1; // s, what it shows
  rate = 25; // frames in a second of an export
  diamonds = make("div", { className: "glid-diamonds", "aria-hidden": true });
  keys = make("div", { className: "glid-keys" });
  eases = make("div", { className: "glid-eases" });
  head = make("div", { className: "glid-playhead" });
  ruler = make("div", {
    className: "glid-ruler",
    tabIndex: 0,
    role: "slider",
    "aria-label": "Time",
    "aria-valuemin": 0,
  });

  #last = { index: -1, at: 0 }; // the click on a keyframe before
  /** @type {Drag | null} */
  #drag = null;
  /** @type {number | null} the pointer that scrubs */
  #scrubbing = null;
  /** @type {Shown | null} */
  #shown = null;

  /** @param {Hand} hand */
  constructor(hand) {
    this.hand = hand;
    this.strip = make("div", {
      className: "glid-strip",
      role: "img",
      onpointerleave: () => hand.hover(""),
    });
    this.range = new RangeMarks({
      at: (time) => this.#at(time),
      timeOf: (e) => this.#timeNear(e, true),
      frame: () => 1 / this.rate,
      set: (range) => hand.range(range),
      hover: (text) => hand.hover(text),
    });
    const { elements } = this.range;
    const rows = [this.ruler, this.diamonds, this.keys, this.eases, this.strip];
    const parts = [...rows, ...elements, this.head];
    this.element = make("div", { className: "glid-track" }, ...parts);
    this.zoom = new Zoom(this.element, () => this.#label());
    new ResizeObserver(() => this.#label()).observe(this.ruler);
    this.element.addEventListener("pointerdown", (e) => this.#down(e));
    this.element.addEventListener("pointermove", (e) => this.#scrub(e));
    this.element.addEventListener("lostpointercapture", (e) => this.#up(e));
  }

  /**
   * Opens a field for the name of a keyframe, by default of the one that has the focus.
   *
   * @param {number} index
   */
  rename(index = this.#focused()) {
    const key = this.#shown?.keyframes[index];
    if (!key) return;
    const rename = (/** @type {string} */ name) => this.hand.rename(index, name);
    nameField(this.element, this.#at(key.time), key.name, rename, () => this.focus());
  }

  // The index of the keyframe that has the focus, or of another row's child; -1 for none.
  #focused(row = this.keys) {
    const root = /** @type {Document | ShadowRoot} */ (row.getRootNode());
    const active = /** @type {Element} */ (root.activeElement);
    return [...row.children].indexOf(active);
  }

  /** @param {number} rate frames in a second of an export */
  showRate(rate) {
    this.rate = rate;
    this.#label();
  }

  focus() {
    this.ruler.focus({ preventScroll: true });
  }

  /** Lets go of what is dragged. */
  drop() {
    this.#drag = null;
    this.#scrubbing = null;
    this.range.drop();
    this.hand.hover("");
    this.hand.dropped();
  }

  /**
   * The time nearest to one to which a keyframe can move.
   *
   * @param {number} index
   * @param {number} time
   */
  landing(index, time) {
    const least = (SLIM / this.#inside().width) * this.span;
    return landing(this.#shown?.keyframes ?? [], index, time, least);
  }

  /**
   * @param {number} place
   * @param {boolean} seen whether the motion is shown
   */
  showHead(place, seen) {
    this.head.style.left = this.#at(place);
    this.head.classList.toggle("glid-seen", seen);
    this.head.dataset.label = place.toFixed(2);
    this.element.dataset.time = String(place);
    this.element.dataset.span = String(this.span);
    this.ruler.setAttribute("aria-valuenow", place.toFixed(2));
    this.ruler.setAttribute("aria-valuetext", seconds(place));
    if (seen && this.#scrubbing === null) this.zoom.reveal(this.head.offsetLeft);
  }

  /**
   * @param {Shown} shown
   * @param {TimelineTraits["thumbnails"]} thumbnails
   */
  showKeys(shown, thumbnails) {
    this.#shown = shown;
    if (this.#drag || this.#scrubbing !== null) return; // what is held must stay in the page
    const all = withReturn(shown);
    this.span = spanOf(all);
    this.ruler.setAttribute("aria-valuemax", this.span.toFixed(2));
    const focused = this.#focused();
    showChildren(
      this.keys,
      all.map(({ name, time, thumbnail }, i) => {
        const title = `${name} at ${seconds(time)}`;
        const width = `${this.#wide(roomAt(all, i, this.span))} - 2px`;
        const own = i < shown.keyframes.length;
        const picture = thumbnail === undefined ? undefined : thumbnails[thumbnail];
        return make(
          "button",
          {
            className: own ? "glid-key" : "glid-key glid-return",
            title: `${title}; drag it to another time`,
            "aria-label": title,
            "aria-pressed": i === shown.active,
            style: `left: ${this.#at(time)}; width: clamp(${SLIM}px, ${width}, ${WIDE}px)`,
            onpointerdown: (/** @type {PointerEvent} */ e) => this.#grab(e, i, time),
            onclick: (/** @type {MouseEvent} */ e) => {
              if (!e.detail) this.hand.select(i % shown.keyframes.length); // by the keyboard
            },
          },
          ...(picture ? [make("img", { src: picture, alt: "", draggable: false })] : []),
        );
      }),
    );
    const key = this.keys.children[focused];
    if (key instanceof HTMLElement) key.focus(); // a changed one lost it
    this.#showDiamonds(all);
    this.#showEases(all);
    const { time: end } = all[all.length - 1];
    this.range.show(shown.range, all.length > 1 ? [all[0].time, end] : null);
  }

  /**
   * A diamond at the exact time of each keyframe, which is dragged as its picture is.
   *
   * @param {Keyframe[]} all
   */
  #showDiamonds(all) {
    showChildren(
      this.diamonds,
      all.map(({ time }, i) => {
        const { title, ariaPressed } = /** @type {HTMLElement} */ (this.keys.children[i]);
        const diamond = make("i", {
          title,
          style: `left: ${this.#at(time)}`,
          onpointerdown: (/** @type {PointerEvent} */ e) => this.#grab(e, i, time),
        });
        diamond.dataset.selected = ariaPressed ?? "false";
        return diamond;
      }),
    );
  }

  /**
   * The curves of the segments, each from one keyframe's picture to the next, where there is room.
   *
   * @param {Keyframe[]} all
   */
  #showEases(all) {
    const focused = this.#focused(this.eases);
    showChildren(
      this.eases,
      all.slice(1).map(({ name, time }, i) => {
        const start = all[i];
        const title = `From ${start.name} to ${name}: ${nameOf(start.easing)}`;
        const button = make("button", {
          className: "glid-segment-ease",
          title,
          "aria-label": title,
          "aria-haspopup": "dialog",
          innerHTML: `${stretchedCurve(start.easing)}<span>${nameOf(start.easing)}</span>`,
          style: `left: ${this.#at(start.time)}; width: calc(${this.#wide(time - start.time)})`,
          onpointerdown: (/** @type {PointerEvent} */ e) => {
            e.stopPropagation(); // the track would scrub
            this.hand.easePressed();
          },
          onclick: () => this.hand.ease(i, button),
        });
        button.dataset.seconds = `${time - start.time}`;
        return button;
      }),
    );
    this.#hideNarrow();
    const button = this.eases.children[focused];
    if (button instanceof HTMLElement) button.focus();
  }

  #hideNarrow() {
    const perSecond = Math.max(this.ruler.clientWidth - 2 * INSET, 0) / this.span;
    for (const button of /** @type {Iterable<HTMLElement>} */ (this.eases.children)) {
      button.hidden = Number(button.dataset.seconds) * perSecond < WIDE + EASE;
    }
  }

  /**
   * @param {Segment[]} segments
   * @param {string} label
   */
  showSegments(segments, label) {
    this.strip.replaceChildren(...segments.flatMap((segment) => this.#pieces(segment)));
    this.strip.setAttribute("aria-label", label);
    this.#label();
  }

  #label() {
    const { ruler, span, rate } = this;
    const width = Math.max(ruler.clientWidth - 2 * INSET, 0);
    const labels = labelledTimes(span, width, this.zoom.factor).map((time) => {
      const frame = frameAt(time, rate);
      const number = frame === null ? [] : [make("b", {}, `${frame}`)];
      const second = make("small", {}, `${Number(time.toFixed(2))} s`);
      return make("span", { style: `left: ${this.#at(time)}` }, ...number, second);
    });
    const frame = width / (span * rate);
    const ticks = make("i", { className: "glid-frames", hidden: frame < LEAST_FRAME });
    ticks.style.setProperty("--glid-frame", `${frame}px`);
    ruler.replaceChildren(ticks, ...labels);
    this.#hideNarrow();
  }

  /** @param {Segment} segment */
  #pieces(segment) {
    const { end, status, until, pieces } = segment;
    const proved = pieces.map((piece) => {
      const height = heightOf(piece.sigma2);
      return this.#piece(piece.start, piece.end, "proved", boundOf(piece), height);
    });
    if (status === "proved") return proved;
    return [...proved, this.#piece(until, end, status, reasonOf(segment), 1)];
  }

  /**
   * @param {number} start
   * @param {number} end
   * @param {string} kind
   * @param {string} text
   * @param {number} height as a share of the strip's
   */
  #piece(start, end, kind, text, height) {
    const width = `calc(${this.#wide(end - start)})`;
    return make("div", {
      className: `glid-piece glid-${kind}`,
      title: text,
      onpointerenter: () => this.hand.hover(text),
      style: `left: ${this.#at(start)}; width: ${width}; --glid-height: ${height}`,
    });
  }

  /**
   * A length of time, as CSS's `calc` takes it.
   *
   * @param {number} time
   */
  #wide(time) {
    return `${time / this.span} * (100% - 2 * var(--glid-inset))`;
  }

  /** @param {number} time */
  #at(time) {
    return `calc(var(--glid-inset) + ${this.#wide(time)})`;
  }

  // The part of the track that stands for time, in CSS pixels of the window.
  #inside() {
    const { left, width } = this.element.getBoundingClientRect();
    const length = getComputedStyle(this.element).getPropertyValue("--glid-inset");
    const inset = Number.parseFloat(length) * scaleOf(this.element).across;
    return { left: left + inset, width: width - 2 * inset };
  }

  /**
   * @param {PointerEvent} e
   * @param {number} index
   * @param {number} time
   */
  #grab(e, index, time) {
    if (e.button !== 0) return;
    e.stopPropagation();
    const button = /** @type {HTMLButtonElement} */ (this.keys.children[index]);
    this.#drag = { index, from: time, x: e.clientX, time: null };
    button.setPointerCapture(e.pointerId);
    button.focus({ preventScroll: true }); // so that Escape is heard
    button.onpointermove = (move) => this.#dragged(move, button);
    button.onlostpointercapture = () => this.#letGo();
  }

  /**
   * @param {PointerEvent} e
   * @param {HTMLButtonElement} button
   */
  #dragged(e, button) {
    const drag = this.#drag;
    if (!drag) return;
    const moved = e.clientX - drag.x;
    if (drag.time === null && Math.abs(moved) <= STILL) return;
    const time = drag.from + (moved / this.#inside().width) * this.span;
    drag.time = this.landing(drag.index, time);
    const diamond = /** @type {HTMLElement} */ (this.diamonds.children[drag.index]);
    button.style.left = this.#at(drag.time);
    diamond.style.left = this.#at(drag.time);
    this.head.style.left = this.#at(drag.time);
    this.hand.hover(`to ${seconds(drag.time)}`);
  }

  #letGo() {
    if (!this.#drag) return;
    const { index, time } = this.#drag;
    this.drop();
    if (time !== null) {
      this.focus();
      this.hand.move(index, time);
    } else if (index < (this.#shown?.keyframes.length ?? 0)) {
      this.#clicked(index);
    }
  }

  /**
   * A first click selects the keyframe, so its button is made anew, and the page tells no double
   * click of it.
   *
   * @param {number} index
   */
  #clicked(index) {
    const now = performance.now();
    const last = this.#last;
    this.#last = { index, at: now };
    if (last.index === index && now - last.at < DOUBLE_CLICK) this.rename(index);
    else this.hand.select(index);
  }

  /** @param {PointerEvent} e */
  #down(e) {
    if (e.button !== 0) return;
    this.#scrubbing = e.pointerId;
    this.element.setPointerCapture(e.pointerId);
    this.#scrub(e);
  }

  /**
   * Goes to the time below the pointer; near a keyframe to its time.
   *
   * @param {PointerEvent} e
   */
  #scrub(e) {
    if (this.#scrubbing === e.pointerId) this.hand.scrub(this.#timeNear(e));
  }

  /**
   * The time below a pointer; near a keyframe its time.
   *
   * @param {PointerEvent} e
   * @param {boolean} [framed] whether it is else that of the nearest frame
   */
  #timeNear(e, framed = false) {
    const { left, width } = this.#inside();
    const time = ((e.clientX - left) / width) * this.span;
    const near = (SNAP / width) * this.span;
    const key = this.#shown?.keyframes.find((one) => Math.abs(one.time - time) < near);
    return key?.time ?? (framed ? Math.round(time * this.rate) / this.rate : time);
  }

  /** @param {PointerEvent} e */
  #up(e) {
    if (this.#scrubbing !== e.pointerId) return;
    this.drop();
    this.hand.scrubbed();
  }
}
