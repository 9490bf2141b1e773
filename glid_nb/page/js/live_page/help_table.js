// The table of keys and gestures behind the "?".

/** @import { Section } from "../pad/help.js" */

/** @type {Section[]} */
export const HELP = [
  [
    "Pins",
    [
      ["Click or tap the shape", "pin a point"],
      ["Drag a pin, or the shape", "move it there; the shape follows, and never folds"],
      ["Drag the ring; Alt on the pin", "turn the shape there; the knob scales it too"],
      ["< >, + -, X", "turn, scale; free both again"],
      ["Delete", "remove the selected pins"],
      ["Arrow keys", "nudge selected pins, with Shift farther; else move a cursor"],
      ["Enter", "show the cursor; pin or select there"],
      [", .", "select the pin before, the next pin"],
      ["Shift-click, Shift and drag, A", "select several pins, those in a box, all"],
      ["Esc", "cancel a drag; select nothing"],
    ],
  ],
  [
    "View and poses",
    [
      ["Wheel, two fingers", "zoom, move the view"],
      ["Drag beside the shape", "move the view"],
      ["F", "fit the window"],
      ["Space", "play the kept poses, pause"],
      ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
      ["0", "back to the undeformed shape"],
    ],
  ],
];
