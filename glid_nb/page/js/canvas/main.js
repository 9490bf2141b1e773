// The pad over the renderer: sends pointers and keys, draws handles, colour bars and notices.

import { copied } from "../pad/clipboard.js";
import { follow, make, save } from "../pad/dom.js";
import { help, shield } from "../pad/help.js";
import { iconButton } from "../pad/icons.js";
import { Link } from "../pad/link.js";
import { openMenu } from "../pad/menu.js";
import { keysAround, Pad } from "../pad/pad.js";
import { painter } from "../pad/pen.js";
import { distance, View } from "../pad/view.js";
import {
  drawBrush,
  drawLasso,
  drawMarks,
  drawOnion,
  drawStiff,
  knobInCorner,
  lostMarks,
  markAt,
  ringAt,
} from "./marks.js";
import { Room } from "./room.js";
import { coveredNear, drawingTime, Shapes, uniformVectors } from "./shapes.js";

const REACH = { mouse: 13, pen: 16, touch: 26 }; // CSS pixels
const KEYS = /^(Arrow\w+|Page\w+|Delete|Backspace|Escape|Enter|[0fa,.[\]<>+=xmbe-])$/i;
const HELP = [
  [
    "Pins",
    [
      ["Click the shape", "pin a point"],
      ["Drag a pin, or the shape", "move it there; the shape follows, and never folds"],
      ["Right-click, long touch, Menu key", "what can be done with a pin, or with the shape there"],
      ["Delete", "remove the selected pins; with Shift keep the shape"],
      ["Ring around a pin: drag it, or its knob", "turn the shape there, scale it there"],
      ["< >, + -, X", "turn, scale; leave both free again"],
      ["Page Down, Page Up, [ ]", "selected pins and what is around them go back, come forward"],
      ["Arrow keys", "nudge selected pins, with Shift farther; else move a cursor"],
      ["Enter", "show the cursor; pin or select there"],
    ],
  ],
  [
    "Selecting",
    [
      ["Shift-click, A", "select several pins, all pins"],
      ["Shift and drag, Ctrl and drag", "select the pins in a box, in a lasso"],
      [
        ", .",
        "select the pin before, the next pin, and bring it into view; so does a click on an arrow at the edge",
      ],
      ["Esc", "cancel a drag; select nothing"],
    ],
  ],
  [
    "Poses",
    [
      ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
      ["Ctrl+C, Ctrl+V", "copy the pose, put it on this or a similar shape"],
      ["M", "swap left and right"],
      ["0", "back to the undeformed shape"],
    ],
  ],
  ["Stiff areas", [["B, E", "paint what should stay as it is, erase it; Esc lays the brush down"]]],
  [
    "View",
    [
      ["Wheel, two fingers", "zoom"],
      ["Middle button, Space and drag", "move the view"],
      ["F", "see everything"],
      ["P", "the picture alone, for lectures; Esc brings the rest back"],
      ["W", "the whole screen"],
    ],
  ],
  [
    "Timeline",
    [
      ["Space", "play the motion through the poses, pause; on the canvas too"],
      ["Arrow keys, Home, End", "step in time, with Shift to the next pose; first, last pose"],
      ["Alt and arrow keys", "move the pose in time; Delete removes it"],
    ],
  ],
];
const FIRST = "Click the shape to pin a point, then drag the pin · ? shows all keys";
const PAINT = "Paint what should stay as it is · E erases · Esc when done";
const TIPS = [
  "where it should be. Drag it; a right click shows what else; Shift-click selects several",
  "where the shape has got to. The cyan disk is where it should be",
];
const COVERED = ". Another part of the shape covers it";
const RING_TIPS = {
  turn: "Drag around the pin to turn the shape there; X leaves it free again",
  scale: "Drag away from the pin or towards it to scale the shape there; X leaves it free again",
};
const COPIED = "The pose is in the clipboard; Ctrl+V on a canvas puts it there";
const NOT_COPIED = "The browser does not give access to the clipboard; use Ctrl+C and Ctrl+V";
const SAVE_VIEW_AFTER = 250; // ms
const LEAST_SIZE = 240; // CSS pixels

function colorBar({ title, colors, ticks, about }) {
  const gradient = `background: linear-gradient(to right, ${colors.join(", ")})`;
  const labels = ticks.map((tick) => make("span", {}, tick));
  return make(
    "div",
    { className: "glid-legend-part", title: about },
    make("div", { className: "glid-legend-title" }, title),
    make("div", { className: "glid-legend-bar", style: gradient }),
    make("div", { className: "glid-legend-ticks" }, ...labels),
  );
}

function resizeGrip(model) {
  let from = null;
  return shield(
    make("div", {
      className: "glid-resize",
      title: "Drag to resize",
      onpointerdown: (e) => {
        e.preventDefault();
        e.target.setPointerCapture(e.pointerId);
        from = [model.get("width") - e.clientX, model.get("height") - e.clientY];
      },
      onpointermove: (e) => {
        if (!from) return;
        const [width, height] = [from[0] + e.clientX, from[1] + e.clientY].map((side) =>
          Math.max(LEAST_SIZE, Math.round(side)),
        );
        save(model, { width, height });
      },
      onlostpointercapture: () => (from = null),
    }),
  );
}

function render({ model, el, signal }) {
  el.classList.add("glid-host", "glid-pad-host");
  const interactive = model.get("interactive"); // else all pointers and keys pass by
  const paper = make("canvas", { className: "glid-paper" });
  const bars = make("div", { className: "glid-legend" });
  const notice = make("div", { className: "glid-notice", role: "status" });
  const prepared = make("div", { className: "glid-prepared", role: "status" });
  const label = "Deformation canvas: arrow keys move, Enter pins a point";
  const look = { className: "glid-pad", role: "application", "aria-label": label };
  const parts = [paper, bars, notice, prepared];
  const box = make("div", { ...look, inert: !interactive }, ...parts);
  const keys = help(HELP);
  box.dataset.lmSuppressShortcuts = "true"; // JupyterLab must not take the keys first
  el.append(box);

  let saving;
  const view = new View(
    () => {
      see();
      clearTimeout(saving);
      saving = setTimeout(
        () => save(model, { view: [view.x, view.y, view.unit] }),
        SAVE_VIEW_AFTER,
      );
    },
    { nearest: 1e-4, farthest: 1 },
  );
  const shapes = new Shapes(model, view);
  const soon = painter(paper, view, signal, (pen) => {
    const { found, held, focused } = pad;
    const cursor = focused ? model.get("cursor") : null;
    corner.classList.toggle("glid-through", !shapes.motion && knobInCorner(view, marks(), held));
    if (shapes.motion) return; // pins belong to the pose that is edited
    drawOnion(pen, view, model.get("onion"));
    drawStiff(pen, view, model.get("stiff"), paints());
    drawMarks(pen, view, model.get("marks"), { hovered: found?.mark, held, cursor });
    if (paints()) drawBrush(pen, view, model.get("brush"), pad);
    if (pad.encloses && pad.path.length > 2) drawLasso(pen, view, pad.path);
  });
  const see = () => {
    shapes.see();
    soon();
  };
  const say = (notice) => save(model, { notice });
  const link = new Link(model, box, signal, () => {
    // an error is no notice yet
    if (!link.busy && link.refusal && link.refusal !== model.get("notice")) say(link.refusal);
  });
  const marks = () => model.get("marks");
  const paints = () => "radius" in model.get("brush");
  // Opens the menu of a pin or of the shape; by default that of the pin selected last.
  const showMenu = (place, found = { mark: marks().selected.at(-1) }) => {
    const mark = found?.mark;
    const { selected, targets } = marks();
    const point = mark === undefined ? (model.get("cursor") ?? [view.x, view.y]) : targets[mark];
    const press = (key, e) => () => pad.press(key, e);
    place ??= view.toScreen(point);
    const pin = ["Add a pin here", "Click", () => pad.send("pin", place)];
    const all = selected.includes(mark) && selected.length > 1 ? ` ${selected.length} pins` : "";
    openMenu(box, place, [
      ...(mark === undefined
        ? coveredNear(box, place)
          ? [pin, null]
          : []
        : [
            ["Bring forward", "Page Up", press("PageUp")],
            ["Send back", "Page Down", press("PageDown")],
            null,
            [`Remove${all}`, "Delete", press("Delete")],
            ["Remove, keep the shape", "Shift+Delete", press("Delete", { shiftKey: true })],
            ["Leave angle and scale free", "X", press("x")],
            null,
          ]),
      ["Copy the pose", "Ctrl+C", press("copy")],
      ["Paste a pose", "Ctrl+V", () => pasted().then(paste, () => say(NOT_COPIED))],
      ["Swap left and right", "M", press("m")],
      ["Select all pins", "A", press("a")],
      ["The undeformed shape", "0", press("0")],
      ["See everything", "F", press("f")],
      ["Paint stiff areas", "B", press("b")],
      ["The picture alone", "P", alone],
      ["Full screen", "W", whole],
      ["All keys", "?", keys.toggle],
    ]);
  };
  const room = interactive && new Room(box, model, signal);
  const alone = () => room.alone();
  const whole = () => room.fullScreen();
  const pad = new Pad(box, view, link, {
    reach: REACH,
    keys: KEYS,
    actions: { "?": keys.toggle, contextmenu: () => showMenu(), p: alone, w: whole },
    menu: showMenu,
    tapped: () => box.dispatchEvent(new CustomEvent("glid:play", { bubbles: true })),
    get painting() {
      return paints();
    },
    find: (point, reach) =>
      shapes.motion || paints()
        ? null
        : (markAt(marks(), point, reach) ??
          ringAt(view, marks(), view.toScreen(point), reach / view.unit / 2)),
    encloses: (found, e) =>
      found ? null : e.shiftKey ? "box" : e.ctrlKey || e.metaKey ? "lasso" : null,
    held: ({ mark }) => {
      const { selected, targets } = marks();
      return new Map((selected.includes(mark) ? selected : [mark]).map((i) => [i, targets[i]]));
    },
    cursor: (found) => {
      if (found?.part) {
        box.title = RING_TIPS[found.part];
        return "grab";
      }
      box.title = "";
      if (!found) return "crosshair";
      const name = ["Pin", found.mark + 1, model.get("names")[found.mark]].join(" ").trim();
      const covered = marks().hidden.includes(found.mark) ? COVERED : "";
      box.title = `${name}: ${TIPS[Number(found.reached)]}${covered}`;
      return "grab";
    },
    changed: soon,
  });
  const button = (...look) => iconButton(...look, "glid-help-button");
  const corner = make(
    "div",
    { className: "glid-corner" },
    keys.button,
    button("fit", "Full screen (W)", whole),
    button("rectangle", "The picture alone (P)", alone),
  );
  if (interactive) {
    box.append(shield(corner), keys.table, resizeGrip(model));
    keysAround(box, (e) => pad.keydown(e), signal);
  }

  // While the timeline shows a motion, the first touch goes back to the pose that is edited.
  let back = null;
  const showMotion = (motion, release, heights) => {
    back = release;
    shapes.motion = motion;
    shapes.lift(heights);
    showLegend();
    shapes.refresh();
    soon();
  };
  for (const name of ["pointerdown", "keydown"]) {
    box.addEventListener(
      name,
      (e) => {
        const other = e.key && (e.ctrlKey || e.metaKey || !KEYS.test(e.key));
        if (!shapes.motion || e.button === 1 || other) return;
        e.stopImmediatePropagation();
        e.preventDefault();
        back();
      },
      true,
    );
  }

  // Poses go from one canvas to another as text in the clipboard.
  const pasted = async () => navigator.clipboard.readText();
  const paste = (text) => link.put({ type: "paste_pose", text });
  model.on("msg:custom", async ({ copy: text }) => {
    if (text && pad.focused) say((await copied(text)) ? COPIED : NOT_COPIED);
  });
  box.addEventListener("copy", (e) => {
    if (!pad.focused) return;
    e.preventDefault();
    pad.press("copy");
  });
  box.addEventListener("paste", (e) => {
    e.preventDefault();
    paste(e.clipboardData.getData("text"));
  });
  box.addEventListener(
    "pointerdown",
    (e) => {
      const lost = lostMarks(view, marks()).find(({ at }) => distance(at, pad.place(e)) < 12);
      if (!lost || e.target !== box) return;
      [view.x, view.y] = lost.target;
      view.changed();
      e.stopImmediatePropagation();
    },
    true,
  );

  // A pin that was selected alone, though not by the pointer, comes into view.
  let chosen;
  const reveal = () => {
    const {
      selected: [first, ...others],
      targets,
      images,
    } = marks();
    const now = others.length ? undefined : first;
    if (now === chosen) return;
    chosen = now;
    if (now === undefined || pad.mode) return;
    if (lostMarks(view, { targets: [targets[now], images[now]] }).length < 2) return;
    [view.x, view.y] = targets[now];
    view.changed();
  };

  const fit = () => {
    Object.assign(view, { width: model.get("width"), height: model.get("height") });
    [view.x, view.y, view.unit] = model.get("view");
    Object.assign(box.style, { width: `${view.width}px`, height: `${view.height}px` });
    see();
  };
  const tell = () => {
    const refusal = model.get("notice");
    const first = interactive && !marks().targets.length;
    notice.textContent = refusal || (paints() ? PAINT : first ? FIRST : "");
    notice.hidden = !notice.textContent;
    notice.classList.toggle("glid-first", !refusal);
  };
  const prepare = () => {
    const share = model.get("prepared");
    prepared.hidden = share >= 1;
    prepared.textContent = `Warming up: ${Math.round(100 * share)} %`;
    prepared.style.backgroundSize = `${100 * share}% 100%, auto`;
  };
  const showLegend = () => {
    const shown = [model.get("legend"), model.get("panel_legend")]
      .filter((bar) => bar.title)
      .map((bar) => ({ ...bar, title: (shapes.motion && bar.moving) || bar.title }));
    bars.replaceChildren(...shown.map(colorBar));
    bars.hidden = !shown.length;
    bars.dataset.corner = model.get("legend_corner");
  };
  follow(model, {
    "change:width change:height change:view": fit,
    "change:coefficients": () => shapes.refresh(),
    "change:marks change:cursor change:onion change:stiff change:brush": soon,
    "glid:motion": showMotion,
    "change:legend change:panel_legend change:legend_corner": showLegend,
    "change:notice change:marks change:brush": tell,
    "change:marks": reveal,
    "change:prepared": prepare,
  });
  shapes
    .load()
    .then(() => drawingTime(box, shapes))
    .then((time) => {
      if (!signal.aborted) save(model, { drawn: true, drawing_time: time });
    });
  if (model.get("uniform_vectors") === 0) save(model, { uniform_vectors: uniformVectors() || -1 });

  return () => {
    clearTimeout(saving);
    shapes.close();
  };
}

export default { render };
