// The pins of a motion at a time.

import assert from "node:assert/strict";
import { test } from "node:test";
import { pinBetweenAt } from "../../glid_nb/page/js/canvas/marks.js";
import { pinsAt, pinsLater } from "../../glid_nb/page/js/timeline/moving_pins.js";

/** @param {number[]} numbers */
const wire = (...numbers) => new DataView(new Float32Array(numbers).buffer);

const PINS = {
  spans: [
    { end: 1, times: [0, 0.5, 1], floats: wire(0, 0, 2, 4, 4, 4), locked: [] },
    { end: 2, times: [1, 1.5], floats: wire(4, 4, 0, 1, 5, 4, 0, 3), locked: [1] },
  ],
  poses: [
    { floats: wire(0.5, 0), locked: [] },
    { floats: wire(4, 4, 0, 1.5), locked: [1] },
    { floats: wire(7, 8, 9, 10), locked: [0] },
  ],
  keyframes: [0, 1, 2, 3],
};

test("pins move on straight lines between the knots", () => {
  assert.deepEqual(pinsAt(PINS, 0.25), { places: [[1, 2]], locked: [] });
  assert.deepEqual(pinsAt(PINS, 0.75), { places: [[3, 4]], locked: [] });
});

test("beyond what is proved they stay, and each span has pins of its own", () => {
  const there = { places: [[5, 4], [0, 3]], locked: [1] }; // biome-ignore format: two pairs
  assert.deepEqual(pinsAt(PINS, 1.5), there);
  assert.deepEqual(pinsAt(PINS, 1.9), there);
  assert.deepEqual(pinsAt(PINS, 2.5), there);
});

test("at a keyframe, as at the kernel's hundredths, they are that pose's", () => {
  assert.deepEqual(pinsAt(PINS, 1.004), {
    places: [
      [4, 4],
      [0, 1.5],
    ],
    locked: [1],
  });
  assert.deepEqual(pinsAt(PINS, 3), { places: [[0.5, 0]], locked: [] }); // a loop's return
});

test("after the last keyframe they are that pose's", () => {
  const places = [
    [7, 8],
    [9, 10],
  ];
  assert.deepEqual(pinsLater(PINS), { places, locked: [0] });
});

test("where there are none, or the kernel has told none, there are none", () => {
  const none = { places: [], locked: [] };
  assert.deepEqual(pinsAt({ spans: [], poses: [], keyframes: [] }, 0.5), none);
  assert.deepEqual(pinsLater({ spans: [], poses: [], keyframes: [] }), none);
  const empty = { end: 1, times: [0, 1], floats: wire(), locked: [] };
  assert.deepEqual(pinsAt({ spans: [empty], poses: [], keyframes: [] }, 0.5), none);
});

test("the nearest pin that is not hidden is found", () => {
  /** @type {[number, number][]} */
  const places = [
    [Number.NaN, Number.NaN],
    [1, 0],
    [0.4, 0],
  ];
  assert.equal(pinBetweenAt(places, [0, 0], 0.5)?.mark, 2);
  assert.equal(pinBetweenAt(places, [0.8, 0], 0.5)?.mark, 1);
  assert.equal(pinBetweenAt(places, [0, 2], 0.5), null);
});
