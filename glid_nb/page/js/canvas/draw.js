// What is drawn over the shape: pins, other poses' outlines, stiff areas, the brush, the lasso.
//
// A pin's target is a cyan disk, its image a black dot, and a line leads from one to the other. Pins
// that another part of the shape covers are faint rings.

import { make, penOf } from "../pad/dom.js";
import { circle, disk, fillPath, rectangle, strokePath, tracePath } from "../pad/pen.js";
import { distance } from "../pad/view.js";
import { arrowsTo, dial, KNOB } from "./marks.js";

/** @import { Mark, Point, Strokes } from "../types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { View } from "../pad/view.js" */
/** @import { Brush, CanvasTraits, Marks } from "./traits.js" */

// Radii, CSS pixels.
const TARGET = 7.5;
const IMAGE = 3.5;
const RING = 12;
const APART = 2; // of target and image, from which a line joins them

const BORDER = "rgba(255,255,255,0.85)";
const PALE = "rgba(255,255,255,0.9)";
const INK = "#2b2b2b";
const TARGET_FILL = "#00d5e0";
const TARGET_EDGE = "#063f45";
const HIDDEN = "#067a82";
const CHOSEN = "#0072b2";
const WANTED = "#d55e00"; // of the ring
const FREE = "rgba(40,40,40,0.75)"; // of the ring
const STIFF = "#4b0f7a"; // told by its hatching, whatever the colours
/** @type {Strokes} */
const HOLLOW = [
  [6, PALE],
  [4, TARGET_EDGE],
  [2, TARGET_FILL],
];
const FAINT = 0.7; // of pins that belong to another pose

/**
 * Lines between pairs of points.
 *
 * @param {Pen} pen
 * @param {Point[][]} pairs
 * @param {Strokes} strokes
 */
function lines(pen, pairs, strokes) {
  pen.lineCap = "round";
  tracePath(pen, pairs, false);
  strokePath(pen, strokes);
}

/**
 * Outlines of other poses.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {CanvasTraits["onion"]} outlines
 */
export function drawOnion(pen, view, outlines) {
  for (const [color, loops] of outlines) {
    tracePath(
      pen,
      loops.map((loop) => view.line(loop)),
    );
    strokePath(pen, [
      [3.6, BORDER],
      [1.8, color],
    ]);
  }
}

/**
 * @param {Pen} pen
 * @param {number} strength the stiffer, the closer are the lines
 */
function hatching(pen, strength) {
  const size = Math.round(16 - 9 * strength);
  const tile = make("canvas", { width: size, height: size });
  const ink = penOf(tile);
  /** @type {Point[][]} */
  const diagonals = [
    [
      [0, size],
      [size, 0],
    ],
    [
      [-1, 1],
      [1, -1],
    ],
    [
      [size - 1, size + 1],
      [size + 1, size - 1],
    ],
  ];
  tracePath(ink, diagonals, false);
  strokePath(ink, [
    [3, "rgba(255,255,255,0.75)"],
    [1.5, STIFF],
  ]);
  return pen.createPattern(tile, "repeat") ?? STIFF;
}

/**
 * Stiff areas; faint outlines unless there is a brush.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {CanvasTraits["stiff"]} areas
 * @param {boolean} painting
 */
export function drawStiff(pen, view, areas, painting) {
  pen.globalAlpha = painting ? 1 : 0.4;
  for (const [strength, loops] of areas) {
    const style = painting ? hatching(pen, strength) : "transparent";
    fillPath(
      pen,
      loops.map((loop) => view.line(loop)),
      style,
      "nonzero",
    );
    strokePath(pen, [
      [3.4, BORDER],
      [1.5, STIFF],
    ]);
  }
  pen.globalAlpha = 1;
}

/**
 * The brush below the pointer, and what it has painted since it was pressed.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {Brush} brush
 * @param {{ path: Point[], rests: Point | null }} pointer
 */
export function drawBrush(pen, view, { radius, strength }, { path, rests }) {
  const wide = radius / view.unit;
  const last = path.at(-1);
  if (last) {
    tracePath(pen, [view.line([...path, last])], false);
    pen.lineCap = "round";
    pen.lineJoin = "round";
    pen.globalAlpha = 0.45;
    strokePath(pen, [[2 * wide, strength ? STIFF : "#ffffff"]]);
    pen.globalAlpha = 1;
  }
  if (!rests) return;
  circle(pen, rests, wide, [
    [3.4, BORDER],
    [1.4, STIFF],
  ]);
}

/**
 * The box or lasso that selects.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {Point[]} path
 */
export function drawLasso(pen, view, path) {
  fillPath(pen, [view.line(path)], "rgba(0,114,178,0.12)");
  /** @type {Strokes} */
  const strokes = [
    [3, BORDER],
    [1.4, CHOSEN],
  ];
  strokePath(pen, strokes, [5, 3]);
}

/**
 * @param {Pen} pen
 * @param {View} view
 * @param {Marks} marks
 * @param {object} now
 * @param {Mark | undefined} now.hovered what lies below the pointer
 * @param {Map<Mark, Point>} now.held where the pointer holds targets
 * @param {Point | null} now.cursor the keyboard's
 */
export function drawMarks(pen, view, marks, { hovered, held, cursor }) {
  const targets = view.line(marks.targets.map((point, i) => held.get(i) ?? point));
  const images = view.line(marks.images);
  drawMisses(pen, targets, images);
  targets.forEach((target, i) => {
    if (marks.selected.includes(i)) disk(pen, target, RING, "rgba(0,114,178,0.28)", CHOSEN, 2);
    else if (i === hovered) disk(pen, target, RING, "rgba(0,114,178,0.14)");
    drawTarget(pen, target, marks.hidden.includes(i));
  });
  drawRing(pen, view, marks, held);
  drawArrows(pen, view, marks);
  images.forEach((image, i) => {
    if (marks.hidden.includes(i)) return;
    disk(pen, image, IMAGE + 1, PALE);
    disk(pen, image, IMAGE, "#111");
  });
  if (cursor) drawCursor(pen, view.toScreen(cursor));
}

/**
 * The pins of a motion that stands still: hollow, as they are of another pose.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {Point[]} places
 * @param {object} now
 * @param {Mark | undefined} now.hovered what lies below the pointer
 * @param {Map<Mark, Point>} now.held where the pointer holds them
 */
export function drawBetween(pen, view, places, { hovered, held }) {
  view.line(places.map((place, i) => held.get(i) ?? place)).forEach((place, i) => {
    const touched = i === hovered || held.has(i);
    if (touched) disk(pen, place, RING, "rgba(0,114,178,0.14)");
    pen.globalAlpha = touched ? 1 : FAINT;
    circle(pen, place, TARGET, HOLLOW);
  });
  pen.globalAlpha = 1;
}

/**
 * Lines from where pins are to where they should be.
 *
 * @param {Pen} pen
 * @param {Point[]} targets
 * @param {Point[]} images
 */
function drawMisses(pen, targets, images) {
  const pairs = targets.map((target, i) => [images[i], target]);
  const apart = pairs.filter(([image, target]) => image && distance(image, target) >= APART);
  lines(pen, apart, [
    [3.6, BORDER],
    [1.6, INK],
  ]);
}

/**
 * @param {Pen} pen
 * @param {Point} place
 * @param {boolean} hidden
 */
function drawTarget(pen, place, hidden) {
  if (!hidden) {
    disk(pen, place, TARGET, TARGET_FILL, TARGET_EDGE, 1.4);
    return;
  }
  /** @type {Strokes} */
  const strokes = [
    [3.4, BORDER],
    [1.6, HIDDEN],
  ];
  circle(pen, place, TARGET, strokes, [3.5, 2.4]);
}

/**
 * The ring and its knob: orange and full what is wanted, grey and dashed what is free.
 *
 * @param {Pen} pen
 * @param {View} view
 * @param {Marks} marks
 * @param {Map<Mark, Point>} held
 */
function drawRing(pen, view, marks, held) {
  const ring = dial(view, marks, held);
  if (!ring) return;
  const [, , turned, scaled] = marks.ring;
  const { centre, radius, knob } = ring;
  const [x, y] = knob;
  const color = turned ? WANTED : FREE;
  circle(pen, centre, radius, [[4, BORDER]]);
  circle(pen, centre, radius, [[2, color]], turned ? [] : [6, 4]);
  lines(
    pen,
    [[centre, knob]],
    [
      [3, BORDER],
      [1.2, color],
    ],
  );
  const square = rectangle([x - KNOB, y - KNOB], [x + KNOB, y + KNOB]);
  fillPath(pen, [square], scaled ? WANTED : "#fff");
  strokePath(pen, [[1.6, scaled ? "#fff" : FREE]]);
}

/**
 * @param {Pen} pen
 * @param {View} view
 * @param {Marks} marks
 */
function drawArrows(pen, view, marks) {
  for (const { at, angle } of arrowsTo(view, marks.targets)) {
    const corner = (/** @type {number} */ turn, /** @type {number} */ radius) =>
      /** @type {Point} */ ([
        at[0] + radius * Math.cos(angle + turn),
        at[1] + radius * Math.sin(angle + turn),
      ]);
    fillPath(pen, [[corner(0, 11), corner(2.4, 9), corner(-2.4, 9)]], TARGET_FILL);
    strokePath(pen, [[1.6, TARGET_EDGE]]);
  }
}

/**
 * @param {Pen} pen
 * @param {Point} place
 */
function drawCursor(pen, [x, y]) {
  const arm = (/** @type {number} */ dx, /** @type {number} */ dy) =>
    /** @type {Point[]} */ ([
      [x + 4 * dx, y + 4 * dy],
      [x + 13 * dx, y + 13 * dy],
    ]);
  lines(
    pen,
    [arm(1, 0), arm(-1, 0), arm(0, 1), arm(0, -1)],
    [
      [4, PALE],
      [1.6, WANTED],
    ],
  );
}
