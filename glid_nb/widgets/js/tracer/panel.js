// The controls beside the picture.

import { make } from "../pad/dom.js";

const METHODS = [
  ["auto", "Auto", "Chosen for the picture"],
  ["alpha", "Alpha", "What is not transparent"],
  ["threshold", "Brightness", "What is darker, or brighter, than a threshold"],
  ["color", "Colour", "What differs from the background's colour"],
  ["scribbles", "Scribbles", "What painted strokes mark"],
];
// Name, label, unit, title, and of the slider: its end (as a share of the longer side for px, of the
// component's area for px²), the power of its scale, and its decimals.
const NUMBERS = [
  ["threshold", "Threshold", "0–1", "Least value of what is foreground", 1, 1, 3],
  ["smoothing", "Smoothing", "px", "Blur before the outline is taken", 0.01, 2, 1],
  ["offset", "Offset", "px", "How far the cage stays from the shape", 0.05, 1.5, 1],
  ["simplify", "Simplify", "px", "How far simplification may move the outline", 0.03, 1.5, 1],
  ["min_hole_area", "Least hole", "px²", "Smaller holes are filled", 0.1, 4, 0],
];
const OUTLINES = [
  ["foreground", "Paint over it", "A few strokes over the shape, then over what is around it"],
  ["polygon", "Draw its outline", "Click corner after corner, or draw around the shape"],
  ["rectangle", "Rectangle", "Drag a rectangle"],
  ["whole", "Whole picture", "Everything, the background too"],
];
const STEPS = 1000;

// A slider with a number beside it; null, shown as "auto", lets the tracer choose.
class NumberControl {
  constructor(name, label, unit, title, share, power, digits, choose) {
    Object.assign(this, { name, unit, share, power, digits, choose, most: 1 });
    this.slider = make("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": label, oninput: () => this.slide(), onchange: () => (this.current = null) });
    this.number = make("input", { type: "number", className: "glid-number", min: 0, step: "any", placeholder: "auto", "aria-label": `${label} (${unit})`, onchange: () => this.type() });
    this.auto = make("button", { type: "button", className: "glid-auto", title: "Let the tracer choose", onclick: () => choose({ [name]: null }) }, "auto");
    this.element = make("div", { className: "glid-control", title, "data-name": name }, make("label", {}, label), this.auto, this.number, make("span", { className: "glid-unit" }, unit), this.slider);
  }

  get slid() {
    return Number((this.most * (this.slider.value / STEPS) ** this.power).toFixed(this.digits));
  }

  slide() {
    this.current ??= Math.random().toString(36); // the gesture's name, unique among views
    this.number.value = this.slid;
    this.auto.classList.remove("glid-on");
    this.choose({ [this.name]: this.slid }, this.current);
  }

  type() {
    const text = this.number.value.trim();
    const value = text === "" ? null : Number(text);
    this.choose({ [this.name]: Number.isFinite(value) ? value : null });
  }

  update(value, automatic, unitSize) {
    this.most = Math.max(this.share * unitSize, 1e-9);
    this.auto.classList.toggle("glid-on", value === null);
    if (this.current) return; // it is being dragged
    const seen = value ?? automatic;
    this.number.value = seen === null || seen === undefined ? "" : Number(seen.toFixed(this.digits));
    if (seen === this.slid) return; // else rounding would move the slider
    const share = Math.min(Math.max((seen ?? 0) / this.most, 0), 1);
    this.slider.value = Math.round(STEPS * share ** (1 / this.power));
  }
}

export class Panel {
  constructor(act, stage, chooseTool) {
    this.act = act;
    this.stage = stage;
    const choose = (changes, gesture = null) =>
      act("set_options", { changes, gesture, ...(gesture && { replaces: gesture }) });
    this.numbers = NUMBERS.map((row) => new NumberControl(...row, choose));
    const rows = Object.fromEntries(this.numbers.map(({ name, element }) => [name, element]));
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
    this.hand = OUTLINES.map(([tool, label, title]) =>
      make("button", { type: "button", title, "data-tool": tool, onclick: () => (tool === "whole" ? act("draw") : chooseTool(tool)) }, label),
    );
    this.doubt = make("p", { hidden: true });
    this.byHand = make("div", { className: "glid-by-hand" }, this.doubt, ...this.hand);
    this.holes = make("div", { className: "glid-holes" });
    this.holesTitle = make("h4");
    this.notes = make("ul");
    this.notesBox = make("details", { className: "glid-notes" }, make("summary", {}, "Notes"), this.notes);
    this.element = make(
      "div",
      { className: "glid-panel" },
      make("h4", {}, "By hand"),
      this.byHand,
      make("h4", {}, "Foreground"),
      make("div", { className: "glid-methods", role: "radiogroup", "aria-label": "Method" }, ...this.methods),
      this.scribbleRow, this.pickColor, rows.threshold, this.invertRow, rows.smoothing, this.componentRow,
      make("h4", {}, "Outline"),
      rows.offset, rows.simplify, this.holesTitle, rows.min_hole_area, this.holes, this.notesBox,
    );
  }

  update(shown) {
    const { options, automatic } = shown;
    this.element.hidden = !shown.size;
    if (!shown.size) return;
    const units = { "0–1": 1, px: Math.max(...shown.size), "px²": shown.component_area };
    for (const control of this.numbers) {
      control.update(options[control.name], automatic?.[control.name], units[control.unit]);
    }
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
    const guess = Boolean(shown.doubt) || !shown.loops.length;
    this.byHand.classList.toggle("glid-guess", guess);
    this.doubt.hidden = !guess;
    this.doubt.textContent = shown.doubt ? `This outline is a guess: ${shown.doubt}. Show it the shape:` : "Show it the shape:";
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

  updateHoles({ holes, n_holes: count, n_filled: filled, loops }) {
    const kept = Math.max(loops.length - 1, 0) || "no";
    this.holesTitle.textContent = `${kept} ${kept === 1 ? "hole" : "holes"} in the cage${filled ? `, ${filled} small filled` : ""}`;
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
    // Rebuilding takes the focus; the row that had it gets it back.
    const at = [...this.holes.children].findIndex((row) => row.contains(this.holes.getRootNode().activeElement));
    if (count > holes.length) rows.push(make("div", { className: "glid-unit" }, `and ${count - holes.length} smaller ones`));
    this.holes.replaceChildren(...rows);
    rows[at]?.querySelector("input")?.focus();
  }

  updateTool(tool) {
    const [foreground, background] = this.paint;
    const buttons = { foreground, background, color: this.pickColor, component: this.pickComponent };
    for (const [name, button] of Object.entries(buttons)) button.classList.toggle("glid-on", name === tool);
    for (const button of this.hand) button.classList.toggle("glid-on", button.dataset.tool === tool);
  }
}
