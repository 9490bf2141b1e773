var page=globalThis;page.glidModules??=new Map;var modules=page.glidModules;async function heard(proxy){
const manager=proxy.widget_manager;const id=proxy.get("_own_id");if(!manager?.has_model?.(id))return;
const model=await manager.get_model(id);if(!model.comm_live)return;model.glidHears??=hear(model);await model.
glidHears}async function hear(model){try{await model._handle_comm_msg({content:{data:{}}})}catch{const ipywidgets=Object.
getPrototypeOf(Object.getPrototypeOf(model));await new Promise(resolve=>{model.comm.on_msg(async message=>{
await ipywidgets._handle_comm_msg.call(model,message);if(message.content.data.state?._own_id)resolve(
null)});model.comm.send({method:"request_state"})})}}async function render(context){await heard(context.
model);const script=context.model.get("_script");let loading=modules.get(script);if(!loading){const url=URL.
createObjectURL(new Blob([script],{type:"text/javascript"}));loading=import(url).finally(()=>URL.revokeObjectURL(
url));modules.set(script,loading)}const module=await loading;if(!context.signal.aborted)return module.
default.render(context)}var loader_default={render};export{loader_default as default};
