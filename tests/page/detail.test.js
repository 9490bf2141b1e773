// A slow page draws fewer pixels while a shape moves.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Detail } from "../../glid_nb/page/js/canvas/detail.js";

const SLOW = 40; // ms

/** A view of pythreejs's, which records what it draws. */
function fakeView(ratio = 2) {
  /** @type {number[]} */
  const drawn = [];
  const renderer = {
    ratio,
    getPixelRatio: () => renderer.ratio,
    setPixelRatio: (/** @type {number} */ value) => {
      renderer.ratio = value;
    },
  };
  return { renderer, drawn, renderScene: () => drawn.push(renderer.ratio) };
}

/** @param {ReturnType<typeof fakeView>} view */
const detailOf = (view) => new Detail(() => [Promise.resolve(view)]);
const soon = () => new Promise((go) => setImmediate(go));

test("a slow page draws half of the pixels along each side while a shape moves, and then all of them", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const view = fakeView();
  const detail = detailOf(view);
  for (let i = 0; i < 5; i++) {
    detail.moved(SLOW);
    await soon();
    t.mock.timers.tick(100);
  }
  assert.equal(view.drawn.length, 1); // the canvas changes its size once
  assert.equal(view.drawn[0], 1);
  t.mock.timers.tick(200);
  await soon();
  assert.equal(view.drawn[1], 2);
  assert.equal(view.renderer.ratio, 2);
});

test("a page that draws in time, or whose time is unknown, draws all pixels", async () => {
  const view = fakeView();
  const detail = detailOf(view);
  detail.moved(5);
  detail.moved(0);
  await soon();
  assert.deepEqual(view.drawn, []);
});

test("a renderer that is given away has all pixels again at once", async (t) => {
  t.mock.timers.enable({ apis: ["setTimeout"] });
  const view = fakeView();
  const detail = detailOf(view);
  detail.moved(SLOW);
  await soon();
  detail.restore();
  assert.equal(view.renderer.ratio, 2);
});
