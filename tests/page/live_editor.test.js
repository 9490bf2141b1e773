// The live page of a widget, and the kernel that hears of its maps.

import assert from "node:assert/strict";
import { test } from "node:test";
import { joined } from "../../glid_nb/page/js/live_editor/joined.js";
import { pinAt } from "../../glid_nb/page/js/live_page/pins.js";

/** @import { Coefficients } from "../../glid_nb/page/js/live/types.js" */
/** @import { Edit } from "../../glid_nb/page/js/live_editor/joined.js" */
/** @import { Pin } from "../../glid_nb/page/js/live_page/data.js" */

/** A page whose maps are found by `settle`, and what is heard of them. */
function page() {
  /** @type {Edit[]} */
  const heard = [];
  let drawn = 0;
  const editing = {
    pins: /** @type {readonly Pin[]} */ ([]),
    frame: { id: 1, coefficients: /** @type {Coefficients} */ (Float64Array.of(0)) },
    settled: true,
    inGesture: false,
    told: () => {
      drawn++;
    },
    replace: (/** @type {readonly Pin[]} */ pins, /** @type {Coefficients} */ coefficients) => {
      editing.pins = pins;
      editing.frame = { id: editing.frame.id + 1, coefficients };
      editing.settled = false;
      editing.told();
    },
  };
  const show = joined(editing, (edit) => heard.push(edit));
  const settle = (/** @type {number} */ value) => {
    editing.frame = { id: editing.frame.id + 1, coefficients: Float64Array.of(value) };
    editing.settled = true;
    editing.told();
  };
  return { heard, editing, show, settle, draws: () => drawn };
}

test("a map is told once, when the page is at rest and no hand is on it", () => {
  const { heard, editing, settle, draws } = page();
  editing.told();
  assert.equal(heard.length, 0); // nothing has changed
  editing.pins = [pinAt([0, 0], [1, 0])];
  editing.inGesture = true;
  settle(5);
  assert.equal(heard.length, 0);
  editing.inGesture = false;
  editing.told();
  editing.told();
  assert.deepEqual(heard, [{ pins: editing.pins, coefficients: [5] }]);
  assert.equal(draws(), 4); // the page itself hears of every change
});

test("a pose of the kernel is solved and told, one of another view only shown", () => {
  const { heard, editing, show, settle } = page();
  const edit = { pins: [pinAt([0, 0], [2, 0])], coefficients: [3] };
  show(edit, false);
  assert.deepEqual(editing.frame.coefficients, Float64Array.of(3));
  settle(4);
  assert.deepEqual(heard, [{ ...edit, coefficients: [4] }]);
  show(edit, true);
  settle(6);
  assert.equal(heard.length, 1);
  settle(7); // the hand goes back to these pins, as undo does
  assert.deepEqual(heard[1], { ...edit, coefficients: [7] });
});
