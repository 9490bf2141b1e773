// Between the world and the screen.

import assert from "node:assert/strict";
import { test } from "node:test";
import { View } from "../../glid_nb/page/js/pad/view.js";

/** @import { Point } from "../../glid_nb/page/js/types.js" */

/** @param {1 | -1} up */
function viewWith(up) {
  const view = new View(() => {}, { up, nearest: 0.01, farthest: 2 });
  return Object.assign(view, { x: 3, y: -2, unit: 0.5, width: 400, height: 300 });
}

/**
 * @param {Point} found
 * @param {Point} wanted
 */
function assertNear(found, wanted) {
  assert.ok(Math.hypot(found[0] - wanted[0], found[1] - wanted[1]) < 1e-9, `${found} ≠ ${wanted}`);
}

for (const up of /** @type {const} */ ([1, -1])) {
  test(`the screen and the world are each other's inverse, y ${up > 0 ? "up" : "down"}`, () => {
    const view = viewWith(up);
    assertNear(view.toWorld(view.toScreen([7, 11])), [7, 11]);
    assertNear(view.toScreen([3, -2]), [200, 150]);
    const above = view.toWorld([200, 140]);
    assertNear(above, [3, -2 + 5 * up]);
  });

  test(`a zoom keeps the point below the pointer, y ${up > 0 ? "up" : "down"}`, () => {
    const view = viewWith(up);
    const before = view.toWorld([50, 60]);
    view.zoom(0.5, [50, 60]);
    assert.equal(view.unit, 0.25);
    assertNear(view.toWorld([50, 60]), before);
  });

  test(`a pan moves what is seen with the hand, y ${up > 0 ? "up" : "down"}`, () => {
    const view = viewWith(up);
    const below = view.toWorld([50, 60]);
    view.pan(10, -20);
    assertNear(view.toScreen(below), [60, 40]);
  });
}

test("a zoom ends at the nearest and the farthest view, and the point stays", () => {
  const view = viewWith(1);
  const before = view.toWorld([50, 60]);
  view.zoom(1e-9, [50, 60]);
  assert.equal(view.unit, 0.01);
  view.zoom(1e9, [50, 60]);
  assert.equal(view.unit, 2);
  assertNear(view.toWorld([50, 60]), before);
});

test("two pointers that spread zoom about their middle", () => {
  const view = viewWith(1);
  /** @type {Map<number, Point>} */
  const pointers = new Map([
    [1, [100, 100]],
    [2, [200, 100]],
  ]);
  view.follow(pointers, 2, [300, 100]);
  assert.equal(view.unit, 0.25);
  assert.deepEqual(pointers.get(2), [300, 100]);
});

test("a wheel that tells lines goes farther than one that tells pixels", () => {
  const [pixels, lines] = [0, 1].map((deltaMode) => {
    const view = viewWith(1);
    const event = { deltaY: 1, deltaMode, ctrlKey: false, preventDefault() {} };
    view.wheel(/** @type {WheelEvent} */ (event), [0, 0]);
    return view.unit;
  });
  assert.ok(lines > pixels && pixels > 0.5);
});
