// What the tracer says, and its sliders.

import assert from "node:assert/strict";
import { test } from "node:test";
import { endOf, NUMBERS, shareAt, valueAt } from "../../glid_nb/page/js/tracer/number_control.js";
import { TOOL_NAMES, TOOLS } from "../../glid_nb/page/js/tracer/tools.js";
import { holesIn, statusOf } from "../../glid_nb/page/js/tracer/words.js";

/** @import { Shown } from "../../glid_nb/page/js/tracer/traits.js" */

/**
 * @param {Partial<Shown>} changes
 * @returns {Shown}
 */
function shown(changes = {}) {
  return {
    size: [200, 100],
    loops: [
      [
        [0, 0],
        [1, 0],
        [0, 1],
      ],
    ],
    problems: [],
    options: { method: "auto", invert: null },
    automatic: null,
    notes: [],
    component: 0,
    n_components: 1,
    component_area: 5000,
    n_filled: 0,
    reach_shares: { in_hole: 0.5, edge: 0.5 },
    holes: [],
    n_holes: 0,
    strokes: { foreground: [], background: [] },
    doubt: null,
    can_undo: false,
    can_redo: false,
    edited: false,
    discarded: false,
    tool: "edit",
    corners: [],
    inside: [],
    cut: null,
    knife_width: null,
    selected: [],
    keeps: false,
    ...changes,
  };
}

test("the status tells of the cage", () => {
  assert.deepEqual(statusOf(shown(), null, false), {
    kind: "ok",
    text: "Cage with 3 vertices and no holes",
  });
  const several = statusOf(shown({ n_components: 4 }), null, false);
  assert.match(several.text, / · the largest of 4 components$/);
  const second = statusOf(shown({ n_components: 4, component: 1 }), null, false);
  assert.match(second.text, / · component 2 of 4 components$/);
});

test("a refusal comes before all else, then that an answer is overdue", () => {
  assert.deepEqual(statusOf(shown(), "too large", true), { kind: "bad", text: "too large" });
  assert.equal(statusOf(shown(), null, true).kind, "busy");
  assert.equal(statusOf(shown({ size: null }), null, false).kind, "idle");
});

test("without a clear outline the status says why and what to do; an invalid cage is bad", () => {
  assert.deepEqual(statusOf(shown({ doubt: "it is faint", loops: [] }), null, false), {
    kind: "guess",
    text: "No outline yet, as it is faint · paint over the shape",
  });
  const problems = [{ message: "edges cross", point: null }];
  assert.equal(statusOf(shown({ problems }), null, false).kind, "bad");
});

test("a cut says what it did, in front of what the cage is", () => {
  const after = (/** @type {Shown["cut"]} */ cut) => statusOf(shown({ cut }), null, false).text;
  const cage = "Cage with 3 vertices and no holes";
  assert.equal(
    after({ shares: [1], kept: 0, in_middle: false }),
    `Cut open along the line · ${cage}`,
  );
  assert.match(after({ shares: [1], kept: 0, in_middle: true }), /^Cut inside .* thin hole · Cage/);
  assert.match(
    after({ shares: [0.75, 0.25], kept: 1, in_middle: false }),
    /^Cut into 2 pieces: 25 % of the shape is kept, the other one is left out · Cage/,
  );
  assert.match(
    after({ shares: [0.6, 0.3, 0.1], kept: 0, in_middle: false }),
    /^Cut into 3 pieces: 60 % of the shape is kept, the others are left out · Cage/,
  );
});

test("holes are counted in words", () => {
  assert.deepEqual([-1, 0, 1, 2].map(holesIn), ["no holes", "no holes", "1 hole", "2 holes"]);
});

test("a slider's place and its value belong together", () => {
  for (const option of NUMBERS) {
    const most = endOf(option, shown());
    assert.equal(shareAt(0, most, option), 0);
    assert.equal(shareAt(2 * most, most, option), 1);
    const value = valueAt(0.7, most, option);
    assert.ok(Math.abs(valueAt(shareAt(value, most, option), most, option) - value) < 1e-9);
  }
});

test("every tool has a key of its own, which its title names", () => {
  const keys = Object.values(TOOLS).map(({ key }) => key);
  assert.equal(new Set(keys).size, keys.length);
  for (const { key, label } of Object.values(TOOLS)) {
    assert.ok(label.endsWith(`(${key.toUpperCase()})`));
  }
});

test("every tool has its button", () => {
  assert.deepEqual(TOOL_NAMES.toSorted(), Object.keys(TOOLS).toSorted());
});
