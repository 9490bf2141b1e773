// Handles and targets, drawn over the shape: cyan disks where handles should go, black dots where
// they are, and a line between the two. Those that another part of the shape covers are faint rings.

import { make } from "../pad/dom.js";
import { nearest } from "../pad/hit.js";
import { circle, disk, fillPath, rectangle, strokePath, tracePath } from "../pad/pen.js";
import { distance } from "../pad/view.js";

const TARGET = 7.5;
const IMAGE = 3.5;
const RING = 12; // radii, CSS pixels
const DIAL = 42;
const KNOB = 6;
const EDGE = 14;
const CORNER = [36, 112]; // of a scale of 1; of the buttons; CSS pixels
const WANTED = "#d55e00";
const FREE = "rgba(40,40,40,0.75)";
const BORDER = "rgba(255,255,255,0.85)";

// Lines between pairs of points, with a border.
function lines(pen, pairs, styles) {
  pen.lineCap = "round";
  tracePath(pen, pairs, false);
  strokePath(pen, styles);
}

// Outlines of other poses: colour, and loops of points.
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

const STIFF = "#4b0f7a"; // told by its hatching, whatever the colours

function hatching(pen, strength) {
  const size = Math.round(16 - 9 * strength); // the stiffer, the closer
  const tile = make("canvas", { width: size, height: size });
  const ink = tile.getContext("2d");
  tracePath(
    ink,
    [
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
    ],
    false,
  );
  strokePath(ink, [
    [3, "rgba(255,255,255,0.75)"],
    [1.5, STIFF],
  ]);
  return pen.createPattern(tile, "repeat");
}

// Painted areas: strength, and loops of points; faint outlines unless there is a brush.
export function drawStiff(pen, view, areas, brush) {
  pen.globalAlpha = brush ? 1 : 0.4;
  for (const [strength, loops] of areas) {
    fillPath(
      pen,
      loops.map((loop) => view.line(loop)),
      brush ? hatching(pen, strength) : "transparent",
      "nonzero",
    );
    strokePath(pen, [
      [3.4, BORDER],
      [1.5, STIFF],
    ]);
  }
  pen.globalAlpha = 1;
}

// The brush below the pointer, and what it has painted since it was pressed.
export function drawBrush(pen, view, { radius, strength }, { path, rests }) {
  const wide = radius / view.unit;
  const color = strength ? STIFF : "#ffffff";
  if (path.length) {
    tracePath(pen, [view.line([...path, path.at(-1)])], false);
    Object.assign(pen, { lineCap: "round", lineJoin: "round", globalAlpha: 0.45 });
    strokePath(pen, [[2 * wide, color]]);
    pen.globalAlpha = 1;
  }
  if (!rests) return;
  circle(pen, rests, wide, [
    [3.4, BORDER],
    [1.4, STIFF],
  ]);
}

// The ring around the pin that was selected last: where it is, and its knob, on the screen.
function dial(view, marks, held) {
  const last = marks.selected.at(-1);
  const [angle, scale] = marks.ring;
  if (angle === undefined || !marks.targets[last]) return null;
  const centre = view.toScreen(held?.get(last) || marks.targets[last]);
  const [x, y] = centre;
  const radius = DIAL * Math.min(2.5, Math.max(0.5, scale));
  return { centre, radius, knob: [x + radius * Math.cos(angle), y - radius * Math.sin(angle)] };
}

// Whether the ring's knob is below the corner's buttons.
export function knobInCorner(view, marks, held) {
  const [x, y] = dial(view, marks, held)?.knob ?? [0, 0];
  return x > view.width - CORNER[0] - KNOB && y < CORNER[1] + KNOB;
}

// The part of the ring at a place on the screen, as `part`; null for none.
export function ringAt(view, marks, place, reach) {
  const ring = dial(view, marks);
  if (!ring) return null;
  if (distance(place, ring.knob) <= Math.max(KNOB + 4, reach)) return { part: "scale" };
  const far = Math.abs(distance(place, ring.centre) - ring.radius);
  return far <= reach ? { part: "turn" } : null;
}

// Orange and full what is wanted, grey and dashed what is free.
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
  fillPath(pen, [rectangle([x - KNOB, y - KNOB], [x + KNOB, y + KNOB])], scaled ? WANTED : "#fff");
  strokePath(pen, [[1.6, scaled ? "#fff" : FREE]]);
}

// Where the edge points to pins that are out of sight: `at` on the screen, `target` in the world.
export function lostMarks(view, marks) {
  return marks.targets.flatMap((target) => {
    const place = view.toScreen(target);
    const [x, y] = place;
    if (x >= 0 && y >= 0 && x <= view.width && y <= view.height) return [];
    const within = (value, size) => Math.min(size - EDGE, Math.max(EDGE, value));
    const height = within(y, view.height);
    const at = [within(x, view.width - (height < CORNER[1] ? CORNER[0] : 0)), height];
    return [{ at, target, angle: Math.atan2(y - at[1], x - at[0]) }];
  });
}

function drawLost(pen, view, marks) {
  for (const {
    at: [x, y],
    angle,
  } of lostMarks(view, marks)) {
    const corner = (turn, r) => [x + r * Math.cos(angle + turn), y + r * Math.sin(angle + turn)];
    fillPath(pen, [[corner(0, 11), corner(2.4, 9), corner(-2.4, 9)]], "#00d5e0");
    strokePath(pen, [[1.6, "#063f45"]]);
  }
}

// The box or lasso that selects.
export function drawLasso(pen, view, path) {
  fillPath(pen, [view.line(path)], "rgba(0,114,178,0.12)");
  strokePath(
    pen,
    [
      [3, BORDER],
      [1.4, "#0072b2"],
    ],
    [5, 3],
  );
}

// held: where the pointer holds targets, by index.
export function drawMarks(pen, view, marks, { hovered, held, cursor }) {
  const targets = view.line(marks.targets.map((p, i) => held.get(i) || p));
  const images = view.line(marks.images);
  const apart = targets
    .map((target, i) => [images[i], target])
    .filter(([a, b]) => a && distance(a, b) >= 2);
  lines(pen, apart, [
    [3.6, BORDER],
    [1.6, "#2b2b2b"],
  ]);
  targets.forEach((target, i) => {
    if (marks.selected.includes(i)) disk(pen, target, RING, "rgba(0,114,178,0.28)", "#0072b2", 2);
    else if (i === hovered) disk(pen, target, RING, "rgba(0,114,178,0.14)");
    if (marks.hidden.includes(i))
      circle(
        pen,
        target,
        TARGET,
        [
          [3.4, BORDER],
          [1.6, "#067a82"],
        ],
        [3.5, 2.4],
      );
    else disk(pen, target, TARGET, "#00d5e0", "#063f45", 1.4);
  });
  drawRing(pen, view, marks, held);
  drawLost(pen, view, marks);
  images.forEach((image, i) => {
    if (marks.hidden.includes(i)) return;
    disk(pen, image, IMAGE + 1, "rgba(255,255,255,0.9)");
    disk(pen, image, IMAGE, "#111");
  });
  if (!cursor) return;
  const [x, y] = view.toScreen(cursor);
  const arms = [
    [1, 0],
    [-1, 0],
    [0, 1],
    [0, -1],
  ].map(([dx, dy]) => [
    [x + 4 * dx, y + 4 * dy],
    [x + 13 * dx, y + 13 * dy],
  ]);
  lines(pen, arms, [
    [4, "rgba(255,255,255,0.9)"],
    [1.6, "#d55e00"],
  ]);
}

// The nearest target, or else the nearest dot, within reach of a point; null for none. As in the
// kernel's gestures, a hidden one counts as farther away by a third of the reach.
export function markAt(marks, point, reach) {
  const at = (points, reached) =>
    nearest(
      points.map((place, mark) => {
        const loss = marks.hidden.includes(mark) ? reach / 3 : 0;
        return { mark, reached, d: distance(place, point), loss };
      }),
      reach,
    );
  return at(marks.targets, false) ?? at(marks.images, true);
}
