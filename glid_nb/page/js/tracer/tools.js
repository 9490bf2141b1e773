// The tools, and the tables of what they do.

/** @import { Section } from "../pad/help.js" */
/** @import { Tool } from "./traits.js" */

/** @type {Record<Tool, { key: string, label: string, hint: string }>} label: the button's title */
export const TOOLS = {
  edit: {
    key: "v",
    label: "Edit vertices and holes (V)",
    hint:
      "Drag a vertex · double-click an edge to add one · " +
      "right-click a vertex to delete it · click a hole to drop it",
  },
  foreground: { key: "b", label: "Paint over the shape (B)", hint: "Paint over the shape" },
  background: {
    key: "n",
    label: "Paint over the background (N)",
    hint: "Paint over the background around the shape",
  },
  color: {
    key: "i",
    label: "Pick the background's colour (I)",
    hint: "Click a pixel that shows the background's colour",
  },
  component: {
    key: "c",
    label: "Pick the component to trace (C)",
    hint: "Click the part of the picture to trace",
  },
  polygon: {
    key: "p",
    label: "Draw the outline by hand (P)",
    hint:
      "Click the corners in turn, or draw around the shape · " +
      "double-click or Enter closes it · Esc starts over",
  },
  rectangle: {
    key: "r",
    label: "Draw a rectangle (R)",
    hint: "Drag a rectangle over the shape",
  },
};

/** @type {Tool[]} */
export const TOOL_NAMES = [
  "edit",
  "foreground",
  "background",
  "color",
  "component",
  "polygon",
  "rectangle",
];

/** @type {Section[]} */
export const HELP = [
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
      ["P, R", "draw the outline or a hole in it, a rectangle; Enter closes it, Esc discards it"],
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
