// The small module that each widget loads.

import assert from "node:assert/strict";
import { test } from "node:test";
import loader from "../../glid_nb/page/js/pad/loader.js";

// A widget's own module, as if it were loaded; node loads none from a blob. It draws what was told.
const SCRIPT = "the module's text";
const { glidModules } = /** @type {any} */ (globalThis);
glidModules.set(SCRIPT, {
  default: { render: (/** @type {any} */ { model }) => [model.get("told")] },
});

/**
 * What anywidget hands to `render`, and the model of ipywidgets behind it.
 *
 * @param {boolean} gaveUp whether anywidget answers each message with an error
 */
function widget(gaveUp) {
  /** @type {Record<string, unknown>} */
  const state = { _script: SCRIPT, _own_id: "one", told: "nothing" };
  /** @type {((message: object) => unknown) | undefined} */
  let listener;
  const asked = /** @type {unknown[]} */ ([]);
  class OfIpywidgets {
    comm_live = true;
    comm = {
      on_msg: (/** @type {(message: object) => unknown} */ heard) => {
        listener = heard;
      },
      send: (/** @type {unknown} */ message) => asked.push(message),
    };

    async _handle_comm_msg(/** @type {any} */ { content: { data } }) {
      Object.assign(state, data.state);
    }
  }
  class OfAnywidget extends OfIpywidgets {
    async _handle_comm_msg(/** @type {any} */ message) {
      if (gaveUp) throw new Error("Failed to initialize model.");
      return super._handle_comm_msg(message);
    }
  }
  const model = new OfAnywidget();
  const widget_manager = {
    has_model: (/** @type {string} */ id) => id === "one",
    get_model: async () => model,
  };
  const get = (/** @type {string} */ name) => state[name];
  const context = { model: { get, widget_manager }, signal: new AbortController().signal };
  const update = (/** @type {object} */ changed) =>
    listener?.({ content: { data: { method: "update", state: changed } } });
  return { context: /** @type {any} */ (context), model, asked, update };
}

test("a widget that anywidget serves is drawn at once, and asks for nothing", async () => {
  const { context, asked } = widget(false);
  assert.deepEqual(await loader.render(context), ["nothing"]);
  assert.deepEqual(asked, []);
});

test("one that it has given up asks for its state, and is drawn with it", async () => {
  const { context, asked, update } = widget(true);
  const views = Promise.all([loader.render(context), loader.render(context)]);
  while (!asked.length) await Promise.resolve();
  update({ told: "a part" });
  update({ told: "all", _own_id: "one", _script: SCRIPT });
  assert.deepEqual(await views, [["all"], ["all"]]);
  assert.deepEqual(asked, [{ method: "request_state" }]);
});

test("without a kernel, and in a host that is not Jupyter, it is drawn as it is", async () => {
  const { context, model } = widget(true);
  model.comm_live = false;
  assert.deepEqual(await loader.render(context), ["nothing"]);
  context.model.widget_manager = undefined;
  assert.deepEqual(await loader.render(context), ["nothing"]);
});
