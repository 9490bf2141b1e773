// Figures with sliders: which frame is shown, and its words.

import assert from "node:assert/strict";
import { test } from "node:test";
import { dragged, frameAt, svgOf, wordsOf } from "../../glid_nb/page/js/frames/frames.js";

/** @import { Control, Frames } from "../../glid_nb/page/js/frames/data.js" */

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
  parts: [],
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

/** @type {(name: string, count: number, check?: boolean) => Control} */
const slider = (name, count, check = false) => {
  return { name, values: Array.from({ length: count }, (_, i) => `${i}`), start: 0, check };
};

test("a dragged point goes to the nearest place of a grid, and leaves the check box alone", () => {
  const controls = [slider("x", 5), slider("y", 4), slider("psi", 2, true)];
  /** @type {[number, number][]} */
  const points = [];
  for (let x = 0; x < 5; x++)
    for (let y = 0; y < 4; y++) points.push([10 * x, 10 * y], [10 * x, 10 * y]);
  assert.deepEqual(dragged(controls, points, [0, 0, 1], [33, 18]), [3, 2, 1]);
  assert.deepEqual(dragged(controls, points, [4, 3, 0], [-50, 12]), [0, 1, 0]);
  assert.deepEqual(dragged(controls, points, [2, 2, 0], [21, 19]), [2, 2, 0]);
});

test("a point that walks around twice keeps its round, and stops at both ends", () => {
  const controls = [slider("walked", 25)]; // twice around, in steps of 30 degrees
  /** @type {(degrees: number) => [number, number]} */
  const at = (degrees) => {
    const angle = (degrees * Math.PI) / 180;
    return [100 * Math.cos(angle), 100 * Math.sin(angle)];
  };
  const points = Array.from({ length: 25 }, (_, i) => at(30 * i));
  let positions = [0];
  const seen = [0];
  for (let degrees = 20; degrees <= 720; degrees += 20) {
    positions = dragged(controls, points, positions, at(degrees));
    seen.push(positions[0]);
  }
  assert.deepEqual(positions, [24]);
  assert.ok(seen.every((now, i) => i === 0 || (now >= seen[i - 1] && now <= seen[i - 1] + 1)));
  assert.deepEqual(dragged(controls, points, [24], at(30)), [24]);
  assert.deepEqual(dragged(controls, points, [0], at(330)), [0]);
});
