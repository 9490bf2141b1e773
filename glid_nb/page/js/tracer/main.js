// The cage tracer's page: a toolbar, the stage with picture and cage, the panel, a status line.

import { follow, make } from "../pad/dom.js";
import { help } from "../pad/help.js";
import { iconButton } from "../pad/icons.js";
import { Link } from "../pad/link.js";
import { keysAround } from "../pad/keys.js";
import { makePanel } from "./panel.js";
import { Stage, TOOLS } from "./stage.js";

const HELP = [
  [
    "Outline",
    [
      [
        "V",
        "edit: drag a vertex, double-click an edge to add one, click a hole to drop or keep it",
      ],
      ["Right-click, Delete", "remove a vertex"],
      ["[ ]", "select the vertex before, the next vertex"],
      ["Arrow keys", "nudge the selected vertex, with Shift farther"],
      ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
    ],
  ],
  [
    "By hand",
    [
      ["B, N", "paint over the shape, over the background"],
      ["I, C", "pick the background's colour, the component"],
      ["P, R", "draw the outline, a rectangle; Enter closes an outline, Esc gives it up"],
    ],
  ],
  [
    "View",
    [
      ["Wheel, + -, F", "zoom after a click on the picture, fit the picture"],
      ["Drag beside the outline", "move the view"],
    ],
  ],
];
const PART = 1 << 20; // bytes of a file per message

function render({ model, el, signal }) {
  const root = make("div", { className: "glid-skin glid-tracer" });
  const link = new Link(model, root, signal, () => {
    showStatus();
    if (link.idle) showTool(model.get("shown").tool);
  });

  // Asks the kernel for something, in order.
  const act = (type, content = {}, buffers = []) => link.put({ type, ...content }, buffers);

  async function upload(file) {
    const name = file.name || "the picture";
    let start = 0;
    let refused = null;
    do {
      const data = await file.slice(start, start + PART).arrayBuffer();
      refused = await act("upload", { name, size: file.size, start, buffered: true }, [data]);
      start += PART;
    } while (!refused && start < file.size);
  }

  const stage = new Stage(root, link, upload, signal);
  const panel = makePanel(act, stage);
  const tools = Object.entries(TOOLS).map(([name, [label]]) => iconButton(name, label));
  Object.keys(TOOLS).forEach((name, i) => (tools[i].dataset.tool = name));
  const undo = iconButton("undo", "Undo (Ctrl+Z)", () => act("undo"));
  const redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => act("redo"));
  const back = { title: "Go back to the outline as traced", onclick: () => act("discard_edits") };
  const discard = make("button", back, "Discard edits");
  const input = make("input", {
    type: "file",
    accept: "image/*",
    hidden: true,
    onchange: () => input.files[0] && upload(input.files[0]),
  });
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
    open,
    input,
    gap(),
    ...tools,
    gap(),
    undo,
    redo,
    discard,
    make("span", { className: "glid-grow" }),
    iconButton("minus", "Zoom out (-)", () => stage.zoom(false)),
    iconButton("plus", "Zoom in (+)", () => stage.zoom(true)),
    iconButton("fit", "Fit the picture (F)", () => stage.fit()),
    keys.button,
  );
  const status = make("div", { className: "glid-status", role: "status", "aria-live": "polite" });
  root.append(
    toolbar,
    make("div", { className: "glid-body" }, stage.element, panel.element),
    status,
  );
  keysAround(stage.element, (e) => stage.pad.keydown(e), signal, root);
  el.classList.add("glid-host");
  el.append(root);

  // Shown at once; the kernel changes the tool after what was done with the last one.
  root.addEventListener("click", (e) => {
    const name = e.target.closest("[data-tool]")?.dataset.tool;
    if (!name) return;
    showTool(name);
    act("tool", { name });
  });

  function showTool(name) {
    if (name !== stage.tool) stage.setTool(name);
    for (const button of root.querySelectorAll("[data-tool]")) {
      button.ariaPressed = button.dataset.tool === name;
    }
  }

  function showStatus() {
    const { size, loops, problems, component, discarded, doubt } = model.get("shown");
    if (!loops) return;
    const n = loops.flat().length;
    const count = model.get("shown").n_components;
    const holes = Math.max(loops.length - 1, 0);
    let kind = "ok";
    let text = `Cage with ${n} vertices and ${holes || "no"} ${holes === 1 ? "hole" : "holes"}`;
    if (link.refusal) [kind, text] = ["bad", link.refusal];
    else if (link.busy) [kind, text] = ["busy", "Working…"];
    else if (!size) [kind, text] = ["idle", "No picture yet"];
    else if (problems.length) {
      [kind, text] = [
        "bad",
        loops.length
          ? "This is not a valid cage; the last valid cage is kept"
          : "There is no cage yet",
      ];
    } else if (discarded) {
      text += " · your edits were lost with the old outline; Undo brings them back";
    } else if (count > 1) {
      const which = component ? `component ${component + 1}` : "the largest";
      text += ` · ${which} of ${count} components`;
    }
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
      link.refusal = `The picture cannot be shown: ${error.message}`;
      showStatus();
    });
  }

  const setHeight = () => {
    const height = model.get("height"); // without one it is as high as there is room
    root.style.setProperty("--glid-height", height ? `${height}px` : "");
  };
  follow(model, {
    "change:height": setHeight,
    "change:shown": showState,
    "change:picture": showPicture,
  });

  return () => stage.close();
}

export default { render };
