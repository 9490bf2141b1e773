// Opens the live page of one shape: unpacks its data, starts the solver, and measures how to draw.

import { identityOf } from "../live/wire.js";
import { Editing } from "./editing.js";
import { TAKEN } from "./files.js";
import { loadedMesh, loadedPicture, startedSolver, unpackedReel, viewOf } from "./opening.js";
import { openPage } from "./page_opener.js";
import { Stage } from "./stage.js";

/** @import { LiveData } from "./data.js" */
/** @import { Unpacked } from "./page_opener.js" */

openPage(async (/** @type {Unpacked<LiveData>} */ { data, worker }, canvas, gl) => {
  const [solving, mesh, picture] = await Promise.all([
    startedSolver(data, worker),
    loadedMesh(data),
    loadedPicture("source"),
  ]);
  const view = viewOf(mesh.source, data.margin);
  const stage = new Stage(canvas, gl, data, mesh, picture);
  const frame = await stage.choose(solving, view);
  const editing = new Editing(solving, mesh, frame, identityOf(data.outline));
  const startSecond = async () => {
    const second = await startedSolver(data, worker);
    await second.map({ type: "points", points: stage.points });
    return second;
  };
  const holes = data.outline.hole_points.length;
  const reel = data.motion && unpackedReel(data.motion, holes);
  return [data, { stage, editing, view, taken: TAKEN }, startSecond, reel];
});
