// Playing a motion, frame by frame.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";
import { Player } from "../../glid_nb/page/js/timeline/player.js";
import { Frames } from "./fakes.js";

/** @import { Repeat } from "../../glid_nb/page/js/motion/motion.js" */

/** @type {Frames} */
let frames;

beforeEach(() => {
  frames = new Frames();
});

/** @param {Repeat} repeat */
function playing(repeat) {
  /** @type {[number[] | null, number | undefined][]} */
  const shown = [];
  const ended = mock.fn();
  const player = new Player(
    (floats, time) => void shown.push([floats && [...floats], time]),
    () => {},
    ended,
  );
  const first = { start: 0, end: 1, until: 1, times: [0, 1], floats: new Float32Array([0, 10]) };
  const half = {
    start: 1,
    end: 2,
    until: 1.5,
    times: [1, 1.5],
    floats: new Float32Array([10, 20]),
  };
  player.set([first, half], repeat);
  return { player, shown, ended };
}

/** @param {number} now */
async function frame(now) {
  frames.run(now);
  await new Promise((resolve) => setImmediate(resolve));
}

test("a time shows the coefficients of its interval", () => {
  const { player, shown } = playing("once");
  player.scrub(0.5);
  player.scrub(1.25);
  assert.deepEqual(shown, [
    [[5], 0.5],
    [[15], 1.25],
  ]);
});

test("beyond what is proved the last proved instant stays", () => {
  const { player, shown } = playing("once");
  player.scrub(1.9);
  assert.deepEqual(shown, [[[20], 1.9]]);
});

test("where one of several shapes is proved less far, all stay there", () => {
  /** @type {[number, number[], Record<string, number[]>][]} */
  const shown = [];
  const player = new Player(
    (floats, time, others) => {
      const theirs = Object.entries(others ?? {}).map(([key, values]) => [key, [...values]]);
      shown.push([time ?? NaN, [...(floats ?? [])], Object.fromEntries(theirs)]);
    },
    () => {},
  );
  const span = (/** @type {number} */ start, /** @type {number} */ until) => ({
    ...{ start, end: start + 1, until, times: [start, start + 1] },
    floats: new Float32Array([10 * start, 10 * start + 10]),
  });
  const [whole, half, none] = [span(0, 1), span(0, 0.5), span(1, 1)];
  player.set([whole, span(1, 2)], "once", { arm: [half, span(1, 2)], leg: [whole, none] });
  for (const time of [0.25, 0.75, 1.5]) player.scrub(time);
  assert.deepEqual(shown, [
    [0.25, [2.5], { arm: [2.5], leg: [2.5] }],
    [0.75, [5], { arm: [5], leg: [5] }],
    [1.5, [10], { arm: [10], leg: [10] }],
  ]);
});

test("a loop range plays over and over, whatever the motion does at its end", async () => {
  const { player, ended } = playing("once");
  player.range = [0.5, 1.5];
  player.play(); // from 0, before the range
  await frame(0);
  assert.equal(player.place, 0.5);
  await frame(900);
  assert.ok(Math.abs(player.place - 1.4) < 1e-9);
  await frame(1300);
  assert.ok(Math.abs(player.place - 0.8) < 1e-9);
  assert.ok(player.playing);
  player.scrub(1.8); // a hand goes anywhere
  assert.equal(player.place, 1.8);
  player.play();
  await frame(2000);
  assert.equal(player.place, 0.5);
  assert.equal(ended.mock.callCount(), 0);
});

test("a motion that plays once ends at its end, and then begins anew", async () => {
  const { player, ended } = playing("once");
  player.play();
  await frame(0);
  await frame(1500);
  assert.ok(player.playing);
  await frame(2500);
  assert.ok(!player.playing);
  assert.equal(ended.mock.callCount(), 1); // its last keyframe is selected
  assert.equal(player.time, 2);
  player.play();
  assert.equal(player.time, 0);
});

test("on the way back of a ping-pong the playhead runs back", async () => {
  const { player, shown } = playing("ping-pong");
  player.play();
  await frame(0);
  await frame(2500);
  assert.equal(player.time, 2.5);
  assert.equal(player.place, 1.5);
  assert.deepEqual(shown.at(-1), [[20], 1.5]);
  player.play();
  assert.ok(!player.playing);
});

test("the next frame waits until the one before is drawn", async () => {
  let drawn = () => {};
  const player = new Player(
    () =>
      new Promise((resolve) => {
        drawn = () => resolve(null);
      }),
    () => {},
  );
  const span = { start: 0, end: 9, until: 9, times: [0, 9], floats: new Float32Array() };
  player.set([span], "once");
  player.play();
  await frame(0);
  await frame(500);
  assert.equal(player.time, 0);
  drawn();
  await frame(500);
  await frame(1000);
  assert.ok(player.time > 0);
});

test("going back shows the pose that is edited, once", () => {
  const { player, shown } = playing("loop");
  player.scrub(0.5);
  player.release(1);
  player.release(1);
  assert.deepEqual(shown.slice(1), [[null, undefined]]);
  assert.equal(player.time, 1);
});

test("after the last keyframe its pose stays, and playing begins in the motion", () => {
  const { player, shown } = playing("once");
  player.scrub(2.5);
  assert.equal(player.place, 2.5);
  assert.deepEqual(shown.at(-1), [[20], 2.5]);
  player.scrub(1);
  assert.equal(player.place, 1);
  player.scrub(3);
  player.play();
  assert.equal(player.place, 0);
  player.release(0);
  player.scrub(4);
  player.release(1);
  assert.equal(player.place, 1);
  assert.deepEqual(shown.at(-1), [null, undefined]);
});

test("a time after a loop's return shows the return", () => {
  const { player } = playing("loop");
  player.scrub(5);
  assert.equal(player.place, 2);
});

test("a single keyframe has times after it, and none before", () => {
  /** @type {[unknown, number | undefined][]} */
  const shown = [];
  const player = new Player(
    (floats, time) => void shown.push([floats, time]),
    () => {},
  );
  player.set([], "once");
  player.only = 0.5;
  player.scrub(1.5);
  assert.equal(player.place, 1.5);
  assert.deepEqual(shown, [[null, 1.5]]);
  player.scrub(0.2);
  assert.equal(player.place, 0.5);
  assert.ok(!player.seen);
});
