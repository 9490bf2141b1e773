// Where the pale pins are that invite a drag.

import assert from "node:assert/strict";
import { test } from "node:test";
import { ghostPins } from "../../glid_nb/page/js/canvas/ghosts.js";
import { encloses } from "../../glid_nb/page/js/pad/hit.js";
import { distance } from "../../glid_nb/page/js/pad/view.js";

/** @import { Point } from "../../glid_nb/page/js/types.js" */

/** @type {(...numbers: [number, number, number, number]) => Point[]} */
const box = (left, bottom, right, top) => [
  [left, bottom],
  [right, bottom],
  [right, top],
  [left, top],
];

test("three pale pins are inside the shape, beside its holes, and far from each other", () => {
  const cage = box(-8, -2, 8, 2);
  const hole = box(-1, -1, 1, 1);
  const pins = ghostPins({ cage, holes: [hole] });
  assert.equal(pins.length, 3);
  for (const [, y] of pins) assert.ok(Math.abs(y) < 1.6); // none at the boundary
  for (const pin of pins) assert.ok(encloses(cage, pin) && !encloses(hole, pin));
  const ends = pins.map(([x]) => x).sort((a, b) => a - b);
  assert.ok(ends[0] < -5 && ends[2] > 5 && Math.abs(ends[1]) < 3, `${ends}`);
  for (const [i, pin] of pins.entries()) {
    assert.ok(pins.every((other, j) => i === j || distance(pin, other) > 4));
  }
});
