// anywidget loads a module for each widget, and a page keeps all that it ever loaded. So this small
// one is what each loads, and the widget's own module, the text in `_script`, is loaded once.

/** @import { Context } from "../types.js" */

const page = /** @type {{ glidModules?: Map<string, Promise<any>> }} */ (globalThis);
page.glidModules ??= new Map();
const modules = page.glidModules;

/** @param {Context} context */
async function render(context) {
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
