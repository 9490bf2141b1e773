// Draws the stage: picture, cage, vertices, holes, strokes and the places of problems.

import { make } from "../pad/dom.js";
import { circle, disk, fillPath, strokePath, tracePath } from "../pad/pen.js";

const HALO = "rgba(255, 255, 255, 0.9)";
const SPECK = 12; // CSS pixels; dropped holes smaller than this show under the pointer only
const CHECK = 8; // CSS pixels per square of the checkerboard under transparent pictures

export function drawStage(ctx, scene) {
  const { view, colors } = scene;
  if (!scene.size) return;
  const corner = view.toScreen([0, 0]);
  const extent = scene.size.map((n) => n / view.unit);
  ctx.fillStyle = checks(ctx, colors);
  ctx.fillRect(...corner, ...extent);
  if (scene.bitmap) {
    ctx.imageSmoothingEnabled = 6 * view.unit > 1;
    ctx.imageSmoothingQuality = "high";
    ctx.drawImage(scene.bitmap, ...corner, ...extent);
  }
  const loops = scene.loops.map((loop) => view.line(loop));
  if (loops.length && scene.showVertices) {
    const [[left, top], [w, h]] = [corner, extent];
    const frame = [[left, top], [left + w, top], [left + w, top + h], [left, top + h]];
    fillPath(ctx, [...loops, frame], colors.veil); // what lies outside the cage fades
  }
  scene.holes.forEach((hole, i) => {
    const loop = view.line(hole.loop);
    const hovered = scene.hover?.hole === i;
    if (hovered) fillPath(ctx, [loop], hole.kept ? colors.warnSoft : colors.accentSoft);
    const visible = Math.sqrt(hole.area) > SPECK * view.unit;
    if (hovered || (!hole.kept && visible)) strokeLoops(ctx, [loop], colors.faint, 1.25, [4, 3]);
  });
  drawStrokes(ctx, scene);
  if (loops.length && !(scene.drawing && scene.doubt)) drawCage(ctx, scene, loops);
  drawOutline(ctx, scene);
  for (const problem of scene.problems) {
    if (problem.point) circle(ctx, view.toScreen(problem.point), 13, [[5, HALO], [2.25, colors.warn]]);
  }
}

function checks(ctx, { checkLight, checkDark }) {
  const tile = make("canvas", { width: 2 * CHECK, height: 2 * CHECK });
  const pen = tile.getContext("2d");
  pen.fillStyle = checkLight;
  pen.fillRect(0, 0, tile.width, tile.height);
  pen.fillStyle = checkDark;
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

function drawStrokes(ctx, scene) {
  if (!scene.showStrokes) return;
  const { view, strokes } = scene;
  const pairs = ["background", "foreground"].map((brush) => [strokes[brush], scene.colors[brush]]);
  if (scene.stroke) pairs.push([[scene.stroke.points], scene.colors[scene.stroke.brush]]);
  ctx.lineCap = ctx.lineJoin = "round";
  for (const [lines, color] of pairs) {
    for (const line of lines) {
      tracePath(ctx, [view.line([...line, line.at(-1)])], false); // a dot too
      strokePath(ctx, [[8, HALO], [5, color]]);
    }
  }
}

function drawOutline(ctx, { outline, corners, colors, view }) {
  tracePath(ctx, [view.line(outline)], false);
  strokePath(ctx, [[4.5, HALO], [2, colors.foreground]]);
  for (const corner of corners) disk(ctx, view.toScreen(corner), 4, "white", colors.foreground, 2);
}

function drawCage(ctx, scene, loops) {
  const { colors, hover, selected } = scene;
  const color = scene.problems.length ? colors.warn : colors.accent;
  strokeLoops(ctx, loops, color, 1.75);
  if (!scene.showVertices) return;
  const radius = vertexRadius(loops);
  loops.forEach((loop, i) =>
    loop.forEach((vertex, j) => {
      const chosen = selected.has(`${i}:${j}`);
      const hovered = hover?.vertex?.loop === i && hover.vertex.index === j;
      const r = hovered || chosen ? radius + 1.75 : radius;
      disk(ctx, vertex, r + 1, HALO);
      disk(ctx, vertex, r, chosen || hovered ? color : "white", color, 1.5);
    }),
  );
  if (hover?.edge) drawPlus(ctx, scene.view.toScreen(hover.edge.foot), color);
}

// Smaller where vertices are close together.
function vertexRadius(loops) {
  const edges = loops.flatMap((loop) => loop.map((a, i) => [a, loop[(i + 1) % loop.length]]));
  const total = edges.reduce((sum, [[x, y], [u, v]]) => sum + Math.hypot(u - x, v - y), 0);
  return Math.min(4, Math.max(1.75, (total / Math.max(edges.length, 1)) * 0.16));
}

function drawPlus(ctx, [x, y], color) {
  disk(ctx, [x, y], 7, "white", color, 1.5);
  tracePath(ctx, [[[x - 3.5, y], [x + 3.5, y]], [[x, y - 3.5], [x, y + 3.5]]], false);
  ctx.stroke();
}
