// What is at a point; all arguments in the same coordinates.

import { tracePath } from "./pen.js";
import { distance } from "./view.js";

const probe = document.createElement("canvas").getContext("2d");

// The nearest of things at a distance `d`, within reach; null for none. What has a `loss` counts as
// farther away by that.
export function nearest(things, reach) {
  const far = ({ d, loss = 0 }) => d + loss;
  return things.filter(({ d }) => d <= reach).sort((a, b) => far(a) - far(b))[0] ?? null;
}

export function nearestVertex(loops, point, reach) {
  const vertices = loops.flatMap((loop, i) =>
    loop.map((vertex, j) => ({ loop: i, index: j, d: distance(vertex, point) })),
  );
  return nearest(vertices, reach);
}

export function nearestEdge(loops, point, reach) {
  const edges = loops.flatMap((loop) =>
    loop.map((a, j) => {
      const b = loop[(j + 1) % loop.length];
      const along = [b[0] - a[0], b[1] - a[1]];
      const dot = (point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1];
      const t = Math.min(Math.max(dot / (distance(a, b) ** 2 || 1e-30), 0), 1);
      const foot = [a[0] + t * along[0], a[1] + t * along[1]];
      return { foot, d: distance(foot, point) };
    }),
  );
  return nearest(edges, reach);
}

// The index of the smallest hole around a point, -1 for none.
export function holeAt(holes, [x, y]) {
  const around = holes.filter((hole) => {
    tracePath(probe, [hole.loop]);
    return probe.isPointInPath(x, y);
  });
  return holes.indexOf(around.sort((a, b) => a.area - b.area)[0]);
}
