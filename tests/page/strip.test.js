// The strip that shows what is proved along a motion.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Motion } from "../../glid_nb/page/js/motion/motion.js";
import { heightOf, proofStrip } from "../../glid_nb/page/js/motion/strip.js";

const motion = new Motion({ times: [0, 1, 2], repeat: "once" }, new Float32Array(3));

/** @param {string} name of a style sheet @param {string} variable */
function colorIn(name, variable) {
  const text = readFileSync(new URL(`../../glid_nb/page/js/${name}`, import.meta.url), "utf8");
  return text.match(new RegExp(`${variable}: (light-dark\\([^)]*\\))`))?.[1];
}

test("what is proved has one colour, and the height of its bound", () => {
  const layers = proofStrip(motion, (time) => (time < 1 ? 0.25 : -1)).split(",linear");
  assert.equal(layers.length, 100);
  for (const layer of layers.slice(0, 50))
    assert.match(layer, /\(var\(--accent\) 0 0\).* 25% no-repeat/);
  for (const layer of layers.slice(50)) assert.match(layer, /#7f7f7f.* 100% no-repeat/);
});

test("the least bound is still seen, and one above 1 fills the strip", () => {
  assert.ok(heightOf(0) > 0);
  assert.equal(heightOf(0.5), 0.5);
  assert.equal(heightOf(3), 1);
});

test("the editor and the exported page show it in the same colour", () => {
  const accent = colorIn("pad/pad.css", "--glid-accent");
  assert.ok(accent);
  assert.equal(colorIn("exported/exported.css", "--accent"), accent);
});
