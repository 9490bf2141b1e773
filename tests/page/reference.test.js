// The reference picture behind the shape.

import assert from "node:assert/strict";
import { test } from "node:test";
import { placeOf } from "../../glid_nb/page/js/canvas/reference.js";
import { View } from "../../glid_nb/page/js/pad/view.js";

/** @import { Point } from "../../glid_nb/page/js/types.js" */

/**
 * Left, top, width and height to a thousandth of a CSS pixel.
 *
 * @param {Point} size
 * @param {number[]} picture
 * @param {Partial<View>} changes
 */
function place(size, picture, changes = {}) {
  const made = new View(() => {}, { nearest: 1e-4, farthest: 1 });
  const view = Object.assign(made, { unit: 0.05, width: 600, height: 400, ...changes });
  return Object.values(placeOf(size, picture, view)).map((v) => Math.round(1000 * v) / 1000);
}

test("a reference of the picture's shape covers the picture's frame", () => {
  // The picture is 20 by 10 units, 400 by 200 CSS pixels.
  assert.deepEqual(place([1000, 500], [300, 150]), [100, 100, 400, 200]);
});

test("another reference fits into the frame, in its middle, and moves with the view", () => {
  assert.deepEqual(place([70, 70], [300, 150]), [200, 100, 200, 200]);
  assert.deepEqual(place([400, 100], [150, 150]), [100, 150, 400, 100]);
  const moved = place([70, 70], [300, 150], { x: 1, y: -2, unit: 0.1 });
  assert.deepEqual(moved, [240, 130, 100, 100]);
});
