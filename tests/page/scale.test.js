// Where things lie along the timeline.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  frameAt,
  keyAt,
  labelledTimes,
  landing,
  nextKey,
  roomAt,
  spanOf,
  withReturn,
} from "../../glid_nb/page/js/timeline/scale.js";
import { boundOf, noteOn, reasonOf } from "../../glid_nb/page/js/timeline/words.js";
import { worstOf } from "../../glid_nb/page/js/timeline/worst.js";
import { scrolledTo } from "../../glid_nb/page/js/timeline/zoom.js";

/** @import { Shown, Span } from "../../glid_nb/page/js/timeline/traits.js" */

/** @param {number[]} times */
function keys(...times) {
  return times.map((time, i) => ({ name: `Pose ${i + 1}`, time, easing: "linear" }));
}

/**
 * @param {Partial<Shown>} changes
 * @returns {Shown}
 */
function shown(changes) {
  return {
    keyframes: keys(0, 1, 3),
    active: 0,
    repeat: "once",
    back: 0.5,
    range: null,
    recording: false,
    onion: false,
    exports: true,
    kernel: false,
    part: "",
    ...changes,
  };
}

/**
 * @param {Partial<Span>} changes
 * @returns {Span}
 */
function span(changes) {
  const floats = new DataView(new ArrayBuffer(0));
  const proved = { start: 0, end: 1, until: 1, times: [0, 1], floats, sigma2: [0.5], reason: "" };
  return { ...proved, status: "proved", ...changes };
}

test("a loop of two or more poses shows its return to the first", () => {
  const all = withReturn(shown({ repeat: "loop" }));
  assert.deepEqual(all.at(-1), { name: "Back to Pose 1", time: 3.5, easing: "linear" });
  assert.equal(withReturn(shown({})).length, 3);
  assert.equal(withReturn(shown({ repeat: "loop", keyframes: keys(0) })).length, 1);
});

test("the track shows more than the last keyframe, and a second at least", () => {
  assert.ok(spanOf(keys(0, 10)) > 10);
  assert.ok(spanOf(keys(0)) > 1);
});

test("a keyframe has the room to its nearest neighbour", () => {
  assert.equal(roomAt(keys(0, 1, 3), 1, 9), 1);
  assert.equal(roomAt(keys(0, 1, 3), 2, 9), 2);
  assert.equal(roomAt(keys(0), 0, 9), 9);
});

test("there are some labels on any track, never many", () => {
  for (const seconds of [1.15, 7, 60, 3600]) {
    const times = labelledTimes(seconds);
    assert.ok(times.length > 2 && times.length <= 13, `${times.length} labels in ${seconds} s`);
  }
});

test("labels have room beside each other", () => {
  for (const seconds of [1.15, 7, 60, 3600]) {
    for (const width of [150, 250, 500, 1000]) {
      const times = labelledTimes(seconds, width);
      if (times.length > 1) assert.ok(((times[1] - times[0]) / seconds) * width >= 36);
    }
  }
  assert.equal(labelledTimes(1.15, 0).length, labelledTimes(1.15).length); // not measured yet
});

test("a zoomed track has more labels, with frames where a time has one", () => {
  assert.ok(labelledTimes(2.5, 4000, 4).length > 2 * labelledTimes(2.5, 1000).length);
  assert.equal(frameAt(0.4, 25), 10);
  assert.equal(frameAt(0.1, 25), null);
  assert.equal(frameAt(0.3, 10), 3);
});

test("what a zoom is about stays below the pointer", () => {
  assert.equal(scrolledTo(0.5, 100, 2000), 900);
  assert.equal(scrolledTo(0.25, 100, 2068), 434);
  assert.equal(scrolledTo(0.02, 100, 2000), 0);
});

test("keyframes are found by their times", () => {
  assert.equal(keyAt(keys(0, 1, 3), 1), 1);
  assert.equal(keyAt(keys(0, 1, 3), 1.01), -1);
  assert.equal(nextKey(keys(0, 1, 3), 1, 1), 2);
  assert.equal(nextKey(keys(0, 1, 3), 1, -1), 0);
  assert.equal(nextKey(keys(0, 1, 3), 3, 1), null);
});

test("a keyframe lands where it can be told from the others, as near as possible", () => {
  assert.equal(landing(keys(0, 1, 3), 1, 2, 0.1), 2);
  assert.equal(landing(keys(0, 1, 3), 1, 2.98, 0.1), 2.9);
  assert.equal(landing(keys(0, 1, 3), 1, 3.02, 0.1), 3.1);
  assert.equal(landing(keys(0, 1, 3), 1, -5, 0.1), 0.1);
});

test("a loop's return stays behind the last keyframe", () => {
  assert.equal(landing(keys(0, 1, 3), 3, 1, 0.1), 3.1);
});

test("the note tells what is proved, or why not", () => {
  const told = (/** @type {Partial<Shown>} */ changes, /** @type {Span[]} */ ...spans) =>
    noteOn(shown(changes), worstOf([{ name: "", spans }]));
  const proof = told({}, span({}));
  assert.match(proof.text, /^Proved at every instant of 1\.00 s: σ₂ ≥ 0\.500\.$/);
  assert.equal(proof.kind, "state");
  assert.deepEqual(told({}, span({ status: "fails", reason: "It folds." })), {
    text: "It folds.",
    kind: "bad",
  });
  assert.equal(told({}, span({ status: "computing" })).text, "Proving the motion between poses…");
  assert.match(told({ kernel: true }, span({})).text, /^Played by the kernel/);
  const alone = told({ keyframes: keys(0) });
  assert.match(alone.text, /^Key \(K\) a second pose/);
  assert.equal(alone.kind, "advice");
  assert.match(told({ recording: true }, span({})).text, /^Recording/);
});

test("of several parts the worst counts, at each instant, and is named", () => {
  const body = { name: "Body", spans: [span({})] };
  const arm = { name: "Arm", spans: [span({ times: [0, 0.4, 1], sigma2: [0.9, 0.2] })] };
  const [proved] = worstOf([body, arm]);
  assert.equal(proved.status, "proved");
  assert.equal(proved.part, "");
  assert.deepEqual(proved.pieces, [
    { start: 0, end: 0.4, sigma2: 0.5, part: "Body" },
    { start: 0.4, end: 1, sigma2: 0.2, part: "Arm" },
  ]);
  assert.match(boundOf(proved.pieces[1]), /0\.200 from 0\.40 s to 1\.00 s; the worst part is Arm/);
  assert.match(noteOn(shown({}), [proved]).text, /σ₂ ≥ 0\.200 \(Arm\)\.$/);
});

test("a part that is not proved ends the proof of all", () => {
  const body = { name: "Body", spans: [span({})] };
  const failing = span({ status: "fails", reason: "It folds.", until: 0.6, times: [0, 0.3, 0.6] });
  const arm = { name: "Arm", spans: [failing] };
  const leg = { name: "Leg", spans: [span({ status: "computing", until: 0, sigma2: [] })] };
  const [two] = worstOf([body, arm]);
  assert.deepEqual([two.status, two.until, two.part], ["fails", 0.6, "Arm"]);
  // Between the last piece and the instant where the proof fails there is no bound.
  assert.deepEqual(two.pieces, [{ start: 0, end: 0.3, sigma2: 0.5, part: "Body" }]);
  assert.equal(noteOn(shown({}), [two]).text, "Arm: It folds.");
  const [three] = worstOf([body, arm, leg]);
  assert.deepEqual([three.status, three.until, three.pieces], ["fails", 0, []]);
  const [untold] = worstOf([body, { name: "New", spans: [] }]);
  assert.deepEqual([untold.status, untold.part, untold.until], ["computing", "New", 0]);
  assert.match(reasonOf(untold), /^New: Not proved yet from 0\.00 s to 1\.00 s$/);
});
