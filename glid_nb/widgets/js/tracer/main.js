// The cage tracer's page: a toolbar, the stage with picture and cage, the panel, a status line.

import { follow, make } from "../pad/dom.js";
import { help } from "../pad/help.js";
import { Link } from "../pad/link.js";
import { keysAround } from "../pad/pad.js";
import { iconButton } from "../pad/icons.js";
import { Panel } from "./panel.js";
import { Stage } from "./stage.js";

const TOOLS = [
  ["edit", "Edit vertices and holes (V)"],
  ["foreground", "Paint over the shape (B)"],
  ["background", "Paint over the background (N)"],
  ["color", "Pick the background's colour (I)"],
  ["component", "Pick the component to trace (C)"],
  ["polygon", "Draw the outline by hand (P)"],
  ["rectangle", "Draw a rectangle (R)"],
];
const HELP = [
  ["Outline", [
    ["V", "edit: drag a vertex, double-click an edge to add one, click a hole to drop or keep it"],
    ["Right-click, Delete", "remove a vertex"],
    ["[ ]", "select the vertex before, the next vertex"],
    ["Arrow keys", "nudge the selected vertex, with Shift farther"],
    ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
  ]],
  ["By hand", [
    ["B, N", "paint over the shape, over the background"],
    ["I, C", "pick the background's colour, the component"],
    ["P, R", "draw the outline, a rectangle; Enter closes an outline, Esc gives it up"],
  ]],
  ["View", [
    ["Wheel, + -, F", "zoom after a click on the picture, fit the picture"],
    ["Drag beside the outline", "move the view"],
  ]],
];
const PART = 1 << 20; // bytes of a file per message

function render({ model, el }) {
  let refusal = null, busy = false;
  const root = make("div", { className: "glid-skin glid-tracer" });
  const link = new Link(model, el, (report) => {
    busy = report.busy;
    if (report.refusal || !busy) refusal = report.refusal;
    showStatus();
  }, (idle) => {
    root.dataset.idle = idle;
    if (idle) showTool(model.get("shown").tool);
  });
  root.dataset.idle = true;

  // Asks the kernel for something, in order.
  const act = (type, content = {}, buffers = []) => link.put({ type, ...content }, buffers);

  async function upload(file) {
    const name = file.name || "the picture";
    let start = 0, refused = null;
    do {
      const data = await file.slice(start, start + PART).arrayBuffer();
      refused = await act("upload", { name, size: file.size, start, buffered: true }, [data]);
      start += PART;
    } while (!refused && start < file.size);
  }

  const stage = new Stage(root, link, upload);
  const panel = new Panel(act, stage, chooseTool);
  const tools = TOOLS.map(([name, label]) => iconButton(name, label, () => chooseTool(name)));
  const undo = iconButton("undo", "Undo (Ctrl+Z)", () => act("undo"));
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => act("redo"));
  const discard = make("button", { type: "button", title: "Go back to the outline as traced", onclick: () => act("discard_edits") }, "Discard edits");
  const input = make("input", { type: "file", accept: "image/*", hidden: true, onchange: () => input.files[0] && upload(input.files[0]) });
  const open = iconButton("open", "Open a picture", () => {
    input.value = "";
    input.click();
  });
  const keys = help(HELP);
  stage.element.append(keys.table);
  stage.actions["?"] = keys.toggle;
  const gap = () => make("span", { className: "glid-gap" });
  const toolbar = make(
    "div",
    { className: "glid-toolbar", role: "toolbar", "aria-label": "Tracer" },
    open, input, gap(), ...tools, gap(), undo, redo, discard,
    make("span", { className: "glid-grow" }),
    iconButton("minus", "Zoom out (-)", () => stage.zoom(false)),
    iconButton("plus", "Zoom in (+)", () => stage.zoom(true)),
    iconButton("fit", "Fit the picture (F)", () => stage.fit()),
    keys.button,
  );
  const status = make("div", { className: "glid-status", role: "status", "aria-live": "polite" });
  root.append(toolbar, make("div", { className: "glid-body" }, stage.element, panel.element), status);
  const forget = keysAround(stage.element, (e) => stage.pad.keydown(e), root);
  el.classList.add("glid-host");
  el.append(root);

  // Shown at once; the kernel changes the tool after what was done with the last one.
  function chooseTool(name) {
    showTool(name);
    act("tool", { name });
  }

  function showTool(name) {
    if (name !== stage.tool) stage.setTool(name);
    tools.forEach((button, i) => {
      button.classList.toggle("glid-on", TOOLS[i][0] === name);
      button.setAttribute("aria-pressed", TOOLS[i][0] === name);
    });
    panel.updateTool(name);
  }

  function showStatus() {
    if (!model.get("shown").loops) return;
    const { size, loops, problems, n_components: count, component, discarded, doubt } = model.get("shown");
    const n = loops.reduce((sum, loop) => sum + loop.length, 0);
    const holes = Math.max(loops.length - 1, 0);
    let kind = "ok", text = `Cage with ${n} vertices and ${holes || "no"} ${holes === 1 ? "hole" : "holes"}`;
    if (refusal) [kind, text] = ["bad", refusal];
    else if (busy) [kind, text] = ["busy", "Working…"];
    else if (!size) [kind, text] = ["idle", "No picture yet"];
    else if (problems.length) {
      [kind, text] = ["bad", loops.length ? "This is not a valid cage; the last valid cage is kept" : "There is no cage yet"];
    } else if (discarded) text += " · your edits were lost with the old outline; Undo brings them back";
    else if (count > 1) text += ` · ${component ? `component ${component + 1}` : "the largest"} of ${count} components`;
    if (kind === "ok" && doubt) [kind, text] = ["guess", `A guess, as ${doubt} · ${text}`];
    root.dataset.status = kind;
    status.textContent = text;
  }

  function showState() {
    const shown = model.get("shown");
    if (!shown.loops) return; // the first state is still on its way
    stage.update(shown);
    panel.update(shown);
    undo.disabled = !shown.can_undo;
    redo.disabled = !shown.can_redo;
    discard.hidden = !shown.edited;
    tools.forEach((button) => (button.disabled = !shown.size));
    if (link.idle) showTool(shown.tool);
    showStatus();
  }

  function showPicture() {
    stage.setPicture(model.get("picture")).catch((error) => {
      refusal = `The picture cannot be shown: ${error.message}`;
      showStatus();
    });
  }

  const setHeight = () => {
    const height = model.get("height"); // without one it is as high as there is room
    root.style.setProperty("--glid-height", height ? `${height}px` : "");
  };
  const unfollow = follow(model, {
    "change:height": setHeight, "change:shown": showState, "change:picture": showPicture,
  });

  return () => {
    unfollow();
    forget();
    link.close();
    stage.close();
  };
}

export default { render };
