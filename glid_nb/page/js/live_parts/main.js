// Opens the live page of several shapes. They share a canvas, pins, undo and a timeline; each has a
// solver of its own, whose certificates are joined.

import { identityOf } from "../live/wire.js";
import { byKind } from "../live_page/elements.js";
import {
  contextOf,
  fail,
  loadedMesh,
  loadedPicture,
  startedSolver,
  tellReady,
  unpackedReel,
  viewOf,
} from "../live_page/opening.js";
import { LivePage } from "../live_page/page.js";
import { chained } from "./joint_map.js";
import { JointSolving } from "./joint_solving.js";
import { PartsEditing, seenIn } from "./parts_editing.js";
import { takenOf } from "./parts_files.js";
import { PartsStage } from "./parts_stage.js";
import { jointReel } from "./reel.js";

/** @import { View } from "../pad/view.js" */
/** @import { LiveData, Pin } from "../live_page/data.js" */
/** @import { PartsData } from "./data.js" */

/**
 * What the first script of html/live_page.html has unpacked, and what this one adds.
 * @typedef {{ data: PartsData, worker: string, view?: View, editing?: PartsEditing }} Unpacked
 */
const unpackedPage = /** @type {Unpacked} */ (Reflect.get(globalThis, "glidPage"));
const { data, worker } = unpackedPage;

/** @type {LiveData[]} */
const parts = data.parts.map((part) => ({ ...data, ...part }));
const rests = parts.map(({ outline }) => identityOf(outline));

function startedSolvers() {
  return Promise.all(parts.map((part) => startedSolver(part, worker)));
}

/** Solvers for the motion, so that the edited pose stays where it is. */
async function secondSolving(/** @type {PartsStage} */ { points }) {
  const solvers = await startedSolvers();
  const maps = solvers.map((one, i) => one.map({ type: "points", points: points[i] }));
  return new JointSolving(solvers, rests, await Promise.all(maps));
}

/**
 * The pins of all parts at each keyframe, with the part's number in their handles.
 * @returns {Pin[][]}
 */
function jointPoses() {
  return parts[0].poses.map((_, keyframe) =>
    parts.flatMap(({ poses }, part) =>
      poses[keyframe].map((pin) => ({ ...pin, handle: [pin.handle[0], pin.handle[1], part] })),
    ),
  );
}

async function loadedReel() {
  const reels = parts.map(async ({ motion, outline }) => {
    if (!motion) throw new Error("one of the shapes has no motion");
    return unpackedReel(motion, outline.hole_points.length);
  });
  return jointReel(await Promise.all(reels));
}

async function open() {
  const canvas = byKind("picture", HTMLCanvasElement);
  const gl = contextOf(canvas);
  const [solvers, meshes, pictures] = await Promise.all([
    startedSolvers(),
    Promise.all(parts.map(loadedMesh)),
    Promise.all(parts.map((_, i) => loadedPicture(`source${i}`))),
  ]);
  const view = viewOf(chained(meshes.map(({ source }) => source)), data.margin);
  const stage = new PartsStage(canvas, gl, parts, meshes, pictures);
  const solving = new JointSolving(solvers, rests, await stage.choose(solvers, view));
  const shapes = meshes.map((mesh, i) => ({ mesh, isSeen: seenIn(pictures[i], data.frame) }));
  const editing = new PartsEditing(solving, shapes, solving.newest, chained(rests));
  const poses = jointPoses();
  const told = { stage, editing, view, taken: takenOf(data) };
  const page = new LivePage({ ...parts[0], poses }, told, () => secondSolving(stage));
  editing.begin(poses[0]);
  if (parts[0].motion) await page.film.load(await loadedReel(), poses);
  Object.assign(unpackedPage, { view, editing });
  tellReady(stage);
}

open().catch(fail);
