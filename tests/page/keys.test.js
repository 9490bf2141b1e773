// Keys for the history, and the menus' rows.

import assert from "node:assert/strict";
import { test } from "node:test";
import { menuRows } from "../../glid_nb/page/js/canvas/context_menu.js";
import { undoOrRedo } from "../../glid_nb/page/js/pad/keys.js";

const PLAIN = { ctrlKey: false, metaKey: false, shiftKey: false };

test("Ctrl or Cmd with Z undoes, with Shift and Z or with Y redoes", () => {
  assert.equal(undoOrRedo({ ...PLAIN, key: "z", ctrlKey: true }), "undo");
  assert.equal(undoOrRedo({ ...PLAIN, key: "Z", metaKey: true, shiftKey: true }), "redo");
  assert.equal(undoOrRedo({ ...PLAIN, key: "y", ctrlKey: true }), "redo");
  assert.equal(undoOrRedo({ ...PLAIN, key: "z" }), null);
  assert.equal(undoOrRedo({ ...PLAIN, key: "a", ctrlKey: true }), null);
});

/**
 * The menu's labels, and the keys that its rows press.
 *
 * @param {{ pinned: number } | null} pin
 * @param {boolean} covered
 */
function menu(pin, covered) {
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
  const rows = menuRows(does, pin, covered).filter((row) => row !== null);
  for (const [, , act] of rows) act();
  return { labels: rows.map(([label]) => label), pressed };
}

test("the menu of several pins removes all of them", () => {
  const { labels, pressed } = menu({ pinned: 3 }, false);
  assert.ok(labels.includes("Remove 3 pins"));
  assert.ok(pressed.includes("Shift+Delete"));
  assert.ok(menu({ pinned: 1 }, false).labels.includes("Remove"));
});

test("a pin is offered only where the shape is", () => {
  assert.equal(menu(null, true).labels[0], "Add a pin here");
  assert.equal(menu(null, false).labels[0], "Copy the pose");
});
