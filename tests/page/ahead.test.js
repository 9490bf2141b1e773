// The page's own solver ahead of the kernel, and vertices that the page moves.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Ahead, marksOf } from "../../glid_nb/page/js/canvas/ahead.js";
import { Vertices } from "../../glid_nb/page/js/canvas/vertices.js";
import { LiveWorker } from "../../glid_nb/page/js/live/live.js";
import { identityOf, Wire } from "../../glid_nb/page/js/live/wire.js";
import { fakeModel } from "./fakes.js";
import { golden } from "./live/golden.js";

/** @import { Lead } from "../../glid_nb/page/js/canvas/ahead.js" */
/** @import { Outlined } from "../../glid_nb/page/js/canvas/traits.js" */
/** @import { Outline } from "../../glid_nb/page/js/live/types.js" */
/** @import { Port } from "../../glid_nb/page/js/live/solving.js" */
/** @import { Point } from "../../glid_nb/page/js/types.js" */

const { outline, pose, coefficients, points, images, fz } = golden("teapot"); // with a hole

/**
 * @param {Outline} of
 * @returns {Outlined}
 */
function outlinedOf(of) {
  const loops = [of.offset_cage, ...of.offset_holes];
  const chain = loops.reduce((sum, loop) => sum + loop.length + 1, 0);
  return { outline: of, chain: chain + 1, shaderHoles: Math.max(2, of.hole_points.length) };
}

test("a map in the shader's form gives its coefficients back, in single precision", () => {
  const { outline: _, ...sizes } = outlinedOf(outline);
  const wire = new Wire(outline, sizes);
  const floats = wire.of(Float64Array.from(coefficients));
  assert.equal(floats.length, wire.length);
  const back = wire.coefficients(floats);
  assert.deepEqual([...back], coefficients.map(Math.fround));
});

/**
 * A mesh with a vertex at each point, as three.js has it.
 * @param {string} name
 * @param {Point[]} at
 */
function meshAt(name, at) {
  const position = {
    array: Float32Array.from(at.flatMap(([x, y]) => [x, y, 0])),
    count: at.length,
  };
  const image = { array: new Float32Array(2 * at.length), count: at.length, version: 0 };
  const derivatives = { array: new Float32Array(4 * at.length), version: 0 };
  const geometry = { attributes: { position, image, derivatives }, userData: {} };
  const material = { uniforms: { overlay: { value: 2 } } };
  return { name, visible: true, geometry, material };
}

test("the page moves the vertices of its meshes, and of no other ones", () => {
  const outlined = outlinedOf(outline);
  const wire = new Wire(outline, outlined).of(Float64Array.from(coefficients));
  const ours = meshAt("moved by the page", points);
  const others = [meshAt("", points), { ...meshAt("moved by the page", points), visible: false }];
  new Vertices(outlined).move([ours, ...others], wire);
  const { image, derivatives } = ours.geometry.attributes;
  const wanted = images.flat();
  assert.ok(wanted.every((value, i) => Math.abs(value - image.array[i]) < 1e-4));
  assert.ok(fz.every(([re], i) => Math.abs(re - derivatives.array[4 * i]) < 1e-4));
  assert.ok(fz.every(([, im], i) => Math.abs(im - derivatives.array[4 * i + 1]) < 1e-4));
  assert.ok(image.version > 0 && derivatives.version > 0);
  for (const { geometry } of others) {
    assert.ok(geometry.attributes.image.array.every((value) => value === 0));
  }
});

test("derivatives are computed where something shows them", () => {
  const outlined = outlinedOf(outline);
  const wire = new Wire(outline, outlined).of(Float64Array.from(coefficients));
  const mesh = meshAt("moved by the page", points);
  const { image, derivatives } = mesh.geometry.attributes;
  const { overlay } = mesh.material.uniforms;
  overlay.value = 0; // the plain picture
  const vertices = new Vertices(outlined);
  vertices.move([mesh], wire);
  assert.ok(image.version > 0 && derivatives.version === 0);
  overlay.value = 1; // the grid
  vertices.move([mesh], wire);
  assert.ok(derivatives.version > 0);
  assert.ok(fz.every(([re], i) => Math.abs(re - derivatives.array[4 * i]) < 1e-4));
});

/** A solver in this thread, and what a canvas sees of it. */
async function started(changes = {}) {
  const rest = Float64Array.from(identityOf(outline));
  const { handles } = pose;
  const model = fakeModel({
    solver_script: "of the worker",
    solver: { options: { energy: "iso" } },
    outline: outlinedOf(outline),
    rest: {
      number: 1,
      pose: { handles, targets: handles },
      coefficients: new DataView(rest.buffer),
    },
    marks: { targets: handles, images: handles, selected: [0], hidden: [], ring: [0, 1, 0, 0] },
    ...changes,
  });
  /** @type {(Lead | null)[]} */
  const shown = [];
  /** @type {(() => void)[]} */
  const turns = [];
  const ended = { count: 0 };
  const makeWorker = () => {
    /** @type {Port} */
    const port = {
      onmessage: null,
      postMessage: (request) => {
        worker.receive(request);
        if (request.type === "shape") queueMicrotask(run);
      },
      terminate: () => {
        ended.count += 1;
      },
    };
    const worker = new LiveWorker(
      (data) => port.onmessage?.({ data }),
      (turn) => turns.push(turn),
    );
    return port;
  };
  const run = () => {
    for (let i = 0; i < 200 && turns.length > 0; i++) turns.shift()?.();
  };
  const ahead = new Ahead(/** @type {any} */ (model), (lead) => shown.push(lead), makeWorker);
  await ahead.prepare();
  return { ahead, model, shown, run, ended };
}

/** @param {number} t how far the last pin is moved */
function dragged(t) {
  const last = pose.handles.length - 1;
  const [x, y] = pose.handles[last];
  const [u, v] = pose.targets[last];
  return new Map([[last, /** @type {Point} */ ([x + t * (u - x), y + t * (v - y)])]]);
}

test("dragged pins are followed from the kernel's map until it has its next one", async () => {
  const { ahead, shown, run } = await started();
  ahead.follow(dragged(0.2));
  run();
  ahead.follow(dragged(0.3));
  run();
  assert.ok(ahead.leads);
  const last = shown.at(-1);
  const [[pin, target]] = dragged(0.3);
  assert.ok(last);
  assert.deepEqual(last.pins.targets[pin], target);
  const [x, y] = last.pins.images[pin];
  assert.ok(Math.hypot(x - target[0], y - target[1]) < 0.05);
  assert.equal(last.floats.length, new Wire(outline, outlinedOf(outline)).length);
  ahead.giveBack();
  assert.equal(shown.at(-1), null);
  assert.ok(!ahead.leads);
});

test("maps that come after the kernel's are not shown", async () => {
  const { ahead, shown, run } = await started();
  ahead.follow(dragged(0.3));
  ahead.giveBack();
  const count = shown.length;
  run();
  assert.equal(shown.length, count);
});

test("the page leads only from where the kernel is, with the same pins", async () => {
  const moved = pose.handles.map(([x, y]) => [x + 0.1, y]);
  const elsewhere = {
    marks: { targets: moved, images: moved, selected: [], hidden: [], ring: [] },
  };
  const fewer = {
    marks: { targets: moved.slice(1), images: [], selected: [], hidden: [], ring: [] },
  };
  for (const changes of [{ rest: {} }, { solver: {} }, { solver_script: "" }, elsewhere, fewer]) {
    const { ahead, shown, run } = await started(changes);
    ahead.follow(dragged(0.3));
    run();
    assert.ok(!ahead.leads);
    assert.deepEqual(shown, []);
  }
});

test("a hand that is still asks for nothing", async () => {
  const { ahead, shown, run } = await started();
  ahead.follow(dragged(0.2));
  run();
  const count = shown.length;
  ahead.follow(dragged(0.2));
  run();
  assert.equal(shown.length, count);
});

test("another problem starts another worker, and the old one ends", async () => {
  const { ahead, shown, run, ended } = await started();
  ahead.follow(dragged(0.2));
  run();
  await ahead.prepare();
  assert.equal(ended.count, 1);
  assert.equal(shown.at(-1), null);
  ahead.follow(dragged(0.2));
  run();
  assert.ok(ahead.leads);
  ahead.close();
  assert.equal(ended.count, 2);
});

test("pins are drawn where the lead has them, while they are the same ones", () => {
  /** @type {Point[]} */
  const one = [[1, 2]];
  const marks = { targets: one, images: one, selected: [0], hidden: [0], ring: [0.5, 1, 1, 0] };
  /** @type {Lead} */
  const lead = {
    floats: new Float32Array(),
    pins: { targets: [[3, 4]], images: [[3, 5]], samples: Float64Array.of(0, 2, 0, 0) },
  };
  const shown = marksOf(/** @type {any} */ (marks), lead);
  assert.deepEqual([shown.targets, shown.images, shown.hidden], [[[3, 4]], [[3, 5]], [0]]);
  assert.deepEqual(shown.ring, [0.5, 2, 1, 0]); // the angle is wanted, the scale is the map's
  assert.deepEqual(marksOf(/** @type {any} */ (marks), null), marks);
  const more = { ...marks, targets: [...one, ...one] };
  assert.deepEqual(marksOf(/** @type {any} */ (more), lead), more);
});
