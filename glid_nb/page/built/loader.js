// pad/loader.js
var modules = globalThis.glidModules ??= /* @__PURE__ */ new Map();
async function render(context) {
  const script = context.model.get("_script");
  if (!modules.has(script)) {
    const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    modules.set(script, import(url).finally(() => URL.revokeObjectURL(url)));
  }
  const module = await modules.get(script);
  if (!context.signal.aborted) return module.default.render(context);
}
var loader_default = { render };
export {
  loader_default as default
};
