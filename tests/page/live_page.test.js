// The parts of the live page that need no browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Solving } from "../../glid_nb/page/js/live/solving.js";
import { coefficientsOf, movedVertices } from "../../glid_nb/page/js/live/wire.js";
import { Editing } from "../../glid_nb/page/js/live_page/editing.js";
import { nameOf } from "../../glid_nb/page/js/live_page/files.js";
import { History } from "../../glid_nb/page/js/live_page/history.js";
import { quicker, shaderSuffices, sharpness } from "../../glid_nb/page/js/live_page/measuring.js";
import { boxOf, divided, dividedTimes, sourceAt } from "../../glid_nb/page/js/live_page/mesh.js";
import {
  allowedScale,
  between,
  joined,
  nextPin,
  pinAt,
} from "../../glid_nb/page/js/live_page/pins.js";
import { lineThrough } from "../../glid_nb/page/js/live_page/plots.js";
import { hexText, proofFiles } from "../../glid_nb/page/js/live_page/proof_file.js";
import { pythonCode } from "../../glid_nb/page/js/live_page/python.js";
import { spokenOf } from "../../glid_nb/page/js/live_page/report.js";

/** @import { LiveAnswer, LiveMap, LiveRequest, Outline } from "../../glid_nb/page/js/live/types.js" */
/** @import { Handle } from "../../glid_nb/page/js/live_page/data.js" */
/** @import { Point } from "../../glid_nb/page/js/types.js" */
/** @import { Mesh } from "../../glid_nb/page/js/exported/renderer.js" */

/** @type {Mesh} a unit square of two triangles, the second one higher */
const SQUARE = {
  source: Float32Array.of(0, 0, 1, 0, 1, 1, 0, 1),
  heights: Float32Array.of(0, 0, 0.5, 1),
  triangles: [
    [0, 1, 2],
    [0, 2, 3],
  ],
};

test("a divided mesh covers the same area, and keeps its first vertices", () => {
  const finer = dividedTimes(SQUARE, 2);
  assert.equal(finer.triangles.length, 32);
  assert.deepEqual(finer.source.subarray(0, 8), SQUARE.source);
  const { source, triangles } = finer;
  const area = triangles.reduce((sum, [a, b, c]) => {
    const [ux, uy] = [source[2 * b] - source[2 * a], source[2 * b + 1] - source[2 * a + 1]];
    const [vx, vy] = [source[2 * c] - source[2 * a], source[2 * c + 1] - source[2 * a + 1]];
    assert.ok(ux * vy > uy * vx);
    return sum + (ux * vy - uy * vx) / 2;
  }, 0);
  assert.equal(area, 1);
  assert.equal(divided(SQUARE).source.length / 2, 9); // the diagonal's middle is one vertex
});

test("the source of a place is on the highest triangle there; beside the shape there is none", () => {
  const images = SQUARE.source.map((x) => 2 * x + 1);
  assert.deepEqual(sourceAt(SQUARE, images, [1.5, 2.5]), [0.25, 0.75]);
  assert.equal(sourceAt(SQUARE, images, [0, 0]), null);
  const folded = Float32Array.of(0, 0, 1, 0, 1, 1, 1, 0); // the second triangle lies on the first
  const [x, y] = sourceAt(SQUARE, folded, [0.8, 0.2]) ?? [0, 0];
  assert.ok(y > x);
  assert.deepEqual(boxOf(images), [1, 1, 3, 3]);
});

test("undo and redo walk through all states, and a change forgets what was undone", () => {
  /** @type {History<number>} */
  const history = new History();
  history.note(1);
  history.note(2);
  assert.equal(history.undo(3), 2);
  assert.equal(history.undo(2), 1);
  assert.equal(history.undo(1), undefined);
  assert.equal(history.redo(1), 2);
  history.note(2);
  assert.ok(!history.canRedo);
});

test("scales stay in their limits; the next pin goes round", () => {
  assert.equal(allowedScale(1e9), 20);
  assert.equal(allowedScale(0), 0.05);
  assert.deepEqual(
    [nextPin(3, 2, 1), nextPin(3, 0, -1), nextPin(3, undefined, 1), nextPin(3, undefined, -1)],
    [0, 2, 0, 2],
  );
  assert.equal(nextPin(0, undefined, 1), -1);
});

test("on the way between poses, a pin of one of them follows the shape in the other", () => {
  const first = [pinAt([0, 0], [1, 1])];
  const second = [{ ...pinAt([0, 0], [3, 5]), angle: 1 }, pinAt([4, 4], [5, 5])];
  const image = (/** @type {Handle} */ [x, y]) => /** @type {Point} */ ([x + 10, y]);
  const [leaving, arriving] = joined(first, second, image, image);
  assert.deepEqual(leaving[1].target, [14, 4]);
  const half = between(leaving, arriving, 0.5);
  assert.deepEqual(half[0].target, [2, 3]);
  assert.equal(half[0].angle, null); // free in one of them
  assert.deepEqual(half[1].target, [9.5, 4.5]);
});

test("angles turn the shorter way", () => {
  const pin = pinAt([0, 0], [0, 0]);
  const [half] = between([{ ...pin, angle: 3 }], [{ ...pin, angle: -3 }], 0.5);
  assert.ok(Math.abs(Math.abs(half.angle ?? 0) - Math.PI) < 1e-12);
});

test("numbers in a proof are what Python's float.hex writes", () => {
  assert.equal(hexText(1.5), "0x1.8000000000000p+0");
  assert.equal(hexText(-0.1), "-0x1.999999999999ap-4");
  assert.equal(hexText(0), "0x0.0p+0");
  assert.equal(hexText(2 ** -1074), "0x0.0000000000001p-1022");
});

test("the two files have the same numbers, and no -0", () => {
  const outline = { cage: [], holes: [], offset_cage: [], offset_holes: [], hole_points: [] };
  const coefficients = Float64Array.of(-0, 0.1, 0, 2);
  const bounds = { sigma2_lower: 0.5, sigma1_upper: 2, k_upper: 0.25 };
  const certificate = { certified: true, ...bounds, windings: [0], halved: 0, refused: -1 };
  const files = proofFiles(outline, { coefficients, certificate, panels: [[[0, 0]]] });
  const [map, proof] = [JSON.parse(files.map), JSON.parse(files.proof)];
  assert.deepEqual(map.phi, [[0, 0.1]]);
  assert.deepEqual(proof.phi, [[hexText(0), hexText(0.1)]]);
  assert.equal(proof.sigma1_upper, hexText(2));
  assert.deepEqual([proof.panels, proof.windings], [[[[0, 0]]], [0]]);
});

const OUTLINE = /** @type {Outline} */ (
  /** @type {unknown} */ ({
    cage: [
      [0, 0],
      [0.1, 0],
      [0, 1e-7],
    ],
    holes: [],
  })
);

test("a pose in Python names only what was asked for", () => {
  const pins = [pinAt([0, 0], [1, 2.5]), { ...pinAt([3, 0], [3, 0]), angle: 0.5 }];
  const code = pythonCode(pins, { options: { energy: "amips", s: 0.5 }, outline: OUTLINE });
  assert.match(code, /^cage = glid\.Cage\(\[\[0,0\],\[0\.1,0\],\[0,1e-7\]\], \[\]\)$/m);
  assert.match(code, /handles=\[\[0, 0\], \[3, 0\]\]/);
  assert.match(code, /angles=\[None, 0.5\]/);
  assert.doesNotMatch(code, /scales|weights|depths|names|p2p_weight/);
  assert.match(code, /solve\(domain, pose, glid.energies.AMIPS\(0.5\)\)/);
});

test("the module moves the vertices only where that is quicker", () => {
  assert.equal(quicker(40, 20, 5), "module");
  assert.equal(quicker(40, 20, 25), "shader");
  assert.ok(shaderSuffices(2) && !shaderSuffices(30));
});

test("a movement has fewer pixels only where drawing is slow, and a picture at rest has all", () => {
  assert.equal(sharpness(40, true), 0.5);
  assert.equal(sharpness(40, false), 1);
  assert.equal(sharpness(5, true), 1);
});

test("moved vertices are their images, then both derivatives", () => {
  const images = Float64Array.of(1, 2, 3, 4);
  const samples = Float64Array.of(5, 6, 7, 8, 9, 10, 11, 12);
  const moved = movedVertices({ images, samples });
  assert.deepEqual([...moved], [1, 2, 5, 7, 9, 11, 3, 4, 6, 8, 10, 12]);
});

test("holes' coefficients are tied exactly, whatever was rounded", () => {
  const row = Float32Array.of(1, 2, 0.3, 0.4, 5, 6, 0.3001, -0.4001); // one vertex, one hole
  const [pr, hr, pi, hi, qr, kr, qi, ki] = coefficientsOf(row, 1);
  assert.deepEqual([pr, pi, qr, qi], [1, 2, 5, 6]);
  assert.deepEqual([kr, ki], [hr, -hi]);
});

test("a plot's line ends at its right, and stays in the box", () => {
  const line = lineThrough([0, 5, 1], 100, 30, [0, 1]);
  assert.deepEqual(line[2], [98, 2]);
  assert.deepEqual(line[0][1], 28);
  assert.equal(line[1][1], 2);
});

/** A worker that keeps what it is asked. */
function fakeWorker() {
  /** @type {LiveRequest[]} */
  const requests = [];
  /** @type {import("../../glid_nb/page/js/live/solving.js").Port} */
  const port = { postMessage: (request) => requests.push(request), onmessage: null };
  const answer = (/** @type {LiveAnswer} */ data) => port.onmessage?.({ data });
  return { port, requests, answer };
}

/**
 * @param {number} id
 * @param {Partial<LiveMap>} [more]
 * @returns {LiveMap}
 */
function mapOf(id, more = {}) {
  const bounds = { sigma2_lower: 1, sigma1_upper: 1, k_upper: 0 };
  return {
    type: "map",
    id,
    settled: true,
    outcome: "minimal",
    energy: 2,
    coefficients: Float64Array.of(id),
    certificate: { certified: true, ...bounds, windings: [0], halved: 0, refused: -1 },
    images: Float64Array.from(SQUARE.source),
    samples: null,
    pins: { images: new Float64Array(), samples: new Float64Array() },
    steps: 0,
    took: 0,
    evaluated: 0,
    ...more,
  };
}

test("a request is answered by its last map; a failure rejects it", async () => {
  const { port, answer } = fakeWorker();
  const solving = new Solving(port);
  const asked = solving.map({ type: "solve", pose: { handles: [], targets: [] } });
  answer(mapOf(1, { settled: false, energy: 9 }));
  answer(mapOf(1, { energy: 3 }));
  assert.equal((await asked).energy, 3);
  const failing = solving.ask({ type: "claim" });
  answer({ type: "failed", id: 2, message: "why" });
  await assert.rejects(failing, /why/);
});

function startedEditing() {
  const { port, requests, answer } = fakeWorker();
  const editing = new Editing(new Solving(port), SQUARE, mapOf(0));
  return { editing, requests, answer };
}

test("a gesture is one step of undo, and undo brings the certified map back", () => {
  const { editing, requests, answer } = startedEditing();
  assert.ok(editing.pin([0.5, 0.25]));
  answer(mapOf(1));
  editing.beginGesture();
  editing.move(new Map([[0, [0.6, 0.3]]]));
  editing.move(new Map([[0, [0.9, 0.9]]]));
  editing.endGesture();
  answer(mapOf(3));
  editing.undo();
  assert.deepEqual(editing.pins[0].target, [0.5, 0.25]);
  const place = requests.find(({ type }) => type === "place");
  assert.ok(place?.type === "place");
  assert.deepEqual([...place.coefficients], [1]);
  editing.redo();
  assert.deepEqual(editing.pins[0].target, [0.9, 0.9]);
  editing.undo();
  editing.undo();
  assert.deepEqual([editing.pins.length, editing.canUndo], [0, false]);
});

test("no map is taken that is not certified, or that belongs to pins of before", () => {
  const { editing, answer } = startedEditing();
  editing.pin([0.5, 0.25]);
  const uncertified = { ...mapOf(1).certificate, certified: false };
  answer(mapOf(1, { certificate: uncertified }));
  assert.equal(editing.frame.id, 0);
  editing.remove();
  answer(mapOf(1));
  assert.equal(editing.frame.id, 0);
  answer(mapOf(2));
  assert.equal(editing.frame.id, 2);
});

test("beside the shape nothing is pinned; a cancelled gesture leaves no step", () => {
  const { editing } = startedEditing();
  assert.ok(!editing.pin([5, 5]));
  editing.beginGesture();
  editing.pin([0.5, 0.25]);
  editing.cancelGesture();
  assert.deepEqual([editing.pins.length, editing.canUndo], [0, false]);
});

test("a pin that the shape does not follow is named once the shape is at rest", () => {
  const { editing, answer } = startedEditing();
  editing.pin([0.5, 0.25]);
  const pins = { images: Float64Array.of(3, 3), samples: Float64Array.of(0, 2, 0, 0) };
  answer(mapOf(1, { pins, settled: false }));
  assert.deepEqual(editing.missed, []);
  answer(mapOf(1, { pins, outcome: "refused" }));
  assert.deepEqual(editing.missed, [0]);
  assert.ok(editing.refused);
  assert.match(spokenOf(editing), /does not reach pin 1/);
  assert.deepEqual(editing.turnOf(0), { angle: Math.PI / 2, scale: 2 });
});

test("the lines of Python have the stiff areas", () => {
  const stiffness = [
    {
      points: [
        [0, 1],
        [2, 3],
      ],
      radius: 0.5,
      strength: 1,
    },
  ];
  const code = pythonCode([], { options: {}, stiffness, outline: OUTLINE });
  assert.match(code, /stiffness=\[\{"points":\[\[0,1\],\[2,3\]\],"radius":0\.5,"strength":1\}\],/);
});

test("a pose in Python has the pins' depths and names, quoted", () => {
  const named = { ...pinAt([3, 0], [3, 0]), weight: 2, depth: -1, name: 'the "tail"' };
  const code = pythonCode([pinAt([0, 0], [0, 0]), named], { options: {}, outline: OUTLINE });
  assert.match(code, /depths=\[0, -1\],\n/);
  assert.match(code, /weights=\[1, 2\],\n/);
  assert.match(code, /names=\["", "the \\"tail\\""\],\n/);
});

test("files have the title's letters, and no command takes their names for options", () => {
  assert.equal(nameOf({ title: "Écureuil été" }), "Écureuil-été");
  assert.equal(nameOf({ title: "ヤモリ" }), "ヤモリ");
  assert.equal(nameOf({ title: "--force ../x" }), "force-x");
  assert.equal(nameOf({ title: " ?! " }), "picture");
  assert.equal(nameOf({ title: "x".repeat(300) }).length, 80);
});

test("screen readers hear that there are no pins", () => {
  const nothing = { pins: [], selected: [], missed: [], inGesture: false };
  assert.equal(spokenOf(nothing), "No pins");
});
