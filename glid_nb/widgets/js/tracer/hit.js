// What is under a point, all in the same coordinates.

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
      const t = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / square;
      const c = Math.min(Math.max(t, 0), 1);
      const foot = [a[0] + c * along[0], a[1] + c * along[1]];
      const d = distance(foot, point);
      if (d <= (best?.d ?? reach)) best = { loop: i, edge: j, foot, d };
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

// Index of the smallest hole around a point, -1 for none.
export function holeAt(holes, point) {
  let best = -1;
  holes.forEach((hole, i) => {
    if (contains(hole.loop, point) && (best < 0 || hole.area < holes[best].area)) best = i;
  });
  return best;
}
