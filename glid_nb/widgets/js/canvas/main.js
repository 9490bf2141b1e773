// The pad over the renderer: takes what the hand does and draws handles, colour bars and notices.

import { Link } from "../pad/link.js";
import { Pad } from "../pad/pad.js";
import { View } from "../pad/view.js";
import { drawMarks, markAt } from "./marks.js";
import { Shapes, drawingTime, uniformVectors } from "./shapes.js";

const REACH = { mouse: 13, pen: 16, touch: 26 }; // CSS pixels
const KEYS = new Set([
  "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Delete", "Backspace", "Escape", "Enter",
  "0", "f", "F", ",", ".", "a", "A",
]);
const SAVE_VIEW_AFTER = 250; // ms
const LEAST_SIZE = 240; // CSS pixels

function element(parent, tag, name, text) {
  const made = document.createElement(tag);
  made.className = `glid-${name}`;
  if (text !== undefined) made.textContent = text;
  parent.appendChild(made);
  return made;
}

function colorBar(box, content) {
  element(box, "div", "legend-title", content.title);
  element(box, "div", "legend-bar").style.background =
    `linear-gradient(to right, ${content.colors.join(", ")})`;
  const ticks = element(box, "div", "legend-ticks");
  for (const tick of content.ticks) element(ticks, "span", "legend-tick", tick);
}

// Changes traits, and tells the kernel.
function save(model, changes) {
  for (const [name, value] of Object.entries(changes)) model.set(name, value);
  model.save_changes();
}

function resizeGrip(pad, model) {
  const grip = element(pad, "div", "resize");
  grip.title = "Drag to resize";
  let from = null;
  const on = (name, act) =>
    grip.addEventListener(name, (e) => {
      e.stopPropagation();
      act(e);
    });
  on("pointerdown", (e) => {
    e.preventDefault();
    grip.setPointerCapture(e.pointerId);
    from = [model.get("width") - e.clientX, model.get("height") - e.clientY];
  });
  on("pointermove", (e) => {
    if (!from) return;
    const [width, height] = [from[0] + e.clientX, from[1] + e.clientY];
    save(model, {
      width: Math.max(LEAST_SIZE, Math.round(width)),
      height: Math.max(LEAST_SIZE, Math.round(height)),
    });
  });
  for (const name of ["pointerup", "pointercancel"]) on(name, () => (from = null));
}

function render({ model, el }) {
  el.classList.add("glid-pad-host");
  const box = element(el, "div", "pad");
  box.setAttribute("role", "application");
  box.setAttribute("aria-label", "Deformation canvas: arrow keys move, Enter adds a handle");
  box.dataset.lmSuppressShortcuts = "true"; // JupyterLab must not take the keys first
  const paper = element(box, "canvas", "paper");
  const bars = element(box, "div", "legend");
  const notice = element(box, "div", "notice");
  notice.setAttribute("role", "status");

  const shapes = new Shapes(model);
  let due = 0;
  const draw = () => {
    due = 0;
    const ratio = window.devicePixelRatio || 1;
    const { width, height } = view;
    const size = [Math.round(width * ratio), Math.round(height * ratio)];
    if (paper.width !== size[0] || paper.height !== size[1]) [paper.width, paper.height] = size;
    const pen = paper.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const { found, held, focused } = pad ?? { held: new Map() };
    const cursor = focused ? model.get("cursor") : null;
    drawMarks(pen, view, model.get("marks"), { hovered: found?.mark, held, cursor });
  };
  const soon = () => { due = due || requestAnimationFrame(draw); };

  let saving;
  const view = new View(() => {
    look();
    clearTimeout(saving);
    saving = setTimeout(() => save(model, { view: [view.x, view.y, view.unit] }), SAVE_VIEW_AFTER);
  }, { nearest: 1e-4, farthest: 1 });
  const look = () => {
    shapes.look(view);
    soon();
  };
  const link = new Link(model);
  const marks = () => model.get("marks");
  const pad = model.get("interactive") ? new Pad(box, view, link, {
    reach: REACH,
    keys: KEYS,
    removesByLongPress: true,
    find: (point, reach) => markAt(marks(), point, reach),
    held: ({ mark }) => {
      const { selected, targets } = marks();
      return new Map((selected.includes(mark) ? selected : [mark]).map((i) => [i, targets[i]]));
    },
    pans: () => false,
    paints: () => false,
    cursor: (found) => (found ? "grab" : "crosshair"),
    changed: soon,
  }) : null;
  if (pad) resizeGrip(box, model);

  const fit = () => {
    Object.assign(view, { width: model.get("width"), height: model.get("height") });
    [view.x, view.y, view.unit] = model.get("view");
    Object.assign(box.style, { width: `${view.width}px`, height: `${view.height}px` });
    look();
  };
  const tell = () => {
    notice.textContent = model.get("notice");
    notice.hidden = !notice.textContent;
  };
  const showLegend = () => {
    const shown = [model.get("legend"), model.get("panel_legend")].filter((bar) => bar.title);
    bars.replaceChildren();
    bars.hidden = !shown.length;
    for (const content of shown) colorBar(element(bars, "div", "legend-part"), content);
    bars.dataset.corner = model.get("legend_corner");
  };
  const listeners = {
    "change:width change:height change:view": fit,
    "change:coefficients": () => shapes.refresh(),
    "change:marks change:cursor": soon,
    "change:legend change:panel_legend change:legend_corner": showLegend,
    "change:notice": tell,
  };
  for (const [names, listener] of Object.entries(listeners)) model.on(names, listener);
  fit();
  showLegend();
  tell();
  let gone = false;
  shapes.load().then(() => drawingTime(box, shapes)).then((time) => {
    if (gone) return;
    save(model, { drawn: true, drawing_time: time });
  });
  if (model.get("uniform_vectors") === 0) save(model, { uniform_vectors: uniformVectors() || -1 });

  return () => {
    gone = true;
    cancelAnimationFrame(due);
    clearTimeout(saving);
    for (const [names, listener] of Object.entries(listeners)) model.off(names, listener);
    pad?.close();
    link.close();
    shapes.close();
  };
}

export default { render };
