// The timeline below the canvas: keyframes with thumbnails, the proof between them, a playhead.

import { Motion } from "../motion/motion.js";
import { make, toFloats } from "../pad/dom.js";
import { undoOrRedo } from "../pad/keys.js";
import { Link } from "../pad/link.js";
import { Bar, legend } from "./bar.js";
import { EaseEditor } from "./ease_editor.js";
import { pinsAt, pinsLater } from "./moving_pins.js";
import { Player } from "./player.js";
import { keyAt, nextKey, withReturn } from "./scale.js";
import { Track } from "./track.js";
import { noteOn } from "./words.js";
import { worstOf } from "./worst.js";

/** @import { Context, Model } from "../types.js" */
/** @import { Heights, Span, TimelineTraits } from "./traits.js" */

const NUDGE = 0.1; // s, with Alt

export class Timeline {
  note = make("div", { className: "glid-timeline-note", role: "status" });
  /** @type {Model<any> | null} the canvas's, once it is found */
  stage = null;

  /** @type {Motion | null} the picture's heights at the keyframes, where they differ */
  #layers = null;
  /** @type {Record<string, Motion | null>} those of the shapes around the edited one, by their keys */
  #otherLayers = {};
  #easeBefore = -1; // the segment whose easing was open when a button was pressed
  /** @type {number | null} where the kernel has been asked to go, until it has answered */
  #goal = null;
  #played = false; // whether the kernel knows that somebody has played
  #hovered = ""; // what lies below the pointer, in words
  #playing = {
    release: () => this.release(),
    pause: () => {
      this.player.pause();
      this.#goal = this.player.place; // a drag there makes a keyframe; a click gives the goal up
      return this.player.place;
    },
    reach: () => {
      const { keyframes, active } = this.shown;
      if (keyAt(keyframes, this.player.place) === active) this.release();
    },
  };

  /** @param {Context<TimelineTraits>} context */
  constructor({ model, el, signal }) {
    this.model = model;
    this.root = make("div", {
      className: "glid-skin glid-timeline",
      role: "group",
      "aria-label": "Timeline",
    });
    this.root.dataset.lmSuppressShortcuts = "true"; // JupyterLab must not take the keys first
    this.link = new Link(model, this.root, signal, () => this.tell());
    this.player = new Player(
      (...shown) => this.#show(...shown),
      () => this.showHead(),
      () => this.#selectHere(),
    );
    this.bar = new Bar({
      play: () => this.play(),
      keep: () => this.keep(),
      act: (type, content) => void this.act(type, content),
      edit: (type, content) => void this.edit(type, content),
      zoom: (by) => this.track.zoom.zoom(by),
      ease: () => this.#ease(),
    });
    this.bar.ease.addEventListener("pointerdown", () => this.#easePressed());
    this.ease = new EaseEditor(
      (index, easing) => void this.act("set_easing", { index, easing }),
      (index) => this.#easeClosed(index),
    );
    this.track = new Track({
      scrub: (time) => this.#scrub(time),
      scrubbed: () => this.#selectHere(),
      select: (index) => this.select(index),
      move: (index, time) => void this.act("move_pose", { index, time }),
      rename: (index, name) => void this.act("rename_pose", { index, name }),
      range: (range) => void this.act("set_loop_range", { range }),
      ease: (index, button) => this.#openEase(index, button),
      easePressed: () => this.#easePressed(),
      hover: (text) => {
        this.#hovered = text;
        this.tell();
      },
      dropped: () => {
        this.showKeys();
        this.showHead();
      },
    });
    const parts = [this.bar.element, this.note, legend(), this.track.zoom.box];
    this.root.append(
      make("div", { className: "glid-timeline-parts" }, ...parts),
      this.ease.element,
    );
    this.root.addEventListener("keydown", (e) => this.#keydown(e));
    this.root.addEventListener("keyup", (e) => {
      if (e.key === " " && !this.#typing(e)) e.preventDefault();
    });
    // After a click on a button the keys are the timeline's again.
    this.bar.element.addEventListener("click", (e) => {
      const target = /** @type {Element} */ (e.target);
      if (e.detail && target.closest("button")) this.track.focus();
    });
    el.classList.add("glid-host");
    el.append(this.root);
  }

  get shown() {
    return this.model.get("shown");
  }

  get spans() {
    return this.model.get("motion").spans;
  }

  /** The proofs between the keyframes, of all parts together. */
  get segments() {
    const others = this.model.get("part_motions");
    return worstOf([{ name: this.shown.part ?? "", spans: this.spans }, ...others]);
  }

  get active() {
    return this.shown.keyframes[this.shown.active];
  }

  /**
   * Asks the kernel for something.
   *
   * @param {string} type
   * @param {Record<string, unknown>} content
   */
  act(type, content = {}) {
    return this.link.put({ type, ...content });
  }

  /**
   * Changes the pose that is edited.
   *
   * @param {string} type
   * @param {Record<string, unknown>} content
   */
  edit(type, content = {}) {
    return this.act(type, { index: this.shown.active, ...content });
  }

  /** Back to the pose that is edited. */
  release = () => {
    this.#goal = null;
    this.player.release(this.active.time);
  };

  /**
   * The canvas draws another map: it shows a pose that is edited. Of a pose that was just chosen the
   * map comes first, and the playhead waits there for the rest.
   */
  edited() {
    if (this.player.seen) this.player.release(this.#goal ?? this.active.time);
  }

  /** @param {number} index */
  select(index) {
    if (index === this.shown.active) this.release();
    else this.#go("go_to_pose", { index }, this.shown.keyframes[index].time);
  }

  /**
   * Asks the kernel to edit the pose at a time.
   *
   * @param {string} type
   * @param {Record<string, unknown>} content
   * @param {number} time
   */
  async #go(type, content, time) {
    this.#goal = time;
    await this.act(type, content);
    if (this.#goal === time) this.#goal = null;
  }

  tell() {
    const { note } = this;
    const { text, kind } = this.#told();
    // What goes on is not spoken: it changes with each pose, and the footer speaks then.
    note.ariaLive = kind === "state" || kind === "hover" ? "off" : "polite";
    if (note.textContent !== text) note.textContent = text;
    note.title = text;
    note.dataset.kind = kind;
    note.dataset.tone = kind === "bad" ? "bad" : "";
  }

  /** @returns {import("./words.js").Note} */
  #told() {
    const { refusal } = this.link;
    if (refusal) return { text: refusal, kind: "bad" };
    if (this.#hovered) return { text: this.#hovered, kind: "hover" };
    return noteOn(this.shown, this.segments);
  }

  showHead() {
    const { keyframes } = this.shown;
    if (!keyframes) return; // the kernel has said nothing yet
    const { place, seen, playing } = this.player;
    const end = this.spans.at(-1)?.end ?? keyframes[keyframes.length - 1].time;
    this.track.showHead(place, seen);
    this.bar.showTime(place, end, playing);
    this.#tellElsewhere(seen && place !== this.active.time);
  }

  /**
   * While another time is seen, the edited pose is not marked, and the editor's footer names it.
   *
   * @param {boolean} elsewhere
   */
  #tellElsewhere(elsewhere) {
    const now = elsewhere ? this.active.name : "";
    if ((this.root.dataset.elsewhere ?? "") === now) return;
    const editor = /** @type {HTMLElement | null} */ (this.root.closest(".glid-editor"));
    if (elsewhere) {
      this.root.dataset.elsewhere = now;
      editor?.style.setProperty("--glid-edited", JSON.stringify(`${now}:`));
    } else {
      delete this.root.dataset.elsewhere;
      editor?.style.removeProperty("--glid-edited");
    }
  }

  showRate() {
    this.track.showRate(this.model.get("rate"));
  }

  showKeys() {
    this.track.showKeys(this.shown, this.model.get("thumbnails"));
    const segment = this.#segment(this.ease.index);
    if (segment) this.ease.show(segment.title, segment.easing);
    else this.ease.close();
  }

  showState() {
    const { keyframes, active } = this.shown;
    const now = `${active}/${keyframes.length}`;
    const moved = this.root.dataset.active !== now;
    this.root.dataset.active = now;
    this.bar.update(this.shown);
    this.showKeys();
    this.showMotion();
    if (moved) this.release();
    else if (!this.player.seen && !this.player.playing) {
      this.player.release(this.#goal ?? this.active.time);
    }
  }

  showMotion() {
    const { player, shown, spans } = this;
    player.only = shown.keyframes?.[0].time ?? 0;
    player.range = shown.range ?? null;
    player.set(intervalsOf(spans), shown.repeat, this.#others);
    const computing = spans.some(({ status }) => status === "computing");
    if (shown.kernel && !player.playing && player.seen && computing) this.release();
    this.tell();
    this.track.showSegments(this.segments, noteOn(shown, this.segments).text);
    this.showHead();
  }

  /** The motions of the shapes around the edited one, by their keys. */
  get #others() {
    const motions = this.model.get("part_motions");
    return Object.fromEntries(motions.map(({ key, spans }) => [key, intervalsOf(spans)]));
  }

  showOthers() {
    const layers = this.model.get("part_motions").map((one) => [one.key, layersOf(one.heights)]);
    this.#otherLayers = Object.fromEntries(layers);
    this.showMotion();
  }

  showPins() {
    this.player.renew();
  }

  showHeights() {
    this.#layers = layersOf(this.model.get("heights"));
  }

  /**
   * Has the canvas show coefficients, or the kernel's frame of a time; without a time the pose that
   * is edited.
   *
   * @param {Float32Array | null} floats
   * @param {number} [time]
   * @param {Record<string, Float32Array>} others coefficients of the shapes around, by their keys
   * @param {number} [at] the time of what is drawn
   */
  #show(floats, time, others = {}, at = undefined) {
    const { stage } = this;
    if (!stage) return;
    const moving = time !== undefined;
    const heights = moving ? (this.#layers?.at(time) ?? null) : null;
    const parts = Object.entries(others).map(([key, theirs]) => {
      return [key, { floats: theirs, heights: this.#otherLayers[key]?.at(time ?? 0) ?? null }];
    });
    const seen = moving ? (floats ?? true) : null;
    const pins = at === undefined ? null : this.#pinsAt(at);
    stage.trigger("glid:motion", seen, this.#playing, heights, Object.fromEntries(parts), pins);
    if (this.shown.kernel) return this.act("frame", { time: time ?? null, replaces: "frame" });
  }

  /**
   * The pins that can be dragged; null while it plays.
   *
   * @param {number} at
   */
  #pinsAt(at) {
    const { player, model } = this;
    if (player.playing) return null;
    const pins = model.get("pins");
    return player.later === null ? pinsAt(pins, at) : pinsLater(pins);
  }

  /** Plays, or pauses. The kernel hears of the first time. */
  play() {
    this.player.play();
    if (!this.player.playing || this.#played) return;
    this.#played = true;
    void this.act("played");
  }

  /** Makes a keyframe of what is shown. */
  keep() {
    const { player } = this;
    if (player.seen) this.#go("keep", { time: player.place }, player.place);
    else this.act("keep", { time: this.active.time });
  }

  /**
   * What the panel shows of a segment; null if there is none.
   *
   * @param {number} index
   */
  #segment(index) {
    const [start, end] = withReturn(this.shown).slice(index, index + 2);
    return index >= 0 && end
      ? { title: `${start.name} → ${end.name}`, easing: start.easing }
      : null;
  }

  // The easing of the motion that leaves the edited pose; at the end, of the one that arrives there.
  #ease() {
    const { active, keyframes } = this.shown;
    const last = withReturn(this.shown).length - 2;
    const { bar, track } = this;
    const index = Math.min(active, last);
    const own = /** @type {HTMLElement | undefined} */ (track.eases.children[index]);
    if (keyframes.length > 1) this.#openEase(index, own && !own.hidden ? own : bar.ease);
  }

  // A press elsewhere closes the panel before the click comes, and the click on its own button would
  // open it again.
  #easePressed() {
    this.#easeBefore = this.ease.index;
  }

  /**
   * @param {number} index
   * @param {HTMLElement} at
   */
  #openEase(index, at) {
    const segment = this.#segment(index);
    if (segment && this.#easeBefore !== index) {
      this.ease.open(index, segment.title, segment.easing, at);
    }
    this.#easeBefore = -1;
  }

  /**
   * Gives the focus back, unless it is already elsewhere.
   *
   * @param {number} index
   */
  #easeClosed(index) {
    const { activeElement } = document;
    const lost = !activeElement || activeElement === document.body;
    if (!lost && !this.ease.element.contains(activeElement)) return;
    const button = this.track.eases.children[index];
    if (button instanceof HTMLElement && !button.hidden) button.focus({ preventScroll: true });
    else this.track.focus();
  }

  /** @param {number} time */
  #scrub(time) {
    this.player.scrub(Math.min(time, this.track.span));
  }

  // Selects the keyframe that is shown, after a motion has ended or a pointer that scrubbed was let go.
  #selectHere() {
    const index = keyAt(this.shown.keyframes, this.player.place);
    if (index >= 0) this.select(index);
  }

  /** @param {Event} e */
  #typing(e) {
    return this.bar.element.contains(/** @type {Node} */ (e.target));
  }

  /** @param {KeyboardEvent} e */
  #keydown(e) {
    const history = undoOrRedo(e);
    if (!history && (e.ctrlKey || e.metaKey)) return;
    e.stopPropagation();
    const does = this.#typing(e) ? null : this.#keyDoes(e);
    if (!history && !does) return;
    e.preventDefault();
    if (history) this.act(history);
    else does?.();
  }

  /** @param {0 | 1} which the start or the end of the loop range, at the playhead */
  #rangeEnd(which) {
    const { player } = this;
    this.track.range.key(which, player.seen ? player.place : this.active.time);
  }

  /**
   * What a key does; null for the others.
   *
   * @param {KeyboardEvent} e
   * @returns {(() => void) | null}
   */
  #keyDoes(e) {
    const { keyframes } = this.shown;
    switch (e.key) {
      case " ":
        return () => void (e.repeat || this.play());
      case "ArrowLeft":
        return () => this.#step(e, -1);
      case "ArrowRight":
        return () => this.#step(e, 1);
      case "Enter":
        return e.target === this.track.ruler ? () => this.#ease() : null;
      case "F2":
        return () => this.track.rename();
      case "Delete":
      case "Backspace":
        return () => void this.edit("delete_pose");
      case "Home":
        return () => (e.shiftKey ? this.#rangeEnd(0) : this.select(0));
      case "End":
        return () => (e.shiftKey ? this.#rangeEnd(1) : this.select(keyframes.length - 1));
      case "Escape":
        return () => {
          this.track.drop();
          this.release();
        };
      default:
        return null;
    }
  }

  /**
   * @param {KeyboardEvent} e
   * @param {1 | -1} sign
   */
  #step(e, sign) {
    const { player, track } = this;
    const { keyframes, active } = this.shown;
    if (e.altKey) {
      const time = track.landing(active, this.active.time + sign * NUDGE);
      this.edit("move_pose", { time });
    } else if (e.shiftKey) {
      this.select(nextKey(keyframes, player.place, sign) ?? active);
    } else {
      this.#scrub(player.place + sign / track.rate);
    }
  }
}

/**
 * @param {Span[]} spans
 * @returns {import("./player.js").Interval[]}
 */
function intervalsOf(spans) {
  return spans.map((span) => ({ ...span, floats: toFloats(span.floats) }));
}

/** @param {Heights} heights */
function layersOf({ times, floats }) {
  return times.length ? new Motion({ times, repeat: "once" }, toFloats(floats)) : null;
}
