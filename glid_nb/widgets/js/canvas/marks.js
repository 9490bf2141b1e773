// Handles and targets, drawn over the shape: cyan disks where handles should go, black dots where
// they are, and a line between the two. Those that another part of the shape covers are faint rings.

import { make } from "../pad/dom.js";
import { disk, strokePath, tracePath } from "../pad/pen.js";

const TARGET = 7.5, IMAGE = 3.5, RING = 12; // radii, CSS pixels

// Lines between pairs of points, with a border.
function lines(pen, pairs, styles) {
  pen.lineCap = "round";
  tracePath(pen, pairs, false);
  strokePath(pen, styles);
}

// A dashed ring with a border.
function ring(pen, place) {
  pen.setLineDash([3.5, 2.4]);
  disk(pen, place, TARGET, null, "rgba(255,255,255,0.85)", 3.4);
  disk(pen, place, TARGET, null, "#067a82", 1.6);
  pen.setLineDash([]);
}

// Outlines of other poses: colour, and loops of points.
export function drawOnion(pen, view, outlines) {
  for (const [color, loops] of outlines) {
    tracePath(pen, loops.map((loop) => loop.map((p) => view.toScreen(p))));
    pen.globalAlpha = 0.13;
    pen.fillStyle = color;
    pen.fill("evenodd");
    pen.globalAlpha = 0.8;
    strokePath(pen, [[1.4, color]]);
  }
  pen.globalAlpha = 1;
}

const STIFF = "#4b0f7a"; // told by its hatching, whatever the colours

function hatching(pen, strength) {
  const size = Math.round(16 - 9 * strength); // the stiffer, the closer
  const tile = make("canvas", { width: size, height: size }), ink = tile.getContext("2d");
  tracePath(ink, [[[0, size], [size, 0]], [[-1, 1], [1, -1]], [[size - 1, size + 1], [size + 1, size - 1]]], false);
  strokePath(ink, [[3, "rgba(255,255,255,0.75)"], [1.5, STIFF]]);
  return pen.createPattern(tile, "repeat");
}

// Painted areas: strength, and loops of points.
export function drawStiff(pen, view, areas) {
  for (const [strength, loops] of areas) {
    tracePath(pen, loops.map((loop) => loop.map((p) => view.toScreen(p))));
    pen.fillStyle = hatching(pen, strength);
    pen.fill();
    strokePath(pen, [[3.4, "rgba(255,255,255,0.85)"], [1.5, STIFF]]);
  }
}

// The brush below the pointer, and what it has painted since it was pressed.
export function drawBrush(pen, view, { radius, strength }, { path, rests }) {
  const wide = radius / view.unit, color = strength ? STIFF : "#ffffff";
  if (path.length) {
    tracePath(pen, [[...path, path.at(-1)].map((p) => view.toScreen(p))], false);
    Object.assign(pen, { lineCap: "round", lineJoin: "round", globalAlpha: 0.45 });
    strokePath(pen, [[2 * wide, color]]);
    pen.globalAlpha = 1;
  }
  if (!rests) return;
  disk(pen, rests, wide, null, "rgba(255,255,255,0.85)", 3.4);
  disk(pen, rests, wide, null, STIFF, 1.4);
}

// held: where the pointer holds targets, by index.
export function drawMarks(pen, view, marks, { hovered, held, cursor }) {
  const targets = marks.targets.map((p, i) => view.toScreen(held.get(i) || p));
  const images = marks.images.map((p) => view.toScreen(p));
  const apart = targets.map((target, i) => [images[i], target])
    .filter(([a, b]) => a && Math.hypot(a[0] - b[0], a[1] - b[1]) >= 2);
  lines(pen, apart, [[3.6, "rgba(255,255,255,0.85)"], [1.6, "#2b2b2b"]]);
  targets.forEach((target, i) => {
    if (marks.selected.includes(i)) disk(pen, target, RING, "rgba(0,114,178,0.28)", "#0072b2", 2);
    else if (i === hovered) disk(pen, target, RING, "rgba(0,114,178,0.14)");
    if (marks.hidden.includes(i)) ring(pen, target);
    else disk(pen, target, TARGET, "#00d5e0", "#063f45", 1.4);
  });
  images.forEach((image, i) => {
    if (marks.hidden.includes(i)) return;
    disk(pen, image, IMAGE + 1, "rgba(255,255,255,0.9)");
    disk(pen, image, IMAGE, "#111");
  });
  if (!cursor) return;
  const [x, y] = view.toScreen(cursor);
  const arms = [[1, 0], [-1, 0], [0, 1], [0, -1]]
    .map(([dx, dy]) => [[x + 4 * dx, y + 4 * dy], [x + 13 * dx, y + 13 * dy]]);
  lines(pen, arms, [[4, "rgba(255,255,255,0.9)"], [1.6, "#d55e00"]]);
}

// The nearest target, or else the nearest dot, within reach of a point; null for none. As in the
// kernel's gestures, a hidden one counts as farther away by a third of the reach.
export function markAt(marks, point, reach) {
  for (const points of [marks.targets, marks.images]) {
    let best = null;
    points.forEach(([x, y], i) => {
      const gap = Math.hypot(x - point[0], y - point[1]);
      const far = gap + (marks.hidden.includes(i) ? reach / 3 : 0);
      if (gap <= reach && far < (best?.far ?? Infinity)) best = { mark: i, far };
    });
    if (best) return { mark: best.mark, reached: points === marks.images };
  }
  return null;
}
