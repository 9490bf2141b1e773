// Figures with sliders: which frame is shown, and its words.

import assert from "node:assert/strict";
import { test } from "node:test";
import { frameAt, svgOf, wordsOf } from "../../glid_nb/page/js/frames/frames.js";

/** @import { Frames } from "../../glid_nb/page/js/frames/data.js" */

/** @type {Frames} */
const DATA = {
  controls: [
    { name: "t", values: ["0", "0.5", "1"], start: 0, check: false },
    { name: "psi", values: ["False", "True"], start: 1, check: true },
  ],
  lines: ["<svg>", "</svg>", "<a/>", "<b/>"],
  frames: [
    [0, 1],
    [0, 2, 1],
    [0, 3, 1],
    [0, 2, 3, 1],
    [0, 3, 2, 1],
    [0, 2, 2, 1],
  ],
  titles: ["", "a", "b", "a, b", "b, a", "a, a"],
};

test("each position of the controls has a frame of its own, and the last control changes first", () => {
  const found = [0, 1, 2].flatMap((t) => [0, 1].map((psi) => frameAt(DATA.controls, [t, psi])));
  assert.deepEqual(found, [0, 1, 2, 3, 4, 5]);
});

test("a frame has its own lines, in order", () => {
  assert.equal(svgOf(DATA, 3), "<svg>\n<a/>\n<b/>\n</svg>");
  assert.equal(svgOf(DATA, 4), "<svg>\n<b/>\n<a/>\n</svg>");
});

test("the words name all values, and the title if there is one", () => {
  assert.equal(wordsOf(DATA, [1, 1]), "t = 0.5, psi = True: a, b");
  assert.equal(wordsOf(DATA, [0, 0]), "t = 0, psi = False");
});
