// Pointers and keys over a picture, without a page.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";
import { Pad } from "../../glid_nb/page/js/pad/pad.js";
import { View } from "../../glid_nb/page/js/pad/view.js";

/** @import { KernelEvent, Mark, Point } from "../../glid_nb/page/js/types.js" */
/** @import { Behaviour } from "../../glid_nb/page/js/pad/pad.js" */

const PIN = /** @type {Point} */ ([0, 0]); // in the world: the middle of the element

beforeEach(() => {
  mock.timers.reset();
  mock.timers.enable({ apis: ["setTimeout"] });
});

/** An element of 400 x 300 pixels. */
class FakeElement extends EventTarget {
  style = { cursor: "" };
  tabIndex = -1;
  focus() {}
  setPointerCapture() {}
  matches() {
    return true;
  }
  offsetWidth = 400;
  offsetHeight = 300;
  box = { left: 0, top: 0, width: 400, height: 300 };
  getBoundingClientRect() {
    return this.box;
  }
}

/**
 * A pad over a pin, and all that is around it.
 *
 * @param {Partial<Behaviour>} changes
 */
function padWith(changes = {}) {
  /** @type {KernelEvent[]} */
  const sent = [];
  /** @type {((refusal: null) => void)[]} */
  const answers = [];
  const link = {
    signal: new AbortController().signal,
    put(/** @type {KernelEvent} */ event) {
      sent.push(event);
      return new Promise((resolve) => answers.push(resolve));
    },
  };
  /** @type {Behaviour} */
  const behaviour = {
    reach: { mouse: 10, touch: 20 },
    keys: /^(Delete|a)$/,
    actions: {},
    find: ([x, y], reach) => (Math.hypot(x, y) <= reach ? { mark: 0 } : null),
    held: ({ mark }) => new Map([[/** @type {Mark} */ (mark), PIN]]),
    cursor: (found) => (found ? "grab" : "crosshair"),
    changed() {},
    ...changes,
  };
  const view = new View(() => {}, { nearest: 0.01, farthest: 10 });
  Object.assign(view, { unit: 0.1, width: 400, height: 300 });
  const element = new FakeElement();
  const pad = new Pad(/** @type {any} */ (element), view, /** @type {any} */ (link), behaviour);
  const fire = (/** @type {string} */ type, /** @type {Record<string, unknown>} */ more) => {
    const event = Object.assign(new Event(type, { cancelable: true }), more);
    element.dispatchEvent(event);
    return event;
  };
  const pointer = (
    /** @type {string} */ type,
    /** @type {number} */ clientX,
    /** @type {number} */ clientY,
    more = {},
  ) =>
    fire(`pointer${type}`, {
      pointerId: 1,
      pointerType: "mouse",
      button: 0,
      clientX,
      clientY,
      ...more,
    });
  const answer = async () => {
    for (const resolve of answers.splice(0)) resolve(null);
    await Promise.resolve();
  };
  return { pad, view, element, sent, fire, pointer, answer, types: () => sent.map((e) => e.type) };
}

test("a drag goes to the kernel in the world's units, and moves what it holds at once", async () => {
  const { pad, pointer, sent, types, answer } = padWith();
  pointer("down", 200, 150);
  pointer("move", 220, 150);
  assert.deepEqual(pad.held.get(0), [2, 0]);
  pointer("up", 220, 150);
  assert.deepEqual(types(), ["down", "move", "up"]);
  assert.deepEqual([sent[1].x, sent[1].y, sent[1].reach], [2, 0, 1]);
  assert.equal(sent[1].replaces, "move 1");
  assert.equal(pad.held.size, 1); // until the kernel's place is known
  await answer();
  assert.equal(pad.held.size, 0);
});

test("the right button drags nothing", () => {
  const { pad, pointer } = padWith();
  pointer("down", 200, 150, { button: 2 });
  pointer("move", 220, 150);
  assert.equal(pad.held.size, 0);
});

test("the middle button, and the left one with Space, move the view and send nothing", () => {
  for (const [button, space] of /** @type {[number, boolean][]} */ ([
    [1, false],
    [0, true],
  ])) {
    const { view, fire, pointer, types } = padWith();
    if (space) fire("keydown", { key: " " });
    pointer("down", 100, 100, { button });
    pointer("move", 110, 100);
    assert.equal(view.x, -1);
    assert.deepEqual(types(), []);
  }
});

test("a tap on Space plays; one that moved the view does not", () => {
  const tapped = mock.fn();
  const { fire, pointer } = padWith({ tapped });
  fire("keydown", { key: " " });
  fire("keyup", { key: " " });
  assert.equal(tapped.mock.callCount(), 1);
  fire("keydown", { key: " " });
  pointer("down", 100, 100);
  fire("keyup", { key: " " });
  assert.equal(tapped.mock.callCount(), 1);
});

test("where the left button moves the view, a click is still the kernel's", () => {
  const { view, pointer, types } = padWith({ pans: () => true, find: () => null });
  pointer("down", 100, 100);
  pointer("move", 102, 100);
  pointer("up", 102, 100);
  assert.deepEqual(types(), ["down", "move", "up"]);
  assert.equal(view.x, 0);
  pointer("down", 100, 100);
  pointer("move", 110, 100);
  assert.equal(types().at(-1), "cancel");
  assert.equal(view.x, -1);
});

test("a second finger takes the first one's gesture back, and both zoom", () => {
  const { pad, view, pointer, types } = padWith();
  const finger = { pointerType: "touch" };
  pointer("down", 200, 150, finger);
  pointer("down", 300, 150, { ...finger, pointerId: 2 });
  assert.deepEqual(types(), ["down", "cancel"]);
  assert.equal(pad.held.size, 0);
  pointer("move", 400, 150, { ...finger, pointerId: 2 });
  assert.equal(view.unit, 0.05);
});

test("a long touch opens the menu and is no drag; one that moves is", () => {
  const menu = mock.fn();
  const still = padWith({ menu });
  still.pointer("down", 200, 150, { pointerType: "touch" });
  mock.timers.tick(600);
  mock.timers.tick(100);
  assert.equal(menu.mock.callCount(), 1);
  assert.deepEqual(still.types(), ["down", "cancel"]);
  const moved = padWith({ menu });
  moved.pointer("down", 200, 150, { pointerType: "touch" });
  moved.pointer("move", 220, 150, { pointerType: "touch" });
  mock.timers.tick(1000);
  assert.equal(menu.mock.callCount(), 1);
});

test("a box has the corners of the drag, and goes to the kernel when it ends", () => {
  const { pointer, sent, types } = padWith({ find: () => null, encloses: () => "box" });
  pointer("down", 100, 100, { shiftKey: true });
  pointer("move", 200, 150, { shiftKey: true });
  pointer("up", 200, 150, { shiftKey: true });
  assert.deepEqual(types(), ["down", "up"]);
  assert.equal(sent[1].encloses, true);
  assert.equal(/** @type {Point[]} */ (sent[1].path).length, 4);
});

test("only the pad's keys go to the kernel; the page's own act at once", () => {
  const help = mock.fn();
  const { fire, sent, types } = padWith({ actions: { "?": help } });
  fire("keydown", { key: "?" });
  assert.equal(help.mock.callCount(), 1);
  const other = fire("keydown", { key: "q" });
  assert.ok(!other.defaultPrevented);
  fire("keydown", { key: "Delete" });
  fire("keydown", { key: "z", ctrlKey: true });
  fire("keydown", { key: "a", ctrlKey: true });
  fire("keydown", { key: "Delete", ctrlKey: true });
  assert.deepEqual(types(), ["key", "key", "key"]);
  assert.deepEqual(
    sent.map(({ key }) => key),
    ["Delete", "undo", "a"],
  );
});

test("the cursor tells what is below the pointer, and what is held", () => {
  const { element, pointer } = padWith();
  pointer("move", 100, 100);
  assert.equal(element.style.cursor, "crosshair");
  pointer("move", 200, 150);
  assert.equal(element.style.cursor, "grab");
  pointer("down", 200, 150);
  assert.equal(element.style.cursor, "grabbing");
});

test("a wheel zooms with the focus; else it scrolls the page, unless the pad is the page", () => {
  const wheel = { deltaY: 100, deltaMode: 0, clientX: 0, clientY: 0 };
  const wheeled = (/** @type {boolean} */ focused, /** @type {boolean} */ ownsWheel, more = {}) => {
    const { element, fire, view } = padWith({ ownsWheel });
    element.matches = () => focused;
    const { defaultPrevented } = fire("wheel", { ...wheel, ...more });
    assert.equal(view.unit > 0.1, defaultPrevented);
    return defaultPrevented;
  };
  assert.equal(wheeled(true, false), true);
  assert.equal(wheeled(false, false), false);
  assert.equal(wheeled(false, false, { ctrlKey: true }), true); // a pinch on a touchpad
  assert.equal(wheeled(false, true), true);
});

test("a pad that the page has zoomed or scaled finds the pointer in its own pixels", () => {
  const { element, pointer, sent } = padWith();
  element.box = { left: 50, top: 20, width: 500, height: 150 };
  pointer("down", 50 + 1.25 * 220, 20 + 0.5 * 140);
  assert.deepEqual([sent[0].x, sent[0].y], [2, 1]);
});

test("keys of other scripts go to the kernel by their places", () => {
  const { fire, sent } = padWith();
  fire("keydown", { key: "ф", code: "KeyA" });
  fire("keydown", { key: "я", code: "KeyZ", ctrlKey: true });
  assert.deepEqual(
    sent.map(({ key }) => key),
    ["a", "undo"],
  );
});

test("a drag goes where its behaviour puts it, also with shift", () => {
  const { pointer, sent, pad } = padWith({ constrain: ([x]) => [x, 0] });
  pointer("down", 200, 150, { shiftKey: true });
  pointer("move", 230, 120, { shiftKey: true });
  const move = sent.at(-1);
  assert.deepEqual([move?.type, move?.x, move?.y], ["move", 3, 0]);
  assert.deepEqual(pad.held.get(0), [3, 0]);
});
