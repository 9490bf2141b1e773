// What is needed before a live page can be shown: its solvers, meshes, pictures and motions.

import { CannotShow } from "../exported/renderer.js";
import { cornersOf, restored, unpacked } from "../exported/unpack.js";
import { Solving, startedWorker } from "../live/solving.js";
import { coefficientsOf, identityOf } from "../live/wire.js";
import { View } from "../pad/view.js";
import { byId, byKind } from "./elements.js";
import { poseOf } from "./pins.js";
import { fitted, roomOn } from "./room.js";

/** @import { LiveData } from "./data.js" */

/**
 * A worker that has the shape, at the map to begin with.
 * @param {LiveData} data
 * @param {string} worker its script
 */
export async function startedSolver({ outline, options, start, poses }, worker) {
  const solving = new Solving(startedWorker(worker));
  await solving.ask({ type: "shape", outline, options });
  const coefficients = start.length ? Float64Array.from(start) : identityOf(outline);
  await solving.map({ type: "place", pose: poseOf(poses[0]), coefficients });
  return solving;
}

/** @param {LiveData} data */
export async function loadedMesh(data) {
  const source = await unpacked(data.source, 2);
  const heights = await unpacked(data.heights, 1);
  const triangles = await cornersOf(data.triangles);
  return { source, heights, triangles };
}

/**
 * @param {string} id
 * @returns {Promise<HTMLImageElement>}
 */
export async function loadedPicture(id) {
  const picture = byKind(id, HTMLImageElement);
  await picture.decode().catch(() => {
    throw new CannotShow("The picture in this page is damaged.");
  });
  return picture;
}

/**
 * The view in which points fill the page.
 * @param {ArrayLike<number>} points x and y in turn
 * @param {number} margin
 */
export function viewOf(points, margin) {
  const view = new View(() => {}, { nearest: 1e-4, farthest: 1 });
  const room = roomOn(byId("pad"));
  return Object.assign(view, room.size, fitted(points, room, margin));
}

/**
 * The knots of the motion that came with a shape.
 * @param {NonNullable<LiveData["motion"]>} motion
 * @param {number} holes of the shape
 */
export async function unpackedReel(
  { coefficients, width, times, keyframes, repeat, sigma2 },
  holes,
) {
  const rows = await restored(coefficients, width);
  const knots = times.map((_, i) => ({
    coefficients: coefficientsOf(rows.subarray(i * width, (i + 1) * width), holes),
    sigma2: Math.min(sigma2[i - 1] ?? Infinity, sigma2[i] ?? Infinity),
  }));
  return { times, knots, keyframes, repeat };
}
