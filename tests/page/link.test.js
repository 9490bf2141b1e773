// The queue of events for the kernel.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";
import { Link } from "../../glid_nb/page/js/pad/link.js";
import { Frames, fakeModel } from "./fakes.js";

/** @type {Frames} */
let frames;

beforeEach(() => {
  frames = new Frames();
  mock.timers.reset();
  mock.timers.enable({ apis: ["setTimeout"] });
});

/** A link and all that is around it. */
function linked() {
  const model = fakeModel();
  const classes = new Set();
  const host = { classList: classes };
  const element = { dataset: /** @type {Record<string, string>} */ ({}), closest: () => host };
  const ending = new AbortController();
  let reports = 0;
  const link = new Link(model, /** @type {any} */ (element), ending.signal, () => {
    reports += 1;
  });
  const answer = (/** @type {number} */ ack, /** @type {string | null} */ refusal = null) =>
    model.trigger("msg:custom", { view: link.view, ack, refusal });
  const batches = () => model.sent.map(({ events }) => events.map(typeAndNumber));
  return { link, model, element, ending, classes, answer, batches, reports: () => reports };
}

/** @param {{ type: string, seq: number }} event */
function typeAndNumber({ type, seq }) {
  return `${type} ${seq}`;
}

test("events wait until the batch before is answered and its frame is drawn", () => {
  const { link, answer, batches } = linked();
  link.put({ type: "down" });
  link.put({ type: "move" });
  link.put({ type: "up" });
  assert.deepEqual(batches(), [["down 1"]]);
  answer(1);
  assert.equal(batches().length, 1);
  frames.run();
  assert.deepEqual(batches()[1], ["move 2", "up 3"]);
});

test("a move replaces the move that waits, though not one before another event", () => {
  const { link, answer, batches } = linked();
  link.put({ type: "down" });
  link.put({ type: "move", replaces: "move 1" });
  link.put({ type: "move", replaces: "move 1" });
  link.put({ type: "key" });
  link.put({ type: "move", replaces: "move 1" });
  link.put({ type: "move", replaces: "move 2" });
  answer(1);
  frames.run();
  assert.deepEqual(batches()[1], ["move 3", "key 4", "move 5", "move 6"]);
});

test("every event resolves to the refusal of the batch that handled it", async () => {
  const { link, answer } = linked();
  const first = link.put({ type: "a" });
  const second = link.put({ type: "b" });
  answer(1);
  frames.run();
  answer(2, "there is no pin");
  assert.equal(await first, null);
  assert.equal(await second, "there is no pin");
  assert.equal(link.refusal, "there is no pin");
});

test("the element says whether all is answered", () => {
  const { link, element, answer } = linked();
  assert.equal(element.dataset.idle, "true");
  link.put({ type: "a" });
  assert.equal(element.dataset.idle, "false");
  answer(1);
  assert.equal(element.dataset.idle, "true");
});

test("an answer that is overdue is reported, and one that came in time is not", () => {
  const slow = linked();
  slow.link.put({ type: "a" });
  mock.timers.tick(249);
  assert.equal(slow.link.busy, false);
  mock.timers.tick(1);
  assert.equal(slow.link.busy, true);
  slow.answer(1);
  assert.equal(slow.link.busy, false);
  const fast = linked();
  fast.link.put({ type: "a" });
  fast.answer(1);
  mock.timers.tick(1000);
  assert.equal(fast.link.busy, false);
  assert.equal(fast.reports(), 1);
});

test("without any answer the next batch goes after two seconds", () => {
  const { link, batches } = linked();
  link.put({ type: "a" });
  link.put({ type: "b" });
  mock.timers.tick(2000);
  assert.deepEqual(batches(), [["a 1"], ["b 2"]]);
});

test("answers for another view are not heard", () => {
  const { link, model } = linked();
  link.put({ type: "a" });
  model.trigger("msg:custom", { view: "another", ack: 1, refusal: null });
  assert.equal(link.idle, false);
});

test("where the kernel is gone nothing is sent, and the page says so", () => {
  const { link, model, classes, batches } = linked();
  model.widget_manager.kernel = { isDisposed: true };
  link.put({ type: "a" });
  assert.deepEqual(batches(), []);
  assert.ok(classes.has("jupyter-widgets-disconnected"));
});

test("a view that is removed sends nothing more", () => {
  const { link, ending, batches } = linked();
  link.put({ type: "a" });
  link.put({ type: "b" });
  ending.abort();
  mock.timers.tick(5000);
  assert.equal(batches().length, 1);
});
