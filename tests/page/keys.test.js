// Keys for the history, and the menus' rows.

import assert from "node:assert/strict";
import { test } from "node:test";
import { menuRows } from "../../glid_nb/page/js/canvas/context_menu.js";
import { keyOf, undoOrRedo } from "../../glid_nb/page/js/pad/keys.js";

/** @import { PinMarks } from "../../glid_nb/page/js/canvas/traits.js" */

const PLAIN = { ctrlKey: false, metaKey: false, shiftKey: false };

test("Ctrl or Cmd with Z undoes, with Shift and Z or with Y redoes", () => {
  assert.equal(undoOrRedo({ ...PLAIN, key: "z", ctrlKey: true }), "undo");
  assert.equal(undoOrRedo({ ...PLAIN, key: "Z", metaKey: true, shiftKey: true }), "redo");
  assert.equal(undoOrRedo({ ...PLAIN, key: "y", ctrlKey: true }), "redo");
  assert.equal(undoOrRedo({ ...PLAIN, key: "z" }), null);
  assert.equal(undoOrRedo({ ...PLAIN, key: "a", ctrlKey: true }), null);
});

test("keyboards of other scripts have the shortcuts of Latin ones, by the place of a key", () => {
  for (const key of ["я", "ζ", "ז", "ئ"]) {
    assert.equal(undoOrRedo({ ...PLAIN, key, code: "KeyZ", ctrlKey: true }), "undo");
  }
  assert.equal(
    undoOrRedo({ ...PLAIN, key: "Я", code: "KeyZ", ctrlKey: true, shiftKey: true }),
    "redo",
  );
  assert.equal(keyOf({ key: "х", code: "BracketLeft" }), "[");
  assert.equal(keyOf({ key: "Ю", code: "Period", shiftKey: true }), ">");
  assert.equal(keyOf({ key: "٠", code: "Digit0" }), "0");
});

test("Latin keyboards of any arrangement say themselves what they type", () => {
  assert.equal(keyOf({ key: "w", code: "KeyZ" }), "w"); // French
  assert.equal(keyOf({ key: "ö", code: "Semicolon" }), "ö");
  assert.equal(keyOf({ key: "Escape", code: "Escape" }), "Escape");
  assert.equal(keyOf({ key: "Dead", code: "Equal" }), "Dead");
});

/**
 * The menu's labels, and the keys that its rows press.
 *
 * @param {number[] | null} pins
 * @param {boolean} covered
 * @param {Partial<PinMarks>} [marks]
 */
function menu(pins, covered, marks = {}) {
  /** @type {string[]} */
  const pressed = [];
  const nothing = () => {};
  const press = (/** @type {string} */ key, shift = false) => {
    return () => void pressed.push(shift ? `Shift+${key}` : key);
  };
  const does = {
    press,
    pin: nothing,
    paste: nothing,
    alone: nothing,
    fullScreen: nothing,
    showKeys: nothing,
  };
  const known = { locked: [], away: [], groups: [], ...marks };
  const rows = menuRows(does, pins, covered, known).filter((row) => row !== null);
  for (const [, , act] of rows) act();
  return { labels: rows.map(([label]) => label), pressed };
}

test("the menu of several pins removes all of them", () => {
  const { labels, pressed } = menu([0, 1, 2], false);
  assert.ok(labels.includes("Remove 3 pins"));
  assert.ok(labels.includes("Group"));
  assert.ok(pressed.includes("Shift+Delete"));
  const { labels: one } = menu([0], false);
  assert.ok(one.includes("Remove") && one.includes("Hide") && !one.includes("Group"));
});

test("the menu says whether its pins will be locked or unlocked", () => {
  const locked = [0, 1];
  assert.ok(menu([2], false, { locked }).labels.includes("Lock"));
  assert.ok(menu([1, 2], false, { locked }).labels.includes("Lock"));
  assert.ok(menu([0, 1], false, { locked }).labels.includes("Unlock"));
  for (const pins of [[2], [0, 1]]) {
    assert.ok(menu(pins, false, { locked }).pressed.includes("l"));
  }
});

test("a pin is offered only where the shape is", () => {
  assert.equal(menu(null, true).labels[0], "Add a pin here");
  assert.equal(menu(null, false).labels[0], "Copy the pose");
  const { labels, pressed } = menu(null, false, { away: [1] });
  assert.equal(labels[0], "Show hidden pins");
  assert.equal(pressed[0], "Shift+h");
});
