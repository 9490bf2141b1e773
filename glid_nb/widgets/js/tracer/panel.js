// The controls beside the picture.

import { make } from "./dom.js";

const METHODS = [
  ["auto", "Auto", "What suits the picture"],
  ["alpha", "Alpha", "What is not transparent"],
  ["threshold", "Brightness", "What is darker, or brighter, than a threshold"],
  ["color", "Colour", "What differs from the background's colour"],
  ["scribbles", "Scribbles", "What strokes painted over the picture tell"],
];
const STEPS = 1000;

// A slider with a number beside it; null, shown as "auto", lets the tracer choose.
class NumberControl {
  constructor(name, label, unit, title, choose) {
    this.name = name;
    this.choose = choose;
    this.range = { least: 0, most: 1, power: 1, digits: 2 };
    this.slider = make("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": label, oninput: () => this.slide(), onchange: () => (this.current = null) });
    this.number = make("input", { type: "number", className: "glid-number", min: 0, step: "any", placeholder: "auto", "aria-label": `${label} (${unit})`, onchange: () => this.type() });
    this.auto = make("button", { type: "button", className: "glid-auto", title: "Let the tracer choose", onclick: () => choose({ [name]: null }) }, "auto");
    this.element = make("div", { className: "glid-control", title, "data-name": name }, make("label", {}, label), this.auto, this.number, make("span", { className: "glid-unit" }, unit), this.slider);
  }

  setRange(least, most, power, digits) {
    this.range = { least, most: Math.max(most, least + 1e-9), power, digits };
  }

  // The value at the slider's place.
  get slid() {
    const { least, most, power, digits } = this.range;
    return Number((least + (most - least) * (this.slider.value / STEPS) ** power).toFixed(digits));
  }

  slide() {
    this.current ??= Math.random().toString(36); // a gesture that no other view and slider has
    const rounded = this.slid;
    this.number.value = rounded;
    this.auto.classList.remove("glid-on");
    this.choose({ [this.name]: rounded }, this.current);
  }

  type() {
    const text = this.number.value.trim();
    const value = text === "" ? null : Number(text);
    this.choose({ [this.name]: Number.isFinite(value) ? value : null });
  }

  update(value, automatic) {
    this.auto.classList.toggle("glid-on", value === null);
    const seen = value ?? automatic;
    if (this.current) return; // under the hand
    const { least, most, power, digits } = this.range;
    this.number.value = seen === null || seen === undefined ? "" : Number(seen.toFixed(digits));
    if (seen === this.slid) return; // it stays where the hand left it
    const share = Math.min(Math.max(((seen ?? least) - least) / (most - least), 0), 1);
    this.slider.value = Math.round(STEPS * share ** (1 / power));
  }
}

export class Panel {
  constructor(act, stage, chooseTool) {
    this.act = act;
    this.stage = stage;
    const choose = (changes, gesture = null) =>
      act("set_options", { changes, gesture, ...(gesture && { replaces: gesture }) });
    const number = (...args) => new NumberControl(...args, choose);
    this.numbers = {
      threshold: number("threshold", "Threshold", "0–1", "Least value of what is foreground"),
      smoothing: number("smoothing", "Smoothing", "px", "Blur before the outline is taken"),
      offset: number("offset", "Offset", "px", "How far the cage stays from the shape"),
      simplify: number("simplify", "Simplify", "px", "How far simplification may move the outline"),
      min_hole_area: number("min_hole_area", "Least hole", "px²", "Smaller holes are filled"),
    };
    this.methods = METHODS.map(([value, label, title]) =>
      make("button", { type: "button", title, role: "radio", "data-value": value, onclick: () => choose({ method: value }) }, label),
    );
    this.invert = make("input", { type: "checkbox", onchange: () => choose({ invert: this.invert.checked }) });
    this.invertRow = make("label", { className: "glid-row" }, this.invert, "Swap foreground and background");
    this.pickColor = make("button", { type: "button", onclick: () => chooseTool("color") }, "Pick the background's colour");
    this.paint = ["foreground", "background"].map((brush) =>
      make("button", { type: "button", className: `glid-brush glid-${brush}`, onclick: () => chooseTool(brush) }, brush === "foreground" ? "Shape" : "Background"),
    );
    this.clear = make("button", { type: "button", onclick: () => act("clear_scribbles") }, "Clear");
    this.scribbleRow = make("div", { className: "glid-row" }, ...this.paint, this.clear);
    this.component = make("select", { "aria-label": "Component", onchange: () => choose({ component: Number(this.component.value), component_at: null }) });
    this.pickComponent = make("button", { type: "button", onclick: () => chooseTool("component") }, "Pick");
    this.componentRow = make("div", { className: "glid-row" }, make("span", { className: "glid-grow" }, "Component"), this.component, this.pickComponent);
    this.holes = make("div", { className: "glid-holes" });
    this.holesTitle = make("h4");
    this.notes = make("ul");
    this.notesBox = make("details", { className: "glid-notes" }, make("summary", {}, "Notes"), this.notes);
    this.element = make(
      "div",
      { className: "glid-panel" },
      make("h4", {}, "Foreground"),
      make("div", { className: "glid-methods", role: "radiogroup", "aria-label": "Method" }, ...this.methods),
      this.scribbleRow,
      this.pickColor,
      this.numbers.threshold.element,
      this.invertRow,
      this.numbers.smoothing.element,
      this.componentRow,
      make("h4", {}, "Outline"),
      this.numbers.offset.element,
      this.numbers.simplify.element,
      this.holesTitle,
      this.numbers.min_hole_area.element,
      this.holes,
      this.notesBox,
    );
  }

  update(shown) {
    const { options, automatic } = shown;
    this.element.hidden = !shown.size;
    if (!shown.size) return;
    const longer = Math.max(...shown.size);
    const { threshold, smoothing, offset, simplify, min_hole_area } = this.numbers;
    threshold.setRange(0, 1, 1, 3);
    smoothing.setRange(0, 0.01 * longer, 2, 1);
    offset.setRange(0, 0.05 * longer, 1.5, 1);
    simplify.setRange(0, 0.03 * longer, 1.5, 1);
    min_hole_area.setRange(0, 0.1 * shown.component_area, 4, 0);
    for (const [name, control] of Object.entries(this.numbers)) control.update(options[name], automatic?.[name]);
    const method = options.method;
    const used = method === "auto" ? automatic?.method : method;
    for (const button of this.methods) {
      const on = button.dataset.value === method;
      button.classList.toggle("glid-on", on);
      button.setAttribute("aria-checked", on);
      button.classList.toggle("glid-used", method === "auto" && button.dataset.value === used);
    }
    this.scribbleRow.hidden = used !== "scribbles";
    this.pickColor.hidden = used !== "color";
    this.invertRow.hidden = used !== "color" && used !== "threshold";
    this.invert.checked = options.invert === true;
    this.invert.indeterminate = options.invert === null && used === "threshold";
    this.updateComponents(shown);
    this.updateHoles(shown);
    this.notesBox.hidden = !shown.notes.length;
    this.notes.replaceChildren(...shown.notes.map((note) => make("li", {}, note)));
  }

  updateComponents({ component, n_components: count }) {
    this.componentRow.hidden = count < 2;
    const listed = Math.min(count, 50);
    if (this.component.length !== listed) {
      this.component.replaceChildren(...Array.from({ length: listed }, (_, i) => make("option", { value: i }, i ? `${i + 1}.` : "Largest")));
    }
    this.component.value = component;
  }

  updateHoles({ holes, n_holes: count, automatic }) {
    const kept = holes.filter((hole) => hole.kept).length;
    const none = automatic ? "Holes: none" : "Holes";
    this.holesTitle.textContent = count ? `Holes: ${kept} of ${count} kept` : none;
    const rows = holes.map((hole, i) => {
      const box = make("input", { type: "checkbox", checked: hole.kept, onchange: () => this.act("toggle_hole", { number: i }) });
      const area = hole.area >= 1e4 ? `${(hole.area / 1e3).toFixed(0)}k px²` : `${hole.area.toFixed(0)} px²`;
      return make(
        "label",
        { className: "glid-hole", onpointerenter: () => this.stage.highlightHole(i), onpointerleave: () => this.stage.highlightHole(null) },
        box,
        make("span", { className: "glid-grow" }, `Hole ${i + 1}${hole.by_offset ? " (made by the offset)" : ""}`),
        make("span", { className: "glid-unit" }, area),
      );
    });
    // Rebuilding takes the focus from a row; it goes back to where it was.
    const at = [...this.holes.children].findIndex((row) => row.contains(this.holes.getRootNode().activeElement));
    this.holes.replaceChildren(...rows);
    rows[at]?.querySelector("input").focus();
  }

  updateTool(tool) {
    this.paint[0].classList.toggle("glid-on", tool === "foreground");
    this.paint[1].classList.toggle("glid-on", tool === "background");
    this.pickColor.classList.toggle("glid-on", tool === "color");
    this.pickComponent.classList.toggle("glid-on", tool === "component");
  }
}
