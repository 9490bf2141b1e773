// The exported page: what it reads, and how its time runs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { around, viewOn } from "../../glid_nb/page/js/exported/boxes.js";
import { glideTo, playedFrom } from "../../glid_nb/page/js/exported/course.js";
import {
  down,
  downSmall,
  provedNow,
  sigma2At,
  up,
} from "../../glid_nb/page/js/exported/numbers.js";
import { inOrder, projectionMatrix } from "../../glid_nb/page/js/exported/renderer.js";
import { cornersOf, restored, unpacked } from "../../glid_nb/page/js/exported/unpack.js";
import { Motion } from "../../glid_nb/page/js/motion/motion.js";

/**
 * As `packed` in glid_nb/export/page.py.
 *
 * @param {number[][]} rows whole numbers
 * @param {number} step
 */
function packed(rows, step) {
  const width = rows[0].length;
  const flat = rows.flat();
  const second = flat.map(
    (value, i) => value - 2 * (flat[i - width] ?? 0) + (flat[i - 2 * width] ?? 0),
  );
  const folded = second.map((value) => ((value << 1) ^ (value >> 31)) >>> 0);
  const planes = [0, 8, 16, 24].flatMap((shift) => folded.map((one) => (one >>> shift) & 255));
  return { step, bytes: deflateSync(Uint8Array.from(planes)).toString("base64") };
}

test("packed numbers come back, negative and large ones too", async () => {
  const rows = [
    [0, -1],
    [70000, 5],
    [-3, 100],
    [12, -(2 ** 20)],
  ];
  const found = await unpacked(packed(rows, 0.5), 2);
  assert.deepEqual(
    [...found],
    rows.flat().map((value) => value / 2),
  );
});

test("factored rows are sums of few rows", async () => {
  const factored = {
    sizes: [1, 2],
    rows: {
      ...packed(
        [
          [1, 2],
          [3, 4],
        ],
        1,
      ),
      width: 2,
    },
    shares: packed(
      [
        [1, 0],
        [2, 4],
      ],
      1,
    ),
  };
  assert.deepEqual([...(await restored(factored, 2))], [1, 2, 2 + 6, 4 + 8]);
});

test("triangles are told by a corner and the differences to it", async () => {
  const triangles = packed(
    [
      [4, 1, 2],
      [0, 5, 3],
    ],
    1,
  );
  assert.deepEqual(await cornersOf(triangles), [
    [4, 5, 6],
    [0, 5, 3],
  ]);
});

test("higher triangles are drawn later", () => {
  const heights = new Float32Array([1, 1, 1, 0]);
  /** @type {[number, number, number][]} */
  const triangles = [
    [0, 1, 2],
    [0, 1, 3],
  ];
  const source = new Float32Array(8);
  assert.deepEqual(inOrder({ source, heights, triangles }), [
    [0, 1, 3],
    [0, 1, 2],
  ]);
});

test("the projection takes the view's centre to 0 and its edges to 1", () => {
  const matrix = projectionMatrix(400, 200, 0.1, 3, -1);
  const apply = (/** @type {number} */ x, /** @type {number} */ y) => [
    matrix[0] * x + matrix[12],
    matrix[5] * y + matrix[13],
  ];
  for (const value of apply(3, -1)) assert.ok(Math.abs(value) < 1e-12);
  for (const value of apply(3 + 20, -1 + 10)) assert.ok(Math.abs(value - 1) < 1e-12);
});

test("what plays once ends at its end, and begins anew from there", () => {
  const motion = new Motion({ times: [0, 2], repeat: "once" }, new Float32Array(2));
  const rest = playedFrom(motion, 0.5, false);
  assert.equal(rest.lasts, 1500);
  assert.equal(rest.at(500), 1);
  assert.equal(rest.at(1500), 2);
  assert.equal(playedFrom(motion, 2, false).at(0), 0);
  assert.equal(playedFrom(motion, 1.5, true).at(1000), 0.5);
});

test("a glide ends at its pose; in a loop it goes the shorter way round", () => {
  const once = new Motion({ times: [0, 2], repeat: "once" }, new Float32Array(2));
  const loop = new Motion({ times: [0, 2], repeat: "loop" }, new Float32Array(2));
  const straight = glideTo(once, 1.8, 0.1);
  assert.equal(straight.at(straight.lasts), 0.1);
  const around = glideTo(loop, 1.8, 0.1);
  assert.equal(loop.within(around.at(around.lasts)).toFixed(9), (0.1).toFixed(9));
  assert.ok(around.at(300) > 1.8);
});

test("bounds are rounded to what is still a bound", () => {
  assert.equal(down(0.45678), "0.456");
  assert.equal(up(1.2341), "1.235");
  assert.deepEqual([0.45678, 0.00238, 9.996e-5, 0].map(downSmall), [
    "0.456",
    "2.3e-3",
    "9.9e-5",
    "0.000",
  ]);
});

const PROOF = {
  times: [0, 1, 2],
  keyframes: [0, 2],
  repeat: /** @type {const} */ ("once"),
  sigma2: [0.45678, null],
  sigma1: [1.2341, null],
  k: [0.3, null],
  until: 1.8,
};
const OTHER = { ...PROOF, sigma2: [0.9, 0.8], sigma1: [2.5, 1], k: [0.1, 0.1], until: 2 };

test("a page says what is proved at its time", () => {
  const at = (/** @type {number} */ piece) => [{ proof: PROOF, piece }];
  assert.equal(provedNow(at(0), 0.5), "Now: σ₂ ≥ 0.456, σ₁ ≤ 1.235, k ≤ 0.300");
  assert.equal(provedNow(at(1), 1.7), "Now: proved not to fold");
  assert.equal(provedNow(at(1), 1.9), "Now: not proved");
  assert.deepEqual([sigma2At(at(0), 0.5), sigma2At(at(1), 1.7)], [0.45678, 0]);
  assert.equal(sigma2At(at(1), 1.8), -1);
});

test("the bounds of several shapes hold for all, and one that is not proved is told of", () => {
  // The second shape has knots of its own, so another piece.
  const at = (/** @type {number} */ piece) => [
    { proof: OTHER, piece: 0 },
    { proof: PROOF, piece },
  ];
  assert.equal(provedNow(at(0), 0.5), "Now: σ₂ ≥ 0.456, σ₁ ≤ 2.500, k ≤ 0.300");
  assert.equal(provedNow(at(1), 1.7), "Now: proved not to fold");
  assert.equal(provedNow(at(1), 1.9), "Now: not proved");
  assert.equal(sigma2At(at(0), 0.5), 0.45678);
  assert.equal(sigma2At(at(1), 1.9), -1);
});

test("the view holds the boxes of all shapes, with a margin", () => {
  const box = around([
    [-1, -2, 3, 4],
    [0, -5, 8, 1],
  ]);
  assert.deepEqual(box, [-1, -5, 8, 4]);
  const view = viewOn(box, 90, 180, 0.05);
  assert.deepEqual([view.x, view.y], [3.5, -0.5]);
  assert.ok(Math.abs(view.unit - 9 / 81) < 1e-12); // the width decides
});
