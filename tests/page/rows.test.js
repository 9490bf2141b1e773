// Which rows of a list are selected.

import assert from "node:assert/strict";
import { test } from "node:test";
import { between, rowAfter } from "../../glid_nb/page/js/rows/choice.js";

test("Shift selects all rows between, and the clicked one counts most", () => {
  const keys = [7, 3, 5, 9];
  assert.deepEqual(between(keys, 3, 9), [3, 5, 9]);
  assert.deepEqual(between(keys, 9, 3), [9, 5, 3]);
  assert.deepEqual(between(keys, 5, 5), [5]);
  assert.deepEqual(between(keys, -1, 5), [5], "nothing was selected before");
});

test("arrow keys stay in the list", () => {
  assert.equal(rowAfter("ArrowDown", 0, 3), 1);
  assert.equal(rowAfter("ArrowDown", 2, 3), 2);
  assert.equal(rowAfter("ArrowUp", 0, 3), 0);
  assert.equal(rowAfter("End", 0, 3), 2);
  assert.equal(rowAfter("Home", 2, 3), 0);
  assert.equal(rowAfter("ArrowDown", 0, 0), null);
  assert.equal(rowAfter("x", 1, 3), null);
});
