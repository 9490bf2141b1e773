// Where a drag with Shift or Ctrl puts a pin, and what is said of it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { constrained, pixelAt } from "../../glid_nb/page/js/canvas/constrain.js";
import { movedPin } from "../../glid_nb/page/js/canvas/numbers.js";

/** @import { Marks } from "../../glid_nb/page/js/canvas/traits.js" */
/** @import { Point } from "../../glid_nb/page/js/types.js" */

const SIZE = [200, 100]; // 10 pixels in a unit
const START = /** @type {Point} */ ([1.03, 2.04]);
const FREE = { axis: false, whole: false };

test("shift keeps a pin on the axis along which it was moved farther", () => {
  assert.deepEqual(constrained(START, [3, 2.5], { ...FREE, axis: true }, SIZE), [3, 2.04]);
  assert.deepEqual(constrained(START, [1.1, -4], { ...FREE, axis: true }, SIZE), [1.03, -4]);
  assert.deepEqual(constrained(START, [3, 2.5], FREE, SIZE), [3, 2.5]);
});

test("ctrl puts a pin on whole pixels, with shift only along the axis", () => {
  const near = constrained(START, [3.04, 2.56], { ...FREE, whole: true }, SIZE);
  assert.deepEqual(
    near.map((v) => Number(v.toFixed(9))),
    [3, 2.6],
  );
  assert.deepEqual(
    pixelAt(near, SIZE).map((v) => Number(v.toFixed(9))),
    [130, 24],
  );
  const [x, y] = constrained(START, [3.04, 2.5], { axis: true, whole: true }, SIZE);
  assert.equal(Number(x.toFixed(9)), 3);
  assert.equal(y, 2.04);
  assert.deepEqual(constrained(START, [3.04, 2.5], { ...FREE, whole: true }, []), [3.04, 2.5]);
});

test("the numbers are those of the pin that the hand moves", () => {
  /** @type {Marks} */
  const marks = {
    targets: [
      [1, 2],
      [-3, 0],
    ],
    images: [],
    selected: [1],
    hidden: [],
    ring: [Math.PI / 6, 1.5, true, true],
  };
  const held = new Map([[0, /** @type {Point} */ ([1.5, -2])]]);
  const pin = movedPin({ found: { mark: 0 }, pins: 2 }, marks, held, SIZE);
  assert.deepEqual(pin, { at: [1.5, -2], words: ["x 1.500   y −2.000"] });
  const keys = { axis: false, whole: true };
  const whole = movedPin({ found: { mark: 0 }, pins: 2, keys }, marks, held, SIZE);
  assert.deepEqual(whole?.words, ["x 1.500   y −2.000", "pixel 115, 70"]);
  // The ring says how far it turns and scales.
  const ring = movedPin({ found: { part: "knob" }, pins: 2 }, marks, new Map(), SIZE);
  assert.deepEqual(ring, { at: [-3, 0], words: ["30°", "× 1.50"] });
  // A pull on the shape has made the pin that is selected now; beside the shape it makes none.
  assert.equal(movedPin({ found: null, pins: 1 }, marks, new Map(), SIZE)?.at, marks.targets[1]);
  assert.equal(movedPin({ found: null, pins: 2 }, marks, new Map(), SIZE), null);
});
