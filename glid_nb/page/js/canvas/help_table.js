// The table of keys and gestures behind the "?".

/** @import { Section } from "../pad/help.js" */

/** @type {Section[]} */
export const HELP = [
  [
    "Pins",
    [
      ["Click the shape", "pin a point"],
      ["Drag a pin, or the shape", "move it there; the shape follows, and never folds"],
      [
        "Shift, Ctrl in a drag",
        "keep it on one axis; on whole pixels of the picture; Shift turns by 15°",
      ],
      ["Right-click, long touch, Shift+F10", "a menu for the pin or the shape there"],
      ["Delete", "remove the selected pins; with Shift keep the shape"],
      ["Ring around a pin; Alt on the pin", "turn the shape there; the ring's knob scales it too"],
      ["< >, + -, X", "turn, scale; free both again"],
      ["Page Down, Page Up, [ ]", "send selected pins and their surroundings back, forward"],
      ["L, H", "lock the selected pins, hide them; Shift+H shows all again"],
      ["G", "make a group: it is selected and moved together; with Shift dissolve it"],
      ["Arrow keys", "nudge selected pins, with Shift farther; else move a cursor"],
      ["Enter", "show the cursor; pin or select there"],
    ],
  ],
  [
    "Selecting",
    [
      ["Shift-click, A", "select several pins, all pins"],
      ["N, Shift+N, click a part", "edit another part, if there are several"],
      ["Shift and drag, Ctrl and drag", "select the pins in a box, in a lasso"],
      [
        ", .",
        "select the pin before, the next pin, and bring it into view; " +
          "so does a click on an arrow at the edge",
      ],
      [
        "In the list of pins",
        "arrow keys, with Shift several; Ctrl-click one more; F2, double click: rename",
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
  ["Stiff areas", [["B, E", "paint stiff areas, erase them; Esc ends painting"]]],
  [
    "View",
    [
      ["Wheel, two fingers", "zoom"],
      ["Middle button, Space and drag", "move the view"],
      ["F", "see everything"],
      ["P", "the picture alone, for lectures; Esc brings the rest back"],
      ["W", "the whole screen, without the inspector"],
      ["I", "hide the inspector, show it again"],
    ],
  ],
  [
    "Timeline",
    [
      ["K; a drag of a hollow pin", "make a keyframe at the time that is shown"],
      ["Space", "play the motion through the poses, pause; on the canvas too"],
      ["Arrow keys, Home, End", "step a frame, with Shift to the next pose; first, last pose"],
      [
        "Click a curve between poses, Enter",
        "ease the motion there: drag its two handles, or arrow keys",
      ],
      [
        "Shift+Home, Shift+End",
        "play over and over from here, to here; so do the two marks on the ruler, seen below a pointer",
      ],
      [
        "Line below the poses",
        "green: proved, the higher the safer; grey hatching: not yet; orange: not proved",
      ],
      ["Ctrl and wheel", "zoom the timeline; then the wheel alone moves along it"],
      ["Double click a pose, F2", "type its name"],
      ["Alt and arrow keys", "move the pose in time; Delete removes it"],
    ],
  ],
];
