// anywidget loads a module for each widget, and a page keeps all that it ever loaded. So this small
// one is what each loads, and the widget's own module, the text in `_script`, is loaded once.

/** @import { Context, Model } from "../types.js" */

const page = /** @type {{ glidModules?: Map<string, Promise<any>> }} */ (globalThis);
page.glidModules ??= new Map();
const modules = page.glidModules;

/**
 * Waits until a widget hears the kernel.
 *
 * @param {Model} proxy what anywidget hands out instead of the model
 */
async function heard(proxy) {
  const manager = proxy.widget_manager;
  const id = proxy.get("_own_id");
  if (!manager?.has_model?.(id)) return; // another host than Jupyter
  const model = await manager.get_model(id);
  if (!model.comm_live) return; // there is no kernel
  model.glidHears ??= hear(model); // other views of it wait for the same
  await model.glidHears;
}

/**
 * Listens instead of anywidget, if that has given a widget up because this module took too long:
 * then it answers every message with an error, for good. A message that changes nothing tells.
 *
 * @param {any} model of ipywidgets
 */
async function hear(model) {
  try {
    await model._handle_comm_msg({ content: { data: {} } });
  } catch {
    const ipywidgets = Object.getPrototypeOf(Object.getPrototypeOf(model));
    // What came meanwhile is lost, so the kernel is asked for all.
    await new Promise((resolve) => {
      model.comm.on_msg(async (/** @type {any} */ message) => {
        await ipywidgets._handle_comm_msg.call(model, message);
        if (message.content.data.state?._own_id) resolve(null);
      });
      model.comm.send({ method: "request_state" });
    });
  }
}

/** @param {Context} context */
async function render(context) {
  await heard(context.model);
  const script = context.model.get("_script");
  let loading = modules.get(script);
  if (!loading) {
    const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    loading = import(url).finally(() => URL.revokeObjectURL(url));
    modules.set(script, loading);
  }
  const module = await loading;
  if (!context.signal.aborted) return module.default.render(context); // the view may be gone by now
}

export default { render };
