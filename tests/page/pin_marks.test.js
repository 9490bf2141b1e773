// Pins that are locked, hidden or grouped.

import assert from "node:assert/strict";
import { test } from "node:test";
import { arrowsTo, markAt } from "../../glid_nb/page/js/canvas/marks.js";
import { movedWith, withoutHidden } from "../../glid_nb/page/js/canvas/pin_marks.js";
import { View } from "../../glid_nb/page/js/pad/view.js";

/** @import { Point } from "../../glid_nb/page/js/types.js" */

const PLAIN = { locked: [], away: [], groups: [0, 0, 0, 0] };
/** @type {Point[]} */
const POINTS = [
  [0, 0],
  [1, 0],
  [2, 0],
  [3, 0],
];
const MARKS = {
  targets: POINTS,
  images: POINTS,
  selected: [],
  hidden: [],
  ring: /** @type {[]} */ ([]),
};

test("a drag moves the selected pins, or the group of the pressed one, but no locked pin", () => {
  assert.deepEqual(movedWith(1, [], PLAIN), [1]);
  assert.deepEqual(movedWith(1, [0, 1], PLAIN), [0, 1]);
  assert.deepEqual(movedWith(2, [0, 1], PLAIN), [2]);
  const pins = { locked: [3], away: [], groups: [1, 0, 1, 1] };
  assert.deepEqual(movedWith(0, [], pins), [0, 2]);
  assert.deepEqual(movedWith(1, [1, 3], pins), [1]);
  assert.deepEqual(movedWith(3, [1, 3], pins), []);
});

test("a hidden pin is not reached, and nothing points to it", () => {
  const pins = { ...PLAIN, away: [1] };
  assert.equal(withoutHidden(MARKS, PLAIN, Infinity), MARKS);
  const reachable = withoutHidden(MARKS, pins, Infinity);
  assert.equal(markAt(MARKS, [1.1, 0], 0.5)?.mark, 1);
  assert.equal(markAt(reachable, [1.1, 0], 0.5), null);
  assert.equal(markAt(reachable, [1.9, 0], 0.5)?.mark, 2);

  const drawn = withoutHidden(MARKS, pins, Number.NaN);
  assert.deepEqual(drawn.targets[2], [2, 0]);
  const made = new View(() => {}, { nearest: 1e-4, farthest: 1 });
  const view = Object.assign(made, { unit: 0.1, width: 400, height: 300 });
  const [arrow] = arrowsTo(view, drawn.targets);
  assert.ok(Number.isNaN(arrow.at[0])); // a canvas draws nothing there
});
