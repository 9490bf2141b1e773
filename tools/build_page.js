// Bundles the modules and style sheets of glid_nb/page/js into glid_nb/page/built.
//
// The same sources give the same bytes: `tests/page/built.test.js` builds again and compares.

import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import wabt from "wabt";

const ROOT = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const LIVE = path.join(ROOT, "glid_nb", "page", "js", "live");
export const BUILT = path.join(ROOT, "glid_nb", "page", "built");

// The widgets are modules, imported by anywidget. The exported page and a worker contain plain scripts.
const WIDGETS = {
  canvas: "canvas/main.js",
  clipboard: "clipboard/main.js",
  live_editor: "live_editor/main.js",
  loader: "pad/loader.js",
  rows: "rows/main.js",
  timeline: "timeline/main.js",
  toolbar: "toolbar/main.js",
  tracer: "tracer/main.js",
};
const SCRIPTS = { exported: "exported/main.js" };
// The live page and its worker are minified, because the page has to stay below 60 kB. So are the page
// of several shapes, and what every figure with sliders contains.
const FRAMES = { frames: "frames/main.js" };
const FRAMES_STYLES = { frames: "frames/frames.css" };
const SMALL = {
  live: "live/main.js",
  live_page: "live_page/main.js",
  live_parts: "live_parts/main.js",
};
const SMALL_STYLES = { live_page: "live_page/live_page.css" };
const STYLES = {
  canvas: "canvas/canvas.css",
  exported: "exported/exported.css",
  rows: "rows/rows.css",
  timeline: "timeline/timeline.css",
  toolbar: "toolbar/toolbar.css",
  tracer: "tracer/tracer.css",
};

/** The module that holds the bytes of the WebAssembly of live/kernel.wat. */
export const KERNEL = path.join(LIVE, "kernel_code.js");

/** The text of this module. */
export async function kernelCode() {
  const { parseWat } = await wabt();
  const text = await readFile(path.join(LIVE, "kernel.wat"), "utf-8");
  const { buffer } = parseWat("kernel.wat", text, { simd: true }).toBinary({});
  // Hexadecimal digits are shorter than base64 once they are deflated.
  const digits = Buffer.from(buffer).toString("hex");
  return `// Assembled from kernel.wat by tools/build_page.js.\n\nexport const CODE =\n  "${digits}";\n`;
}

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
    target: "es2022",
    logLevel: "warning",
  };
  const lines = { lineLimit: 100 }; // not in the live page, because they cost 2 kB there
  const built = await Promise.all([
    build({ ...shared, ...lines, entryPoints: WIDGETS, format: "esm" }),
    build({ ...shared, ...lines, entryPoints: SCRIPTS, format: "iife" }),
    build({ ...shared, ...lines, entryPoints: FRAMES, format: "iife", minify: true }),
    build({ ...shared, ...lines, entryPoints: FRAMES_STYLES, minify: true }),
    build({ ...shared, entryPoints: SMALL, format: "iife", minify: true }),
    build({ ...shared, entryPoints: SMALL_STYLES, minify: true }),
    build({ ...shared, ...lines, entryPoints: STYLES }),
  ]);
  const files = built.flatMap(({ outputFiles }) => outputFiles ?? []);
  return new Map(files.map((file) => [path.basename(file.path), file.contents]));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  await writeFile(KERNEL, await kernelCode());
  for (const [name, contents] of await bundles()) {
    await writeFile(path.join(BUILT, name), contents);
  }
}
