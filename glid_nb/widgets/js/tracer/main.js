// The cage tracer's page: a toolbar, the stage with picture and cage, the panel, a status line.

import { iconButton, make } from "./dom.js";
import { Link } from "./link.js";
import { Panel } from "./panel.js";
import { Stage } from "./stage.js";

const TOOLS = [
  ["edit", "Edit vertices and holes (V)"],
  ["foreground", "Paint over the shape (B)"],
  ["background", "Paint over the background (N)"],
  ["color", "Pick the background's colour (I)"],
  ["component", "Pick the component to trace (C)"],
];
const PART = 1 << 20; // bytes of a file per message

function render({ model, el }) {
  let refusal = null;
  let busy = false;
  const root = make("div", { className: "glid-tracer" });
  const link = new Link(
    model,
    (report) => {
      busy = report.busy;
      if (report.refusal !== null || !report.busy) refusal = report.refusal;
      showStatus();
    },
    (idle) => (root.dataset.idle = idle),
  );

  const act = {
    gesture: () => link.gesture(),
    get idle() {
      return link.idle;
    },
    setOptions: (changes, gesture = null) => link.send({ action: "set_options", changes, gesture }),
    moveVertex: (loop, index, to, gesture, done) => link.send({ action: "move_vertex", loop, index, to, gesture }, { done }),
    insertVertex: (at) => link.send({ action: "insert_vertex", at }),
    deleteVertices: (vertices) => link.send({ action: "delete_vertices", vertices }),
    toggleHole: (number) => link.send({ action: "toggle_hole", number }),
    paint: (brush, stroke, done) => link.send({ action: "paint", brush, stroke }, { done }),
    pick: (what, at) => link.send({ action: what === "color" ? "pick_background" : "pick_component", at }),
    simple: (action) => link.send({ action }),
    undo: (done) => link.send({ action: "undo" }, { done }),
    upload,
  };

  function upload(file) {
    const name = file.name || "the picture";
    refusal = null;
    const sendPart = async (start) => {
      const data = await file.slice(start, start + PART).arrayBuffer();
      const done = (problem) => problem === null && start + PART < file.size && sendPart(start + PART);
      link.send({ action: "upload", name, size: file.size, start }, { buffers: [data], done });
    };
    sendPart(0);
  }

  const stage = new Stage(root, act, (tool) => {
    tools.forEach((button, i) => {
      button.classList.toggle("glid-on", TOOLS[i][0] === tool);
      button.setAttribute("aria-pressed", TOOLS[i][0] === tool);
    });
    panel.updateTool(tool);
  });
  const panel = new Panel(act, stage);
  const tools = TOOLS.map(([name, label]) => iconButton(name, label, () => stage.setTool(name)));
  const undo = iconButton("undo", "Undo (Ctrl+Z)", () => act.simple("undo"));
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => act.simple("redo"));
  const discard = make("button", { type: "button", title: "Go back to the outline as traced", onclick: () => act.simple("discard_edits") }, "Discard edits");
  const input = make("input", { type: "file", accept: "image/*", hidden: true, onchange: () => input.files[0] && upload(input.files[0]) });
  const open = iconButton("open", "Open a picture", () => {
    input.value = "";
    input.click();
  });
  const gap = () => make("span", { className: "glid-gap" });
  const toolbar = make(
    "div",
    { className: "glid-toolbar", role: "toolbar", "aria-label": "Tracer" },
    open,
    input,
    gap(),
    ...tools,
    gap(),
    undo,
    redo,
    discard,
    make("span", { className: "glid-grow" }),
    iconButton("minus", "Zoom out (-)", () => stage.zoom(0.8)),
    iconButton("plus", "Zoom in (+)", () => stage.zoom(1.25)),
    iconButton("fit", "Fit the picture (F)", () => stage.fit()),
  );
  const status = make("div", { className: "glid-status", role: "status", "aria-live": "polite" });
  root.append(toolbar, make("div", { className: "glid-body" }, stage.element, panel.element), status);
  // JupyterLab's shortcuts for single keys (b: new cell, d d: delete cell) are not for keys typed
  // here; those with Ctrl, such as saving, are, but for undo and redo. It asks for this attribute
  // before any listener of ours on the page's elements.
  const undoes = (e) => (e.ctrlKey || e.metaKey) && ["z", "y"].includes(e.key.toLowerCase());
  const guard = (e) => root.toggleAttribute("data-lm-suppress-shortcuts", undoes(e) || !(e.ctrlKey || e.metaKey));
  window.addEventListener("keydown", guard, true);
  root.addEventListener("keydown", (e) => {
    if (undoes(e) && !e.altKey) {
      act.simple(e.key.toLowerCase() === "z" && !e.shiftKey ? "undo" : "redo");
      e.preventDefault();
    } else if (e.ctrlKey || e.metaKey) return;
    e.stopPropagation(); // the notebook moves between cells by arrow keys
  });
  el.append(root);

  function showStatus() {
    const { size, loops, problems, n_components: count, discarded } = model.get("shown");
    const n = loops.reduce((sum, loop) => sum + loop.length, 0);
    const holes = Math.max(loops.length - 1, 0);
    let kind = "ok";
    let text = `Cage with ${n} vertices and ${holes || "no"} ${holes === 1 ? "hole" : "holes"}`;
    if (refusal) [kind, text] = ["bad", refusal];
    else if (busy) [kind, text] = ["busy", "Working…"];
    else if (!size) [kind, text] = ["idle", "No picture yet"];
    else if (problems.length) {
      [kind, text] = ["bad", loops.length ? "This is no cage yet; the last valid cage is kept" : "There is no cage yet"];
    } else if (discarded) text += " · your edits went with the old outline; Undo brings them back";
    else if (count > 1) text += ` · ${count} components in the picture`;
    root.dataset.status = kind;
    status.textContent = text;
  }

  function showState() {
    const shown = model.get("shown");
    stage.update(shown);
    panel.update(shown);
    undo.disabled = !shown.can_undo;
    redo.disabled = !shown.can_redo;
    discard.hidden = !shown.edited;
    tools.forEach((button) => (button.disabled = !shown.size));
    showStatus();
  }

  function showPicture() {
    const bytes = model.get("picture");
    stage.setPicture(bytes).catch((error) => {
      refusal = `The picture cannot be shown: ${error.message}`;
      showStatus();
    });
  }

  const setHeight = () => root.style.setProperty("--glid-height", `${model.get("height")}px`);
  model.on("change:shown", showState);
  model.on("change:picture", showPicture);
  model.on("change:height", setHeight);
  setHeight();
  showState();
  showPicture();
  stage.setTool("edit");
  root.dataset.idle = true;

  return () => {
    model.off("change:shown", showState);
    model.off("change:picture", showPicture);
    model.off("change:height", setHeight);
    window.removeEventListener("keydown", guard, true);
    link.close();
    stage.close();
  };
}

export default { render };
