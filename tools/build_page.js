// Bundles the modules and style sheets of glid_nb/page/js into glid_nb/page/built.
//
// The same sources give the same bytes: `tests/page/built.test.js` builds again and compares.

import { writeFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const ROOT = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
export const BUILT = path.join(ROOT, "glid_nb", "page", "built");

// The widgets are modules, imported by anywidget. The exported page and a worker contain plain scripts.
const WIDGETS = {
  canvas: "canvas/main.js",
  clipboard: "clipboard/main.js",
  live_editor: "live_editor/main.js",
  loader: "pad/loader.js",
  timeline: "timeline/main.js",
  toolbar: "toolbar/main.js",
  tracer: "tracer/main.js",
};
const SCRIPTS = { exported: "exported/main.js" };
// The live page and its worker are minified, because the page has to stay below 60 kB. So is what
// every figure with sliders contains.
const SMALL = { frames: "frames/main.js", live: "live/main.js", live_page: "live_page/main.js" };
const SMALL_STYLES = { frames: "frames/frames.css", live_page: "live_page/live_page.css" };
const STYLES = {
  canvas: "canvas/canvas.css",
  exported: "exported/exported.css",
  timeline: "timeline/timeline.css",
  toolbar: "toolbar/toolbar.css",
  tracer: "tracer/tracer.css",
};

/**
 * The contents of the bundles, by their file names.
 * @returns {Promise<Map<string, Uint8Array>>}
 */
export async function bundles() {
  /** @type {import("esbuild").BuildOptions} */
  const shared = {
    absWorkingDir: path.join(ROOT, "glid_nb", "page", "js"),
    outdir: BUILT,
    bundle: true,
    write: false,
    charset: "utf8",
    // Every widget's model and every exported page contains its script, so keep it small.
    minifyWhitespace: true,
    lineLimit: 100,
    target: "es2022",
    logLevel: "warning",
  };
  const built = await Promise.all([
    build({ ...shared, entryPoints: WIDGETS, format: "esm" }),
    build({ ...shared, entryPoints: SCRIPTS, format: "iife" }),
    build({ ...shared, entryPoints: SMALL, format: "iife", minify: true }),
    build({ ...shared, entryPoints: SMALL_STYLES, minify: true }),
    build({ ...shared, entryPoints: STYLES }),
  ]);
  const files = built.flatMap(({ outputFiles }) => outputFiles ?? []);
  return new Map(files.map((file) => [path.basename(file.path), file.contents]));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  for (const [name, contents] of await bundles()) {
    await writeFile(path.join(BUILT, name), contents);
  }
}
