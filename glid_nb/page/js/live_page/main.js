// Opens the live page: unpacks its data, starts the solver, and measures how to draw.

import { identityOf } from "../live/wire.js";
import { Editing } from "./editing.js";
import { byKind } from "./elements.js";
import { TAKEN } from "./files.js";
import {
  contextOf,
  fail,
  loadedMesh,
  loadedPicture,
  startedSolver,
  tellReady,
  unpackedReel,
  viewOf,
} from "./opening.js";
import { LivePage } from "./page.js";
import { Stage } from "./stage.js";

/** @import { View } from "../pad/view.js" */
/** @import { LiveData } from "./data.js" */

/**
 * What the first script of html/live_page.html has unpacked. The page adds its view, so that other
 * scripts and tests can tell where a point is on the screen, and what it edits (live_editor/main.js).
 * @typedef {{ data: LiveData, worker: string, view?: View, editing?: Editing }} Unpacked
 */
const unpackedPage = /** @type {Unpacked} */ (Reflect.get(globalThis, "glidPage"));
const { data, worker } = unpackedPage;

async function open() {
  const canvas = byKind("picture", HTMLCanvasElement);
  const gl = contextOf(canvas);
  const [solving, mesh, picture] = await Promise.all([
    startedSolver(data, worker),
    loadedMesh(data),
    loadedPicture("source"),
  ]);
  const view = viewOf(mesh.source, data.margin);
  const stage = new Stage(canvas, gl, data, mesh, picture);
  const frame = await stage.choose(solving, view);
  const editing = new Editing(solving, mesh, frame, identityOf(data.outline));
  const page = new LivePage(data, { stage, editing, view, taken: TAKEN }, async () => {
    const second = await startedSolver(data, worker);
    await second.map({ type: "points", points: stage.points });
    return second;
  });
  editing.begin(data.poses[0]);
  if (data.motion) {
    const holes = data.outline.hole_points.length;
    await page.film.load(await unpackedReel(data.motion, holes), data.poses);
  }
  Object.assign(unpackedPage, { view, editing });
  tellReady(stage);
}

open().catch(fail);
