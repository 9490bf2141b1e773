// Draws the stage: picture, cage, vertices, holes, strokes and the places of problems.

import { make, penOf } from "../pad/dom.js";
import { circle, disk, fillPath, rectangle, strokePath, tracePath } from "../pad/pen.js";

/** @import { Found, Point } from "../types.js" */
/** @import { Pen } from "../pad/pen.js" */
/** @import { Stage } from "./stage.js" */
/** @import { Shown } from "./traits.js" */

/**
 * What is drawn, with the cage's loops on the screen.
 *
 * @typedef {{ shown: Shown, colors: Record<string, string>, loops: Point[][] }} Scene
 */

const HALO = "rgba(255, 255, 255, 0.9)";
const SPECK = 12; // CSS pixels; dropped holes smaller than this show under the pointer only
const CHECK = 8; // CSS pixels per square of the checkerboard under transparent pictures

/**
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Scene} scene
 * @param {Found | null} hover
 */
export function drawStage(pen, stage, scene, hover) {
  const { shown, colors, loops } = scene;
  const { view } = stage;
  const [width, height] = shown.size ?? [0, 0];
  const corner = view.toScreen([0, 0]);
  drawPicture(pen, stage, colors, corner, [width / view.unit, height / view.unit]);
  if (loops.length && !stage.painting) {
    const frame = rectangle(corner, view.toScreen([width, height]));
    fillPath(pen, [...loops, frame], colors.veil); // what lies outside the cage fades
  }
  drawHoles(pen, stage, scene, hover);
  if (stage.brushing || shown.options.method === "scribbles") drawStrokes(pen, stage, scene);
  if (loops.length) drawCage(pen, stage, scene, hover);
  if (stage.drawing || shown.inside.length) drawOutline(pen, stage, scene);
  if (stage.cutting) drawKnife(pen, stage, scene);
  for (const { point } of shown.problems) {
    if (!point) continue;
    circle(pen, view.toScreen(point), 13, [
      [5, HALO],
      [2.25, colors.warn],
    ]);
  }
}

/**
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Record<string, string>} colors
 * @param {Point} corner the upper left one, on the screen
 * @param {Point} extent
 */
function drawPicture(pen, { bitmap, view }, colors, corner, extent) {
  pen.fillStyle = checks(pen, colors);
  pen.fillRect(...corner, ...extent);
  if (!bitmap) return;
  pen.imageSmoothingEnabled = 6 * view.unit > 1;
  pen.imageSmoothingQuality = "high";
  pen.drawImage(bitmap, ...corner, ...extent);
}

/**
 * @param {Pen} pen
 * @param {Record<string, string>} colors
 */
function checks(pen, colors) {
  const tile = make("canvas", { width: 2 * CHECK, height: 2 * CHECK });
  const ink = penOf(tile);
  ink.fillStyle = colors["check-light"];
  ink.fillRect(0, 0, tile.width, tile.height);
  ink.fillStyle = colors["check-dark"];
  for (const at of [0, CHECK]) ink.fillRect(at, at, CHECK, CHECK);
  return pen.createPattern(tile, "repeat") ?? colors["check-light"];
}

/**
 * Strokes loops over wider pale lines, which are seen on dark pictures.
 *
 * @param {Pen} pen
 * @param {Point[][]} loops
 * @param {string} style
 * @param {number} width
 * @param {number[]} [dash]
 */
function strokeLoops(pen, loops, style, width, dash) {
  pen.lineJoin = "round";
  tracePath(pen, loops);
  strokePath(pen, [[width + 2.25, HALO]]);
  strokePath(pen, [[width, style]], dash);
}

/**
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Scene} scene
 * @param {Found | null} hover
 */
function drawHoles(pen, { view }, { shown, colors }, hover) {
  shown.holes.forEach((hole, i) => {
    const loop = view.line(hole.loop);
    const hovered = hover?.hole === i;
    if (hovered) fillPath(pen, [loop], colors[hole.kept ? "warn-soft" : "accent-soft"]);
    const visible = Math.sqrt(hole.area) > SPECK * view.unit;
    if (hovered || (!hole.kept && visible)) strokeLoops(pen, [loop], colors.faint, 1.25, [4, 3]);
  });
}

/**
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Scene} scene
 */
function drawStrokes(pen, { view, brushing, tool, pad: { path } }, { shown, colors }) {
  /** @type {[lines: Point[][], color: string][]} */
  const painted = [
    [shown.strokes.background, colors.background],
    [shown.strokes.foreground, colors.foreground],
  ];
  if (brushing && path.length) painted.push([[path], colors[tool]]);
  pen.lineCap = "round";
  pen.lineJoin = "round";
  for (const [lines, color] of painted) {
    for (const line of lines) {
      tracePath(pen, [view.line([...line, line[line.length - 1]])], false); // a dot too
      strokePath(pen, [
        [8, HALO],
        [5, color],
      ]);
    }
  }
}

/**
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Scene} scene
 */
function drawOutline(pen, stage, { shown, colors }) {
  const { view } = stage;
  const color = colors.foreground;
  tracePath(pen, [view.line(stage.drawn())], false);
  strokePath(pen, [
    [4.5, HALO],
    [2, color],
  ]);
  for (const corner of shown.corners) disk(pen, view.toScreen(corner), 4, "white", color, 2);
}

/**
 * The line of a cut, as far as it goes.
 *
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Scene} scene
 */
function drawKnife(pen, { view, pad: { path } }, { colors }) {
  if (!path.length) return;
  pen.lineCap = "butt";
  pen.lineJoin = "round";
  tracePath(pen, [view.line(path)], false);
  strokePath(pen, [[5, HALO]]);
  strokePath(pen, [[2.25, colors.warn]], [7, 4]);
}

/**
 * @param {Pen} pen
 * @param {Stage} stage
 * @param {Scene} scene
 * @param {Found | null} hover
 */
function drawCage(pen, { view, painting }, { shown, colors, loops }, hover) {
  const color = shown.problems.length ? colors.warn : colors.accent;
  strokeLoops(pen, loops, color, 1.75);
  if (painting) return;
  const radius = vertexRadius(loops);
  const strong = new Set([hover?.mark, ...shown.selected.map((vertex) => vertex.join(":"))]);
  loops.forEach((loop, i) => {
    loop.forEach((vertex, j) => {
      const seen = strong.has(`${i}:${j}`);
      const r = seen ? radius + 1.75 : radius;
      disk(pen, vertex, r + 1, HALO);
      disk(pen, vertex, r, seen ? color : "white", color, 1.5);
    });
  });
  if (hover?.edge) drawPlus(pen, view.toScreen(hover.edge.foot), color);
}

/**
 * Smaller where vertices are close together.
 *
 * @param {Point[][]} loops
 */
export function vertexRadius(loops) {
  let total = 0;
  let count = 0;
  for (const loop of loops) {
    loop.forEach(([x, y], i) => {
      const [u, v] = loop[(i + 1) % loop.length];
      total += Math.hypot(u - x, v - y);
    });
    count += loop.length;
  }
  return Math.min(4, Math.max(1.75, (total / Math.max(count, 1)) * 0.16));
}

/**
 * @param {Pen} pen
 * @param {Point} place
 * @param {string} color
 */
function drawPlus(pen, [x, y], color) {
  disk(pen, [x, y], 7, "white", color, 1.5);
  /** @type {Point[]} */
  const across = [
    [x - 3.5, y],
    [x + 3.5, y],
  ];
  /** @type {Point[]} */
  const upright = [
    [x, y - 3.5],
    [x, y + 3.5],
  ];
  tracePath(pen, [across, upright], false);
  pen.stroke();
}
