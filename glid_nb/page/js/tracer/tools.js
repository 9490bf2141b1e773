// The tools, and the tables of what they do.

import { PATHS } from "../pad/icons.js";

/** @import { Section } from "../pad/help.js" */
/** @import { Tool } from "./traits.js" */

/**
 * The key, the button's icon, an outline on a 16 x 16 grid, its title, and a hint.
 *
 * @type {Record<Tool, { key: string, icon: string, label: string, hint: string }>}
 */
export const TOOLS = {
  edit: {
    key: "v",
    icon: PATHS.edit,
    label: "Edit vertices and holes (V)",
    hint:
      "Drag a vertex · double-click an edge to add one · " +
      "right-click a vertex to delete it · click a hole to drop it",
  },
  foreground: {
    key: "b",
    icon: "M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z M9.5 12.5h5 M12 10v5",
    label: "Paint over the shape (B)",
    hint: "Paint over the shape",
  },
  background: {
    key: "n",
    icon: "M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z M9.5 12.5h5",
    label: "Paint over the background (N)",
    hint: "Paint over the background around the shape",
  },
  color: {
    key: "i",
    icon: "M9 4l3 3 M10 3.2l1-1a1.6 1.6 0 0 1 2.8 2.2l-1.1 1.1 M9.6 5.2L3.4 11.4 2.5 13.5l2.1-.9 6.2-6.2",
    label: "Pick the background's colour (I)",
    hint: "Click a pixel that shows the background's colour",
  },
  component: {
    key: "c",
    icon: "M8 1.5v3 M8 11.5v3 M1.5 8h3 M11.5 8h3 M8 5.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6z",
    label: "Pick the component to trace (C)",
    hint: "Click the part of the picture to trace",
  },
  polygon: {
    key: "p",
    icon: "M8 2l5.5 4-2 7h-7l-2-7z",
    label: "Draw the outline by hand (P)",
    hint:
      "Click the corners in turn, or draw around the shape · " +
      "double-click or Enter closes it · Esc starts over",
  },
  rectangle: {
    key: "r",
    icon: PATHS.rectangle,
    label: "Draw a rectangle (R)",
    hint: "Drag a rectangle over the shape",
  },
  knife: {
    key: "k",
    icon: "M8 8l4.4-4.4a1.41 1.41 0 0 1 2 2L10 10z M8 8l-6 6c4 .1 6.6-1.2 8-4",
    label: "Cut with the knife (K)",
    hint: "Draw a line: the shape is cut along it · begin or end outside to cut a part loose",
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
  "knife",
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
      [
        "K",
        "knife: draw a line along which the shape is cut; Esc while drawing discards it; " +
          "its width is in the panel",
      ],
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
