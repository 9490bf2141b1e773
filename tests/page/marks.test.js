// Pins on the screen.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  arrowAt,
  arrowsTo,
  dial,
  inSight,
  knobInCorner,
  markAt,
  ringAt,
} from "../../glid_nb/page/js/canvas/marks.js";
import { View } from "../../glid_nb/page/js/pad/view.js";

/** @import { Point } from "../../glid_nb/page/js/types.js" */
/** @import { Marks } from "../../glid_nb/page/js/canvas/traits.js" */

function view() {
  const made = new View(() => {}, { nearest: 1e-4, farthest: 1 });
  return Object.assign(made, { unit: 0.1, width: 400, height: 300 });
}

/**
 * @param {Partial<Marks>} changes
 * @returns {Marks}
 */
function marks(changes = {}) {
  /** @type {Marks} */
  const two = {
    targets: [
      [0, 0],
      [5, 0],
    ],
    images: [
      [0, 1],
      [5, 0],
    ],
    selected: [0],
    hidden: [],
    ring: [0, 1, true, false],
  };
  return { ...two, ...changes };
}

test("a target is found before an image that is nearer", () => {
  assert.deepEqual(markAt(marks(), [0, 0.8], 1)?.reached, false);
  assert.deepEqual(markAt(marks(), [0, 1.2], 1)?.reached, true);
  assert.equal(markAt(marks(), [2.5, 0], 1), null);
});

test("a hidden pin loses against one that is a little farther away", () => {
  const near = marks({
    targets: [
      [0, 0],
      [1, 0],
    ],
    hidden: [0],
  });
  assert.equal(markAt(near, [0.45, 0], 1)?.mark, 1);
  assert.equal(markAt({ ...near, hidden: [] }, [0.45, 0], 1)?.mark, 0);
});

test("the ring is around the pin that was selected last, where the hand holds it", () => {
  assert.deepEqual(dial(view(), marks())?.centre, [200, 150]);
  assert.deepEqual(dial(view(), marks(), new Map([[0, [1, 0]]]))?.centre, [210, 150]);
  assert.equal(dial(view(), marks({ selected: [] })), null);
  assert.equal(dial(view(), marks({ ring: [] })), null);
});

test("the knob turns and scales, the ring turns, and inside it is nothing", () => {
  const ring = dial(view(), marks());
  assert.ok(ring);
  assert.deepEqual(ring.knob, [242, 150]);
  assert.deepEqual(ringAt(view(), marks(), ring.knob, 5), { part: "knob" });
  assert.deepEqual(ringAt(view(), marks(), [200, 108], 5), { part: "turn" });
  assert.equal(ringAt(view(), marks(), [200, 150], 5), null);
});

test("the ring is as large for every scale; only a wanted scale moves the knob, within limits", () => {
  const radii = [0.1, 1, 3, 20].map((scale) => {
    const free = dial(view(), marks({ ring: [0, scale, false, false] }));
    const wanted = dial(view(), marks({ ring: [0, scale, false, true] }));
    assert.deepEqual(free?.knob, [242, 150]);
    assert.equal(free?.radius, wanted?.radius);
    return [wanted?.radius, wanted?.knob[0]];
  });
  assert.deepEqual(radii, [
    [42, 221],
    [42, 242],
    [42, 305],
    [42, 305],
  ]);
});

test("the knob stays inside the view, and off its pin", () => {
  for (const target of /** @type {Point[]} */ ([
    [19, 0],
    [-19.9, 14.9],
    [19.9, -14.9],
    [0, 14.9],
  ])) {
    for (let angle = -3; angle <= 3; angle += 0.25) {
      const ring = dial(view(), marks({ targets: [target], ring: [angle, 1, true, false] }));
      assert.ok(ring);
      const [x, y] = ring.knob;
      assert.ok(x >= 10 && x <= 390 && y >= 10 && y <= 290, `${target} ${angle}: ${x} ${y}`);
      assert.ok(Math.hypot(x - ring.centre[0], y - ring.centre[1]) > 20);
    }
  }
});

test("the corner's buttons let the knob below them through", () => {
  const corner = marks({ targets: [[15, 10]], images: [[15, 10]] });
  assert.ok(knobInCorner(view(), corner, new Map()));
  assert.ok(!knobInCorner(view(), marks(), new Map()));
});

test("arrows lie inside the view and lead to what is out of sight", () => {
  const far = marks({
    targets: [
      [0, 0],
      [100, 0],
    ],
  });
  assert.ok(!inSight(view(), [100, 0]));
  const arrows = arrowsTo(view(), far.targets);
  assert.deepEqual(arrows, [{ at: [386, 150], target: [100, 0], angle: 0 }]);
  assert.deepEqual(arrowAt(view(), far, [380, 150]), [100, 0]);
  assert.equal(arrowAt(view(), far, [200, 150]), null);
});

test("an arrow beside the corner's buttons leaves them room", () => {
  const [arrow] = arrowsTo(view(), [[100, 14]]);
  assert.equal(arrow.at[0], 400 - 36 - 14);
});
