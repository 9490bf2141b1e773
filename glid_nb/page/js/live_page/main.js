// Opens the live page: unpacks its data, starts the solver, and measures how to draw.

import { CannotShow } from "../exported/renderer.js";
import { cornersOf, restored, unpacked } from "../exported/unpack.js";
import { Solving, startedWorker } from "../live/solving.js";
import { coefficientsOf, identityOf } from "../live/wire.js";
import { View } from "../pad/view.js";
import { Editing } from "./editing.js";
import { byId, byKind } from "./elements.js";
import { LivePage } from "./page.js";
import { poseOf } from "./pins.js";
import { fitted, roomOn } from "./room.js";
import { Stage } from "./stage.js";

/** @import { LiveData } from "./data.js" */

/**
 * What the first script of html/live_page.html has unpacked. The page adds its view, so that other
 * scripts and tests can tell where a point is on the screen, and what it edits (live_editor/main.js).
 * @typedef {{ data: LiveData, worker: string, view?: View, editing?: Editing }} Unpacked
 */
const unpackedPage = /** @type {Unpacked} */ (Reflect.get(globalThis, "glidPage"));
const { data, worker } = unpackedPage;

/** A worker that has the shape, at the map to begin with. */
async function startedSolver() {
  const solving = new Solving(startedWorker(worker));
  const { outline, options, start, poses } = data;
  await solving.ask({ type: "shape", outline, options });
  const coefficients = start.length ? Float64Array.from(start) : identityOf(outline);
  await solving.map({ type: "place", pose: poseOf(poses[0]), coefficients });
  return solving;
}

async function loadedMesh() {
  const source = await unpacked(data.source, 2);
  const heights = await unpacked(data.heights, 1);
  const triangles = await cornersOf(data.triangles);
  return { source, heights, triangles };
}

/** @returns {Promise<HTMLImageElement>} */
async function loadedPicture() {
  const picture = byKind("source", HTMLImageElement);
  await picture.decode().catch(() => {
    throw new CannotShow("The picture in this page is damaged.");
  });
  return picture;
}

/** @param {HTMLCanvasElement} canvas */
function contextOf(canvas) {
  const gl = canvas.getContext("webgl2", {
    antialias: true,
    premultipliedAlpha: true,
    preserveDrawingBuffer: true,
  });
  if (!gl) throw new CannotShow("This page needs WebGL 2 and a browser of 2023 or later.");
  return gl;
}

/**
 * The knots of the motion that came with the page.
 * @param {NonNullable<LiveData["motion"]>} motion
 */
async function unpackedReel({ coefficients, width, times, keyframes, repeat, sigma2 }) {
  const rows = await restored(coefficients, width);
  const holes = data.outline.hole_points.length;
  const knots = times.map((_, i) => ({
    coefficients: coefficientsOf(rows.subarray(i * width, (i + 1) * width), holes),
    sigma2: Math.min(sigma2[i - 1] ?? Infinity, sigma2[i] ?? Infinity),
  }));
  return { times, knots, keyframes, repeat };
}

async function open() {
  const canvas = byKind("picture", HTMLCanvasElement);
  const gl = contextOf(canvas);
  const [solving, mesh, picture] = await Promise.all([
    startedSolver(),
    loadedMesh(),
    loadedPicture(),
  ]);
  const view = new View(() => {}, { nearest: 1e-4, farthest: 1 });
  Object.assign(view, roomOn(byId("pad")).size);
  Object.assign(view, fitted(mesh.source, roomOn(byId("pad")), data.margin));
  const stage = new Stage(canvas, gl, data, mesh, picture);
  const frame = await stage.choose(solving, view);
  const editing = new Editing(solving, mesh, frame, identityOf(data.outline));
  const page = new LivePage(data, { stage, editing, view }, async () => {
    const second = await startedSolver();
    await second.map({ type: "points", points: stage.points });
    return second;
  });
  editing.begin(data.poses[0]);
  if (data.motion) await page.film.load(await unpackedReel(data.motion), data.poses);
  Object.assign(unpackedPage, { view, editing });
  const { dataset } = document.documentElement;
  dataset.mover = stage.mover;
  dataset.frame = stage.frameTime.toFixed(1);
  dataset.ready = "true";
}

open().catch((error) => {
  const problem = byId("problem");
  problem.textContent = error.message;
  problem.hidden = false;
  if (!(error instanceof CannotShow)) throw error; // for the console
});
