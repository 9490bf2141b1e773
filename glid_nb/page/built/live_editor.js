function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}var KERNEL="kernel";function render({model,el,signal}){const view=crypto.randomUUID();const frame=make(
"iframe",{title:model.get("title"),srcdoc:model.get("page"),allow:"clipboard-write; fullscreen",className:"\
glid-live-editor"});frame.style.cssText=`display: block; width: 100%; height: ${model.get("height")}\
px; border: 0`;const show=()=>{const{by,pins,coefficients}=model.get("edit");if(!by||by===view)return;
const edit={glid:"edit",pins,coefficients,quiet:by!==KERNEL};frame.contentWindow?.postMessage(edit,"\
*")};const hear=({source,data})=>{if(source!==frame.contentWindow)return;if(data.glid==="ready")show();
if(data.glid!=="edit")return;model.set("edit",{by:view,pins:data.pins,coefficients:data.coefficients});
model.save_changes()};window.addEventListener("message",hear,{signal});model.on("change:edit",show);
signal?.addEventListener("abort",()=>model.off("change:edit",show));el.append(frame)}var main_default={
render};export{main_default as default};
