// What is at a point.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  encloses,
  holeAt,
  nearest,
  nearestEdge,
  nearestVertex,
} from "../../glid_nb/page/js/pad/hit.js";

/** @import { Point } from "../../glid_nb/page/js/types.js" */

/**
 * @param {number} left
 * @param {number} side
 * @returns {Point[]}
 */
function square(left, side) {
  return [
    [left, left],
    [left + side, left],
    [left + side, left + side],
    [left, left + side],
  ];
}

test("the nearest thing within reach is found, the first one where two are as near", () => {
  const things = [
    { name: "far", d: 3 },
    { name: "first", d: 1 },
    { name: "second", d: 1 },
  ];
  assert.equal(nearest(things, 2)?.name, "first");
  assert.equal(nearest(things, 0.5), null);
});

test("a loss makes a thing count as farther away, but not as out of reach", () => {
  const things = [
    { name: "hidden", d: 1, loss: 1 },
    { name: "seen", d: 1.5 },
  ];
  assert.equal(nearest(things, 1.6)?.name, "seen");
  assert.equal(nearest(things, 1.2)?.name, "hidden");
});

test("a vertex is told by its loop and its place in it", () => {
  const found = nearestVertex([square(0, 10), square(4, 2)], [6.1, 4.1], 1);
  assert.deepEqual([found?.loop, found?.index], [1, 1]);
});

test("the foot on an edge lies on the edge, at its end if the point is beyond", () => {
  assert.deepEqual(nearestEdge([square(0, 10)], [3, -1], 2)?.foot, [3, 0]);
  assert.deepEqual(nearestEdge([square(0, 10)], [11, 11], 2)?.foot, [10, 10]);
  assert.equal(nearestEdge([square(0, 10)], [5, 5], 2), null);
});

test("an edge of no length is a point", () => {
  /** @type {Point} */
  const point = [1, 1];
  assert.deepEqual(nearestEdge([[point, point]], [1, 2], 2)?.foot, [1, 1]);
});

test("the smallest hole around a point is found", () => {
  const holes = [
    { loop: square(0, 10), area: 100 },
    { loop: square(4, 2), area: 4 },
  ];
  assert.equal(holeAt(holes, [5, 5]), 1);
  assert.equal(holeAt(holes, [1, 1]), 0);
  assert.equal(holeAt(holes, [11, 1]), -1);
});

test("a loop goes around what is inside, whatever its direction", () => {
  const loop = square(0, 10);
  for (const one of [loop, loop.toReversed()]) {
    assert.ok(encloses(one, [5, 5]));
    assert.ok(!encloses(one, [-1, 5]));
    assert.ok(!encloses(one, [5, 11]));
  }
});
