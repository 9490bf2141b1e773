var page=globalThis;page.glidModules??=new Map;var modules=page.glidModules;async function render(context){
const script=context.model.get("_script");let loading=modules.get(script);if(!loading){const url=URL.
createObjectURL(new Blob([script],{type:"text/javascript"}));loading=import(url).finally(()=>URL.revokeObjectURL(
url));modules.set(script,loading)}const module=await loading;if(!context.signal.aborted)return module.
default.render(context)}var loader_default={render};export{loader_default as default};
