// The inspector's numbers while a pin is dragged.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fieldWords, meansStill, wordsOf } from "../../glid_nb/page/js/canvas/followed.js";
import { turnWords } from "../../glid_nb/page/js/canvas/numbers.js";

test("numbers are written as the kernel writes them", () => {
  assert.deepEqual(wordsOf([1.23456, -2], [Math.PI / 6, 1.5, true, true]), {
    x: "1.235",
    y: "-2",
    angle: "30",
    scale: "1.5",
    detail: "1.23, \u22122.00",
  });
  const { angle, scale, x, detail } = wordsOf([-0.0001, -0.001], [0.3, 1.5, false, false]);
  assert.deepEqual([angle, scale], ["", ""]); // free
  assert.deepEqual([x, detail], ["0", "0.00, 0.00"]);
});

test("fields of several pins say what all of them have", () => {
  const free = { angle: "", scale: "" };
  const turned = fieldWords([[1, 2]], [Math.PI / 6, 1.5, true, false], free);
  assert.deepEqual(turned, { x: "1", y: "2", angle: "30", scale: "" });
  /** @type {[number, number][]} */
  const places = [
    [1, 2],
    [3, 2.0000001],
  ];
  const several = fieldWords(places, [Math.PI / 6, 1.5, true, true], { angle: "10", scale: "" });
  assert.deepEqual(several, { x: "", y: "2", angle: "30", scale: "" });
  const locked = fieldWords([[1, 2]], [], { angle: "10", scale: "2" });
  assert.deepEqual(locked, { x: "1", y: "2", angle: "10", scale: "2" });
});

test("after a drag that changed nothing the kernel's numbers are shown again", () => {
  assert.ok(meansStill("1.2", "3.4", "1.2"));
  assert.ok(meansStill("1.2346", "3.4", "1.2345")); // rounded on the way
  assert.ok(meansStill("", "16.5", "")); // free
  assert.ok(meansStill("1.00, \u22122.00", "1.00, \u22121.50", "1.00, \u22122.00"));
  assert.ok(!meansStill("1.2", "3.4", "3.4"));
  assert.ok(!meansStill("1.2", "3.4", "3.3999"));
  assert.ok(!meansStill("", "16.47", "16.471"));
});

test("turn and scale are told also where they are free", () => {
  assert.deepEqual(turnWords([Math.PI / 6, 1.234, true, false]), ["30°", "× 1.23 free"]);
  assert.deepEqual(turnWords([-0.00001, 1, false, true]), ["0° free", "× 1.00"]);
});
