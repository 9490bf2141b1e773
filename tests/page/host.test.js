// A live page in a frame, and the program around it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { joinHost } from "../../glid_nb/page/js/live_page/host.js";
import { pinAt } from "../../glid_nb/page/js/live_page/pins.js";

/** @import { Coefficients } from "../../glid_nb/page/js/live/types.js" */
/** @import { Message } from "../../glid_nb/page/js/live_page/host.js" */
/** @import { Pin } from "../../glid_nb/page/js/live_page/data.js" */

/** A page whose maps are found by `settle`, and what the program around it hears. */
function framed() {
  /** @type {Message[]} */
  const heard = [];
  const parent = { postMessage: (/** @type {Message} */ message) => heard.push(message) };
  const page = Object.assign(new EventTarget(), { parent });
  const editing = {
    pins: /** @type {readonly Pin[]} */ ([]),
    frame: { id: 1, coefficients: /** @type {Coefficients} */ (Float64Array.of(0)) },
    settled: true,
    inGesture: false,
    replace: (/** @type {readonly Pin[]} */ pins, /** @type {Coefficients} */ coefficients) => {
      editing.pins = pins;
      editing.frame = { id: editing.frame.id + 1, coefficients };
      editing.settled = false;
    },
  };
  const tell = joinHost(editing, /** @type {Window} */ (/** @type {unknown} */ (page)));
  const settle = (/** @type {number} */ value) => {
    editing.frame = { id: editing.frame.id + 1, coefficients: Float64Array.of(value) };
    editing.settled = true;
    tell();
  };
  const say = (/** @type {unknown} */ data, /** @type {unknown} */ source = parent) =>
    page.dispatchEvent(Object.assign(new Event("message"), { data, source }));
  return { heard, editing, tell, settle, say };
}

test("a map is told once, when the page is at rest and the hand is off", () => {
  const { heard, editing, tell, settle } = framed();
  assert.deepEqual(heard, [{ glid: "ready" }]);
  tell();
  assert.equal(heard.length, 1); // nothing has changed
  editing.pins = [pinAt([0, 0], [1, 0])];
  editing.inGesture = true;
  settle(5);
  assert.equal(heard.length, 1);
  editing.inGesture = false;
  tell();
  tell();
  assert.deepEqual(heard.slice(1), [{ glid: "edit", pins: editing.pins, coefficients: [5] }]);
});

test("a pose from outside is taken, and answered unless it is quiet", () => {
  const { heard, editing, settle, say } = framed();
  const edit = { glid: "edit", pins: [pinAt([0, 0], [2, 0])], coefficients: [3] };
  say(edit, {}); // from another window
  say({ glid: "other" });
  assert.deepEqual(editing.pins, []);
  say(edit);
  assert.deepEqual(editing.frame.coefficients, Float64Array.of(3));
  settle(4);
  assert.deepEqual(heard[1], { ...edit, coefficients: [4] });
  say({ ...edit, quiet: true });
  settle(6);
  assert.equal(heard.length, 2);
  settle(7); // the hand goes back to these pins, as undo does
  assert.deepEqual(heard[2], { ...edit, coefficients: [7] });
});

test("a page in a window of its own tells nobody", () => {
  const alone = new EventTarget();
  Object.assign(alone, { parent: alone });
  const { editing } = framed();
  const tell = joinHost(editing, /** @type {Window} */ (/** @type {unknown} */ (alone)));
  editing.frame = { id: 9, coefficients: Float64Array.of(0) };
  assert.equal(tell(), undefined);
});
