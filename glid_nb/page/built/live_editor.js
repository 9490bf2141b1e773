function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}function joined(editing,tell){let known=editing.frame.id;let unanswered=null;const{told}=editing;editing.
told=()=>{told();const{pins,frame}=editing;if(!editing.settled||editing.inGesture||frame.id===known)
return;known=frame.id;const answers=pins!==unanswered;unanswered=null;if(answers)tell({pins:[...pins],
coefficients:[...frame.coefficients]})};return({pins,coefficients},quiet)=>{unanswered=quiet?pins:null;
editing.replace(pins,Float64Array.from(coefficients))}}var KERNEL="kernel";function render({model,el,signal}){const view=crypto.randomUUID();const frame=make(
"iframe",{title:model.get("title"),srcdoc:model.get("page"),allow:"clipboard-write; fullscreen"});frame.
style.cssText=`display: block; width: 100%; height: ${model.get("height")}px; border: 0`;const tell=edit=>{
model.set("edit",{by:view,...edit});model.save_changes()};let show=(_,_quiet)=>{};whenOpen(frame,editing=>{
show=joined(editing,tell);const{by,...edit}=model.get("edit");if(by)show(edit,by!==KERNEL)});const follow=()=>{
const{by,...edit}=model.get("edit");if(by&&by!==view)show(edit,by!==KERNEL)};model.on("change:edit",
follow);signal?.addEventListener("abort",()=>model.off("change:edit",follow));el.append(frame)}function whenOpen(frame,use){
frame.addEventListener("load",()=>{const root=frame.contentDocument?.documentElement;if(!root)return;
const waiting=new MutationObserver(look);waiting.observe(root,{attributeFilter:["data-ready"]});look();
function look(){if(!root?.dataset.ready)return;waiting.disconnect();use(Reflect.get(frame.contentWindow??
{},"glidPage").editing)}})}var main_default={render};export{main_default as default};
