// What is at a point; all arguments in the same coordinates.

const distance = ([x, y], [u, v]) => Math.hypot(x - u, y - v);

export function nearestVertex(loops, point, reach) {
  let best = null;
  loops.forEach((loop, i) =>
    loop.forEach((vertex, j) => {
      const d = distance(vertex, point);
      if (d <= (best?.d ?? reach)) best = { loop: i, index: j, d };
    }),
  );
  return best;
}

export function nearestEdge(loops, point, reach) {
  let best = null;
  loops.forEach((loop, i) =>
    loop.forEach((a, j) => {
      const b = loop[(j + 1) % loop.length];
      const along = [b[0] - a[0], b[1] - a[1]];
      const square = along[0] ** 2 + along[1] ** 2 || 1e-30;
      const dot = (point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1];
      const t = Math.min(Math.max(dot / square, 0), 1);
      const foot = [a[0] + t * along[0], a[1] + t * along[1]];
      const d = distance(foot, point);
      if (d <= (best?.d ?? reach)) best = { foot, d };
    }),
  );
  return best;
}

export function contains(loop, [x, y]) {
  let inside = false;
  for (let i = 0, j = loop.length - 1; i < loop.length; j = i++) {
    const [xi, yi] = loop[i];
    const [xj, yj] = loop[j];
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

// The index of the smallest hole around a point, -1 for none.
export function holeAt(holes, point) {
  const around = holes.filter((hole) => contains(hole.loop, point));
  return holes.indexOf(around.sort((a, b) => a.area - b.area)[0]);
}
