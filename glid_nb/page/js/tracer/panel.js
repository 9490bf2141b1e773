// The controls beside the picture.
//
// Buttons with `data-tool` are the toolbar's too; it hears them and shows which is chosen.

import { make, showChildren } from "../pad/dom.js";
import { NUMBERS, NumberControl } from "./number_control.js";
import { holesIn } from "./words.js";

/** @import { Stage } from "./stage.js" */
/** @import { Hole, Shown, Tool } from "./traits.js" */

/** @typedef {(type: string, content?: Record<string, unknown>) => void} Act */

/** @type {[method: string, label: string, title: string][]} */
const METHODS = [
  ["auto", "Auto", "Chosen for the picture"],
  ["alpha", "Alpha", "Pixels that are not transparent"],
  ["threshold", "Brightness", "Pixels darker, or brighter, than a threshold"],
  ["color", "Colour", "Pixels that differ from the background's colour"],
  ["scribbles", "Scribbles", "Pixels like those under painted strokes"],
];
/** @type {[tool: Tool, label: string, title: string][]} */
const OUTLINES = [
  ["foreground", "Paint over it", "A few strokes over the shape, then over the background"],
  ["polygon", "Draw its outline", "Click the corners in turn, or draw around the shape"],
  ["rectangle", "Rectangle", "Drag a rectangle"],
];
const MOST_LISTED = 50; // components
const LARGE = 1e4; // px², from which areas are told in thousands

export class Panel {
  /**
   * @param {Act} act
   * @param {Stage} stage
   */
  constructor(act, stage) {
    this.act = act;
    this.stage = stage;
    this.numbers = NUMBERS.map((option) => {
      return new NumberControl(option, (changes, gesture) => this.#choose(changes, gesture));
    });
    this.methods = METHODS.map(([method, label, title]) => {
      const onclick = () => this.#choose({ method });
      return make("button", { title, role: "radio", "data-value": method, onclick }, label);
    });
    this.invert = make("input", {
      type: "checkbox",
      onchange: () => this.#choose({ invert: this.invert.checked }),
    });
    this.inverts = make(
      "label",
      { className: "glid-row" },
      this.invert,
      "Swap foreground and background",
    );
    this.pickColor = make("button", { "data-tool": "color" }, "Pick the background's colour");
    this.scribbles = row(
      brush("foreground", "Shape"),
      brush("background", "Background"),
      make("button", { onclick: () => act("clear_scribbles") }, "Clear"),
    );
    this.knife = make("input", {
      type: "number",
      className: "glid-number",
      min: 0,
      step: "any",
      placeholder: "auto",
      "aria-label": "Width of the knife (px)",
      onchange: () => {
        const { value } = this.knife;
        act("knife", { width: value === "" ? null : Number(value) });
      },
    });
    this.knives = row(
      make("span", { className: "glid-grow" }, "Width of the knife"),
      this.knife,
      make("span", { className: "glid-unit" }, "px"),
    );
    this.knives.classList.add("glid-knife");
    this.knives.title = "How wide the slit is; empty: as narrow as is good";
    this.component = make("select", {
      "aria-label": "Component",
      onchange: () => this.#choose({ component: Number(this.component.value), component_at: null }),
    });
    this.components = row(
      make("span", { className: "glid-grow" }, "Component"),
      this.component,
      make("button", { "data-tool": "component" }, "Pick"),
    );
    this.keep = row(make("button", { onclick: () => act("keep_pieces") }, "Keep all as parts"));
    this.doubt = make("p");
    const title = "Show the outline as it was found, and use it";
    this.guess = make("button", { title, onclick: () => act("accept_guess") }, "Use the guess");
    const byHand = [this.doubt, ...this.#outlines(), this.guess];
    this.byHand = make("div", { className: "glid-by-hand" }, ...byHand);
    this.holesTitle = make("h4");
    this.holes = make("div", { className: "glid-holes" });
    this.notes = make("ul");
    this.notesBox = make(
      "details",
      { className: "glid-notes" },
      make("summary", {}, "Notes"),
      this.notes,
    );
    this.element = this.#laidOut();
  }

  #laidOut() {
    const group = { className: "glid-methods", role: "radiogroup", "aria-label": "Method" };
    const [threshold, smoothing, offset, simplify, leastHole] = this.numbers.map(
      ({ element }) => element,
    );
    return make(
      "div",
      { className: "glid-panel" },
      make("h4", {}, "By hand"),
      this.byHand,
      this.knives,
      make("h4", {}, "Foreground"),
      make("div", group, ...this.methods),
      ...[this.scribbles, this.pickColor, threshold, this.inverts, smoothing, this.components],
      this.keep,
      make("h4", {}, "Outline"),
      ...[offset, simplify, this.holesTitle, leastHole, this.holes, this.notesBox],
    );
  }

  #outlines() {
    const buttons = OUTLINES.map(([tool, label, title]) => {
      return make("button", { title, "data-tool": tool }, label);
    });
    const title = "Everything, the background too";
    const whole = make("button", { title, onclick: () => this.act("draw") }, "Whole picture");
    return [...buttons, whole];
  }

  /**
   * @param {Record<string, unknown>} changes of the options
   * @param {string} [gesture] changes of one gesture are one step of the history
   */
  #choose(changes, gesture) {
    this.act("set_options", { changes, gesture, replaces: gesture });
  }

  /** @param {Shown} shown */
  update(shown) {
    this.element.hidden = !shown.size;
    if (!shown.size) return;
    for (const control of this.numbers) control.update(shown);
    this.#showMethod(shown);
    this.#showDoubt(shown);
    this.#showComponents(shown);
    this.#showHoles(shown);
    this.knives.hidden = shown.tool !== "knife";
    this.knife.value = shown.knife_width === null ? "" : String(shown.knife_width);
    this.notesBox.hidden = !shown.notes.length;
    this.notes.replaceChildren(...shown.notes.map((note) => make("li", {}, note)));
  }

  /** @param {Shown} shown */
  #showMethod({ options, automatic }) {
    const { method, invert } = options;
    const used = method === "auto" ? automatic?.method : method;
    for (const button of this.methods) {
      button.ariaChecked = String(button.dataset.value === method);
      button.classList.toggle("glid-used", button.dataset.value === used);
    }
    this.scribbles.hidden = used !== "scribbles";
    this.pickColor.hidden = used !== "color";
    this.inverts.hidden = used !== "color" && used !== "threshold";
    this.invert.checked = invert === true;
    this.invert.indeterminate = invert === null && used === "threshold";
  }

  /** @param {Shown} shown */
  #showDoubt({ doubt, loops }) {
    const guess = Boolean(doubt) || !loops.length;
    this.byHand.classList.toggle("glid-guess", guess);
    this.doubt.hidden = !guess;
    this.guess.hidden = !doubt;
    const why = doubt ? `The outline is not clear: ${doubt}. ` : "";
    this.doubt.textContent = `${why}Show it the shape:`;
  }

  /** @param {Shown} shown */
  #showComponents({ component, n_components: count, keeps }) {
    this.components.hidden = count < 2;
    this.keep.hidden = count < 2 || !keeps;
    const listed = Math.min(count, MOST_LISTED);
    if (this.component.length !== listed) {
      const options = Array.from({ length: listed }, (_, i) => {
        return new Option(i ? `${i + 1}.` : "Largest", String(i));
      });
      this.component.replaceChildren(...options);
    }
    this.component.value = String(component);
  }

  /** @param {Shown} shown */
  #showHoles({ holes: listed, n_holes: count, n_filled: filled, loops, doubt }) {
    const small = filled ? `, ${filled} small filled` : "";
    this.holesTitle.textContent = `${holesIn(loops.length - 1)} in the cage${small}`;
    this.holesTitle.hidden = Boolean(doubt); // no outline, no holes
    const rows = listed.map((hole, i) => this.#holeRow(hole, i));
    const left = count - listed.length;
    const more = make("div", { className: "glid-unit" }, `and ${left} smaller ones`);
    // A row that changes loses the focus; it gets it back.
    const root = /** @type {Document | ShadowRoot} */ (this.holes.getRootNode());
    const focused = [...this.holes.children].findIndex((one) => one.contains(root.activeElement));
    showChildren(this.holes, left ? [...rows, more] : rows);
    const boxes = this.holes.querySelectorAll("input");
    for (const [i, { kept }] of listed.entries()) boxes[i].checked = kept;
    boxes[focused]?.focus();
  }

  /**
   * @param {Hole} hole
   * @param {number} i
   */
  #holeRow(hole, i) {
    const size =
      hole.area >= LARGE ? `${(hole.area / 1e3).toFixed(0)}k px²` : `${hole.area.toFixed(0)} px²`;
    const made = hole.by_offset ? " (made by the offset)" : "";
    return make(
      "label",
      {
        className: "glid-hole",
        onpointerenter: () => this.stage.highlightHole(i),
        onpointerleave: () => this.stage.highlightHole(null),
      },
      make("input", {
        type: "checkbox",
        checked: hole.kept,
        onchange: () => this.act("toggle_hole", { number: i }),
      }),
      make("span", { className: "glid-grow" }, `Hole ${i + 1}${made}`),
      make("span", { className: "glid-unit" }, size),
    );
  }
}

/** @param {...Node} parts */
function row(...parts) {
  return make("div", { className: "glid-row" }, ...parts);
}

/**
 * @param {Tool} tool
 * @param {string} label
 */
function brush(tool, label) {
  return make("button", { className: `glid-brush glid-${tool}`, "data-tool": tool }, label);
}
