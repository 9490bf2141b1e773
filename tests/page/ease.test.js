// The easings of the timeline as curves.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  handlesOf,
  nameOf,
  PRESETS,
  pathOf,
  withHandle,
} from "../../glid_nb/page/js/timeline/ease.js";

test("every preset has a name and a curve from corner to corner", () => {
  assert.deepEqual(
    PRESETS.map(([name]) => name),
    ["linear", "in", "out", "in-out", "hold"],
  );
  for (const [name, label] of PRESETS) {
    assert.equal(nameOf(name), label);
    assert.match(pathOf(name, 12), /^M0 12 .*12 0$/);
  }
  assert.equal(nameOf([0.1, 0, 0.2, 1]), "Curve");
});

test("the handles of the presets give their polynomials", () => {
  /** @type {Record<string, (s: number) => number>} */
  const wanted = {
    linear: (s) => s,
    in: (s) => s * s,
    out: (s) => s * (2 - s),
    "in-out": (s) => s * s * (3 - 2 * s),
  };
  const bezier = (/** @type {number} */ a, /** @type {number} */ b, /** @type {number} */ t) =>
    3 * t * (1 - t) ** 2 * a + 3 * t * t * (1 - t) * b + t ** 3;
  for (const [name, way] of Object.entries(wanted)) {
    const [x1, y1, x2, y2] = handlesOf(name) ?? assert.fail();
    for (const t of [0.1, 0.35, 0.8]) {
      assert.ok(Math.abs(bezier(x1, x2, t) - t) < 1e-12);
      assert.ok(Math.abs(bezier(y1, y2, t) - way(t)) < 1e-12);
    }
  }
  assert.equal(handlesOf("hold"), null);
});

test("a handle stays in the unit square, where time and way never run back", () => {
  assert.deepEqual(withHandle([0.1, 0.2, 0.3, 0.4], 0, [-2, 7]), [0, 1, 0.3, 0.4]);
  assert.deepEqual(withHandle([0.1, 0.2, 0.3, 0.4], 1, [0.123, 0.456]), [0.1, 0.2, 0.12, 0.46]);
  assert.deepEqual(withHandle("hold", 0, [0.5, 0]).slice(0, 2), [0.5, 0]);
});
