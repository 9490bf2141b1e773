// The timeline's buttons.

import { make } from "../pad/dom.js";
import { drawnButton, icon, iconButton } from "../pad/icons.js";
import { seconds } from "./words.js";
import { STEP } from "./zoom.js";

/** @import { Shown } from "./traits.js" */

/**
 * What the buttons do; `edit` changes the pose that is edited.
 *
 * @typedef {object} Does
 * @property {() => void} play
 * @property {() => void} keep
 * @property {(type: string, content?: Record<string, unknown>) => void} act
 * @property {(type: string, content?: Record<string, unknown>) => void} edit
 * @property {(by: number) => void} zoom
 * @property {() => void} ease opens the easing of the motion that leaves the pose
 */

/** @typedef {[value: string, label: string]} Choice */

/** @type {Choice[]} */
const REPEATS = [
  ["once", "Once"],
  ["loop", "Loop"],
  ["ping-pong", "Ping-pong"],
];
/** Chosen while a part plays over and over, whatever the motion as a whole does. @type {Choice} */
const OF_RANGE = ["range", "Loop range"];
const ONION = "Onion skin: outlines of the poses before (blue) and after (orange) the edited pose";
const KEY =
  "Key this pose and continue with a copy (K); at another time, key the shape that is shown there";
/** @type {[kind: string, label: string][]} */
const LEGEND = [
  ["proved", "proved"],
  ["computing", "not yet"],
  ["refused", "not proved"],
];

const EASE = "M2.5 13.5C8 13.5 8 2.5 13.5 2.5"; // an icon

export class Bar {
  recording = false;
  onionOn = false;
  #range = new Option(OF_RANGE[1], OF_RANGE[0]);

  /** @param {Does} does */
  constructor({ play, keep, act, edit, zoom, ease }) {
    this.play = iconButton("play", "Play, pause (Space)", play);
    this.repeat = menu("Play once, in a loop, or there and back", REPEATS, (repeat) => {
      if (repeat !== OF_RANGE[0]) act("play_all", { repeat }); // one step, also from a range
    });
    this.clock = make("span", { className: "glid-time", role: "timer" });
    this.record = iconButton("record", "Record: keep the next drag as keyframes", () =>
      act("record", { on: !this.recording }),
    );
    this.onion = iconButton("onion", ONION, () => act("onion", { on: !this.onionOn }));
    this.keep = make("button", { className: "glid-keep", title: KEY, onclick: keep }, "Key");
    const copy = iconButton("copy", "Duplicate this pose", () => edit("duplicate_pose"));
    this.ease = drawnButton(EASE, "Easing of the motion that leaves this pose (Enter)", ease);
    this.ease.ariaHasPopup = "dialog";
    this.remove = iconButton("trash", "Delete this pose (Delete)", () => edit("delete_pose"));
    this.save = iconButton("export", "Export the motion", () => {
      this.save.dispatchEvent(new CustomEvent("glid:inspect", { bubbles: true }));
      act("export");
    });
    this.element = make(
      "div",
      { className: "glid-bar", role: "toolbar", "aria-label": "Motion" },
      ...[this.play, this.repeat, this.clock, gap()],
      ...[this.record, this.onion, gap()],
      ...[this.keep, copy, this.remove, this.ease, gap(), this.save],
      make(
        "span",
        { className: "glid-zoom" },
        gap(),
        iconButton("minus", "See more of the timeline (Ctrl and wheel)", () => zoom(1 / STEP)),
        iconButton("plus", "See less of the timeline, larger (Ctrl and wheel)", () => zoom(STEP)),
      ),
    );
  }

  /**
   * @param {Shown} shown
   */
  update({ keyframes, repeat, range, recording, onion, exports }) {
    const alone = keyframes.length < 2;
    if (range) this.repeat.append(this.#range);
    else this.#range.remove();
    this.repeat.value = range ? OF_RANGE[0] : repeat;
    this.remove.disabled = alone;
    for (const control of [this.play, this.save, this.repeat, this.ease]) {
      control.disabled = alone;
    }
    this.save.hidden = !exports;
    this.recording = recording;
    this.onionOn = onion;
    this.record.ariaPressed = String(recording);
    this.onion.ariaPressed = String(onion);
  }

  /**
   * @param {number} place of the playhead
   * @param {number} end
   * @param {boolean} playing
   */
  showTime(place, end, playing) {
    const does = playing ? "pause" : "play";
    if (this.play.dataset.does !== does) this.play.innerHTML = icon(does);
    this.play.dataset.does = does;
    this.clock.textContent = `${place.toFixed(2)} / ${seconds(end)}`;
  }
}

/** What the colours of the strip mean. */
export function legend() {
  const parts = LEGEND.map(([kind, label]) => {
    return make("span", {}, make("i", { className: "glid-swatch", "data-kind": kind }), label);
  });
  return make("div", { className: "glid-proof-legend", "aria-hidden": true }, ...parts);
}

function gap() {
  return make("span", { className: "glid-gap" });
}

/**
 * @param {string} label
 * @param {Choice[]} choices
 * @param {(value: string) => void} act
 */
function menu(label, choices, act) {
  const options = choices.map(([value, text]) => new Option(text, value));
  const select = make("select", { "aria-label": label, title: label }, ...options);
  select.addEventListener("change", () => act(select.value));
  return select;
}
