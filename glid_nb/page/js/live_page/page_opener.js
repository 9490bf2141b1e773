// Opens a live page, of one shape or of several, or tells its reader why it does not open.

import { CannotShow } from "../exported/renderer.js";
import { byId, byKind } from "./elements.js";
import { LivePage } from "./page.js";

/** @import { Solver } from "../live/solving_types.js" */
/** @import { Reel } from "./film.js" */
/** @import { Parts, Shown } from "./page.js" */

/** How a stage draws, and ms of a frame. @typedef {{ mover: string, frameTime: number }} Drawn */

/**
 * What the first script of html/live_page.html has unpacked. The page adds its view, so that other
 * scripts and tests can tell where a point is on the screen, and what it edits (live_editor/main.js).
 * @template [Data=any]
 * @typedef {{ data: Data, worker: string }} Unpacked
 */

/**
 * What a page shows, its parts, what starts a solver for its motion, and the motion that comes with it.
 * @typedef {[
 *   shown: Shown,
 *   parts: Parts & { stage: Drawn },
 *   startSecond: () => Promise<Solver>,
 *   reel: Promise<Reel> | null,
 * ]} Made
 */

/** @typedef {(page: Unpacked, canvas: HTMLCanvasElement, gl: WebGL2RenderingContext) => Promise<Made>} Make */

/** @param {Make} make */
export async function openPage(make) {
  try {
    await opened(make);
  } catch (error) {
    const problem = byId("problem");
    problem.textContent = /** @type {Error} */ (error).message;
    problem.hidden = false;
    if (!(error instanceof CannotShow)) throw error; // for the console
  }
}

/** @param {Make} make */
async function opened(make) {
  const unpacked = Reflect.get(globalThis, "glidPage");
  const canvas = byKind("picture", HTMLCanvasElement);
  const gl = canvas.getContext("webgl2", { preserveDrawingBuffer: true });
  if (!gl) throw new CannotShow("This page needs WebGL 2 and a browser of 2023 or later.");
  const [shown, parts, startSecond, reel] = await make(unpacked, canvas, gl);
  const { stage, editing, view } = parts;
  const page = new LivePage(shown, parts, startSecond);
  editing.begin(shown.poses[0]);
  if (reel) await page.film.load(await reel, shown.poses);
  Object.assign(unpacked, { view, editing });
  const { mover, frameTime } = stage; // for other scripts
  Object.assign(document.documentElement.dataset, {
    mover,
    frame: frameTime.toFixed(1),
    ready: true,
  });
}
