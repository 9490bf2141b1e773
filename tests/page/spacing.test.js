// Moves that may wait go to the kernel one at a time, the newest, and before everything else.

import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { Spacing } from "../../glid_nb/page/js/canvas/spacing.js";

/** @import { KernelEvent } from "../../glid_nb/page/js/types.js" */

beforeEach(() => mock.timers.enable({ apis: ["setTimeout"] }));
afterEach(() => mock.timers.reset());

function spaced() {
  /** @type {unknown[]} */
  const sent = [];
  const spacing = new Spacing((/** @type {KernelEvent} */ event) => {
    sent.push(event.x ?? event.type);
    return Promise.resolve("said");
  });
  return { spacing, sent };
}

test("the first move goes at once, then the newest of those that wait", async () => {
  const { spacing, sent } = spaced();
  assert.equal(await spacing.put({ type: "move", x: 1 }, true), "said");
  assert.equal(await spacing.put({ type: "move", x: 2 }, true), null);
  spacing.put({ type: "move", x: 3 }, true);
  assert.deepEqual(sent, [1]);
  mock.timers.tick(600);
  assert.deepEqual(sent, [1, 3]);
  mock.timers.tick(600);
  spacing.put({ type: "move", x: 4 }, true);
  assert.deepEqual(sent, [1, 3, 4]); // after a pause without moves, at once again
});

test("another event comes after the move that waits", () => {
  const { spacing, sent } = spaced();
  spacing.put({ type: "move", x: 1 }, true);
  spacing.put({ type: "move", x: 2 }, true);
  spacing.put({ type: "up" }, false);
  assert.deepEqual(sent, [1, 2, "up"]);
  mock.timers.tick(5000);
  assert.deepEqual(sent, [1, 2, "up"]);
});

test("moves that may not wait go at once", () => {
  const { spacing, sent } = spaced();
  for (const x of [1, 2, 3]) spacing.put({ type: "move", x }, false);
  assert.deepEqual(sent, [1, 2, 3]);
});

test("nothing is sent after the end", () => {
  const { spacing, sent } = spaced();
  spacing.put({ type: "move", x: 1 }, true);
  spacing.put({ type: "move", x: 2 }, true);
  spacing.close();
  mock.timers.tick(5000);
  assert.deepEqual(sent, [1]);
});
