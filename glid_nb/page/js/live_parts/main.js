// Opens the live page of several shapes. They share a canvas, pins, undo and a timeline; each has a
// solver of its own, whose certificates are joined.

import { identityOf } from "../live/wire.js";
import {
  loadedMesh,
  loadedPicture,
  startedSolver,
  unpackedReel,
  viewOf,
} from "../live_page/opening.js";
import { openPage } from "../live_page/page_opener.js";
import { chained } from "./joint_map.js";
import { JointSolving } from "./joint_solving.js";
import { PartsEditing, seenIn } from "./parts_editing.js";
import { takenOf } from "./parts_files.js";
import { PartsStage } from "./parts_stage.js";
import { jointReel } from "./reel.js";

/** @import { LiveData, Pin } from "../live_page/data.js" */
/** @import { Unpacked } from "../live_page/page_opener.js" */
/** @import { PartsData } from "./data.js" */

/**
 * The pins of all parts at each keyframe, with the part's number in their handles.
 * @param {LiveData[]} parts
 * @returns {Pin[][]}
 */
function jointPoses(parts) {
  return parts[0].poses.map((_, keyframe) =>
    parts.flatMap(({ poses }, part) =>
      poses[keyframe].map((pin) => ({ ...pin, handle: [pin.handle[0], pin.handle[1], part] })),
    ),
  );
}

/** @param {LiveData[]} parts */
async function loadedReel(parts) {
  const reels = parts.map(async ({ motion, outline }) => {
    if (!motion) throw new Error("one of the shapes has no motion");
    return unpackedReel(motion, outline.hole_points.length);
  });
  return jointReel(await Promise.all(reels));
}

openPage(async (/** @type {Unpacked<PartsData>} */ { data, worker }, canvas, gl) => {
  /** @type {LiveData[]} */
  const parts = data.parts.map((part) => ({ ...data, ...part }));
  const rests = parts.map(({ outline }) => identityOf(outline));
  const startAll = () => Promise.all(parts.map((part) => startedSolver(part, worker)));
  const [solvers, meshes, pictures] = await Promise.all([
    startAll(),
    Promise.all(parts.map(loadedMesh)),
    Promise.all(parts.map((_, i) => loadedPicture(`source${i}`))),
  ]);
  const view = viewOf(chained(meshes.map(({ source }) => source)), data.margin);
  const stage = new PartsStage(canvas, gl, parts, meshes, pictures);
  const solving = new JointSolving(solvers, rests, await stage.choose(solvers, view));
  const shapes = meshes.map((mesh, i) => ({ mesh, isSeen: seenIn(pictures[i], data.frame) }));
  const editing = new PartsEditing(solving, shapes, solving.newest, chained(rests));
  const startSecond = async () => {
    const second = await startAll();
    const maps = second.map((one, i) => one.map({ type: "points", points: stage.points[i] }));
    return new JointSolving(second, rests, await Promise.all(maps));
  };
  const shown = { ...parts[0], poses: jointPoses(parts) };
  const reel = shown.motion && loadedReel(parts);
  return [shown, { stage, editing, view, taken: takenOf(data) }, startSecond, reel];
});
