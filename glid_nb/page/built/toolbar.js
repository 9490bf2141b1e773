function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}function save(model,changes){for(const[name,value]of Object.entries(changes))model.set(name,value);model.
save_changes()}function follow(model,listeners){for(const[names,listener]of Object.entries(listeners)){model.on(names,
listener);listener()}}var PATHS={edit:"M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",brush:"M13.5 2.5l-6 6 M6.7 9.2c-1.6\
-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z",eraser:"M9.2 2.8l4 4-6\
.4 6.4H4.4L2.2 11z M5.5 6.6l4 4 M7 13.2h6.5",rectangle:"M2.5 4h11v8h-11z",undo:"M5.5 3L2.5 6l3 3 M3 \
6h6.2a3.6 3.6 0 0 1 0 7.2H6",redo:"M10.5 3l3 3-3 3 M13 6H6.8a3.6 3.6 0 0 0 0 7.2H10",fit:"M2 5.5V2h3\
.5 M10.5 2H14v3.5 M14 10.5V14h-3.5 M5.5 14H2v-3.5",screen:"M10 2h4v4 M14 2L9.5 6.5 M6 14H2v-4 M2 14l\
4.5-4.5",eye:"M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8z M8 6.2a1.8 1.8 0 1 0 0 3.\
6 1.8 1.8 0 0 0 0-3.6z",plus:"M8 3v10 M3 8h10",minus:"M3 8h10",open:"M2 12.5v-9h4l1.5 2H14v7z",play:"\
M5 3l8 5-8 5z",pause:"M5.5 3v10 M10.5 3v10",record:"M8 4.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6z",
onion:"M6.2 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8z M9.8 4a4 4 0 1 1 0 8",copy:"M5.5 5.5h8v8h-8z M3 10.5v-8h8",
export:"M8 2v8 M4.8 6.8L8 10l3.2-3.2 M3 13.5h10",trash:"M3 4.5h10 M6.5 4.5v-2h3v2 M4.5 4.5l.6 9h5.8l\
.6-9"};function icon(name){return drawn(PATHS[name])}function drawn(path){return`<svg viewBox="0 0 1\
6 16" aria-hidden="true"><path d="${path}"/></svg>`}function iconButton(name,title,onclick,className="\
glid-icon"){return drawnButton(PATHS[name],title,onclick,className)}function drawnButton(path,title,onclick,className="\
glid-icon"){return make("button",{title,"aria-label":title,className,onclick,innerHTML:drawn(path)})}var BELOW=4;var ViewMenu=class{constructor(model,press){this.model=model;this.overlays=model.get("ov\
erlays").map(([name,label])=>{const item=row("menuitemradio",label,()=>save(model,{overlay:name}));item.
dataset.value=name;return item});this.checks=model.get("checks").map(([name,label,title])=>{const item=row(
"menuitemcheckbox",label,()=>{const shows=model.get("shows");save(model,{shows:{...shows,[name]:!shows[name]}})});
item.dataset.value=name;item.title=title;return item});const closing=(label,action)=>row("menuitem",
label,()=>{this.menu.hidePopover();press(action)});const picture=closing("The picture alone","p");this.
reference=closing("","reference");this.reference.title="A picture behind the shape, to draw poses af\
ter; no export has it";picture.append(make("kbd",{},"P"));this.menu=make("div",{className:"glid-menu\
 glid-view-menu",role:"menu","aria-label":"What the canvas shows",popover:"auto"},group("Show",this.
overlays),group("Overlays",this.checks),...[make("hr"),this.reference,picture]);this.label=make("spa\
n",{className:"glid-view-label"});this.button=make("button",{className:"glid-view-button",title:"Wha\
t the shape shows","aria-haspopup":"menu",popoverTargetElement:this.menu,innerHTML:icon("eye")});this.
button.append(this.label,make("span",{className:"glid-chevron"}));this.menu.addEventListener("before\
toggle",()=>this.#place());this.menu.addEventListener("toggle",e=>this.#opened(e));this.menu.addEventListener(
"keydown",e=>this.#step(e))}show(){const overlay=this.model.get("overlay");const shows=this.model.get(
"shows");for(const item of this.overlays){const chosen=item.dataset.value===overlay;item.ariaChecked=
String(chosen);if(chosen)this.label.textContent=item.textContent}const{firstElementChild:label}=this.
reference;const has=this.model.get("referenced");if(label)label.textContent=has?"Remove the referenc\
e":"Reference picture…";for(const item of this.checks)item.ariaChecked=String(shows[item.dataset.value??
""])}#place(){const{left,bottom}=this.button.getBoundingClientRect();const lowest=window.innerHeight-
this.menu.offsetHeight-BELOW;const rightmost=window.innerWidth-this.menu.offsetWidth-BELOW;this.menu.
style.left=`${Math.max(BELOW,Math.min(left,rightmost))}px`;this.menu.style.top=`${Math.max(BELOW,Math.
min(bottom+BELOW,lowest))}px`}#opened({newState}){this.button.ariaExpanded=String(newState==="open");
if(newState!=="open")return;this.#place();this.overlays.find(item=>item.ariaChecked==="true")?.focus(
{preventScroll:true})}#step(e){const by={ArrowDown:1,ArrowUp:-1}[e.key];if(!by)return;e.preventDefault();
e.stopPropagation();const items=[...this.menu.querySelectorAll("button")];const focused=items.indexOf(
document.activeElement);items.at((focused+by)%items.length)?.focus()}};var groups=0;function group(name,items){
groups+=1;const id=`glid-view-group-${groups}`;const head=make("div",{id,className:"glid-menu-head",
role:"presentation"},name);return make("div",{role:"group","aria-labelledby":id},head,...items)}function row(role,label,onclick){
return make("button",{role,onclick},make("span",{},label))}var TOOLS=[["","edit","Select and drag pins (Esc)"],["stiff","brush","Paint what should stay stiff (\
B)"],["erase","eraser","Erase stiff areas (E)"]];var INSPECTOR="M2 3h12v10H2z M10 3v10";var Toolbar=class{constructor(model){
this.model=model;this.view=new ViewMenu(model,name=>this.#press(name));this.tools=TOOLS.map(([tool,icon2,
title])=>{const button=iconButton(icon2,title,()=>this.#press(`tool:${tool}`));button.dataset.tool=tool||
"select";return button});this.undo=iconButton("undo","Undo (Ctrl+Z)",()=>model.send({type:"undo"}));
this.redo=iconButton("redo","Redo (Ctrl+Shift+Z)",()=>model.send({type:"redo"}));this.element=make("\
div",{className:"glid-skin glid-toolbar glid-tools",role:"toolbar","aria-label":"Deform"},...[...this.
tools,gap(),this.undo,this.redo,gap(),this.view.button,this.view.menu],make("span",{className:"glid-\
grow"}),iconButton("minus","Zoom out (wheel)",()=>this.#press("zoom:out")),iconButton("plus","Zoom i\
n (wheel)",()=>this.#press("zoom:in")),iconButton("fit","See everything (F)",()=>this.#press("f")),drawnButton(
INSPECTOR,"Hide the inspector, show it again (I)",()=>this.#press("i")),iconButton("screen","Full sc\
reen (W)",()=>this.#press("w")),this.#help())}showTool(tool=this.model.get("tool")){const name=tool||
"select";for(const button of this.tools)button.ariaPressed=String(button.dataset.tool===name)}canvasTook(e){
const editor=this.element.closest(".glid-editor");if(editor?.contains(e.target)){this.showTool(e.detail)}}showHistory(){
this.undo.disabled=!this.model.get("can_undo");this.redo.disabled=!this.model.get("can_redo")}#find(selector){
return this.element.closest(".glid-editor")?.querySelector(selector)}#press(key){const event=new CustomEvent(
"glid:press",{detail:key});this.#find(".glid-pad:not([inert])")?.dispatchEvent(event)}#help(){const title="\
Keys and gestures (?)";const look={className:"glid-help-button",title,"aria-label":title};const button=make(
"button",look,"?");const aim=()=>{button.popoverTargetElement=this.#find(".glid-pad:not([inert]) .gl\
id-help")??null};button.addEventListener("pointerenter",aim);button.addEventListener("focus",aim);return button}};
function gap(){return make("span",{className:"glid-gap"})}function render({model,el,signal}){const toolbar=new Toolbar(model);el.classList.add("glid-host");el.
append(toolbar.element);const took=e=>toolbar.canvasTook(e);window.addEventListener("glid:tool",took,
{signal});follow(model,{"change:tool":()=>toolbar.showTool(),"change:can_undo change:can_redo":()=>toolbar.
showHistory(),"change:overlay change:shows change:referenced":()=>toolbar.view.show()})}var main_default={
render};export{main_default as default};
