// Draws the stage: picture, cage, vertices, holes, strokes and the places of problems.

import { make } from "../pad/dom.js";
import { circle, disk, fillPath, rectangle, strokePath, tracePath } from "../pad/pen.js";

const HALO = "rgba(255, 255, 255, 0.9)";
const SPECK = 12; // CSS pixels; dropped holes smaller than this show under the pointer only
const CHECK = 8; // CSS pixels per square of the checkerboard under transparent pictures

export function drawStage(ctx, stage, hover) {
  const { view, colors, shown, bitmap, painting } = stage;
  const corner = view.toScreen([0, 0]);
  const extent = shown.size.map((n) => n / view.unit);
  ctx.fillStyle = checks(ctx, colors);
  ctx.fillRect(...corner, ...extent);
  if (bitmap) {
    ctx.imageSmoothingEnabled = 6 * view.unit > 1;
    ctx.imageSmoothingQuality = "high";
    ctx.drawImage(bitmap, ...corner, ...extent);
  }
  const loops = stage.loops.map((loop) => view.line(loop));
  if (loops.length && !painting) {
    // what lies outside the cage fades
    fillPath(ctx, [...loops, rectangle(corner, view.toScreen(shown.size))], colors.veil);
  }
  shown.holes.forEach((hole, i) => {
    const loop = view.line(hole.loop);
    const hovered = hover?.hole === i;
    if (hovered) fillPath(ctx, [loop], colors[hole.kept ? "warn-soft" : "accent-soft"]);
    const visible = Math.sqrt(hole.area) > SPECK * view.unit;
    if (hovered || (!hole.kept && visible)) strokeLoops(ctx, [loop], colors.faint, 1.25, [4, 3]);
  });
  if (stage.brushing || shown.options.method === "scribbles") drawStrokes(ctx, stage);
  if (loops.length && !(stage.drawing && shown.doubt)) drawCage(ctx, stage, loops, hover);
  if (stage.drawing) drawOutline(ctx, stage);
  for (const problem of shown.problems) {
    if (problem.point)
      circle(ctx, view.toScreen(problem.point), 13, [
        [5, HALO],
        [2.25, colors.warn],
      ]);
  }
}

function checks(ctx, colors) {
  const tile = make("canvas", { width: 2 * CHECK, height: 2 * CHECK });
  const pen = tile.getContext("2d");
  pen.fillStyle = colors["check-light"];
  pen.fillRect(0, 0, tile.width, tile.height);
  pen.fillStyle = colors["check-dark"];
  for (const at of [0, CHECK]) pen.fillRect(at, at, CHECK, CHECK);
  return ctx.createPattern(tile, "repeat");
}

// Strokes loops over wider pale lines, which are seen on dark pictures.
function strokeLoops(ctx, loops, style, width, dash = []) {
  ctx.lineJoin = "round";
  tracePath(ctx, loops);
  strokePath(ctx, [[width + 2.25, HALO]]);
  strokePath(ctx, [[width, style]], dash);
}

function drawStrokes(ctx, { view, colors, shown, brushing, tool, pad: { path } }) {
  const pairs = ["background", "foreground"].map((brush) => [shown.strokes[brush], colors[brush]]);
  if (brushing && path.length) pairs.push([[path], colors[tool]]);
  ctx.lineCap = ctx.lineJoin = "round";
  for (const [lines, color] of pairs) {
    for (const line of lines) {
      tracePath(ctx, [view.line([...line, line.at(-1)])], false); // a dot too
      strokePath(ctx, [
        [8, HALO],
        [5, color],
      ]);
    }
  }
}

function drawOutline(ctx, stage) {
  const { view, shown } = stage;
  const color = stage.colors.foreground;
  tracePath(ctx, [view.line(stage.drawn())], false);
  strokePath(ctx, [
    [4.5, HALO],
    [2, color],
  ]);
  for (const corner of shown.corners) disk(ctx, view.toScreen(corner), 4, "white", color, 2);
}

function drawCage(ctx, { view, colors, shown, painting }, loops, hover) {
  const color = shown.problems.length ? colors.warn : colors.accent;
  strokeLoops(ctx, loops, color, 1.75);
  if (painting) return;
  const radius = vertexRadius(loops);
  const strong = new Set([hover?.mark, ...shown.selected.map((vertex) => vertex.join(":"))]);
  loops.forEach((loop, i) =>
    loop.forEach((vertex, j) => {
      const seen = strong.has(`${i}:${j}`);
      const r = seen ? radius + 1.75 : radius;
      disk(ctx, vertex, r + 1, HALO);
      disk(ctx, vertex, r, seen ? color : "white", color, 1.5);
    }),
  );
  if (hover?.edge) drawPlus(ctx, view.toScreen(hover.edge.foot), color);
}

// Smaller where vertices are close together.
function vertexRadius(loops) {
  const edges = loops.flatMap((loop) => loop.map((a, i) => [a, loop[(i + 1) % loop.length]]));
  const total = edges.reduce((sum, [[x, y], [u, v]]) => sum + Math.hypot(u - x, v - y), 0);
  return Math.min(4, Math.max(1.75, (total / Math.max(edges.length, 1)) * 0.16));
}

function drawPlus(ctx, [x, y], color) {
  disk(ctx, [x, y], 7, "white", color, 1.5);
  tracePath(
    ctx,
    [
      [
        [x - 3.5, y],
        [x + 3.5, y],
      ],
      [
        [x, y - 3.5],
        [x, y + 3.5],
      ],
    ],
    false,
  );
  ctx.stroke();
}
