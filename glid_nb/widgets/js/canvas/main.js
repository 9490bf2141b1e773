// The pad over the renderer: takes what the hand does and draws handles, colour bar and notices.

import { Input } from "./input.js";
import { Link } from "./link.js";
import { drawMarks } from "./marks.js";
import { Shapes, uniformVectors } from "./shapes.js";
import { drawingTime } from "./speed.js";
import { View } from "./view.js";

function element(parent, tag, name, text) {
  const made = document.createElement(tag);
  made.className = `glid-${name}`;
  if (text !== undefined) made.textContent = text;
  parent.appendChild(made);
  return made;
}

// What is drawn, beside the model's traits: where the hand is, before the kernel knows.
class State {
  constructor(model) {
    this.model = model;
    this.held = new Map();
    this.hovered = -1;
    this.focus = false;
  }

  marks() {
    return this.model.get("marks");
  }

  release() {
    // The kernel's answer to the last move may be on its way; it replaces these.
    this.held = new Map();
  }
}

function legend(box, contents) {
  box.replaceChildren();
  box.hidden = !contents.length;
  for (const content of contents) colorBar(element(box, "div", "legend-part"), content);
}

function colorBar(box, content) {
  element(box, "div", "legend-title", content.title);
  element(box, "div", "legend-bar").style.background =
    `linear-gradient(to right, ${content.colors.join(", ")})`;
  const ticks = element(box, "div", "legend-ticks");
  for (const tick of content.ticks) element(ticks, "span", "legend-tick", tick);
}

function resizeGrip(pad, model) {
  const grip = element(pad, "div", "resize");
  grip.title = "Drag to resize";
  let from = null;
  grip.addEventListener("pointerdown", (e) => {
    e.stopPropagation();
    e.preventDefault();
    grip.setPointerCapture(e.pointerId);
    from = { x: e.clientX, y: e.clientY, width: model.get("width"), height: model.get("height") };
  });
  grip.addEventListener("pointermove", (e) => {
    e.stopPropagation();
    if (!from) return;
    model.set("width", Math.max(240, Math.round(from.width + e.clientX - from.x)));
    model.set("height", Math.max(240, Math.round(from.height + e.clientY - from.y)));
    model.save_changes();
  });
  const end = (e) => { e.stopPropagation(); from = null; };
  grip.addEventListener("pointerup", end);
  grip.addEventListener("pointercancel", end);
}

function render({ model, el }) {
  el.classList.add("glid-pad-host");
  const pad = element(el, "div", "pad");
  pad.tabIndex = 0;
  pad.setAttribute("role", "application");
  pad.setAttribute("aria-label", "Deformation canvas: arrow keys move, Enter adds a handle");
  pad.dataset.lmSuppressShortcuts = "true"; // JupyterLab must not take the keys first
  const paper = element(pad, "canvas", "paper");
  const bar = element(pad, "div", "legend");
  const notice = element(pad, "div", "notice");
  notice.setAttribute("role", "status");

  const state = new State(model);
  const shapes = new Shapes(model);
  let drawn = 0;
  const draw = () => {
    drawn = 0;
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [model.get("width"), model.get("height")];
    const size = [Math.round(width * ratio), Math.round(height * ratio)];
    if (paper.width !== size[0] || paper.height !== size[1]) [paper.width, paper.height] = size;
    const pen = paper.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    drawMarks(pen, view, model.get("marks"), {
      hovered: state.hovered, held: state.held, focus: state.focus, cursor: model.get("cursor"),
    });
  };
  const soon = () => { drawn = drawn || requestAnimationFrame(draw); };
  const look = () => {
    shapes.look(view.frame, view.unit);
    soon();
  };
  const view = new View(model, look);
  const link = new Link(model);
  const interactive = model.get("interactive");
  const input = interactive ? new Input(pad, view, link, state, soon) : null;
  if (interactive) resizeGrip(pad, model);

  const fit = () => {
    pad.style.width = `${model.get("width")}px`;
    pad.style.height = `${model.get("height")}px`;
    look();
  };
  const tell = () => {
    const text = model.get("notice");
    notice.textContent = text;
    notice.hidden = !text;
  };
  const frame = () => shapes.refresh();
  const showLegend = () => {
    legend(bar, [model.get("legend"), model.get("panel_legend")].filter((bar) => bar.title));
    bar.dataset.corner = model.get("legend_corner");
  };
  const listeners = [
    ["change:width change:height", fit],
    ["change:coefficients", frame],
    ["change:marks change:cursor", soon],
    ["change:legend change:panel_legend change:legend_corner", showLegend],
    ["change:notice", tell],
  ];
  for (const [names, listener] of listeners) model.on(names, listener);
  fit();
  showLegend();
  tell();
  let gone = false;
  shapes.load().then(() => drawingTime(pad, shapes)).then((time) => {
    if (gone) return;
    link.drawn();
    model.set("drawing_time", time);
    model.save_changes();
  });
  if (model.get("uniform_vectors") === 0) {
    model.set("uniform_vectors", uniformVectors() || -1);
    model.save_changes();
  }

  return () => {
    gone = true;
    cancelAnimationFrame(drawn);
    for (const [names, listener] of listeners) model.off(names, listener);
    if (input) input.close();
    link.close();
    view.close();
    shapes.close();
  };
}

export default { render };
