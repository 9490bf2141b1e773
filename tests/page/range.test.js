// The loop range of the timeline.

import assert from "node:assert/strict";
import { test } from "node:test";
import { keyedEnd, withEnd } from "../../glid_nb/page/js/timeline/range.js";

/** @import { Range } from "../../glid_nb/page/js/timeline/range.js" */

const FRAME = 0.04;
/** @type {Range} */
const WHOLE = [1, 5];

test("an end is dragged within the motion, and leaves a frame at least", () => {
  assert.deepEqual(withEnd(WHOLE, WHOLE, 0, 2, FRAME), [2, 5]);
  assert.deepEqual(withEnd([2, 3], WHOLE, 0, 4, FRAME), [2.96, 3]);
  assert.deepEqual(withEnd([2, 3], WHOLE, 1, 0, FRAME), [2, 2.04]);
  assert.deepEqual(withEnd([2, 3], WHOLE, 1, 9, FRAME), [2, 5]);
  assert.equal(withEnd([2, 5], WHOLE, 0, -1, FRAME), null);
});

test("a key beyond the other end takes that one away, and again at the same time its own", () => {
  assert.deepEqual(keyedEnd(null, WHOLE, 0, 2, FRAME), [2, 5]);
  assert.deepEqual(keyedEnd([2, 5], WHOLE, 1, 3, FRAME), [2, 3]);
  assert.deepEqual(keyedEnd([2, 3], WHOLE, 0, 4, FRAME), [4, 5]);
  assert.deepEqual(keyedEnd([2, 3], WHOLE, 1, 1.5, FRAME), [1, 1.5]);
  assert.deepEqual(keyedEnd([2, 3], WHOLE, 0, 2, FRAME), [1, 3]);
  assert.equal(keyedEnd([2, 5], WHOLE, 0, 2, FRAME), null);
});
