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
  [null, "Whole picture", "Everything, the background too"],
];
const STEPS = 1000; // of a slider
const MOST_LISTED = 50; // components

// A slider with a number beside it; null, shown as "auto", lets the tracer choose.
function numberControl([name, label, unit, title, share, power, digits], choose) {
  let most = 1;
  let gesture = null;
  const slider = make("input", { type: "range", min: 0, max: STEPS, step: 1, "aria-label": label });
  const number = make("input", {
    type: "number",
    className: "glid-number",
    min: 0,
    step: "any",
    placeholder: "auto",
    "aria-label": `${label} (${unit})`,
  });
  const auto = make("button", { className: "glid-auto", title: "Let the tracer choose" }, "auto");
  const slid = () => Number((most * (slider.value / STEPS) ** power).toFixed(digits));
  slider.oninput = () => {
    gesture ??= Math.random().toString(36); // its name, unique among views
    number.value = slid();
    auto.ariaPressed = false;
    choose({ [name]: slid() }, gesture);
  };
  slider.onchange = () => (gesture = null);
  number.onchange = () => choose({ [name]: number.value === "" ? null : Number(number.value) });
  auto.onclick = () => choose({ [name]: null });

  function update({ options, automatic, size, component_area: area }) {
    const value = options[name];
    const seen = value ?? automatic?.[name] ?? null;
    most = Math.max(share * { "0–1": 1, px: Math.max(...size), "px²": area }[unit], 1e-9);
    auto.ariaPressed = value === null;
    if (gesture) return; // it is being dragged
    number.value = seen === null ? "" : Number(seen.toFixed(digits));
    if (seen === slid()) return; // else rounding would move the slider
    const part = Math.min(Math.max(seen / most, 0), 1);
    slider.value = Math.round(STEPS * part ** (1 / power));
  }
  const element = make(
    "div",
    { className: "glid-control", title, "data-name": name },
    make("label", {}, label),
    auto,
    number,
    make("span", { className: "glid-unit" }, unit),
    slider,
  );
  return { element, update };
}

// Buttons with `data-tool` are the toolbar's too; it hears them and shows which is chosen.
export function makePanel(act, stage) {
  const choose = (changes, gesture) => act("set_options", { changes, gesture, replaces: gesture });
  const row = (...parts) => make("div", { className: "glid-row" }, ...parts);
  const numbers = NUMBERS.map((one) => numberControl(one, choose));
  const [threshold, smoothing, offset, simplify, leastHole] = numbers.map(({ element }) => element);
  const methods = METHODS.map(([method, label, title]) => {
    const onclick = () => choose({ method });
    return make("button", { title, role: "radio", "data-value": method, onclick }, label);
  });
  const swap = () => choose({ invert: invert.checked });
  const invert = make("input", { type: "checkbox", onchange: swap });
  const inverts = make(
    "label",
    { className: "glid-row" },
    invert,
    "Swap foreground and background",
  );
  const pickColor = make("button", { "data-tool": "color" }, "Pick the background's colour");
  const brush = (name, label) =>
    make("button", { className: `glid-brush glid-${name}`, "data-tool": name }, label);
  const scribbles = row(
    brush("foreground", "Shape"),
    brush("background", "Background"),
    make("button", { onclick: () => act("clear_scribbles") }, "Clear"),
  );
  const component = make("select", {
    "aria-label": "Component",
    onchange: () => choose({ component: Number(component.value), component_at: null }),
  });
  const components = row(
    make("span", { className: "glid-grow" }, "Component"),
    component,
    make("button", { "data-tool": "component" }, "Pick"),
  );
  const hand = OUTLINES.map(([tool, label, title]) => {
    const does = tool ? { "data-tool": tool } : { onclick: () => act("draw") };
    return make("button", { title, ...does }, label);
  });
  const doubt = make("p");
  const byHand = make("div", { className: "glid-by-hand" }, doubt, ...hand);
  const holes = make("div", { className: "glid-holes" });
  const holesTitle = make("h4");
  const notes = make("ul");
  const summary = make("summary", {}, "Notes");
  const notesBox = make("details", { className: "glid-notes" }, summary, notes);
  const group = { className: "glid-methods", role: "radiogroup", "aria-label": "Method" };
  const element = make(
    "div",
    { className: "glid-panel" },
    make("h4", {}, "By hand"),
    byHand,
    make("h4", {}, "Foreground"),
    make("div", group, ...methods),
    scribbles,
    pickColor,
    threshold,
    inverts,
    smoothing,
    components,
    make("h4", {}, "Outline"),
    offset,
    simplify,
    holesTitle,
    leastHole,
    holes,
    notesBox,
  );

  function update(shown) {
    const { options, automatic, loops, n_components: count } = shown;
    element.hidden = !shown.size;
    if (!shown.size) return;
    for (const control of numbers) control.update(shown);
    const { method } = options;
    const used = method === "auto" ? automatic?.method : method;
    for (const button of methods) {
      button.ariaChecked = button.dataset.value === method;
      button.classList.toggle("glid-used", button.dataset.value === used);
    }
    scribbles.hidden = used !== "scribbles";
    pickColor.hidden = used !== "color";
    inverts.hidden = used !== "color" && used !== "threshold";
    invert.checked = options.invert === true;
    invert.indeterminate = options.invert === null && used === "threshold";
    const guess = Boolean(shown.doubt) || !loops.length;
    byHand.classList.toggle("glid-guess", guess);
    doubt.hidden = !guess;
    const why = shown.doubt ? `This outline is a guess: ${shown.doubt}. ` : "";
    doubt.textContent = `${why}Show it the shape:`;
    components.hidden = count < 2;
    const listed = Math.min(count, MOST_LISTED);
    if (component.length !== listed) {
      const option = (_, i) => new Option(i ? `${i + 1}.` : "Largest", i);
      component.replaceChildren(...Array.from({ length: listed }, option));
    }
    component.value = shown.component;
    showHoles(shown);
    notesBox.hidden = !shown.notes.length;
    notes.replaceChildren(...shown.notes.map((note) => make("li", {}, note)));
  }

  function holeRow(hole, i) {
    const onchange = () => act("toggle_hole", { number: i });
    const [size, unit] = hole.area >= 1e4 ? [hole.area / 1e3, "k px²"] : [hole.area, " px²"];
    const made = hole.by_offset ? " (made by the offset)" : "";
    const point = (index) => () => stage.highlightHole(index);
    return make(
      "label",
      { className: "glid-hole", onpointerenter: point(i), onpointerleave: point(null) },
      make("input", { type: "checkbox", checked: hole.kept, onchange }),
      make("span", { className: "glid-grow" }, `Hole ${i + 1}${made}`),
      make("span", { className: "glid-unit" }, `${size.toFixed(0)}${unit}`),
    );
  }

  function showHoles({ holes: listed, n_holes: count, n_filled: filled, loops }) {
    const kept = Math.max(loops.length - 1, 0) || "no";
    const small = filled ? `, ${filled} small filled` : "";
    holesTitle.textContent = `${kept} ${kept === 1 ? "hole" : "holes"} in the cage${small}`;
    const rows = listed.map(holeRow);
    const left = count - listed.length;
    if (left) rows.push(make("div", { className: "glid-unit" }, `and ${left} smaller ones`));
    // Rebuilding takes the focus; the row that had it gets it back.
    const focused = holes.getRootNode().activeElement;
    const at = [...holes.children].findIndex((one) => one.contains(focused));
    holes.replaceChildren(...rows);
    rows[at]?.querySelector("input")?.focus();
  }

  return { element, update };
}
