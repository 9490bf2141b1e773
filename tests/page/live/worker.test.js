// The worker's loop, without a browser: what it answers, and which requests replace each other.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  distortionOf,
  FieldPoints,
  LiveWorker,
  Shape,
} from "../../../glid_nb/page/js/live/live.js";
import { golden } from "./golden.js";

/** @import { LiveAnswer, LiveMap, Pose } from "../../../glid_nb/page/js/live/types.js" */

/** A worker whose turns are run by hand. */
function startedWorker() {
  /** @type {LiveAnswer[]} */
  const answers = [];
  /** @type {(() => void)[]} */
  const turns = [];
  const worker = new LiveWorker(
    (answer) => answers.push(answer),
    (turn) => turns.push(turn),
  );
  const run = (most = 100) => {
    for (let i = 0; i < most && turns.length > 0; i++) {
      turns.shift()?.();
    }
  };
  return { worker, answers, run };
}

/**
 * @param {Pose} pose
 * @param {number} t
 * @returns {Pose}
 */
function partOf(pose, t) {
  const targets = pose.targets.map(([x, y], i) => {
    const [a, b] = pose.handles[i];
    return /** @type {[number, number]} */ ([a + t * (x - a), b + t * (y - b)]);
  });
  return { handles: pose.handles, targets };
}

/**
 * @param {LiveAnswer | undefined} answer
 * @returns {LiveMap}
 */
function asMap(answer) {
  assert.ok(answer?.type === "map", `${answer?.type}`);
  return answer;
}

test("a shape, a solve, and a drag that settles", () => {
  const { outline, pose, points, minima } = golden("bar");
  const { worker, answers, run } = startedWorker();
  worker.receive({ type: "shape", id: 1, outline, points });
  worker.receive({ type: "solve", id: 2, pose });
  run();
  const [ready, solved] = answers;
  assert.ok(ready.type === "ready" && ready.id === 1);
  const map = asMap(solved);
  assert.ok(map.certificate.certified && map.settled);
  assert.ok(minima[0] !== null && Math.abs(map.energy / minima[0] - 1) < 1e-6);
  assert.equal(map.images?.length, 2 * points.length);
  worker.receive({ type: "drag", id: 3, pose: partOf(pose, 0.9) });
  run();
  const frames = answers.slice(2).map(asMap);
  assert.ok(frames.every((frame) => frame.certificate.certified && frame.id === 3));
  assert.deepEqual(
    frames.map((frame) => frame.settled),
    frames.map((_, i) => i === frames.length - 1),
  );
  const prover = new Shape(outline).prover;
  for (const { coefficients, certificate } of frames) {
    assert.deepEqual(prover.certify(coefficients), certificate);
  }
});

test("the newest drag replaces one that waits", () => {
  const { outline, pose } = golden("bar");
  const { worker, answers, run } = startedWorker();
  worker.receive({ type: "shape", id: 1, outline });
  for (let i = 2; i < 6; i++) {
    worker.receive({ type: "drag", id: i, pose: partOf(pose, i / 60) });
  }
  run();
  assert.deepEqual([...new Set(answers.map((answer) => answer.id))], [1, 5]);
});

test("another energy keeps the map", () => {
  const { outline, pose } = golden("bar");
  const { worker, answers, run } = startedWorker();
  worker.receive({ type: "shape", id: 1, outline });
  worker.receive({ type: "solve", id: 2, pose });
  worker.receive({ type: "options", id: 3, options: { energy: "amips", s: 0.5 } });
  run();
  const [, before, after] = answers;
  assert.deepEqual(asMap(after).coefficients, asMap(before).coefficients);
  assert.ok(asMap(after).energy > asMap(before).energy);
});

test("another map is taken up if it can be proved, and the pins are evaluated there", () => {
  const { outline, pose } = golden("bar");
  const { worker, answers, run } = startedWorker();
  worker.receive({ type: "shape", id: 1, outline });
  worker.receive({ type: "solve", id: 2, pose });
  run();
  const solved = asMap(answers[1]);
  const identity = new Shape(outline).identity();
  worker.receive({ type: "place", id: 3, pose, coefficients: identity });
  worker.receive({ type: "place", id: 4, pose, coefficients: identity.map((x) => -x * 0) });
  worker.receive({ type: "drag", id: 5, pose });
  run();
  const placed = asMap(answers[2]);
  assert.deepEqual(placed.coefficients, identity);
  const [x, y] = pose.handles[0];
  const gap = Math.hypot(placed.pins.images[0] - x, placed.pins.images[1] - y);
  assert.ok(gap < 1e-9);
  assert.equal(answers[3].type, "failed");
  const last = asMap(answers.at(-1));
  assert.ok(last.settled && Math.abs(last.energy / solved.energy - 1) < 1e-4);
});

test("what a proof claims has panels that tile every edge", () => {
  const { outline, pose } = golden("teapot");
  const { worker, answers, run } = startedWorker();
  worker.receive({ type: "shape", id: 1, outline });
  worker.receive({ type: "claim", id: 2 });
  run();
  const [ready, answer] = answers;
  assert.ok(ready.type === "ready" && answer.type === "claim");
  const { panels, certificate } = answer.claim;
  assert.ok(certificate.certified && pose.handles.length > 0);
  assert.equal(panels.flat().length, ready.panels);
  for (const own of panels) {
    const ends = own.map(([k, d]) => (k + 1) / 2 ** d);
    const starts = own.map(([k, d]) => k / 2 ** d);
    assert.deepEqual([...starts, 1], [0, ...ends]);
  }
});

test("a request that fails says so, and the worker goes on", () => {
  const { outline, pose } = golden("bar");
  const { worker, answers, run } = startedWorker();
  worker.receive({ type: "solve", id: 1, pose });
  worker.receive({ type: "shape", id: 2, outline });
  run();
  assert.deepEqual(
    answers.map(({ type, id }) => [type, id]),
    [
      ["failed", 1],
      ["ready", 2],
    ],
  );
});

test("images and derivatives at points are the package's", () => {
  for (const name of ["frog", "teapot"]) {
    const data = golden(name);
    const points = new FieldPoints(new Shape(data.outline).domain, data.points);
    const { images, samples } = points.evaluate(Float64Array.from(data.coefficients));
    const count = data.points.length;
    const { sigma1, sigma2, k } = distortionOf(samples);
    for (let i = 0; i < count; i++) {
      const [fz, fzbar] = [data.fz[i], data.fzbar[i]];
      const off = [
        images[2 * i] - data.images[i][0],
        images[2 * i + 1] - data.images[i][1],
        samples[i] - fz[0],
        samples[count + i] - fz[1],
        samples[2 * count + i] - fzbar[0],
        samples[3 * count + i] + fzbar[1],
        sigma1[i] - Math.hypot(...fz) - Math.hypot(...fzbar),
        sigma2[i] - Math.hypot(...fz) + Math.hypot(...fzbar),
        k[i] - Math.hypot(...fzbar) / Math.hypot(...fz),
      ];
      assert.ok(off.every((value) => Math.abs(value) < 1e-11));
    }
  }
});
