async function copied(text){try{await navigator.clipboard.writeText(text);return true}catch{return copiedBySelection(
text)}}function copiedBySelection(text){const focused=document.activeElement;const area=document.createElement(
"textarea");area.value=text;area.setAttribute("readonly","");Object.assign(area.style,{position:"fix\
ed",top:"0",left:"0",opacity:"0"});document.body.append(area);area.select();try{return document.execCommand(
"copy")}catch{return false}finally{area.remove();if(focused instanceof HTMLElement)focused.focus({preventScroll:true})}}function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}var KEPT=6e4;var saved=new Set;function download(name,data){const href=URL.createObjectURL(new Blob(
[data]));make("a",{href,download:name}).click();setTimeout(()=>URL.revokeObjectURL(href),KEPT)}function render({
model}){model.on("msg:custom",async({number,text,name},[data])=>{if(text!==void 0)model.send({number,
copied:await copied(text)});else if(name&&!saved.has(number))download(name,data);saved.add(number)})}
var main_default={render};export{main_default as default};
