// A figure of several panels on a narrow page: where its panels are.

import assert from "node:assert/strict";
import { test } from "node:test";
import { arranged, heightOf, moved, rearranged } from "../../glid_nb/page/js/frames/narrow.js";

/** @import { Box } from "../../glid_nb/page/js/frames/data.js" */

/** @type {Box[]} */
const TWO = [
  [0, 20, 300, 280],
  [310, 20, 300, 240],
];
/** @type {Box[]} */
const FOUR = [
  ...[0, 1, 2, 3].map((i) => /** @type {Box} */ ([200 * i, 0, 200, 200])),
  [250, 220, 300, 30], // a colour bar
];

test("two panels are below each other in their own size where both are visible", () => {
  const placed = arranged(TWO, 340, 600);
  assert.deepEqual(
    placed.map(({ to }) => to),
    [
      [20, 0, 300, 280],
      [20, 280, 300, 240],
    ],
  );
  assert.equal(heightOf(placed), 520);
});

test("panels are smaller where not all are visible at once, but their text stays legible", () => {
  const [first, second] = arranged(TWO, 340, 470).map(({ to }) => to);
  assert.deepEqual(first.slice(2), [270, 252]);
  assert.ok(second[1] + second[3] <= 470);
  const least = arranged(TWO, 340, 100);
  assert.equal(least[0].to[2], 0.75 * 300);
});

test("a page narrower than a panel makes all parts smaller by the same factor", () => {
  const placed = arranged(TWO, 150, 10_000);
  assert.deepEqual(placed[0].to, [0, 0, 150, 140]);
  assert.deepEqual(placed[1].to, [0, 140, 150, 120]);
});

test("small panels wrap like words, and the colour bar comes below them", () => {
  const placed = arranged(FOUR, 360, 600).map(({ to }) => to);
  const tops = placed.map(([, y]) => y);
  assert.equal(tops[0], tops[1]);
  assert.equal(tops[2], tops[3]);
  assert.ok(tops[0] < tops[2] && tops[2] < tops[4]);
});

test("a point of the first panel goes with it", () => {
  const placed = arranged(TWO, 340, 600);
  const middle = [150 / 610, 160 / 320];
  const found = moved([/** @type {[number, number]} */ (middle)], placed, [610, 320], 340);
  assert.deepEqual(found, [[170 / 340, 140 / 520]]);
});

test("the picture is drawn once and shown through a window for each part", () => {
  const svg =
    '<?xml version="1.0"?>\n<svg width="1pt" height="2pt" viewBox="0 0 1 2">\n<g/>\n</svg>';
  const made = rearranged(svg, arranged(TWO, 340, 600), [610, 320], 340);
  assert.ok(made.includes('<svg id="whole" width="610" height="320" viewBox="0 0 1 2">'));
  assert.equal(made.match(/<g\/>/g)?.length, 1);
  assert.equal(made.match(/<use xlink:href="#whole"\/>/g)?.length, 2);
  assert.ok(made.includes('x="20" y="280" width="300" height="240" viewBox="310 20 300 240"'));
  assert.ok(made.startsWith("<svg"));
});
