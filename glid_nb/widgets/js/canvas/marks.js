// Handles and targets, drawn over the shape: cyan disks where handles should go, black dots where
// they are, and a line between the two.

import { nearestVertex } from "../pad/hit.js";
import { disk } from "../pad/pen.js";

const TARGET = 7.5, IMAGE = 3.5, RING = 12; // radii, CSS pixels

// Lines between pairs of points, with a border.
function lines(pen, pairs, styles) {
  pen.lineCap = "round";
  for (const [width, color] of styles) {
    pen.lineWidth = width;
    pen.strokeStyle = color;
    pen.beginPath();
    for (const [from, to] of pairs) {
      pen.moveTo(...from);
      pen.lineTo(...to);
    }
    pen.stroke();
  }
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
    disk(pen, target, TARGET, "#00d5e0", "#063f45", 1.4);
  });
  for (const image of images) {
    disk(pen, image, IMAGE + 1, "rgba(255,255,255,0.9)");
    disk(pen, image, IMAGE, "#111");
  }
  if (!cursor) return;
  const [x, y] = view.toScreen(cursor);
  const arms = [[1, 0], [-1, 0], [0, 1], [0, -1]]
    .map(([dx, dy]) => [[x + 4 * dx, y + 4 * dy], [x + 13 * dx, y + 13 * dy]]);
  lines(pen, arms, [[4, "rgba(255,255,255,0.9)"], [1.6, "#d55e00"]]);
}

// The nearest target, or else the nearest dot, within reach of a point; null for none.
export function markAt(marks, point, reach) {
  for (const points of [marks.targets, marks.images]) {
    const found = nearestVertex([points], point, reach);
    if (found) return { mark: found.index, reached: points === marks.images };
  }
  return null;
}
