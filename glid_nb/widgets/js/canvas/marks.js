// Handles and targets, drawn over the shape: cyan disks where handles should go, black dots where
// they are, and a line between the two.

const TARGET = 7.5, IMAGE = 3.5, RING = 12; // radii, CSS pixels

function disk(pen, [x, y], radius) {
  pen.beginPath();
  pen.arc(x, y, radius, 0, 2 * Math.PI);
}

export function drawMarks(pen, view, marks, { hovered, held, focus, cursor }) {
  const targets = marks.targets.map((p, i) => view.toScreen(held.get(i) || p));
  const images = marks.images.map((p) => view.toScreen(p));
  pen.lineCap = "round";
  for (const [width, color] of [[3.6, "rgba(255,255,255,0.85)"], [1.6, "#2b2b2b"]]) {
    pen.lineWidth = width;
    pen.strokeStyle = color;
    pen.beginPath();
    targets.forEach(([x, y], i) => {
      if (!images[i] || Math.hypot(x - images[i][0], y - images[i][1]) < 2) return;
      pen.moveTo(...images[i]);
      pen.lineTo(x, y);
    });
    pen.stroke();
  }
  targets.forEach((target, i) => {
    const selected = marks.selected.includes(i);
    if (selected || i === hovered) {
      disk(pen, target, RING);
      pen.fillStyle = selected ? "rgba(0,114,178,0.28)" : "rgba(0,114,178,0.14)";
      pen.fill();
      if (selected) {
        pen.lineWidth = 2;
        pen.strokeStyle = "#0072b2";
        pen.stroke();
      }
    }
    disk(pen, target, TARGET);
    pen.fillStyle = "#00d5e0";
    pen.fill();
    pen.lineWidth = 1.4;
    pen.strokeStyle = "#063f45";
    pen.stroke();
  });
  for (const image of images) {
    disk(pen, image, IMAGE + 1);
    pen.fillStyle = "rgba(255,255,255,0.9)";
    pen.fill();
    disk(pen, image, IMAGE);
    pen.fillStyle = "#111";
    pen.fill();
  }
  if (focus && cursor) drawCursor(pen, view.toScreen(cursor));
}

function drawCursor(pen, [x, y]) {
  for (const [width, color] of [[4, "rgba(255,255,255,0.9)"], [1.6, "#d55e00"]]) {
    pen.lineWidth = width;
    pen.strokeStyle = color;
    pen.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      pen.moveTo(x + 4 * dx, y + 4 * dy);
      pen.lineTo(x + 13 * dx, y + 13 * dy);
    }
    pen.stroke();
  }
}

// The nearest target, or else the nearest dot, within reach of a place on the screen; -1 for none.
export function markAt(view, marks, [px, py], reach) {
  for (const points of [marks.targets, marks.images]) {
    let best = -1, least = reach;
    points.forEach((point, i) => {
      const [x, y] = view.toScreen(point);
      const distance = Math.hypot(x - px, y - py);
      if (distance <= least) [best, least] = [i, distance];
    });
    if (best >= 0) return best;
  }
  return -1;
}
