// Several shapes in one live page: their solvers, maps and motions as one.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Solving } from "../../glid_nb/page/js/live/solving.js";
import { nameOf } from "../../glid_nb/page/js/live_page/files.js";
import { poseOf } from "../../glid_nb/page/js/live_page/pins.js";
import { chained, parted, posesOf, worstOf } from "../../glid_nb/page/js/live_parts/joint_map.js";
import { JointSolving } from "../../glid_nb/page/js/live_parts/joint_solving.js";
import { partNames } from "../../glid_nb/page/js/live_parts/part_names.js";
import { PartsEditing } from "../../glid_nb/page/js/live_parts/parts_editing.js";
import { partsCode } from "../../glid_nb/page/js/live_parts/parts_files.js";
import { jointReel } from "../../glid_nb/page/js/live_parts/reel.js";

/** @import { LiveAnswer, LiveMap, LiveRequest } from "../../glid_nb/page/js/live/types.js" */
/** @import { Mesh } from "../../glid_nb/page/js/exported/renderer.js" */
/** @import { Pin } from "../../glid_nb/page/js/live_page/data.js" */
/** @import { PartData } from "../../glid_nb/page/js/live_parts/data.js" */
/** @import { Point } from "../../glid_nb/page/js/types.js" */

const RESTS = [Float64Array.of(0, 0, 0, 0), Float64Array.of(1, 1, 1, 1)];

/** @type {Mesh} */
const SQUARE = {
  source: Float32Array.of(0, 0, 1, 0, 1, 1, 0, 1),
  heights: Float32Array.of(0, 0, 0, 0),
  triangles: [
    [0, 1, 2],
    [0, 2, 3],
  ],
};

/**
 * A certified map with pins that lie at (id, id).
 * @param {number} id
 * @param {Partial<LiveMap> & { sigma2?: number, count?: number }} [more]
 * @returns {LiveMap}
 */
function mapOf(id, { sigma2 = 1, count = 0, ...more } = {}) {
  return {
    type: "map",
    id,
    settled: true,
    outcome: "minimal",
    energy: 1,
    coefficients: Float64Array.of(id, id, id, id),
    certificate: {
      certified: true,
      sigma2_lower: sigma2,
      sigma1_upper: 2,
      k_upper: 0.5,
      windings: [0],
      halved: 1,
      refused: -1,
    },
    images: Float64Array.of(0, 0, 1, 0, 1, 1, 0, 1),
    samples: null,
    pins: {
      images: new Float64Array(2 * count).fill(id),
      samples: Float64Array.from({ length: 4 * count }, (_, i) => 10 * id + i),
    },
    steps: 1,
    took: 2,
    evaluated: 0,
    ...more,
  };
}

function fakeSolver() {
  /** @type {LiveRequest[]} */
  const requests = [];
  const port = {
    postMessage: (/** @type {LiveRequest} */ request) => void requests.push(request),
    onmessage: /** @type {((event: { data: LiveAnswer }) => void) | null} */ (null),
  };
  const solving = new Solving(port);
  const answer = (/** @type {LiveAnswer} */ data) => port.onmessage?.({ data });
  return { solving, requests, answer };
}

function startedPair() {
  const solvers = [fakeSolver(), fakeSolver()];
  const joint = new JointSolving(
    solvers.map(({ solving }) => solving),
    RESTS,
    [mapOf(0), mapOf(0)],
  );
  /** @type {LiveMap[]} */
  const told = [];
  joint.onmap = (map) => void told.push(map);
  return { joint, solvers, told };
}

/**
 * A pin of a part.
 * @param {number} part
 * @param {Point} target
 * @returns {Pin}
 */
function pinOf(part, target) {
  return {
    handle: [0.5, 0.25, part],
    target,
    angle: null,
    scale: null,
    weight: 1,
    depth: 0,
    name: "",
  };
}

test("coefficients of all parts are one list, and are divided again", () => {
  const all = chained([Float64Array.of(1, 2), Float64Array.of(3)]);
  assert.deepEqual([...all], [1, 2, 3]);
  assert.deepEqual(
    parted(all, [2, 1]).map((one) => [...one]),
    [[1, 2], [3]],
  );
});

test("each solver has its own pins, without the parts' numbers", () => {
  const pose = poseOf([pinOf(1, [7, 7]), pinOf(0, [8, 8]), { ...pinOf(1, [9, 9]), angle: 2 }]);
  const [back, front] = posesOf(pose, 2);
  assert.deepEqual(back.targets, [[8, 8]]);
  assert.deepEqual(front.handles, [
    [0.5, 0.25],
    [0.5, 0.25],
  ]);
  assert.deepEqual(front.angles, [null, 2]);
});

test("what is proved of all is the worst bound, and nothing if one is not certified", () => {
  const proofs = [mapOf(1, { sigma2: 0.7 }), mapOf(1, { sigma2: 0.4 })].map(
    ({ certificate }) => certificate,
  );
  assert.equal(worstOf(proofs).sigma2_lower, 0.4);
  assert.ok(worstOf(proofs).certified);
  assert.ok(!worstOf([proofs[0], { ...proofs[1], certified: false }]).certified);
});

test("a drag asks the part whose pin has moved, and no other", () => {
  const { joint, solvers, told } = startedPair();
  const still = pinOf(0, [0, 0]);
  const first = joint.drag(poseOf([still, pinOf(1, [1, 1])]));
  assert.deepEqual(
    solvers.map(({ requests }) => requests.length),
    [1, 1],
  );
  const second = joint.drag(poseOf([still, pinOf(1, [2, 2])]));
  assert.deepEqual(
    solvers.map(({ requests }) => requests.length),
    [1, 2],
  );
  solvers[1].answer(mapOf(2, { count: 1 }));
  assert.ok(/** @type {LiveMap} */ (told.at(-1)).id < first); // the other part has not answered
  solvers[0].answer(mapOf(1, { count: 1 }));
  const last = /** @type {LiveMap} */ (told.at(-1));
  assert.deepEqual([last.id, last.settled], [second, true]);
  assert.deepEqual([...last.pins.images], [1, 1, 2, 2]);
  assert.deepEqual([...last.pins.samples], [10, 20, 11, 21, 12, 22, 13, 23]);
});

test("a part without its last pin returns to rest, and the other stays where it is", () => {
  const { joint, solvers } = startedPair();
  joint.drag(poseOf([pinOf(0, [0, 0]), pinOf(1, [1, 1])]));
  joint.drag(poseOf([pinOf(0, [0, 0])]));
  const request = solvers[1].requests.at(-1);
  assert.ok(request?.type === "place");
  assert.deepEqual([...request.coefficients], [...RESTS[1]]);
  assert.equal(solvers[0].requests.length, 1);
});

test("maps of all are taken up together, and answered once all have proved theirs", async () => {
  const { joint, solvers } = startedPair();
  const asked = joint.map({
    type: "place",
    pose: poseOf([]),
    coefficients: Float64Array.of(1, 2, 3, 4, 5, 6, 7, 8),
  });
  const [request] = solvers[1].requests;
  assert.ok(request.type === "place");
  assert.deepEqual([...request.coefficients], [5, 6, 7, 8]);
  solvers[0].answer(mapOf(1, { sigma2: 0.3 }));
  solvers[1].answer(mapOf(1));
  assert.equal((await asked).certificate.sigma2_lower, 0.3);
  const failing = joint.map({
    type: "place",
    pose: poseOf([]),
    coefficients: new Float64Array(8),
  });
  solvers[0].answer(mapOf(2));
  solvers[1].answer({ type: "failed", id: 2, message: "it would fold" });
  await assert.rejects(failing, /fold/);
});

test("a change that no part has to solve is settled at once", async () => {
  const { joint, solvers, told } = startedPair();
  const number = joint.place(poseOf([]), new Float64Array(8));
  for (const { answer } of solvers) answer(mapOf(1));
  assert.equal(told.at(-1)?.id, number);
  const next = joint.drag(poseOf([]));
  await Promise.resolve();
  assert.deepEqual([told.at(-1)?.id, told.at(-1)?.settled], [next, true]);
});

test("a press finds the foremost part that is seen there; undo covers the pins of all parts", () => {
  const { joint, solvers } = startedPair();
  const clear = [() => true, (/** @type {Point} */ [x]) => x > 0.5];
  const shapes = clear.map((isSeen) => ({ mesh: SQUARE, isSeen }));
  const editing = new PartsEditing(joint, shapes, joint.newest, chained(RESTS));
  assert.deepEqual(editing.sourceAt([0.75, 0.5]), [0.75, 0.5, 1]);
  assert.deepEqual(editing.sourceAt([0.25, 0.5]), [0.25, 0.5, 0]);
  assert.equal(editing.sourceAt([3, 3]), null);
  editing.pin([0.75, 0.5]);
  editing.pin([0.25, 0.5]);
  assert.deepEqual(
    solvers.map(({ requests }) => requests.map(({ type }) => type)),
    [["drag"], ["drag"]],
  );
  editing.undo();
  assert.deepEqual(
    editing.pins.map(({ handle }) => handle[2]),
    [1],
  );
  editing.undo();
  assert.equal(editing.pins.length, 0);
});

test("a point where no part is seen belongs to the foremost one", () => {
  const { joint } = startedPair();
  const shapes = [0, 1].map(() => ({ mesh: SQUARE, isSeen: () => false }));
  const editing = new PartsEditing(joint, shapes, joint.newest, chained(RESTS));
  assert.equal(editing.sourceAt([0.75, 0.5])?.[2], 1);
});

test("the motion of all parts has the knots of each, and the worst bound", () => {
  const knot = (/** @type {number} */ x, sigma2 = 1) => ({
    coefficients: Float64Array.of(x, x, x, x),
    sigma2,
  });
  const repeat = /** @type {const} */ ("loop");
  const reel = jointReel([
    { times: [0, 2], knots: [knot(0), knot(4)], keyframes: [0, 2], repeat },
    { times: [0, 0.5, 2], knots: [knot(0), knot(8, 0.2), knot(2)], keyframes: [0, 2], repeat },
  ]);
  assert.deepEqual(reel.times, [0, 0.5, 2]);
  assert.deepEqual([...reel.knots[1].coefficients], [1, 1, 1, 1, 8, 8, 8, 8]);
  assert.deepEqual([...reel.knots[2].coefficients], [4, 4, 4, 4, 2, 2, 2, 2]);
  assert.equal(reel.knots[0].sigma2, 0.2);
  assert.deepEqual([reel.keyframes, reel.repeat], [[0, 2], "loop"]);
});

test("the lines of Python make the map of each part", () => {
  const parts = /** @type {PartData[]} */ (
    /** @type {unknown} */ (
      ["red", "blue"].map((name, i) => ({
        name,
        options: {},
        outline: { cage: [[i, 0.1]], holes: [] },
      }))
    )
  );
  const code = partsCode([pinOf(1, [2, 3])], parts);
  assert.match(code, /Cage\(\[\[0,0\.1\]\], \[\]\)\n.*handles=\[\],.*maps\["red"\] = result\.map/s);
  assert.match(
    code,
    /Cage\(\[\[1,0\.1\]\], \[\]\)\n.*handles=\[\[0\.5, 0\.25\]\],\n {4}targets=\[\[2, 3\]\]/s,
  );
});

test("parts that no file system tells apart have files of their own", () => {
  const names = partNames("Two", ["arm?", "arm*", "Arm", "arm-2", "?", "hat"]);
  const low = new Set(names.map((name) => name.toLowerCase()));
  assert.equal(low.size, names.length);
  assert.deepEqual(names.slice(0, 3), ["Two-arm", "Two-arm-2", "Two-Arm-3"]);
  assert.deepEqual(names.slice(4), ["Two", "Two-hat"]);
  assert.equal(
    new Set(partNames("a", ["e\u0301", "\u00e9"]).map((one) => one.normalize())).size,
    2,
  );
  assert.equal(new Set(partNames("a", ["straße", "STRASSE"])).size, 2);
});

test("a long title leaves room for the parts' numbers", () => {
  const names = partNames("title ".repeat(40), ["arm", "leg", "hat"]);
  assert.equal(new Set(names).size, 3);
  // The files are named after them as after a title, which cuts long ones.
  assert.deepEqual(
    names.map((title) => nameOf({ title })),
    names,
  );
});
