// Drawing on a canvas that keeps what it is told.

import assert from "node:assert/strict";
import { test } from "node:test";
import { circle, disk, rectangle, strokePath, tracePath } from "../../glid_nb/page/js/pad/pen.js";

/** A pen, and the calls it got. */
function recorded() {
  /** @type {string[]} */
  const calls = [];
  const pen = {
    lineWidth: 0,
    strokeStyle: "",
    fillStyle: "",
    beginPath: () => calls.push("begin"),
    closePath: () => calls.push("close"),
    moveTo: (/** @type {number} */ x, /** @type {number} */ y) => calls.push(`move ${x} ${y}`),
    lineTo: (/** @type {number} */ x, /** @type {number} */ y) => calls.push(`line ${x} ${y}`),
    arc: () => calls.push("arc"),
    fill: () => calls.push(`fill ${pen.fillStyle}`),
    stroke: () => calls.push(`stroke ${pen.lineWidth} ${pen.strokeStyle}`),
    setLineDash: (/** @type {number[]} */ dash) => calls.push(`dash [${dash}]`),
  };
  return { pen: /** @type {CanvasRenderingContext2D} */ (/** @type {unknown} */ (pen)), calls };
}

test("a path is closed unless it is a line", () => {
  const { pen, calls } = recorded();
  tracePath(pen, [rectangle([0, 0], [2, 1])]);
  assert.deepEqual(calls, ["begin", "move 0 0", "line 2 0", "line 2 1", "line 0 1", "close"]);
  const open = recorded();
  tracePath(
    open.pen,
    [
      [
        [0, 0],
        [1, 1],
      ],
    ],
    false,
  );
  assert.ok(!open.calls.includes("close"));
});

test("strokes come in their order, and the dash ends with them", () => {
  const { pen, calls } = recorded();
  strokePath(
    pen,
    [
      [4, "white"],
      [2, "black"],
    ],
    [6, 4],
  );
  assert.deepEqual(calls, ["dash [6,4]", "stroke 4 white", "stroke 2 black", "dash []"]);
});

test("a disk is filled, and stroked if it has a border", () => {
  const plain = recorded();
  disk(plain.pen, [0, 0], 3, "red");
  assert.ok(plain.calls.includes("fill red"));
  assert.ok(!plain.calls.some((call) => call.startsWith("stroke")));
  const bordered = recorded();
  disk(bordered.pen, [0, 0], 3, "red", "blue", 2);
  assert.ok(bordered.calls.includes("stroke 2 blue"));
});

test("a circle is an arc", () => {
  const { pen, calls } = recorded();
  circle(pen, [0, 0], 3, [[1, "red"]]);
  assert.deepEqual(calls.slice(0, 2), ["begin", "arc"]);
});
