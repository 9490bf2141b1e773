// anywidget loads a module for each widget, and a page keeps all that it ever loaded. So this small one
// is what each loads, and the widget's own module, the text in `_script`, is loaded once.

const modules = (globalThis.glidModules ??= new Map());

async function render(context) {
  const script = context.model.get("_script");
  if (!modules.has(script)) {
    const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    modules.set(
      script,
      import(url).finally(() => URL.revokeObjectURL(url)),
    );
  }
  const module = await modules.get(script);
  if (!context.signal.aborted) return module.default.render(context); // the view may be gone by now
}

export default { render };
