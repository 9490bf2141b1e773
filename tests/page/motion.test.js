// Motions as the page mixes them; tests/widgets/test_motion_browser.py compares with the kernel's.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Motion } from "../../glid_nb/page/js/motion/motion.js";

/** @import { Repeat } from "../../glid_nb/page/js/motion/motion.js" */

/** @param {Repeat} repeat */
function motionOf(repeat) {
  const knots = [0, 10, 4, 20, 8, 0]; // two numbers at each of three knots
  return new Motion({ times: [1, 2, 4], repeat }, new Float32Array(knots));
}

test("arrays are mixed on straight lines between the knots", () => {
  const motion = motionOf("once");
  assert.deepEqual([...motion.at(1)], [0, 10]);
  assert.deepEqual([...motion.at(1.5)], [2, 15]);
  assert.deepEqual([...motion.at(3)], [6, 10]);
  assert.deepEqual([...motion.at(4)], [8, 0]);
});

test("a motion that is shown once stays at its ends", () => {
  const motion = motionOf("once");
  assert.equal(motion.within(0), 1);
  assert.equal(motion.within(9), 4);
  assert.deepEqual([...motion.at(9)], [8, 0]);
});

test("a loop begins again, before its start too", () => {
  const motion = motionOf("loop");
  assert.equal(motion.end, 4);
  assert.equal(motion.within(4.5), 1.5);
  assert.equal(motion.within(0.5), 3.5);
});

test("a ping-pong comes back the same way", () => {
  const motion = motionOf("ping-pong");
  assert.equal(motion.end, 7);
  assert.deepEqual([...motion.at(5)], [...motion.at(3)]);
  assert.deepEqual([...motion.at(6.5)], [...motion.at(1.5)]);
  assert.deepEqual(motion.place(5), { piece: 1, share: 0.5 });
});
