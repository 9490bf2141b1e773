function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}function penOf(canvas){const pen=canvas.getContext("2d");if(!pen)throw new Error("this browser does \
not draw on canvases");return pen}function save(model,changes){for(const[name,value]of Object.entries(
changes))model.set(name,value);model.save_changes()}function toFloats(view){if(!view)return new Float32Array;
return new Float32Array(view.buffer.slice(view.byteOffset,view.byteOffset+view.byteLength))}function follow(model,listeners){
for(const[names,listener]of Object.entries(listeners)){model.on(names,listener);listener()}}var OF_THE_PAD=["pointerdown","pointermove","wheel","keydown","keyup","contextmenu"];function shield(element){
for(const name of OF_THE_PAD)element.addEventListener(name,e=>e.stopPropagation());return element}function help(sections){
const head=make("div",{className:"glid-help-head"},make("h2",{},"Keys and gestures"),make("button",{
title:"Close",ariaLabel:"Close"},"×"));const columns=make("div",{},...sections.map(section));const look={
className:"glid-help",popover:"auto",tabIndex:-1};const table=shield(make("div",look,head,columns));
table.addEventListener("click",()=>table.hidePopover());table.addEventListener("beforetoggle",()=>Object.
assign(table,{autofocus:true}));const title="Keys and gestures (?)";const around2={className:"glid-h\
elp-button",title,"aria-label":title};const button=shield(make("button",{...around2,popoverTargetElement:table},
"?"));return{table,button,toggle:()=>void table.togglePopover()}}function section([title,rows]){return make(
"section",{},make("h3",{},title),make("table",{},...rows.map(row)))}function row([keys,what]){return make(
"tr",{},make("th",{},keys),make("td",{},what))}var PATHS={edit:"M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",brush:"M13.5 2.5l-6 6 M6.7 9.2c-1.6\
-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z",eraser:"M9.2 2.8l4 4-6\
.4 6.4H4.4L2.2 11z M5.5 6.6l4 4 M7 13.2h6.5",rectangle:"M2.5 4h11v8h-11z",undo:"M5.5 3L2.5 6l3 3 M3 \
6h6.2a3.6 3.6 0 0 1 0 7.2H6",redo:"M10.5 3l3 3-3 3 M13 6H6.8a3.6 3.6 0 0 0 0 7.2H10",fit:"M2 5.5V2h3\
.5 M10.5 2H14v3.5 M14 10.5V14h-3.5 M5.5 14H2v-3.5",screen:"M10 2h4v4 M14 2L9.5 6.5 M6 14H2v-4 M2 14l\
4.5-4.5",eye:"M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8z M8 6.2a1.8 1.8 0 1 0 0 3.\
6 1.8 1.8 0 0 0 0-3.6z",plus:"M8 3v10 M3 8h10",minus:"M3 8h10",open:"M2 12.5v-9h4l1.5 2H14v7z",play:"\
M5 3l8 5-8 5z",pause:"M5.5 3v10 M10.5 3v10",record:"M8 4.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6z",
onion:"M6.2 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8z M9.8 4a4 4 0 1 1 0 8",copy:"M5.5 5.5h8v8h-8z M3 10.5v-8h8",
export:"M8 2v8 M4.8 6.8L8 10l3.2-3.2 M3 13.5h10",trash:"M3 4.5h10 M6.5 4.5v-2h3v2 M4.5 4.5l.6 9h5.8l\
.6-9"};function drawn(path){return`<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${path}"/></svg>`}function iconButton(name,title,onclick,className="\
glid-icon"){return drawnButton(PATHS[name],title,onclick,className)}function drawnButton(path,title,onclick,className="\
glid-icon"){return make("button",{title,"aria-label":title,className,onclick,innerHTML:drawn(path)})}var TEXT="textarea, [contenteditable], input:not([type=checkbox], [type=range], [type=radio])";var LAST_LATIN="\
ɏ";var LATIN={Comma:",<",Period:".>",Slash:"/?",Minus:"-_",Equal:"=+",BracketLeft:"[{",BracketRight:"\
]}"};function keyOf({key,code="",shiftKey=false}){if(key.length>1||key<=LAST_LATIN)return key;const[
,letter,digit]=code.match(/^(?:Key([A-Z])|(?:Digit|Numpad)([0-9]))$/)??[];if(letter)return shiftKey?
letter:letter.toLowerCase();return digit??LATIN[code]?.[Number(shiftKey)]??key}function undoOrRedo(e){
if(!e.ctrlKey&&!e.metaKey)return null;const key=keyOf(e).toLowerCase();if(key==="z")return e.shiftKey?
"redo":"undo";return key==="y"?"redo":null}function keysAround(element,act,signal,whole=element){const editorAround=e=>{
const editor=element.closest(".glid-editor")??whole;const inside=editor.contains(e.target)&&element.
checkVisibility();return inside?editor:null};const refocus=e=>{const editor=editorAround(e);if(!editor)
return;editor.tabIndex=-1;const target=e.target;const lost=e.type==="focusout"?target.disabled:target.
closest("[role=tab]");if(lost)editor.focus({preventScroll:true})};const keydown=e=>{const editor=editorAround(
e);if(!editor)return;const target=e.target;const command=e.ctrlKey||e.metaKey;const outside=!element.
contains(target);const runsTheCell=outside&&e.shiftKey&&e.key==="Enter";const ours=undoOrRedo(e)!==null||
!(command||runsTheCell);target.toggleAttribute("data-lm-suppress-shortcuts",ours);editor.onkeydown=ours?
bubbled=>bubbled.stopPropagation():null;if(outside&&!target.matches(TEXT)&&isForThePad(e,target))act(
e)};const options={capture:true,signal};window.addEventListener("pointerdown",refocus,options);window.
addEventListener("focusout",refocus,options);window.addEventListener("keydown",keydown,options)}function isForThePad(e,target){
if(undoOrRedo(e))return!e.altKey;if(e.ctrlKey||e.metaKey||target.matches("select"))return false;if(keyOf(
e)==="Escape"&&target.closest(":popover-open"))return false;const free=target.closest(".glid-timelin\
e")?/^[^ ]$/:/^([^ ]|Escape|Delete)$/;return free.test(keyOf(e))}var BUSY_AFTER=250;var ACKNOWLEDGE_TIMEOUT=2e3;var Link=class{busy=false;refusal=null;view=Math.random().
toString(36).slice(2);#queue=[];#buffers=[];#promised=[];#waiting=false;#awaited=0;#number=0;#acknowledged=0;#overdue;#timeout;#drawing=0;constructor(model,element,signal,report){
this.model=model;this.element=element;this.signal=signal;this.report=report;connectNoMoreComms(model.
widget_manager.kernel);element.dataset.idle="true";signal.addEventListener("abort",()=>this.#stop());
model.on("msg:custom",message=>{if(message.view===this.view)this.#answered(message)})}get idle(){return this.#acknowledged===
this.#number}put(event,buffers=[]){this.#number+=1;const number2=this.#number;const last=this.#queue.
at(-1);if(last?.replaces&&last.replaces===event.replaces)this.#queue.pop();this.#queue.push({...event,
seq:number2});this.#buffers.push(...buffers);this.element.dataset.idle="false";this.#flush();return new Promise(
resolve=>this.#promised.push({number:number2,resolve}))}#flush(){if(this.#waiting||!this.#queue.length)
return;this.#waiting=true;this.#awaited=this.#number;try{const{kernel}=this.model.widget_manager;if(kernel===
null||kernel?.isDisposed)throw new Error("the kernel was shut down");this.model.send({view:this.view,
events:this.#queue},void 0,this.#buffers)}catch{this.#markDisconnected();return}this.#queue=[];this.#buffers=
[];this.#overdue=setTimeout(()=>{this.busy=true;this.report()},BUSY_AFTER);this.#timeout=setTimeout(
()=>this.#release(),ACKNOWLEDGE_TIMEOUT)}#markDisconnected(){const around2=this.element.closest(".gl\
id-editor")??this.element.closest(".glid-host");around2?.classList.add("jupyter-widgets-disconnected")}#answered({
ack,refusal}){if(ack===this.#awaited)clearTimeout(this.#overdue);this.#acknowledged=Math.max(this.#acknowledged,
ack);this.busy=false;this.refusal=refusal;this.element.dataset.idle=String(this.idle);const due=this.#promised.
filter(({number:number2})=>number2<=ack);this.#promised=this.#promised.filter(({number:number2})=>number2>
ack);for(const{resolve}of due)resolve(refusal);this.report();if(ack<this.#awaited)return;if(document.
hidden)this.#release();else this.#drawing=requestAnimationFrame(()=>this.#release())}#release(){this.#stop();
this.#waiting=false;this.#flush()}#stop(){clearTimeout(this.#overdue);clearTimeout(this.#timeout);cancelAnimationFrame(
this.#drawing)}};function connectNoMoreComms(kernel){const status=kernel?.statusChanged;const connect=status?.
connect;if(!connect||Object.hasOwn(status,"connect"))return;status.connect=(slot,receiver)=>!String(
slot).includes("_cleanSubshells")&&connect.call(status,slot,receiver)}var EDGE=8;function openMenu(element,[x,y],rows){const ending2=new AbortController;let pressed=false;
const close=()=>{ending2.abort();menu.remove();element.focus({preventScroll:true})};const step=by=>{
const items=[...menu.querySelectorAll("button")];const focused=document.activeElement;const present=items.
indexOf(focused);items.at((present+by)%items.length)?.focus()};const keys={ArrowDown:()=>step(1),ArrowUp:()=>step(
-1),Escape:close,Tab:close};const item=row2=>{if(!row2)return make("hr");const[label,key,act]=row2;const onclick=e=>{
if(!pressed&&e.detail)return;close();act()};return make("button",{role:"menuitem",onclick},label,make(
"kbd",{},key))};const menu=shield(make("div",{className:"glid-menu",role:"menu",popover:"manual",onpointerdown:()=>{
pressed=true},onpointerover:e=>{e.target.closest("button")?.focus()},oncontextmenu:e=>e.preventDefault(),
onkeydown:e=>{if(!keys[e.key])return;e.preventDefault();keys[e.key]()}},...rows.map(item)));element.
querySelector(".glid-menu")?.remove();element.append(menu);menu.showPopover();putAt(menu,onPage(element,
[x,y]));const pressedElsewhere=e=>{const target=e.target;if(menu.contains(target))return;close();if(e.
button===0&&element.contains(target))e.stopPropagation()};window.addEventListener("pointerdown",pressedElsewhere,
{capture:true,signal:ending2.signal});step(1)}function onPage(element,[x,y]){const{left,top,width,height}=element.
getBoundingClientRect();return[left+x*width/element.offsetWidth,top+y*height/element.offsetHeight]}function putAt(menu,[
x,y]){const{width,height}=menu.getBoundingClientRect();const zoom=width/menu.offsetWidth||1;menu.style.
left=`${within(x,window.innerWidth-width)/zoom}px`;menu.style.top=`${within(y,window.innerHeight-height)/
zoom}px`}function within(at,room){return Math.max(EDGE,Math.min(at,room-EDGE))}var NEARLY_NOTHING="rgba(255, 255, 255, 0.004)";function painter(canvas,view,signal,draw2){let due=0;
signal.addEventListener("abort",()=>cancelAnimationFrame(due));return()=>{if(due)return;due=requestAnimationFrame(
()=>{due=0;draw2(clearedPen(canvas,view))})}}function clearedPen(canvas,{width,height}){const ratio=window.
devicePixelRatio||1;const wide=Math.round(width*ratio);const high=Math.round(height*ratio);if(canvas.
width!==wide||canvas.height!==high){canvas.width=wide;canvas.height=high}const pen=penOf(canvas);pen.
setTransform(ratio,0,0,ratio,0,0);pen.clearRect(0,0,width,height);pen.fillStyle=NEARLY_NOTHING;pen.fillRect(
0,0,width,height);return pen}function circle(pen,[x,y],radius,strokes,dash){pen.beginPath();pen.arc(
x,y,radius,0,2*Math.PI);strokePath(pen,strokes,dash)}function disk(pen,place,radius,fill,stroke,width=1){
circle(pen,place,radius,[]);pen.fillStyle=fill;pen.fill();if(stroke)strokePath(pen,[[width,stroke]])}
function tracePath(pen,lines2,closed=true){pen.beginPath();for(const line of lines2){line.forEach(([
x,y],i)=>{if(i)pen.lineTo(x,y);else pen.moveTo(x,y)});if(closed)pen.closePath()}}function rectangle([
left,top],[right,bottom]){return[[left,top],[right,top],[right,bottom],[left,bottom]]}function fillPath(pen,lines2,style,rule="\
evenodd"){tracePath(pen,lines2);pen.fillStyle=style;pen.fill(rule)}function strokePath(pen,strokes,dash=[]){
pen.setLineDash(dash);for(const[width,style]of strokes){pen.lineWidth=width;pen.strokeStyle=style;pen.
stroke()}pen.setLineDash([])}function scaleOf(element){const{width,height}=element.getBoundingClientRect();const across=width/element.
offsetWidth||1;return{across,down:height/element.offsetHeight||across}}function placeIn(element,{clientX,
clientY}){const{left,top}=element.getBoundingClientRect();const{across,down}=scaleOf(element);return[
(clientX-left)/across,(clientY-top)/down]}var ZOOM=1.25;var WHEEL_SPEED=.0015;var WHEEL_LINE=33;var LINES=1;var PINCH=5;function distance([x,y],[
u,v]){return Math.hypot(x-u,y-v)}var View=class{x=0;y=0;unit=1;width=0;height=0;constructor(changed,{
up=1,nearest:nearest2,farthest}){this.changed=changed;this.up=up;this.nearest=nearest2;this.farthest=
farthest}toWorld([px,py]){const x=this.x+(px-this.width/2)*this.unit;const y=this.y-this.up*(py-this.
height/2)*this.unit;return[x,y]}toScreen([x,y]){const px=(x-this.x)/this.unit+this.width/2;const py=this.
up*(this.y-y)/this.unit+this.height/2;return[px,py]}line(points){return points.map(point=>this.toScreen(
point))}centreOn([x,y]){this.x=x;this.y=y;this.changed()}pan(dx,dy){this.x-=dx*this.unit;this.y+=this.
up*dy*this.unit;this.changed()}zoom(factor,place=[this.width/2,this.height/2]){const[x,y]=this.toWorld(
place);const unit=Math.min(this.farthest,Math.max(this.nearest,this.unit*factor));this.x=x+(this.x-x)*
(unit/this.unit);this.y=y+(this.y-y)*(unit/this.unit);this.unit=unit;this.changed()}wheel(e,place){e.
preventDefault();this.zoom(Math.exp(turnOf(e)*WHEEL_SPEED*(e.ctrlKey?PINCH:1)),place)}follow(pointers,id,place){
const before=pointers.get(id)??place;const other=[...pointers].find(([one])=>one!==id)?.[1];const share=other?
.5:1;pointers.set(id,place);this.pan(share*(place[0]-before[0]),share*(place[1]-before[1]));if(!other)
return;const apart=one=>Math.max(distance(one,other),1);const middle=[(place[0]+other[0])/2,(place[1]+
other[1])/2];this.zoom(apart(before)/apart(place),middle)}};function turnOf(e){return e.deltaMode===
LINES?e.deltaY*WHEEL_LINE:e.deltaY}var CLICK=4;var LONG_PRESS=600;var LONG_PRESS_GRACE=100;var LONG_PRESS_SLACK=8;var PATH_STEP=3;var Pad=class{pointers=new Map;mode=null;grip=null;held=new Map;path=[];encloses=null;found=null;rests=null;#start=[
0,0];#pans=false;#space=false;#tap=false;#longPress;constructor(element,view,link,behaviour){this.element=
element;this.view=view;this.link=link;this.behaviour=behaviour;element.tabIndex=0;link.signal.addEventListener(
"abort",()=>clearTimeout(this.#longPress));element.addEventListener("pointerdown",e=>this.#down(e));
element.addEventListener("pointermove",e=>this.#move(e));element.addEventListener("pointerup",e=>this.#up(
e,"up"));element.addEventListener("pointercancel",e=>this.#up(e,"cancel"));element.addEventListener(
"lostpointercapture",e=>this.#up(e,"cancel"));element.addEventListener("pointerleave",()=>this.hover(
null));element.addEventListener("wheel",e=>this.#wheel(e),{passive:false});element.addEventListener(
"contextmenu",e=>this.#contextMenu(e));element.addEventListener("keydown",e=>this.keydown(e));element.
addEventListener("keyup",e=>this.#keyup(e));element.addEventListener("focus",()=>behaviour.changed());
element.addEventListener("blur",()=>{this.#setSpace(false);behaviour.changed()})}get focused(){return this.
element.matches(":focus")}place(e){return placeIn(this.element,e)}send(type,place,e={},more={}){const[
x,y]=this.view.toWorld(place);const{unit}=this.view;return this.link.put({type,x,y,unit,reach:this.#reach(
e.pointerType)*unit,button:e.button??0,shift:Boolean(e.shiftKey),alt:Boolean(e.altKey),time:e.timeStamp??
performance.now(),...more})}press(key,e){this.behaviour.pressing?.(key);this.send("key",[this.view.width/
2,this.view.height/2],e,{key})}hover(place=this.rests){this.rests=place;if(this.mode!==null)return;this.
found=place&&this.#find(place,"mouse");this.#showCursor();this.behaviour.changed()}keydown(e){const key=keyOf(
e);const command=e.ctrlKey||e.metaKey;const action=command||e.altKey?void 0:this.behaviour.actions[key.
toLowerCase()];const history=undoOrRedo(e);if(!history&&!action&&key!==" "){if(e.altKey||!this.behaviour.
keys.test(key)||command&&key!=="a")return}e.preventDefault();e.stopPropagation();if(key===" "){if(!e.
repeat)this.#tap=true;this.#setSpace(true)}else if(action){action()}else{if(key==="Escape"||history)
this.#drop();this.press(history??key,e)}}#keyup(e){if(e.key!==" ")return;this.#setSpace(false);if(this.#tap)
this.behaviour.tapped?.()}#reach(type){return this.behaviour.reach[type??"mouse"]??this.behaviour.reach.
mouse}#find(place,type){return this.behaviour.find(this.view.toWorld(place),this.#reach(type)*this.view.
unit)}#down(e){if(this.pointers.has(e.pointerId)||this.pointers.size>1)return;e.preventDefault();this.
element.focus({preventScroll:true});this.#tap=false;const place=this.place(e);this.pointers.set(e.pointerId,
place);this.element.setPointerCapture(e.pointerId);const second=this.pointers.size===2;if(second)this.#takeBack(
e);this.#start=place;this.mode=second||e.button===1||e.button===0&&this.#space?"pan":"hand";if(this.
mode==="hand")this.#handDown(place,e);this.#showCursor()}#handDown(place,e){const{behaviour}=this;const found=this.#find(
place,e.pointerType);const left=e.button===0;const drags=left&&!e.altKey&&(behaviour.constrain||!e.shiftKey);
if(drags&&found?.mark!==void 0){this.grip={from:this.view.toWorld(place),points:behaviour.held(found)}}
this.#pans=left&&Boolean(behaviour.pans?.(found,e));this.encloses=left&&!behaviour.painting?behaviour.
encloses?.(found,e):null;this.path=left?[this.view.toWorld(place)]:[];this.send("down",place,e,{part:found?.
part,at:left?behaviour.pressedAt?.():void 0});if(e.pointerType==="touch"&&behaviour.menu&&!behaviour.
painting){this.#longPress=setTimeout(()=>this.#pressedLong(e,place),LONG_PRESS)}behaviour.changed()}#pressedLong(e,place){
this.#longPress=setTimeout(()=>{this.#takeBack(e);this.mode=null;this.#menu(place,"touch")},LONG_PRESS_GRACE)}#menu(place,type){
this.behaviour.menu?.(place,this.#find(place,type))}#contextMenu(e){e.preventDefault();e.stopPropagation();
const touch=e instanceof PointerEvent&&e.pointerType==="touch";if(e.button===2&&!touch)this.#menu(this.
place(e),"mouse")}#takeBack(e){if(this.mode==="hand")this.send("cancel",this.#start,e);this.#drop()}#move(e){
const place=this.place(e);const touch=e.pointerType==="touch";if(!this.pointers.has(e.pointerId)){if(!touch)
this.hover(place);return}if(!touch)this.rests=place;const far=distance(place,this.#start);if(far>LONG_PRESS_SLACK)
clearTimeout(this.#longPress);if(this.mode==="hand"&&this.#pans&&far>CLICK){this.#takeBack(e);this.mode=
"pan";this.#showCursor()}if(this.mode==="pan"){this.view.follow(this.pointers,e.pointerId,place);return}
this.pointers.set(e.pointerId,place);if(this.mode==="hand")this.#handMoved(place,e,far)}#handMoved(place,e,far){
const free=this.view.toWorld(place);this.#lengthenPath(place,free,far);const[x,y]=this.behaviour.constrain?.(
free,e)??free;if(!this.encloses&&!this.behaviour.painting){this.send("move",place,e,{x,y,replaces:`m\
ove ${e.pointerId}`})}if(this.grip){const dx=x-this.grip.from[0];const dy=y-this.grip.from[1];for(const[
mark,[u,v]]of this.grip.points)this.held.set(mark,[u+dx,v+dy])}this.behaviour.changed()}#lengthenPath(place,point,far){
if(this.encloses==="box"){const[corner]=this.path;this.path=far>CLICK?rectangle(corner,point):[corner];
return}const last=this.path.at(-1);if(last&&distance(place,this.view.toScreen(last))>=PATH_STEP)this.
path.push(point)}#up(e,type){if(!this.pointers.has(e.pointerId))return;const place=this.place(e);this.
pointers.delete(e.pointerId);if(this.mode==="hand"){const{path}=this;this.send(type,place,e,{path,encloses:Boolean(
this.encloses)}).then(()=>{if(!this.grip)this.held.clear();if(this.path===path)this.path=[];this.behaviour.
changed()})}this.#letGo();if(!this.pointers.size)this.mode=null;this.#showCursor()}#letGo(){clearTimeout(
this.#longPress);this.grip=null;this.behaviour.changed()}#drop(){this.#letGo();this.held.clear();this.
path=[]}#wheel(e){if(!this.behaviour.ownsWheel&&!this.focused&&!e.ctrlKey)return;e.stopPropagation();
this.view.wheel(e,this.place(e))}#setSpace(pressed){this.#space=pressed;this.#showCursor()}#showCursor(){
this.element.style.cursor=this.#cursor()}#cursor(){if(this.mode==="pan"||this.grip)return"grabbing";
return this.#space?"grab":this.behaviour.cursor(this.found)}};var Solving=class{#worker;#number=0;#asked=new Map;constructor(worker,onmap=()=>{}){this.#worker=worker;
this.onmap=onmap;worker.onmessage=({data})=>this.#answered(data)}ask(request){const id=this.#send(request);
return new Promise((resolve,reject)=>this.#asked.set(id,{resolve,reject}))}async map(request){const answer=await this.
ask(request);if(answer.type!=="map")throw new Error(`the answer is no map but of type ${answer.type}`);
return answer}drag(pose){return this.#send({type:"drag",pose})}place(pose,coefficients){return this.#send(
{type:"place",pose,coefficients})}#send(request){this.#number+=1;this.#worker.postMessage({...request,
id:this.#number});return this.#number}#answered(answer){const asked=this.#asked.get(answer.id);if(answer.
type==="map")this.onmap(answer);if(answer.type==="map"&&!answer.settled)return;this.#asked.delete(answer.
id);if(answer.type==="failed")asked?.reject(new Error(answer.message));else asked?.resolve(answer)}};
function startedWorker(script){const address=URL.createObjectURL(new Blob([script],{type:"text/javas\
cript"}));const worker=new Worker(address);URL.revokeObjectURL(address);return worker}var FAR=1e3;var Wire=class{#chain;#outline;#vertices;#sizes;constructor(outline,{chain,shaderHoles}){
const loops=[outline.offset_cage,...outline.offset_holes];this.#outline=outline;this.#sizes={chain,holes:shaderHoles};
this.#chain=chainOf(loops.map(loop=>loop.length));this.#vertices=loops.flat();this.cage=this.#cageOf()}#cageOf(){
const cage=new Float32Array(4*this.#sizes.chain);const last=this.#vertices[this.#vertices.length-1];
for(let i=0;i<this.#sizes.chain;i++){const link=this.#chain[i];const[x,y]=link?this.#vertices[link.vertex]:
last;const inverse=link&&!link.first?this.#inverseEdge(i):[0,0];cage.set([x,y,...inverse],4*i)}return cage}#inverseEdge(i){
const[x,y]=this.#vertices[this.#chain[i].vertex];const[u,v]=this.#vertices[this.#chain[i-1].vertex];
const[dx,dy]=[x-u,y-v];const square=dx*dx+dy*dy;return[dx/square,-dy/square]}get length(){const{chain,
holes}=this.#sizes;return 4*(chain+holes)}coefficients(wire){const vertices=this.#vertices.length;const holes=this.#outline.
hole_points.length;const n=vertices+holes;const coefficients=new Float64Array(4*n);for(const[i,{vertex}]of this.#chain.
entries()){for(let part=0;part<4;part++)coefficients[part*n+vertex]=wire[4*i+part]}for(let h=0;h<holes;h++){
const[re,im]=wire.subarray(4*(this.#sizes.chain+h)+2);const parts=[re,im,re,-im];for(const[part,value]of parts.
entries())coefficients[part*n+vertices+h]=value}return coefficients}of(coefficients){const{chain,holes}=this.#sizes;
const n=coefficients.length/4;const wire=new Float32Array(4*(chain+holes));for(const[i,{vertex}]of this.#chain.
entries()){for(let part=0;part<4;part++)wire[4*i+part]=coefficients[part*n+vertex]}const far=FAR*Math.
max(...this.#vertices.map(([x,y])=>Math.hypot(x,y)));const points=this.#outline.hole_points;for(let h=0;h<
holes;h++){const column=this.#vertices.length+h;const vector=h<points.length?[...points[h],coefficients[column],
coefficients[n+column]]:[far];wire.set(vector,4*(chain+h))}return wire}};function chainOf(sizes){const chain=[];
let start=0;for(const size of sizes){chain.push({vertex:start+size-1,first:true});for(let i=0;i<size;i++)
chain.push({vertex:start+i,first:false});start+=size}return chain}var SAME=1e-4;var Ahead=class{#model;#show;#makeWorker;#solving=null;#worker=null;#wire=null;#turn=0;#ready=false;#pose=null;#first=0;constructor(model,show,makeWorker=startedWorker){
this.#model=model;this.#show=show;this.#makeWorker=makeWorker}get leads(){return this.#pose!==null}async prepare(){
this.close();this.#turn+=1;const turn=this.#turn;const script=this.#model.get("solver_script");const{
options}=this.#model.get("solver");const outlined=this.#model.get("outline");if(!script||!options||!outlined.
outline)return;const{outline,...sizes}=outlined;this.#wire=new Wire(outline,sizes);this.#worker=this.#makeWorker(
script);this.#solving=new Solving(this.#worker,map=>this.#take(map));await this.#solving.ask({type:"\
shape",outline,options});this.#ready=turn===this.#turn}follow(held){if(!this.#ready||!this.#solving||
!held.size)return;if(!this.#pose&&!this.#begin(this.#solving,held))return;const pose=this.#pose;const targets=pose.
targets.map((target,i)=>held.get(i)??target);if(targets.every((target,i)=>distance(target,pose.targets[i])===
0))return;this.#pose={...pose,targets};this.#solving.drag(this.#pose)}#begin(solving,held){const{pose,
coefficients}=this.#model.get("rest");const{targets}=this.#model.get("marks");if(pose?.targets.length!==
targets.length)return false;const elsewhere=(one,i)=>!held.has(i)&&distance(one,targets[i])>SAME;if(pose.
targets.some(elsewhere))return false;this.#pose=pose;const floats=new Float64Array(coefficients.buffer.
slice(coefficients.byteOffset,coefficients.byteOffset+coefficients.byteLength));this.#first=solving.
place(pose,floats);return true}giveBack(){if(!this.#pose)return;this.#pose=null;this.#show(null)}close(){
this.giveBack();this.#ready=false;this.#worker?.terminate?.();this.#worker=null;this.#solving=null}#take({
id,coefficients,certificate,pins}){const pose=this.#pose;if(!pose||!this.#wire||id<this.#first||!certificate.
certified)return;const at=(_,i)=>[pins.images[2*i],pins.images[2*i+1]];const images=pose.targets.map(
at);const{targets}=pose;const floats=this.#wire.of(coefficients);this.#show({floats,pins:{targets,images,
samples:pins.samples}})}};function marksOf(marks,lead){const count=marks.targets.length;if(lead?.pins.
targets.length!==count)return marks;const{targets,images,samples}=lead.pins;return{...marks,targets,
images,ring:ringOf(marks,samples,count)}}function ringOf({ring,selected},samples,count){const last=selected.
at(-1);if(ring.length===0||last===void 0)return ring;const[angle,scale,turned,scaled]=ring;const[x,y]=[
samples[last],samples[count+last]];return[turned?angle:Math.atan2(y,x),scaled?scale:Math.hypot(x,y),
turned,scaled]}function pinsOfMenu(pin,selected){return selected.includes(pin)?selected:[pin]}function menuRows(does,pins,covered,marks){
return[...pins===null?shapeRows(does,covered):pinRows(does,pins,marks),...marks.away.length?[["Show \
hidden pins","Shift+H",does.press("h",true)]]:[],["Copy the pose","Ctrl+C",does.press("copy")],["Pas\
te a pose","Ctrl+V",does.paste],["Swap left and right","M",does.press("m")],["Select all pins","A",does.
press("a")],["The undeformed shape","0",does.press("0")],["See everything","F",does.press("f")],["Pa\
int stiff areas","B",does.press("b")],["The picture alone","P",does.alone],["Full screen","W",does.fullScreen],
["All keys","?",does.showKeys]]}function pinRows({press},pins,{locked}){const several=pins.length>1;
const lock=pins.every(i=>locked.includes(i))?"Unlock":"Lock";return[[several?`Remove ${pins.length} \
pins`:"Remove","Delete",press("Delete")],["Remove, keep the shape","Shift+Delete",press("Delete",true)],
null,["Bring forward","Page Up",press("PageUp")],["Send back","Page Down",press("PageDown")],["Leave\
 angle and scale free","X",press("x")],[lock,"L",press("l")],["Hide","H",press("h")],...several?[["G\
roup","G",press("g")]]:[],null]}function shapeRows({pin},covered){return covered?[["Add a pin here",
"Click",pin],null]:[]}function nearest(things,reach){let best2=null;let least=Infinity;for(const thing of things){const far=thing.
d+(thing.loss??0);if(!(thing.d<=reach)||far>=least)continue;best2=thing;least=far}return best2}function nearestEdge(loops,point,reach){const edges=loops.flatMap(loop=>loop.map((start,j)=>{const foot=footOn(
start,loop[(j+1)%loop.length],point);return{foot,d:distance(foot,point)}}));return nearest(edges,reach)}
function footOn(start,end,point){const along=[end[0]-start[0],end[1]-start[1]];const dot=(point[0]-start[0])*
along[0]+(point[1]-start[1])*along[1];const share=Math.min(Math.max(dot/(distance(start,end)**2||1e-30),
0),1);return[start[0]+share*along[0],start[1]+share*along[1]]}function encloses(loop,[x,y]){let winding=0;loop.forEach(([x0,y0],i)=>{const[x1,y1]=loop[(i+1)%loop.
length];const left=(x1-x0)*(y-y0)-(x-x0)*(y1-y0);if(y0<=y&&y1>y&&left>0)winding+=1;if(y0>y&&y1<=y&&left<
0)winding-=1});return winding!==0}var KNOB=6;var KNOB_REACH=4;var RADIUS=42;var LEAST_RADIUS=24;var EDGE2=14;var CORNER=[36,112];var ARROW_REACH=12;
function dial(view,marks,held){const last=marks.selected.at(-1);const[angle,scale,,scaled]=marks.ring;
if(angle===void 0||scale===void 0)return null;if(last===void 0||!marks.targets[last])return null;const centre=view.
toScreen(held?.get(last)??marks.targets[last]);const far=RADIUS*(scaled?Math.min(2.5,Math.max(.5,scale)):
1);return{centre,radius:RADIUS,knob:knobInside(view,centre,far,angle)}}function knobInside(view,centre,radius,angle){
const places=[0,1,-1,2,-2,3,-3,4].map(eighths=>{const direction=angle+eighths*Math.PI/4;const x=centre[0]+
radius*Math.cos(direction);const y=centre[1]-radius*Math.sin(direction);return[within2(x,view.width),
within2(y,view.height)]});return places.find(place=>distance(place,centre)>=LEAST_RADIUS)??places[0]}
function knobInCorner(view,marks,held){const[x,y]=dial(view,marks,held)?.knob??[0,0];return x>view.width-
CORNER[0]-KNOB&&y<CORNER[1]+KNOB}function ringAt(view,marks,place,reach){const ring=dial(view,marks);
if(!ring)return null;if(distance(place,ring.knob)<=Math.max(KNOB+KNOB_REACH,reach))return{part:"knob"};
const far=Math.abs(distance(place,ring.centre)-ring.radius);return far<=reach?{part:"turn"}:null}function markAt(marks,point,reach){
return pinAt(marks,false,point,reach)??pinAt(marks,true,point,reach)}function pinBetweenAt(places,point,reach){
const pins=places.map((place,mark)=>({mark,d:distance(place,point)}));return nearest(pins,reach)}function pinAt(marks,reached,point,reach){
const places=reached?marks.images:marks.targets;const pins=places.map((place,mark)=>{const loss=marks.
hidden.includes(mark)?reach/3:0;return{mark,reached,d:distance(place,point),loss}});return nearest(pins,
reach)}function arrowsTo(view,targets){return targets.filter(target=>!inSight(view,target)).map(target=>{
const[x,y]=view.toScreen(target);const height=within2(y,view.height);const besideButtons=height<CORNER[1]?
CORNER[0]:0;const width=within2(x,view.width-besideButtons);return{at:[width,height],target,angle:Math.
atan2(y-height,x-width)}})}function arrowAt(view,marks,place){const arrow=arrowsTo(view,marks.targets).
find(({at})=>distance(at,place)<ARROW_REACH);return arrow?.target??null}function inSight(view,point){
const[x,y]=view.toScreen(point);return x>=0&&y>=0&&x<=view.width&&y<=view.height}function within2(at,size){
return Math.min(size-EDGE2,Math.max(EDGE2,at))}var TARGET=7.5;var IMAGE=3.5;var RING=12;var APART=2;var BORDER="rgba(255,255,255,0.85)";var PALE="r\
gba(255,255,255,0.9)";var INK="#2b2b2b";var TARGET_FILL="#00d5e0";var TARGET_EDGE="#063f45";var HIDDEN="\
#067a82";var CHOSEN="#0072b2";var WANTED="#d55e00";var FREE="rgba(40,40,40,0.75)";var STIFF="#4b0f7a";
var HOLLOW=[[6,PALE],[4,TARGET_EDGE],[2,TARGET_FILL]];var FAINT=.7;function lines(pen,pairs,strokes){
pen.lineCap="round";tracePath(pen,pairs,false);strokePath(pen,strokes)}function drawOnion(pen,view,outlines){
for(const[color,loops]of outlines){tracePath(pen,loops.map(loop=>view.line(loop)));strokePath(pen,[[
3.6,BORDER],[1.8,color]])}}function hatching(pen,strength){const size=Math.round(16-9*strength);const tile=make(
"canvas",{width:size,height:size});const ink=penOf(tile);const diagonals=[[[0,size],[size,0]],[[-1,1],
[1,-1]],[[size-1,size+1],[size+1,size-1]]];tracePath(ink,diagonals,false);strokePath(ink,[[3,"rgba(2\
55,255,255,0.75)"],[1.5,STIFF]]);return pen.createPattern(tile,"repeat")??STIFF}function drawStiff(pen,view,areas,painting){
pen.globalAlpha=painting?1:.4;for(const[strength,loops]of areas){const style=painting?hatching(pen,strength):
"transparent";fillPath(pen,loops.map(loop=>view.line(loop)),style,"nonzero");strokePath(pen,[[3.4,BORDER],
[1.5,STIFF]])}pen.globalAlpha=1}function drawBrush(pen,view,{radius,strength},{path,rests}){const wide=radius/
view.unit;const last=path.at(-1);if(last){tracePath(pen,[view.line([...path,last])],false);pen.lineCap=
"round";pen.lineJoin="round";pen.globalAlpha=.45;strokePath(pen,[[2*wide,strength?STIFF:"#ffffff"]]);
pen.globalAlpha=1}if(!rests)return;circle(pen,rests,wide,[[3.4,BORDER],[1.4,STIFF]])}function drawLasso(pen,view,path){
fillPath(pen,[view.line(path)],"rgba(0,114,178,0.12)");const strokes=[[3,BORDER],[1.4,CHOSEN]];strokePath(
pen,strokes,[5,3])}function drawMarks(pen,view,marks,{hovered,held,cursor}){const targets=view.line(
marks.targets.map((point,i)=>held.get(i)??point));const images=view.line(marks.images);drawMisses(pen,
targets,images);targets.forEach((target,i)=>{if(marks.selected.includes(i))disk(pen,target,RING,"rgb\
a(0,114,178,0.28)",CHOSEN,2);else if(i===hovered)disk(pen,target,RING,"rgba(0,114,178,0.14)");drawTarget(
pen,target,marks.hidden.includes(i))});drawRing(pen,view,marks,held);drawArrows(pen,view,marks);images.
forEach((image,i)=>{if(marks.hidden.includes(i))return;disk(pen,image,IMAGE+1,PALE);disk(pen,image,IMAGE,
"#111")});if(cursor)drawCursor(pen,view.toScreen(cursor))}function drawBetween(pen,view,places,{hovered,
held}){view.line(places.map((place,i)=>held.get(i)??place)).forEach((place,i)=>{const touched=i===hovered||
held.has(i);if(touched)disk(pen,place,RING,"rgba(0,114,178,0.14)");pen.globalAlpha=touched?1:FAINT;circle(
pen,place,TARGET,HOLLOW)});pen.globalAlpha=1}function drawMisses(pen,targets,images){const pairs=targets.
map((target,i)=>[images[i],target]);const apart=pairs.filter(([image,target])=>image&&distance(image,
target)>=APART);lines(pen,apart,[[3.6,BORDER],[1.6,INK]])}function drawTarget(pen,place,hidden){if(!hidden){
disk(pen,place,TARGET,TARGET_FILL,TARGET_EDGE,1.4);return}const strokes=[[3.4,BORDER],[1.6,HIDDEN]];
circle(pen,place,TARGET,strokes,[3.5,2.4])}function drawRing(pen,view,marks,held){const ring=dial(view,
marks,held);if(!ring)return;const[,,turned,scaled]=marks.ring;const{centre,radius,knob}=ring;const[x,
y]=knob;const color=turned?WANTED:FREE;circle(pen,centre,radius,[[4,BORDER]]);circle(pen,centre,radius,
[[2,color]],turned?[]:[6,4]);lines(pen,[[centre,knob]],[[3,BORDER],[1.2,color]]);const square=rectangle(
[x-KNOB,y-KNOB],[x+KNOB,y+KNOB]);fillPath(pen,[square],scaled?WANTED:"#fff");strokePath(pen,[[1.6,scaled?
"#fff":FREE]])}function drawArrows(pen,view,marks){for(const{at,angle}of arrowsTo(view,marks.targets)){
const corner=(turn,radius)=>[at[0]+radius*Math.cos(angle+turn),at[1]+radius*Math.sin(angle+turn)];fillPath(
pen,[[corner(0,11),corner(2.4,9),corner(-2.4,9)]],TARGET_FILL);strokePath(pen,[[1.6,TARGET_EDGE]])}}
function drawCursor(pen,[x,y]){const arm=(dx,dy)=>[[x+4*dx,y+4*dy],[x+13*dx,y+13*dy]];lines(pen,[arm(
1,0),arm(-1,0),arm(0,1),arm(0,-1)],[[4,PALE],[1.6,WANTED]])}function wordsOf([x,y],[angle=0,scale=1,turned,scaled]){return{x:rounded(x),y:rounded(y),angle:turned?
significant(angle*180/Math.PI):"",scale:scaled?significant(scale):"",detail:`${short(x)}, ${short(y)}`}}
function fieldWords(places,ring,before){const words2=places.map(place=>wordsOf(place,ring));const[{x,
y,angle,scale}]=words2;const follows=name=>ring.length&&(words2.length===1||before[name]);return{x:words2.
every(one=>one.x===x)?x:"",y:words2.every(one=>one.y===y)?y:"",angle:follows("angle")?angle:before.angle,
scale:follows("scale")?scale:before.scale}}function rounded(number2){return String(Number(number2.toFixed(
3))||0)}function significant(number2){return String(Number(Number(number2.toFixed(4)).toPrecision(4))||
0)}function short(number2){return(Number(number2.toFixed(2))||0).toFixed(2).replace("-","−")}function meansStill(said,wrote,now){
if(now===wrote||said===wrote)return false;const apart=one=>Math.abs(numberIn(one)-numberIn(now));return now===
said||apart(said)<apart(wrote)}function numberIn(text){const numbers=text.replaceAll("−","-").split(
",").map(Number.parseFloat);return numbers[0]+Math.PI*(numbers[1]??0)}var Written=class{said="";wrote="";constructor(element){
this.element=element;this.said=this.text;this.wrote=this.said}get text(){const{element}=this;return element instanceof
HTMLInputElement?element.value:element.textContent??""}put(text){if(this.text!==this.wrote)this.said=
this.text;this.wrote=text;if(this.text===text)return;if(this.element instanceof HTMLInputElement)this.
element.value=text;else this.element.textContent=text}settle(now){if(this.text===this.wrote&&meansStill(
this.said,this.wrote,now))this.put(this.said)}};var FollowedNumbers=class{#written=new Map;constructor(pad){
this.pad=pad}follow(marks,held){for(const[element,text]of this.#texts(marks,held)){const written=this.#written.
get(element)??new Written(element);this.#written.set(element,written);written.put(text)}}settle(marks){
if(!this.#written.size)return;for(const[element,text]of this.#texts(marks,new Map)){this.#written.get(
element)?.settle(text)}this.#written.clear()}#texts({targets,selected,ring},held){const side=this.pad.
closest(".glid-editor")?.querySelector(".glid-side .glid-bars");const last=selected.at(-1);if(!side||
last===void 0||!targets[last])return[];const field=name=>{return side.querySelector(`.glid-number-${name}\
 input`)};const places=selected.map(i=>held.get(i)??targets[i]).filter(Boolean);const before={angle:field(
"angle")?.value??"",scale:field("scale")?.value??""};const found=Object.entries(fieldWords(places,ring,
before)).map(([name,text])=>[field(name),text]);const cells=side.querySelectorAll(".glid-entry-detai\
l");for(const[i,cell]of cells.entries()){const place=held.get(i)??targets[i];if(place)found.push([cell,
wordsOf(place,[]).detail])}return found.filter(([element])=>element)}};var COUNT=3;var GRID=24;var USED="glid-nb-pinned";var RADIUS2=8;function ghostPins({cage,holes}){const loops=[
cage,...holes];const candidates=gridOver(cage).filter(point=>encloses(cage,point)&&!holes.some(hole=>encloses(
hole,point))).map(point=>({point,clearance:nearestEdge(loops,point,Infinity)?.d??0}));if(!candidates.
length)return[];const places=[best(candidates,[middleOf(candidates)])];while(places.length<COUNT)places.
push(best(candidates,places));return places}function gridOver(loop){const xs=loop.map(([x])=>x);const ys=loop.
map(([,y])=>y);const along=(values,i)=>{const[low,high]=[Math.min(...values),Math.max(...values)];return low+
(i+.5)/GRID*(high-low)};return Array.from({length:GRID*GRID},(_,i)=>[along(xs,i%GRID),along(ys,Math.
floor(i/GRID))])}function middleOf(candidates){const sum=candidates.reduce(([u,v],{point:[x,y]})=>[u+
x,v+y],[0,0]);return[sum[0]/candidates.length,sum[1]/candidates.length]}function best(candidates,others){
const score=({point,clearance})=>Math.min(...others.map(other=>distance(point,other)))*Math.sqrt(clearance);
return candidates.reduce((a,b)=>score(b)>score(a)?b:a).point}var Ghosts=class{#outline=null;#places=[];draw(pen,view,outline,pinned){
if(pinned)remember();if(pinned||!outline||remembered())return;if(outline!==this.#outline){this.#outline=
outline;this.#places=ghostPins(outline)}pen.globalAlpha=.75;for(const place of view.line(this.#places)){
disk(pen,place,RADIUS2,"rgba(255,255,255,0.75)");const ring=[[2,"#067a82"]];circle(pen,place,RADIUS2,
ring,[4,2.3]);disk(pen,place,2.5,"#067a82")}pen.globalAlpha=1}};var used=false;function remembered(){
try{return used||sessionStorage.getItem(USED)!==null}catch{return used}}function remember(){if(used)
return;used=true;try{sessionStorage.setItem(USED,"1")}catch{}}var HELP=[["Pins",[["Click the shape","pin a point"],["Drag a pin, or the shape","move it there; the\
 shape follows, and never folds"],["Shift, Ctrl in a drag","keep it on one axis; on whole pixels of \
the picture; Shift turns by 15°"],["Right-click, long touch, Shift+F10","a menu for the pin or the \
shape there"],["Delete","remove the selected pins; with Shift keep the shape"],["Ring around a pin; \
Alt on the pin","turn the shape there; the ring's knob scales it too"],["< >, + -, X","turn, scale; \
free both again"],["Page Down, Page Up, [ ]","send selected pins and their surroundings back, forwar\
d"],["L, H","lock the selected pins, hide them; Shift+H shows all again"],["G","make a group: it is \
selected and moved together; with Shift dissolve it"],["Arrow keys","nudge selected pins, with Shift\
 farther; else move a cursor"],["Enter","show the cursor; pin or select there"]]],["Selecting",[["Sh\
ift-click, A","select several pins, all pins"],["N, Shift+N, click a part","edit another part, if th\
ere are several"],["Shift and drag, Ctrl and drag","select the pins in a box, in a lasso"],[", .","s\
elect the pin before, the next pin, and bring it into view; so does a click on an arrow at the edge"],
["In the list of pins","arrow keys, with Shift several; Ctrl-click one more; F2, double click: renam\
e"],["Esc","cancel a drag; select nothing"]]],["Poses",[["Ctrl+Z, Ctrl+Shift+Z","undo, redo"],["Ctrl\
+C, Ctrl+V","copy the pose, put it on this or a similar shape"],["M","swap left and right"],["0","ba\
ck to the undeformed shape"]]],["Stiff areas",[["B, E","paint stiff areas, erase them; Esc ends pain\
ting"]]],["View",[["Wheel, two fingers","zoom"],["Middle button, Space and drag","move the view"],["\
F","see everything"],["P","the picture alone, for lectures; Esc brings the rest back"],["W","the who\
le screen, without the inspector"],["I","hide the inspector, show it again"]]],["Timeline",[["K; a d\
rag of a hollow pin","make a keyframe at the time that is shown"],["Space","play the motion through \
the poses, pause; on the canvas too"],["Arrow keys, Home, End","step a frame, with Shift to the next\
 pose; first, last pose"],["Click a curve between poses, Enter","ease the motion there: drag its two\
 handles, or arrow keys"],["Shift+Home, Shift+End","play over and over from here, to here; so do the\
 two marks on the ruler, seen below a pointer"],["Line below the poses","green: proved, the higher t\
he safer; grey hatching: not yet; orange: not proved"],["Ctrl and wheel","zoom the timeline; then th\
e wheel alone moves along it"],["Double click a pose, F2","type its name"],["Alt and arrow keys","mo\
ve the pose in time; Delete removes it"]]]];var Legend=class{element=make("div",{className:"glid-legend"});show(model,moving){const bars=[model.
get("legend"),model.get("panel_legend")].filter(bar=>bar.title);this.element.replaceChildren(...bars.
map(bar=>colorBar(bar,moving)));this.element.hidden=!bars.length;this.element.dataset.corner=model.get(
"legend_corner")}};function colorBar({title,moving,colors,ticks,about},moves){const gradient=`backgr\
ound: linear-gradient(to right, ${colors.join(", ")})`;const labels=ticks.map(tick=>make("span",{},tick));
return make("div",{className:"glid-legend-part",title:about},make("div",{className:"glid-legend-titl\
e"},moves&&moving||title),make("div",{className:"glid-legend-bar",style:gradient}),make("div",{className:"\
glid-legend-ticks"},...labels))}var FIRST="Click the shape to pin a point, then drag the pin · ? shows all keys";var PAINT="Paint s\
tiff areas · E erases · Esc when done";var Notices=class{notice=make("div",{className:"glid-notice",
role:"status"});prepared=make("div",{className:"glid-prepared",role:"progressbar","aria-label":"Prep\
aring the solver",hidden:true});tell(refusal,painting,first){const advice=painting?PAINT:first&&FIRST;
const{notice}=this;notice.textContent=refusal||advice||"";notice.hidden=!notice.textContent;notice.classList.
toggle("glid-first",!refusal);notice.classList.toggle("glid-invites",!refusal&&!painting)}prepare(share){
const{prepared}=this;prepared.hidden=share>=1;prepared.setAttribute("aria-valuenow",String(Math.round(
100*share)));prepared.style.setProperty("--glid-share",String(share))}};var LONGER_SIDE=20;function constrained([x0,y0],[x,y],{axis,whole},size){const across=Math.abs(x-x0)>=
Math.abs(y-y0);const[u,v]=whole?onPixel([x,y],size):[x,y];if(!axis)return[u,v];return across?[u,y0]:
[x0,v]}function pixelAt([x,y],[width,height]){const unit=pixelOf([width,height]);return[x/unit+width/
2,height/2-y/unit]}function onPixel(point,size){const[width,height]=size;if(!width||!height)return point;
const unit=pixelOf(size);const[px,py]=pixelAt(point,size).map(Math.round);return[(px-width/2)*unit,(height/
2-py)*unit]}function pixelOf([width,height]){return LONGER_SIDE/Math.max(width,height)}var BESIDE=20;var PADDING=6;var LINE=16;var FONT="600 11px system-ui, sans-serif";var GROUND="rgba(2\
5,28,34,0.88)";var INK2="#ffffff";var GUIDE="#d55e00";function movedPin(pressed,marks,held,size){const mark=pinOf(
pressed,marks);if(mark===void 0||!marks.targets[mark])return null;const at=held.get(mark)??marks.targets[mark];
if(pressed.found?.part)return{at,words:turnWords(marks.ring)};const[x,y]=at;const words2=[`x ${coordinate(
x)}   y ${coordinate(y)}`];if(pressed.keys?.whole&&size.length){const[px,py]=pixelAt(at,size).map(Math.
round);words2.push(`pixel ${px}, ${py}`)}return{at,words:words2}}function pinOf({found,pins},{selected,
targets}){if(found?.mark!==void 0)return Number(found.mark);return found?.part||targets.length>pins?
selected.at(-1):void 0}function turnWords([angle=0,scale=1,turned,scaled]){const freely=wanted=>wanted?
"":" free";const degrees=Number((angle*180/Math.PI).toFixed(1))||0;return[`${degrees}°${freely(turned)}`,
`× ${scale.toFixed(2)}${freely(scaled)}`]}function coordinate(number2){return(number2||0).toFixed(3).
replace("-","−")}function drawNumbers(pen,view,{at,words:words2}){if(!words2.length)return;const[x,
y]=view.toScreen(at);pen.font=FONT;const width=Math.max(...words2.map(text=>pen.measureText(text).width))+
2*PADDING;const height=LINE*words2.length+PADDING;const beside=x+BESIDE+width<=view.width?x+BESIDE:x-
BESIDE-width;const left=Math.max(beside,2);const top=Math.min(Math.max(y-BESIDE-height,2),view.height-
height-2);pen.beginPath();pen.roundRect(left,top,width,height,4);pen.fillStyle=GROUND;pen.fill();pen.
fillStyle=INK2;pen.textBaseline="middle";words2.forEach((text,i)=>{pen.fillText(text,left+PADDING,top+
PADDING/2+LINE*(i+.5))})}function drawAxis(pen,view,start,at){const[x,y]=view.toScreen(start);const across=start[1]===
at[1];const line=across?[[0,y],[view.width,y]]:[[x,0],[x,view.height]];tracePath(pen,[line],false);strokePath(
pen,[[1,GUIDE]],[4,4])}var BESIDE2=9;var WIDE=5;var HIGH=3.5;var PAPER="rgba(255,255,255,0.9)";var INK3="#2b2b2b";function withoutHidden(marks,{
away},elsewhere){if(!away.length)return marks;const placed=points=>points.map((point,i)=>away.includes(
i)?[elsewhere,elsewhere]:point);return{...marks,targets:placed(marks.targets),images:placed(marks.images)}}
function movedWith(pressed,selected,{locked,groups}){if(locked.includes(pressed))return[];if(selected.
includes(pressed))return selected.filter(i=>!locked.includes(i));const group=groups[pressed];if(!group)
return[pressed];return[...groups.keys()].filter(i=>groups[i]===group&&!locked.includes(i))}function drawLocks(pen,view,{
targets},{locked}){for(const i of locked)if(targets[i])drawLock(pen,view.toScreen(targets[i]))}function drawLock(pen,[
x,y]){const[cx,cy]=[x+BESIDE2,y+BESIDE2];pen.beginPath();pen.arc(cx,cy-HIGH,WIDE-1.5,Math.PI,0);const shackle=[
[4,PAPER],[1.8,INK3]];strokePath(pen,shackle);const body=rectangle([cx-WIDE,cy-HIGH],[cx+WIDE,cy+HIGH]);
tracePath(pen,[body]);strokePath(pen,[[2.5,PAPER]]);fillPath(pen,[body],INK3)}var REACH={mouse:13,pen:16,touch:26};var KEYS=/^(Arrow\w+|Page\w+|Delete|Backspace|Escape|Enter|[0fa,.[\]<>+=xmbelhgn-])$/i;
var TARGET_TIP="where it should be. Drag it; Alt turns it; a right click shows more; Shift-click sel\
ects several";var IMAGE_TIP="where the shape is now. The cyan disk is where it should be";var LOCKED_TIP="\
locked where it is; L unlocks it when it is selected";var BETWEEN_TIP="where it is at this time. A d\
rag makes a keyframe here";var BETWEEN_LOCKED="locked; unlock it at a keyframe (L)";var COVERED=". A\
nother part of the shape covers it";var RING_TIPS={turn:"Drag around the pin to turn the shape there\
; X frees it again",knob:"Drag around the pin to turn the shape there, away from it to scale it; X f\
rees it again"};var PinBehaviour=class{reach=REACH;keys=KEYS;pressed=null;#between=null;constructor(canvas){
this.canvas=canvas;this.actions={"?":canvas.help.toggle,b:()=>canvas.toggleTool("stiff"),e:()=>canvas.
toggleTool("erase"),contextmenu:()=>canvas.openMenu(),i:()=>canvas.room?.toggleInspector(),k:()=>void canvas.
box.dispatchEvent(new CustomEvent("glid:key",{bubbles:true})),p:()=>canvas.room?.alone(),reference:()=>canvas.
reference.toggle(),w:()=>canvas.room?.fullScreen(),"tool:":()=>canvas.takeTool(""),"tool:stiff":()=>canvas.
takeTool("stiff"),"tool:erase":()=>canvas.takeTool("erase"),"zoom:in":()=>canvas.view.zoom(1/ZOOM),"\
zoom:out":()=>canvas.view.zoom(ZOOM)}}pressing(key){if(key==="Escape")this.canvas.putBrushAway()}get painting(){
return this.canvas.painting}changed(){const{pad}=this.canvas;if(pad.encloses&&pad.path.length>2)this.
canvas.leaveMotion();this.canvas.followHand();this.canvas.redraw()}menu(place,found){if(!this.canvas.
shapes.motion)this.canvas.openMenu(place,found)}pressedAt(){return this.canvas.pressedAt()}tapped(){
this.canvas.box.dispatchEvent(new CustomEvent("glid:play",{bubbles:true}))}find(point,reach){const{view,
marks,reachable:reachable2,shapes,painting}=this.canvas;if(painting)return null;if(shapes.motion)return pinBetweenAt(
this.canvas.between.places,point,reach);const mark=markAt(reachable2,point,reach);return mark??ringAt(
view,marks,view.toScreen(point),reach/view.unit/2)}encloses(found,e){const start=this.canvas.pad.grip?.
points.get(found?.mark??"");this.pressed={found,start,pins:this.canvas.marks.targets.length};if(found)
return null;if(e.shiftKey)return"box";return e.ctrlKey||e.metaKey?"lasso":null}get constrains(){const{
axis,whole}=this.pressed?.keys??{};return Boolean(axis||whole)}madePin(){const{pad,model}=this.canvas;
const{pressed}=this;if(!pressed||pressed.found||this.painting||pad.mode!=="hand")return void 0;const count=model.
get("rest").pose?.targets.length??0;return count===pressed.pins+1&&!pad.encloses?pressed.pins:void 0}held({
mark}){const{shapes,between}=this.canvas;if(shapes.motion)return this.#heldBetween(Number(mark),between);
this.#between=null;const{selected,targets}=this.canvas.allMarks;const moved=movedWith(Number(mark),selected,
this.canvas.model.get("pins"));return new Map(moved.map(i=>[i,targets[i]]))}#heldBetween(mark,{places,
locked}){this.#between={mark,places};return new Map(locked.includes(mark)?[]:[[mark,places[mark]]])}motionLeft(){
const{pad,shapes,allMarks,model}=this.canvas;const between=this.#between;if(!between||!pad.grip||shapes.
motion)return;const{mark,places}=between;const all=movedWith(mark,allMarks.selected,model.get("pins"));
const moved=all.filter(i=>i in places);pad.grip.points=new Map(moved.map(i=>[i,places[i]]));this.canvas.
followHand()}constrain(point,e){const{model,pad}=this.canvas;const{pressed}=this;const[from]=pad.path;
if(!pressed||!from||pressed.found?.part||pad.encloses||e.altKey)return point;pressed.keys={axis:e.shiftKey,
whole:e.ctrlKey||e.metaKey};pressed.start??=from;const[x,y]=pressed.start;const free=[x+point[0]-from[0],
y+point[1]-from[1]];const[u,v]=constrained([x,y],free,pressed.keys,model.get("picture_size"));return[
u-x+from[0],v-y+from[1]]}cursor(found){this.canvas.box.title=this.#tip(found);if(found?.mark!==void 0&&
this.#locked(found))return"pointer";return found?"grab":"crosshair"}#locked({mark}){const{shapes,between,
model}=this.canvas;const{locked}=shapes.motion?between:model.get("pins");return locked.includes(Number(
mark))}#tip(found){if(!found)return"";const{marks,model,shapes}=this.canvas;if(found.part)return`${turnWords(
marks.ring).join(", ")}. ${RING_TIPS[found.part]}`;const mark=Number(found.mark);if(shapes.motion){return`\
Pin ${mark+1}: ${this.#locked(found)?BETWEEN_LOCKED:BETWEEN_TIP}`}const name=["Pin",mark+1,model.get(
"names")[mark]].join(" ").trim();if(this.#locked(found))return`${name}: ${LOCKED_TIP}`;const tip=found.
reached?IMAGE_TIP:TARGET_TIP;return`${name}: ${tip}${marks.hidden.includes(mark)?COVERED:""}`}};async function copied(text){try{await navigator.clipboard.writeText(text);return true}catch{return copiedBySelection(
text)}}function copiedBySelection(text){const focused=document.activeElement;const area=document.createElement(
"textarea");area.value=text;area.setAttribute("readonly","");Object.assign(area.style,{position:"fix\
ed",top:"0",left:"0",opacity:"0"});document.body.append(area);area.select();try{return document.execCommand(
"copy")}catch{return false}finally{area.remove();if(focused instanceof HTMLElement)focused.focus({preventScroll:true})}}var COPIED="The pose is in the clipboard; Ctrl+V on a canvas puts it there";var NOT_COPIED="The brow\
ser does not give access to the clipboard; use Ctrl+C and Ctrl+V";var PoseClipboard=class{constructor(canvas){
this.canvas=canvas;const{model,box,pad}=canvas;model.on("msg:custom",async({copy:text})=>{if(text&&pad.
focused)canvas.say(await copied(text)?COPIED:NOT_COPIED)});box.addEventListener("copy",e=>{if(!pad.focused)
return;e.preventDefault();pad.press("copy")});box.addEventListener("paste",e=>{e.preventDefault();this.#put(
e.clipboardData?.getData("text")??"")})}async paste(){try{this.#put(await navigator.clipboard.readText())}catch{
this.canvas.say(NOT_COPIED)}}#put(text){this.canvas.link.put({type:"paste_pose",text})}};var LONGEST=1600;var QUALITY=.85;var WORLD=20;function placeOf([width,height],picture,view){const world=picture.
map(side=>WORLD*side/Math.max(...picture));const scale=Math.min(world[0]/width,world[1]/height)/view.
unit;const[x,y]=view.toScreen([0,0]);const[wide,high]=[scale*width,scale*height];return{left:x-wide/
2,top:y-high/2,width:wide,height:high}}var Reference=class{#picture=null;#behind=null;#turn=0;constructor(box,model,view){
this.box=box;this.model=model;this.view=view}close(){this.#turn+=1;this.#drop()}#drop(){for(const picture of[
this.#picture,this.#behind]){if(picture)URL.revokeObjectURL(picture.url)}}toggle(){if(this.model.get(
"reference").byteLength){save(this.model,{reference:new DataView(new ArrayBuffer(0))});return}const input=make(
"input",{type:"file",accept:"image/*"});input.addEventListener("change",()=>input.files?.[0]&&this.#take(
input.files[0]));input.click()}async#take(file){try{save(this.model,{reference:new DataView(await shrunk(
file)),notice:""})}catch{save(this.model,{notice:`${file.name} is not a picture that this browser ca\
n show`})}}async show(){this.#turn+=1;const turn=this.#turn;const{model}=this;const pictures=[model.
get("reference"),model.get("behind_reference")].map(opened);const[picture,behind]=await Promise.all(
pictures);if(turn!==this.#turn)return;this.#drop();this.#picture=picture&&{...picture,url:URL.createObjectURL(
picture.blob)};this.#behind=behind&&{...behind,url:URL.createObjectURL(behind.blob)};this.place()}place(){
const pane=this.box.closest(".glid-pane");if(!pane)return;pane.classList.toggle("glid-referenced",this.#picture!==
null);const frame=this.model.get("picture_size");this.#put(pane,"--glid-reference",this.#picture);this.#put(
pane,"--glid-behind",this.#behind&&{...this.#behind,size:frame})}#put({style},name,picture){if(!picture){
style.removeProperty(name);return}const at=placeOf(picture.size,this.model.get("picture_size"),this.
view);style.setProperty(name,`url("${picture.url}")`);style.setProperty(`${name}-place`,`${at.left}p\
x ${at.top}px`);style.setProperty(`${name}-size`,`${at.width}px ${at.height}px`)}};async function opened(bytes){
if(!bytes.byteLength)return null;const blob=new Blob([bytes]);const bitmap=await createImageBitmap(blob);
const size=[bitmap.width,bitmap.height];bitmap.close();return{blob,size}}async function shrunk(file){
const bitmap=await createImageBitmap(file);const scale=Math.min(1,LONGEST/Math.max(bitmap.width,bitmap.
height));const width=Math.max(1,Math.round(scale*bitmap.width));const height=Math.max(1,Math.round(scale*
bitmap.height));const canvas=make("canvas",{width,height});penOf(canvas).drawImage(bitmap,0,0,width,
height);bitmap.close();const blob=await new Promise((done,fail)=>{canvas.toBlob(made=>made?done(made):
fail(),"image/webp",QUALITY)});return blob.arrayBuffer()}var LEAST_SIZE=240;function resizeGrip(model){let beyond=null;const side=length=>Math.max(LEAST_SIZE,
Math.round(length));const grip=make("div",{className:"glid-resize",title:"Drag to resize"});const place=({
clientX,clientY})=>{const{across,down}=scaleOf(grip);return[clientX/across,clientY/down]};grip.addEventListener(
"pointerdown",e=>{e.preventDefault();grip.setPointerCapture(e.pointerId);const[x,y]=place(e);beyond=
{width:model.get("width")-x,height:model.get("height")-y}});grip.addEventListener("pointermove",e=>{
if(!beyond)return;const[x,y]=place(e);save(model,{width:side(beyond.width+x),height:side(beyond.height+
y)})});grip.addEventListener("lostpointercapture",()=>{beyond=null});return shield(grip)}var CONTROLS="button, select, input, img, [role=slider]";var SAYS_SOMETHING=/[\p{L}\p{N}]/u;function nameControls(root,signal){
const name=()=>{for(const control of root.querySelectorAll(CONTROLS))nameOne(control)};const observer=new MutationObserver(
name);const what={childList:true,subtree:true,attributes:true,attributeFilter:["title"]};observer.observe(
root,what);signal.addEventListener("abort",()=>observer.disconnect());name()}function nameOne(control){
for(const icon of control.querySelectorAll("i"))icon.ariaHidden="true";const isImage=control instanceof
HTMLImageElement;const attribute=isImage?"alt":"aria-label";const given=control.getAttribute(attribute);
if(given!==null&&control.getAttribute("data-glid-name")!==given)return;if(isNamed(control))return;const name=nameAround(
control);if(!name||name===given)return;control.setAttribute(attribute,name);control.setAttribute("da\
ta-glid-name",name)}function isNamed(control){if(control instanceof HTMLButtonElement)return SAYS_SOMETHING.
test(control.textContent??"");const labels="labels"in control?control.labels:null;return[...labels??
[]].some(label=>SAYS_SOMETHING.test(label.textContent??""))}function nameAround(control){const own=control.
getAttribute("title");if(own)return own;if(control.matches(".glid-plots, .glid-plots *"))return"Plot\
s of the solve";const widget=control.closest(".jupyter-widgets");const label=widget?.querySelector("\
.widget-label")?.textContent?.trim();return label||widget?.getAttribute("title")||labelBefore(widget??
control)}function labelBefore(one){let before=one.previousElementSibling;while(before&&!before.matches(
".widget-label"))before=before.previousElementSibling;return before?.textContent?.trim()??""}var NOTEBOOK=124;var PAGE=48;var PARTS=44+110+28+2;var NARROW_LEGEND=42;var TABS=34;var LEAST=280;var NARROW_LEAST=220;
var BESIDE3=340;var PLOTS=477;var SLACK=20;var SETTLE=80;var NARROW=600;var CLOSE=800;var Room=class{#root=null;#last={
width:0,height:0,all:0};#decides=false;#told="";#room=null;#foot={layout:"",height:0};#plotted=true;#timer;constructor(pad,model,signal){
this.pad=pad;this.model=model;this.signal=signal;this.observer=new ResizeObserver(()=>this.#measureSoon());
this.observer.observe(pad);window.addEventListener("resize",()=>this.#measureSoon(),{signal});window.
addEventListener("keydown",e=>this.#escape(e),{signal,capture:true});model.on("change:room",()=>{if(String(
model.get("room"))!==this.#told)this.#decides=false});const left=()=>{const full=document.fullscreenElement;
if(!full)this.alone(false);if(!full||full===this.#root)this.toggleInspector(Boolean(full))};document.
addEventListener("fullscreenchange",left,{signal});signal.addEventListener("abort",()=>{clearTimeout(
this.#timer);this.observer.disconnect()})}alone(on=!this.#isAlone){const root=this.#root;if(!root||!on&&
!this.#isAlone){this.#measureSoon();return}root.classList.toggle("glid-alone",on);this.#decides=true;
this.#measure();root.scrollIntoView({block:on?"start":"nearest"});this.pad.focus({preventScroll:true});
if(!on&&document.fullscreenElement)document.exitFullscreen()}fullScreen(){if(document.fullscreenElement){
document.exitFullscreen();return}this.#root?.requestFullscreen().catch(error=>{save(this.model,{notice:`\
Full screen is not possible here: ${error.message}`})})}toggleInspector(away){const root=this.#root;
if(!root||root.classList.contains("glid-side-away")===away)return;const focused=root.querySelector("\
.glid-side")?.contains(document.activeElement);const hidden=root.classList.toggle("glid-side-away",away);
if(hidden&&focused)this.pad.focus({preventScroll:true});this.#decides=true;this.#measureSoon()}get#isAlone(){
return Boolean(this.#root?.classList.contains("glid-alone"))}#escape(e){if(e.key!=="Escape"||!this.#isAlone)
return;if(this.pad.matches(":active, :has(.glid-menu, :popover-open)"))return;e.stopPropagation();this.
alone(false)}#measureSoon(){clearTimeout(this.#timer);this.#timer=setTimeout(()=>this.#measure(),SETTLE)}#measure(){
const root=this.pad.closest(".glid-editor");const shell=this.pad.closest(".glid-shell");if(!root||!shell?.
clientWidth)return;root.classList.toggle("glid-narrow",root.clientWidth<NARROW);root.classList.toggle(
"glid-close",root.clientWidth<CLOSE);const room=this.#roomIn(root,shell);if(!this.#root)this.#begin(
root,shell,room);this.#room=room;this.shrink();if(!this.#decides)return;const last=this.#last;const wider=room.
width-last.width;const same=room.height===last.height&&room.all===last.all;if(same&&wider>=0&&wider<
SLACK)return;this.#last=room;const numbers=[room.width,room.height,room.all].map(Math.floor);this.#told=
String(numbers);save(this.model,{room:numbers})}#begin(root,shell,room){this.#root=root;this.observer.
observe(root);this.observer.observe(shell);const plots=shell.querySelector(".glid-plots-box");if(plots)
this.observer.observe(plots);nameControls(root,this.signal);const[width=0]=this.model.get("room");this.#decides=
room.width>width;const released=()=>{this.#decide();this.#measureSoon()};root.addEventListener("poin\
terup",released,{signal:this.signal});const inspected=()=>this.toggleInspector(false);root.addEventListener(
"glid:inspect",inspected,{signal:this.signal})}#decide(){if(this.#decides)return;this.#decides=true;
this.#last={width:0,height:0,all:0}}shrink(){const whole=this.pad.closest(".glid-deform");if(!whole||
!this.#room)return;const panes=whole.querySelectorAll(".glid-pane");const widths=[...panes].map(pane=>Number.
parseFloat(pane.style.width)||0);const share=this.#room.width/widths.reduce((sum,width)=>sum+width,0);
whole.style.zoom=share<1&&!this.#decides?String(share):""}#roomIn(root,shell){const full=document.fullscreenElement===
root;const below=window.innerHeight-(full?0:around(root));if(this.#isAlone)return{width:root.clientWidth,
height:below,all:1};const narrow=root.classList.contains("glid-narrow");const side=shell.querySelector(
".glid-side");const plots=shell.querySelector(".glid-plots-box");const beside=shell.clientWidth-(narrow?
0:side?.offsetWidth??0);const plotted=Boolean(plots?.offsetWidth)&&!narrow&&beside-PLOTS>=BESIDE3;shell.
classList.toggle("glid-beside",plotted);this.#showPlots(plots,plotted);const width=plotted?beside-PLOTS:
beside;const above=shell.getBoundingClientRect().top-root.getBoundingClientRect().top;const section2=Boolean(
side?.offsetWidth);const parts=narrow?this.#partsOnPhone(shell,section2,full):PARTS;const free=below-
above/scaleOf(root).down-parts;const height=Math.max(narrow?NARROW_LEAST:LEAST,free);return{width,height,
all:Number(narrow&&full&&!section2)}}#partsOnPhone(shell,section2,full){const heightOf=name=>{const part=shell.
querySelector(name);return part?.offsetHeight??0};const bars=shell.querySelector(".glid-legend:not([\
hidden])")?NARROW_LEGEND:0;const layout=String([shell.clientWidth,section2,full,bars]);if(this.#foot.
layout!==layout)this.#foot={layout,height:0};const moving=this.pad.matches(":active")||shell.querySelector(
".glid-foot .glid-working");if(!moving||!this.#foot.height){this.#foot.height=Math.max(this.#foot.height,
heightOf(".glid-foot"))}const inspector=section2?TABS+sectionHeight(window.innerHeight):0;const rows=heightOf(
".glid-tools")+heightOf(".glid-timeline");return rows+inspector+bars+this.#foot.height+2}#showPlots(plots,beside){
const seen=Boolean(plots?.offsetWidth);if(seen&&!beside&&!this.#plotted)plots?.scrollIntoView({block:"\
nearest"});this.#plotted=seen}};function sectionHeight(screen){return Math.min(Math.max(screen-730,120),
300)}function around(root){return root.closest(".jp-MainAreaWidget")?NOTEBOOK:PAGE}var FRAME=16;var SHARE=.5;var REST=200;var Detail=class{#views;#less=new Map;#timer;constructor(views){
this.#views=views}moved(drawingTime2){if(drawingTime2<=FRAME)return;clearTimeout(this.#timer);this.#timer=
setTimeout(()=>this.restore(),REST);for(const one of this.#views())void one.then(view=>this.#reduce(
view))}restore(){clearTimeout(this.#timer);for(const[renderer,ratio]of this.#less)renderer.setPixelRatio(
ratio);if(this.#less.size)for(const one of this.#views())void one.then(draw);this.#less.clear()}#reduce(view){
const{renderer}=view;if(!renderer||this.#less.has(renderer))return;const ratio=renderer.getPixelRatio();
this.#less.set(renderer,ratio);renderer.setPixelRatio(SHARE*ratio);draw(view)}};function draw(view){
if(view.renderer&&!view.isFrozen)view.renderScene()}var LN2_HIGH=.6931471803691238;var LN2_LOW=19082149292705877e-26;var TWO_TO_54=0x40000000000000;var L1=.6666666666666735;
var L2=.3999999999940942;var L3=.2857142874366239;var L4=.22222198432149784;var L5=.1818357216161805;
var L6=.15313837699209373;var L7=.14798198605116586;var A0=.3333333333333293;var A1=-.19999999999876483;
var A2=.14285714272503466;var A3=-.11111110405462356;var A4=.09090887133436507;var A5=-.0769187620504483;
var A6=.06661073137387531;var A7=-.058335701337905735;var A8=.049768779946159324;var A9=-.036531572744216916;
var A10=.016285820115365782;var ATAN_HIGH=[.4636476090008061,.7853981633974483,.982793723247329,1.5707963267948966];
var ATAN_LOW=[22698777452961687e-33,3061616997868383e-32,13903311031230998e-33,6123233995736766e-32];
var TINY=1862645149230957e-24;var HUGE=7378697629483821e4;var PI_LOW=12246467991473532e-32;var number=new Float64Array(
1);var words=new Int32Array(number.buffer);number[0]=1;var HIGH2=words[1]===0?0:1;function modulus(x,y){
return Math.sqrt(x*x+y*y)}function log(x){if(!(x>0)||x===Infinity){return logOfSpecial(x)}const subnormal=x<
22250738585072014e-324;number[0]=subnormal?x*TWO_TO_54:x;const exponent=(words[HIGH2]>>20)-1023-(subnormal?
54:0);const fraction=words[HIGH2]&1048575;const carry=fraction+614244&1048576;words[HIGH2]=fraction|
carry^1072693248;return logOfParts(exponent+(carry>>20),number[0]-1,fraction)}function logOfSpecial(x){
if(x===0){return-Infinity}return x===Infinity?Infinity:NaN}function logOfParts(k,f,fraction){if((1048575&
2+fraction)<3){const r2=f*f*(.5-.3333333333333333*f);return k*LN2_HIGH-(r2-k*LN2_LOW-f)}const s=f/(2+
f);const z=s*s;const w=z*z;const even=w*(L2+w*(L4+w*L6));const odd=z*(L1+w*(L3+w*(L5+w*L7)));const r=odd+
even;if((fraction-398458|440401-fraction)>0){const half=.5*f*f;return k*LN2_HIGH-(half-(s*(half+r)+k*
LN2_LOW)-f)}return k*LN2_HIGH-(s*(f-r)-k*LN2_LOW-f)}function atan2(y,x){if(!Number.isFinite(x)||!Number.
isFinite(y)){return NaN}const angle=y===0?0:atan(Math.abs(y/x));if(x>=0){return y<0?-angle:angle}return y<
0?angle-PI_LOW-Math.PI:Math.PI-(angle-PI_LOW)}function atan(x){if(x<.4375){return x<TINY?x:x-x*atanSeries(
x)}if(x>=HUGE){return ATAN_HIGH[3]+ATAN_LOW[3]}if(x<.6875){return atanFrom(0,(2*x-1)/(2+x))}if(x<1.1875){
return atanFrom(1,(x-1)/(x+1))}return x<2.4375?atanFrom(2,(x-1.5)/(1+1.5*x)):atanFrom(3,-1/x)}function atanFrom(entry,t){
return ATAN_HIGH[entry]-(t*atanSeries(t)-ATAN_LOW[entry]-t)}function atanSeries(t){const z=t*t;const w=z*
z;const odd=z*(A0+w*(A2+w*(A4+w*(A6+w*(A8+w*A10)))));const even=w*(A1+w*(A3+w*(A5+w*(A7+w*A9))));return odd+
even}var Domain=class{constructor(outline){const loops=[outline.offset_cage,...outline.offset_holes];this.
cage=[outline.cage,...outline.holes];this.singular=complexOf([...loops.flat(),...outline.hole_points]);
this.exterior=outline.offset_cage.length;this.holes=outline.hole_points.length;this.vertices=loops.flat().
length;this.columns=this.vertices+this.holes;const{next,previous}=neighbours(loops.map(loop=>loop.length));
this.next=next;this.previous=previous;const{edge,inverse}=edgesOf(this.singular,next);this.edge=edge;
this.inverseEdge=inverse;this.largest=largestModulus(this.singular,this.exterior);this.unit=longerSide(
outline.cage)/20;this.free=freeColumns(loops.map(loop=>loop.length))}};function complexOf(points){return{
re:Float64Array.from(points,point=>point[0]),im:Float64Array.from(points,point=>point[1])}}function zeros(size){
return{re:new Float64Array(size),im:new Float64Array(size)}}function neighbours(sizes){const total=sizes.
reduce((sum,size)=>sum+size,0);const next=new Int32Array(total);const previous=new Int32Array(total);
let first=0;for(const size of sizes){for(let i=0;i<size;i++){const after=first+(i+1)%size;next[first+
i]=after;previous[after]=first+i}first+=size}return{next,previous}}function freeColumns(sizes){const free=[];
let first=0;for(const[loop,size]of sizes.entries()){for(let i=loop===0?1:2;i<size;i++){free.push(first+
i)}first+=size}return Int32Array.from(free)}function edgesOf(singular,next){const edge=zeros(next.length);
const inverse=zeros(next.length);for(let e=0;e<next.length;e++){const re=singular.re[next[e]]-singular.
re[e];const im=singular.im[next[e]]-singular.im[e];const square=re*re+im*im;edge.re[e]=re;edge.im[e]=
im;inverse.re[e]=re/square;inverse.im[e]=-im/square}return{edge,inverse}}function largestModulus(points,count){
let largest=0;for(let j=0;j<count;j++){largest=Math.max(largest,modulus(points.re[j],points.im[j]))}
return largest}function longerSide(loop){const sides=[0,1].map(axis=>{const values=loop.map(point=>point[axis]);
return Math.max(...values)-Math.min(...values)});return Math.max(...sides)}var CODE="0061736d0100000001200460017b017c60067f7f7f7f7f7f0060087f7f7f7f7f7f7f7f0060037f7f7f00021001\
0470616765066d656d6f727902000003060500010102030721040773616d706c657300010470756c6c00020474696c650003\
05736f6c766500040afd0e050d002000fd21002000fd2101a00b9c0502087f107b200220036a210b200b20036a210c200c20\
036a210d034020034100200641086a2004491b2108200020086a2109200120086a210a41002107fd0c000000000000000000\
000000000000002116fd0c000000000000000000000000000000002117fd0c000000000000000000000000000000002118fd\
0c000000000000000000000000000000002119fd0c00000000000000000000000000000000211afd0c000000000000000000\
00000000000000211bfd0c00000000000000000000000000000000211cfd0c00000000000000000000000000000000211d03\
40200020076afd000400210e200120076afd000400210f200920076afd0004002110200a20076afd0004002111200220076a\
fd0004002112200b20076afd0004002113200c20076afd0004002114200d20076afd00040021152016200e2012fdf201200f\
2013fdf201fdf101fdf00121162017200e2013fdf201200f2012fdf201fdf001fdf00121172018200e2014fdf201200f2015\
fdf201fdf101fdf00121182019200e2015fdf201200f2014fdf201fdf001fdf0012119201a20102012fdf20120112013fdf2\
01fdf101fdf001211a201b20102013fdf20120112012fdf201fdf001fdf001211b201c20102014fdf20120112015fdf201fd\
f101fdf001211c201d20102015fdf20120112014fdf201fdf001fdf001211d200741106a210720072003490d000b20052006\
6a2107200720161000390300200804402007201a10003903080b200720046a2107200720171000390300200804402007201b\
10003903080b200720046a2107200720181000390300200804402007201c10003903080b200720046a210720072019100039\
0300200804402007201d10003903080b200920036a2100200a20036a2101200641106a210620062004490d000b0bc8040209\
7f0c7b200520036a210b200b20036a210c200c20036a210d0340200641086a200449210e200220066a21082008fd0a030021\
13fd0c000000000000000000000000000000002117200e04402008fd0a030821170b200820046a21082008fd0a03002114fd\
0c000000000000000000000000000000002118200e04402008fd0a030821180b200820046a21082008fd0a03002115fd0c00\
0000000000000000000000000000002119200e04402008fd0a030821190b200820046a21082008fd0a03002116fd0c000000\
00000000000000000000000000211a200e04402008fd0a0308211a0b20034100200e1b2108200020086a2109200120086a21\
0a410021070340200020076afd000400210f200120076afd0004002110200920076afd0004002111200a20076afd00040021\
12200520076a210820082008fd000400200f2013fdf20120102014fdf201fdf00120112017fdf20120122018fdf201fdf001\
fdf001fdf001fd0b0400200b20076a210820082008fd000400200f2014fdf20120102013fdf201fdf10120112018fdf20120\
122017fdf201fdf101fdf001fdf001fd0b0400200c20076a210820082008fd000400200f2015fdf20120102016fdf201fdf0\
0120112019fdf2012012201afdf201fdf001fdf001fdf001fd0b0400200d20076a210820082008fd000400200f2016fdf201\
20102015fdf201fdf1012011201afdf20120122019fdf201fdf101fdf001fdf001fd0b0400200741106a210720072003490d\
000b200920036a2100200a20036a2101200641106a210620062004490d000b0b990202017f0b7b02402006450d0003402004\
20086afd0004002109200520086afd000400210a200020086afd000400210b200c200b2009fdf201fdf001210c200d200b20\
0afdf201fdf001210d200120086afd000400210b200e200b2009fdf201fdf001210e200f200b200afdf201fdf001210f2002\
20086afd000400210b2010200b2009fdf201fdf00121102011200b200afdf201fdf0012111200320086afd000400210b2012\
200b2009fdf201fdf00121122013200b200afdf201fdf0012113200841106a210820082006490d000b0b2007200c10003903\
002007200d10003903082007200e10003903102007200f100039031820072010100039032020072011100039032820072012\
10003903302007201310003903380be90203047f017c027b0340200341707121062000200120034103766c6a2105fd0c0000\
000000000000000000000000000021084100210402402006450d0003402008200520046afd000400200220046afd000400fd\
f201fdf0012108200441106a210420042006490d000b0b200810002107200620034904402007200520066a2b030020022006\
6a2b0300a2a021070b200220036a2104200420042b03002007a1200520036a2b0300a3390300200341086a21032003200149\
0d000b0340200341086b2103200341707121062000200120034103766c6a2105200220036a2104200420042b030020052003\
6a2b0300a339030020042b030021072007fd14210920062003490440200220066a2104200420042b0300200520066a2b0300\
2007a2a13903000b4100210402402006450d000340200220046a200220046afd000400200520046afd0004002009fdf201fd\
f101fd0b0400200441106a210420042006490d000b0b20030d000b0b";var PAGE2=65536;var TILE=8;var compiled={module:moduleOrNull()};var kernels=new WeakMap;function moduleOrNull(){
try{const pairs=CODE.match(/../g)??[];return new WebAssembly.Module(Uint8Array.from(pairs,pair=>Number.
parseInt(pair,16)))}catch{return null}}function arraysOf(...lengths){const buffer=reachable(8*lengths.
reduce((sum,length)=>sum+length,TILE));let first=8*TILE;return lengths.map(length=>{const array=buffer?
new Float64Array(buffer,first,length):new Float64Array(length);first+=array.byteLength;return array})}
function reachable(size){if(!compiled.module){return null}try{const memory=new WebAssembly.Memory({initial:Math.
ceil(size/PAGE2)});const{exports}=new WebAssembly.Instance(compiled.module,{page:{memory}});kernels.
set(memory.buffer,exports);return memory.buffer}catch{return null}}function kernelOf(...arrays){const[
{buffer}]=arrays;return arrays.every(array=>array.buffer===buffer)?kernels.get(buffer):void 0}var UNIT_ROUNDOFF=11102230246251565e-32;var UPWARD=1+9313225746154785e-25;var CUT=64*UNIT_ROUNDOFF;var BESIDE4=64*
UNIT_ROUNDOFF;var LOGARITHM=16*UNIT_ROUNDOFF;var BERNSTEIN=16*UNIT_ROUNDOFF;var TAU=2*Math.PI;var LARGEST_NORM=1e20;var FEW=64;function emptyRows(count,columns){const width=evenly(
columns);const lengths=[count*width,count*width,4*width,4*count];const[re,im,slopes,samples]=count<FEW?
lengths.map(length=>new Float64Array(length)):arraysOf(...lengths);return{count,columns,re,im,slopes,
samples,norms:new Float64Array(count)}}function evenly(columns){return columns+columns%2}function rowsAt(domain,points){
const rows=emptyRows(points.re.length,domain.columns);const width=evenly(domain.columns);for(let i=0;i<
rows.count;i++){rows.norms[i]=fillRow(domain,points.re[i],points.im[i],rows,i*width)}return rows}function fillRow(domain,x,y,row2,first){
const{vertices,columns,next,singular}=domain;let safe=true;for(let e=0;e<vertices;e++){const after=next[e];
const bx=singular.re[e]-x;const by=singular.im[e]-y;const cx=singular.re[after]-x;const cy=singular.
im[after]-y;const angle=atan2(bx*cy-by*cx,bx*cx+by*cy)/TAU;row2.re[first+e]=angle;row2.im[first+e]=-log(
(cx*cx+cy*cy)/(bx*bx+by*by))/(2*TAU);safe=safe&&Math.abs(angle)<.5-CUT}for(let h=vertices;h<columns;h++){
const bx=x-singular.re[h];const by=y-singular.im[h];const square=bx*bx+by*by;row2.re[first+h]=bx/square;
row2.im[first+h]=-by/square}const norm=UPWARD*Math.sqrt(squares(row2,first,columns));return safe&&norm<
LARGEST_NORM?norm:Infinity}function squares(row2,first,count){let sum=0;for(let j=first;j<first+count;j++){
sum+=row2.re[j]*row2.re[j]+row2.im[j]*row2.im[j]}return sum}function coordinatesAt(domain,[x,y]){const{
vertices,columns,next,previous,singular}=domain;const logarithms=zeros(columns);fillRow(domain,x,y,logarithms,
0);const over=timesInverseEdge(domain,logarithms);const c=zeros(columns);for(let j=0;j<vertices;j++){
const p=previous[j];const cx=singular.re[next[j]]-x;const cy=singular.im[next[j]]-y;const bx=singular.
re[p]-x;const by=singular.im[p]-y;c.re[j]=cx*over.re[j]-cy*over.im[j]-(bx*over.re[p]-by*over.im[p]);
c.im[j]=cx*over.im[j]+cy*over.re[j]-(bx*over.im[p]+by*over.re[p])}for(let h=vertices;h<columns;h++){
c.re[h]=log(modulus(x-singular.re[h],y-singular.im[h]))}return c}function timesInverseEdge({vertices,inverseEdge},row2){const over=zeros(vertices);for(let e=0;e<vertices;e++){
over.re[e]=row2.re[e]*inverseEdge.re[e]-row2.im[e]*inverseEdge.im[e];over.im[e]=row2.re[e]*inverseEdge.
im[e]+row2.im[e]*inverseEdge.re[e]}return over}function slopesOf(domain,coefficients){const{vertices,
columns,next,edge}=domain;const slopes=new Float64Array(4*columns);for(const part of[0,2*columns]){const re=coefficients.
subarray(part,part+columns);const im=coefficients.subarray(part+columns,part+2*columns);for(let e=0;e<
vertices;e++){const x=re[next[e]]-re[e];const y=im[next[e]]-im[e];const a=edge.re[e];const b=edge.im[e];
const square=a*a+b*b;slopes[part+e]=(x*a+y*b)/square;slopes[part+columns+e]=(y*a-x*b)/square}for(let h=vertices;h<
columns;h++){slopes[part+h]=re[h];slopes[part+columns+h]=im[h]}}return slopes}function samplesAt(rows,slopes){const{count,columns,re,im}=rows;const width=evenly(columns);const factors=rows.
slopes.fill(0);for(const[i,part]of quarters(slopes).entries()){factors.set(part,i*width)}const products=rows.
samples.subarray(0,4*count);const kernel=kernelOf(re,im,factors,products);if(kernel){const into=products.
byteOffset;kernel.samples(re.byteOffset,im.byteOffset,factors.byteOffset,8*width,8*count,into)}else{
const[pr,pi,qr,qi]=quarters(factors);const[fr,fi,gr,gi]=quarters(products);fillProduct(rows,pr,pi,fr,
fi);fillProduct(rows,qr,qi,gr,gi)}return products.slice()}function fillProduct(rows,re,im,intoRe,intoIm){
const rowRe=rows.re;const rowIm=rows.im;const width=re.length;for(let i=0;i<rows.count;i++){const first=i*
width;let x1=0;let y1=0;let x2=0;let y2=0;for(let e=0;e<width;e+=2){const a1=rowRe[first+e];const b1=rowIm[first+
e];const a2=rowRe[first+e+1];const b2=rowIm[first+e+1];const c1=re[e];const d1=im[e];const c2=re[e+1];
const d2=im[e+1];x1+=a1*c1-b1*d1;y1+=a1*d1+b1*c1;x2+=a2*c2-b2*d2;y2+=a2*d2+b2*c2}intoRe[i]=x1+x2;intoIm[i]=
y1+y2}}function quarters(values){const n=values.length/4;return[values.subarray(0,n),values.subarray(n,2*n),
values.subarray(2*n,3*n),values.subarray(3*n)]}var FieldPoints=class{#domain;#points;#coordinates;#rows=null;constructor(domain,points){const{columns}=domain;
this.#domain=domain;this.#points=complexOf(points);this.count=points.length;this.#coordinates=emptyRows(
points.length,columns);for(const[i,point]of points.entries()){const c=coordinatesAt(domain,point);this.#coordinates.
re.set(c.re,i*evenly(columns));this.#coordinates.im.set(c.im,i*evenly(columns))}}evaluate(coefficients){
return{images:this.images(coefficients),samples:this.samples(coefficients)}}images(coefficients){const[
fr,fi,gr,gi]=quarters(samplesAt(this.#coordinates,coefficients));const images=new Float64Array(2*this.
count);for(let i=0;i<this.count;i++){images[2*i]=fr[i]+gr[i];images[2*i+1]=fi[i]-gi[i]}return images}samples(coefficients){
this.#rows??=rowsAt(this.#domain,this.#points);return samplesAt(this.#rows,slopesOf(this.#domain,coefficients))}};var MOVED_BY_PAGE="moved by the page";var pointsIn=new WeakMap;var imagesIn=new WeakMap;var Vertices=class{#domain;#wire;constructor({
outline,...sizes}){this.#domain=new Domain(outline);this.#wire=new Wire(outline,sizes)}move(meshes,wire,still=false){
const moved=meshes.filter(movedByPage);if(!moved.length||wire.length!==this.#wire.length)return;const coefficients=this.#wire.
coefficients(wire);const distorted=new Set(moved.filter(showsDerivatives).map(mesh=>mesh.geometry));
for(const geometry of new Set(moved.map(mesh=>mesh.geometry))){const{image,derivatives}=geometry.attributes;
if(still&&imagesIn.get(image.array)===wire)continue;const points=this.#pointsOf(geometry);imagesIn.set(
image.array,wire);image.array.set(points.images(coefficients));renew(image);if(distorted.has(geometry)){
interleave(points.samples(coefficients),derivatives.array);renew(derivatives)}geometry.userData.wire=
wire}}#pointsOf(geometry){const known=pointsIn.get(geometry);if(known)return known;const{array,count}=geometry.
attributes.position;const places=Array.from({length:count},(_,i)=>[array[3*i],array[3*i+1]]);const points=new FieldPoints(
this.#domain,places);pointsIn.set(geometry,points);return points}};var newest=0;function renew(attribute){
newest=Math.max(newest,attribute.version)+1;attribute.version=newest}function movedByPage({name,visible}){
return name===MOVED_BY_PAGE&&visible}function showsDerivatives({material}){return material.uniforms?.
overlay?.value!==0}function interleave(samples,into){const count=samples.length/4;for(let part=0;part<
4;part++){for(let i=0;i<count;i++)into[4*i+part]=samples[part*count+i]}}var MovedShape=class{materials=[];#vertices=null;#told;#floats=toFloats();constructor(outlined){if(outlined?.
outline)this.#vertices=new Vertices(outlined)}of(meshes){return meshes.filter(({material})=>this.materials.
some(({obj})=>obj===material))}move(meshes,floats,moving){const still=floats===this.#floats;this.#vertices?.
move(this.of(meshes),floats,still);for(const{obj}of this.materials){const{cage,coefficients,holes,by_margin:byMargin}=obj?.
uniforms??{};if(byMargin?.value)byMargin.value=moving?2:1;if(!coefficients)continue;const chain=cage.
value.length;if(floats.length!==chain+holes.value.length)continue;coefficients.value=floats.subarray(
0,chain);holes.value=floats.subarray(chain)}}rest(meshes,wire){if(this.#told!==wire)this.#floats=toFloats(
wire);this.#told=wire;this.move(meshes,this.#floats,false)}lift(meshes,heights){const geometry=this.
of(meshes)[0]?.geometry;if(!geometry)return;const{position}=geometry.attributes;const kept=geometry.
userData;if(position.array!==kept.lifted)kept.resting=position.array;const{resting}=kept;if(heights?.
length===position.count){kept.lifted=position.array===resting?resting.slice():position.array;heights.
forEach((height,i)=>{kept.lifted[3*i+2]=height});if(position.array===resting)position.setArray(kept.
lifted)}else{if(position.array===resting)return;position.setArray(resting)}renew(position)}};var NEAR=8;var LEAD="glid:lead";var N_TIMED=3;var MOST_FRAMES=100;var Shapes=class{motion=null;partMotions={};lead=null;led=()=>{};#edited=new MovedShape;#around=new Map;#camera=null;#renderer=null;#loading=0;#loaded="";#detail=new Detail(
()=>Object.values(this.#renderer?.views??{}));constructor(model,view){this.model=model;this.view=view;
const loaded="change:materials change:part_shapes change:camera change:renderer";model.on(loaded,()=>this.
load())}async load(){this.#loading+=1;const turn=this.#loading;const{model}=this;const parts=model.get(
"part_shapes")??[];const[[camera,renderer],materials,...others]=await Promise.all([this.#models([model.
get("camera"),model.get("renderer")]),this.#models(model.get("materials")),...parts.map(part=>this.#models(
part.materials))]);if(turn!==this.#loading)return;this.#forget();this.#camera=camera;this.#renderer=
renderer;this.#edited=shapeOf(model.get("outline"),materials);this.#around=new Map(parts.map((part,i)=>[
part.key,shapeOf(part,others[i])]));this.#loaded=this.#references;for(const material of this.#materials)
material.on("change",this.refresh,this);renderer.get("scene").off("beforeRender",keepLittle).on("bef\
oreRender",keepLittle);for(const view of Object.values(renderer.views))view.then(drawNoMore);renderer.
on(LEAD,this.#takeLead,this);this.refresh()}async#models(references){const{widget_manager:manager}=this.
model;const models=await Promise.all(references.map(one=>manager.get_model(one.replace("IPY_MODEL_",
""))));await Promise.all(models.map(one=>one.initPromise));return models}get#materials(){return[this.#edited,
...this.#around.values()].flatMap(({materials})=>materials)}#forget(){this.#detail.restore();this.#renderer?.
off(null,null,this);for(const material of this.#materials)material.off(null,null,this);this.#edited=
new MovedShape;this.#around.clear();this.#loaded=""}get#references(){const parts=this.model.get("par\
t_shapes")??[];return JSON.stringify([this.model.get("materials"),parts.map(({materials})=>materials)])}showLead(lead){
this.#renderer?.trigger(LEAD,lead)}#takeLead(lead){this.lead=lead;if(lead&&this.movesVertices)this.#detail.
moved(this.model.get("drawing_time"));this.refresh();this.led()}get movesVertices(){return this.#meshes.
some(movedByPage)}get#meshes(){return this.#renderer?.get("scene").obj?.children??[]}refresh(){if(this.#loaded===
this.#references)this.#move();this.see();this.redraw()}#move(){const{motion}=this;const moved=motion instanceof
Float32Array&&motion.length?motion:null;const floats=moved??this.lead?.floats??toFloats(this.model.get(
"coefficients"));this.#edited.move(this.#meshes,floats,Boolean(motion));for(const[key,shape]of this.#around){
const seen=motion instanceof Float32Array?this.partMotions[key]:void 0;if(seen)shape.move(this.#meshes,
seen.floats,true);else shape.rest(this.#meshes,this.model.get("part_maps")[key])}}lift(heights){this.#edited.
lift(this.#meshes,heights);for(const[key,shape]of this.#around){shape.lift(this.#meshes,this.partMotions[key]?.
heights??null)}}see(){const{x,y,unit,width,height}=this.view;const w=width/2*unit;const h=height/2*unit;
for(const{obj}of this.#materials){if(obj?.uniforms?.pixel)obj.uniforms.pixel.value=unit}this.#camera?.
set({left:x-w,right:x+w,top:y+h,bottom:y-h})}redraw(){this.#renderer?.trigger("rerender",this.#renderer,
{})}close(){this.#loading+=1;this.#forget()}};function shapeOf(outlined,materials){const shape=new MovedShape(
outlined);shape.materials=materials;return shape}var ending=new WeakSet;function keepLittle(_scene,renderer){
renderer.renderLists.dispose();if(ending.has(renderer))return;ending.add(renderer);const{dispose}=renderer;
renderer.dispose=()=>{dispose.call(renderer);renderer.forceContextLoss()}}function drawNoMore(view){
view.once("remove",()=>{view.renderScene=()=>{}})}function drawnBelow(pad){return pad.closest(".glid\
-pane")?.querySelector(".jupyter-threejs canvas")}function coveredNear(pad,[x,y]){const drawn2=drawnBelow(
pad);if(!drawn2)return false;const size=2*NEAR;const pen=penOf(make("canvas",{width:size,height:size}));
const ratio=drawn2.width/pad.clientWidth;pen.drawImage(drawn2,NEAR-Math.floor(x*ratio),NEAR-Math.floor(
y*ratio));const{data}=pen.getImageData(0,0,size,size);return data.some((value,i)=>i%4===3&&value>0)}
function uniformVectors(){const canvas=make("canvas");const gl=canvas.getContext("webgl2")||canvas.getContext(
"webgl");if(!gl)return 0;const count=gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS);gl.getExtension(
"WEBGL_lose_context")?.loseContext();return count}async function drawingTime(pad,shapes){const times=[];
for(let i=0;i<MOST_FRAMES&&times.length<=N_TIMED;i++){const moving=performance.now();shapes.refresh();
const moved=performance.now()-moving;await new Promise(go=>requestAnimationFrame(go));const canvas=drawnBelow(
pad);const gl=canvas?.getContext("webgl")||canvas?.getContext("webgl2");if(!gl)continue;const start=performance.
now();gl.readPixels(0,0,1,1,gl.RGBA,gl.UNSIGNED_BYTE,new Uint8Array(4));times.push(moved+performance.
now()-start)}return times.length>1?Math.min(...times.slice(1)):0}var PAUSE=500;var Spacing=class{#put;#waits=null;#timer;constructor(put){this.#put=put}put(event,mayWait){
if(mayWait&&this.#timer!==void 0){this.#waits=event;return Promise.resolve(null)}this.#flush();if(mayWait)
this.#pause();return this.#put(event)}close(){clearTimeout(this.#timer)}#pause(){this.#timer=setTimeout(
()=>{if(this.#flush())this.#pause()},PAUSE)}#flush(){clearTimeout(this.#timer);this.#timer=void 0;const event=this.#waits;
this.#waits=null;if(event)void this.#put(event);return event!==null}};var SAVE_VIEW_AFTER=250;var STILL={release(){},pause:()=>void 0,reach(){}};var NO_PINS={places:[],locked:[]};
var Canvas=class{legend=new Legend;notices=new Notices;help=help(HELP);ghosts=new Ghosts;between=NO_PINS;#chosen;#saving;#playing=STILL;#tool;#painted=false;#presses=false;constructor({
model,el,signal}){this.model=model;this.interactive=model.get("interactive");const paper=make("canva\
s",{className:"glid-paper"});this.box=make("div",{className:"glid-pad",role:"application","aria-labe\
l":"Deformation canvas: arrow keys move, Enter pins a point",inert:!this.interactive},paper,this.legend.
element,this.notices.notice,this.notices.prepared);this.box.dataset.lmSuppressShortcuts="true";el.classList.
add("glid-host","glid-pad-host");el.append(this.box);this.view=new View(()=>this.#viewMoved(),{nearest:1e-4,
farthest:1});this.shapes=new Shapes(model,this.view);this.shapes.led=()=>this.redraw();this.ahead=new Ahead(
model,lead=>this.shapes.showLead(lead));this.reference=new Reference(this.box,model,this.view);this.
redraw=painter(paper,this.view,signal,pen=>this.#draw(pen));this.link=new Link(model,this.box,signal,
()=>this.#report());this.room=this.interactive?new Room(this.box,model,signal):null;this.behaviour=new PinBehaviour(
this);this.pad=new Pad(this.box,this.view,this.#listener(signal),this.behaviour);this.numbers=new FollowedNumbers(
this.box);this.clipboard=new PoseClipboard(this);this.corner=this.#makeCorner();if(this.interactive){
this.box.append(shield(this.corner),this.help.table,resizeGrip(model));keysAround(this.box,e=>this.pad.
keydown(e),signal);this.box.addEventListener("glid:press",e=>this.#pressed(e))}this.#takeFirst()}close(){
clearTimeout(this.#saving);this.ahead.close();this.shapes.close();this.reference.close()}get allMarks(){
return marksOf(this.model.get("marks"),this.shapes.lead)}get marks(){return withoutHidden(this.allMarks,
this.model.get("pins"),Number.NaN)}get reachable(){return withoutHidden(this.allMarks,this.model.get(
"pins"),Infinity)}prepareSolver(){if(this.interactive)void this.ahead.prepare()}rested(){if(this.pad.
grip)return;const made=this.behaviour.madePin();if(made===void 0)this.ahead.giveBack();else this.#hold(
made)}#hold(made){const{pad,view,behaviour}=this;const[from]=pad.path;const[place]=pad.pointers.values();
pad.grip={from,points:new Map([[made,from]])};if(!behaviour.constrains)pad.held.set(made,view.toWorld(
place));this.followHand()}followHand(){if(this.pad.grip&&!this.shapes.motion)this.ahead.follow(this.
pad.held)}#listener(signal){const put=event=>{const drags=event.type==="up"||this.pad.grip&&/^(down|move)$/.
test(event.type);if(!drags)this.ahead.giveBack();const leads=this.ahead.leads&&this.shapes.movesVertices;
return spacing.put(event,leads&&event.type==="move")};const spacing=new Spacing(event=>this.link.put(
event));signal.addEventListener("abort",()=>spacing.close());return{put,signal}}get brush(){const{radius,
strength}=this.model.get("brush");const{tool}=this;return tool?{radius,strength:tool==="stiff"?strength:
0}:null}get tool(){const told=this.model.get("brush").tool;return told===void 0?"":this.#tool??told}toggleTool(tool){
this.takeTool(this.tool===tool?"":tool)}takeTool(name){this.pad.link.put({type:"tool",name});this.#showTool(
name)}putBrushAway(){if(this.painting)this.#showTool("")}#showTool(tool){if(tool===this.#tool)return;
this.#tool=tool;this.box.dispatchEvent(new CustomEvent("glid:tool",{bubbles:true,detail:this.tool}));
this.takeFocus();this.showNotice();this.pad.hover();this.redraw()}get painting(){return this.brush!==
null}say(notice){save(this.model,{notice})}openMenu(place,found={mark:this.marks.selected.at(-1)}){const{
selected,targets}=this.marks;const mark=found?.mark===void 0?null:Number(found.mark);const centre=[this.
view.x,this.view.y];const pinned=mark!==null&&Number.isFinite(targets[mark]?.[0]);const point=pinned?
targets[mark]:this.model.get("cursor")??centre;const at=place??this.view.toScreen(point);const does={
press:(key,shift=false)=>{return()=>this.#press(key,shift)},pin:()=>void this.pad.send("pin",at),paste:()=>void this.
clipboard.paste(),alone:()=>this.room?.alone(),fullScreen:()=>this.room?.fullScreen(),showKeys:this.
help.toggle};const covered=mark===null&&coveredNear(this.box,at);const pins=mark===null?null:pinsOfMenu(
mark,selected);openMenu(this.box,at,menuRows(does,pins,covered,this.model.get("pins")))}showMotion(motion=null,playing=STILL,heights=null,parts={},pins=null){
this.between=pins??NO_PINS;this.#playing=playing;this.shapes.motion=motion;this.shapes.partMotions=parts;
this.shapes.lift(heights);this.showLegend();this.shapes.refresh();this.pad.hover();this.redraw()}leaveMotion(){
if(this.shapes.motion)this.#playing.release()}showLegend(){this.legend.show(this.model,Boolean(this.
shapes.motion))}takeFocus(){const{painting}=this;const chosen=painting&&!this.#painted;this.#painted=
painting;const side=this.box.closest(".glid-editor")?.querySelector(".glid-side");if(chosen&&side?.contains(
document.activeElement))this.box.focus({preventScroll:true})}showNotice(){const first=this.interactive&&
!this.marks.targets.length;this.notices.tell(this.model.get("notice"),this.painting,first)}fit(){const{
model,view,box}=this;view.width=model.get("width");view.height=model.get("height");[view.x,view.y,view.
unit]=model.get("view");box.style.width=`${view.width}px`;box.style.height=`${view.height}px`;this.room?.
shrink();this.#see()}reveal(){const{selected,targets,images}=this.marks;const now=selected.length===
1?selected[0]:void 0;if(now===this.#chosen)return;this.#chosen=now;if(now===void 0||this.pad.mode)return;
if(!Number.isFinite(targets[now]?.[0]))return;if(inSight(this.view,targets[now])||inSight(this.view,
images[now]))return;this.view.centreOn(targets[now])}pressedAt(){if(!this.shapes.motion)return void 0;
this.#presses=true;return this.#playing.pause()}#pressed(e){this.#press(e.detail)}#press(key,shift=false){
const act=this.behaviour.actions[key];if(act)act();else this.pad.press(key,{shiftKey:shift})}#takeFirst(){
const take=e=>{if(!this.shapes.motion)return false;e.stopImmediatePropagation();e.preventDefault();return true};
const goBack=e=>take(e)&&this.#playing.release();const capture=true;this.box.addEventListener("point\
erdown",e=>e.button===2&&take(e),{capture});this.box.addEventListener("contextmenu",take,{capture});
const ours=e=>!e.ctrlKey&&!e.metaKey&&KEYS.test(keyOf(e));this.box.addEventListener("keydown",e=>ours(
e)&&goBack(e),{capture});const openedByKeys=e=>{if(e.key!=="F10"||!e.shiftKey)return;e.stopImmediatePropagation();
e.preventDefault();this.openMenu()};this.box.addEventListener("keydown",openedByKeys,{capture});const followArrow=e=>{
const target=arrowAt(this.view,this.marks,this.pad.place(e));if(!target||e.target!==this.box||this.shapes.
motion)return;this.view.centreOn(target);e.stopImmediatePropagation()};this.box.addEventListener("po\
interdown",followArrow,{capture})}#makeCorner(){const look="glid-help-button";return make("div",{className:"\
glid-corner"},this.help.button,iconButton("screen","Full screen (W)",()=>this.room?.fullScreen(),look),
iconButton("rectangle","The picture alone (P)",()=>this.room?.alone(),look))}#report(){const{busy,refusal}=this.
link;if(this.link.idle)this.#showTool(void 0);this.#settleNumbers();if(this.#presses&&this.link.idle&&
this.pad.mode===null){this.#presses=false;this.#playing.reach();this.behaviour.motionLeft()}if(!busy&&
refusal&&refusal!==this.model.get("notice"))this.say(refusal)}#viewMoved(){this.#see();clearTimeout(
this.#saving);this.#saving=setTimeout(()=>{const{x,y,unit}=this.view;save(this.model,{view:[x,y,unit]})},
SAVE_VIEW_AFTER)}#see(){this.shapes.see();this.reference.place();this.redraw()}get#drags(){const{mode,
path,encloses:encloses2}=this.pad;return mode==="hand"&&path.length>1&&!encloses2&&!this.painting}#settleNumbers(){
if(this.link.idle&&!this.#drags)this.numbers.settle(this.model.get("marks"))}#drawNumbers(pen){const{
model,view,pad,marks}=this;const{pressed}=this.behaviour;const drags=this.#drags&&pressed;const moved=drags&&
movedPin(pressed,marks,pad.held,model.get("picture_size"));if(!moved)return;this.numbers.follow(this.
allMarks,pad.held);const{start,keys}=pressed;if(start&&keys?.axis)drawAxis(pen,view,start,moved.at);
drawNumbers(pen,view,moved)}#draw(pen){const{model,view,pad,marks,brush}=this;const{motion}=this.shapes;
const through=!motion&&knobInCorner(view,marks,pad.held);this.corner.classList.toggle("glid-through",
through);if(motion){const{places}=this.between;drawBetween(pen,view,places,{hovered:pad.found?.mark,
held:pad.held});return}drawOnion(pen,view,model.get("onion"));drawStiff(pen,view,model.get("stiff"),
this.painting);if(this.interactive&&!this.painting){this.ghosts.draw(pen,view,model.get("outline").outline,
marks.targets.length>0)}const cursor=pad.focused?model.get("cursor"):null;const pins=model.get("pins");
const held=new Map([...pad.held].filter(([mark])=>!pins.away.includes(Number(mark))));drawMarks(pen,
view,marks,{hovered:pad.found?.mark,held,cursor});drawLocks(pen,view,marks,pins);if(brush)drawBrush(
pen,view,brush,pad);else this.#drawNumbers(pen);if(pad.encloses&&pad.path.length>2)drawLasso(pen,view,
pad.path)}};function render(context){const{model,signal}=context;const canvas=new Canvas(context);follow(model,{
"change:width change:height change:view":()=>canvas.fit(),"change:coefficients":()=>canvas.shapes.lead||
canvas.shapes.refresh(),"change:part_maps":()=>canvas.shapes.refresh(),"change:solver_script change:\
solver change:outline":()=>canvas.prepareSolver(),"change:rest":()=>canvas.rested(),"change:drawing_\
time":()=>model.get("drawn")&&!model.get("drawing_time")&&measure(canvas,signal),"change:marks chang\
e:cursor change:onion change:stiff change:brush change:pins":()=>canvas.redraw(),"glid:motion":(...shown)=>canvas.
showMotion(...shown),"change:legend change:panel_legend change:legend_corner":()=>canvas.showLegend(),
"change:notice change:marks change:brush":()=>canvas.showNotice(),"change:marks":()=>canvas.reveal(),
"change:brush":()=>canvas.takeFocus(),"change:reference change:behind_reference":()=>void canvas.reference.
show(),"change:prepared":()=>canvas.notices.prepare(model.get("prepared"))});measure(canvas,signal);
if(model.get("uniform_vectors")===0){save(model,{uniform_vectors:uniformVectors()||-1})}return()=>canvas.
close()}async function measure({box,model,shapes},signal){await shapes.load();const time=await drawingTime(
box,shapes);if(!signal.aborted)save(model,{drawn:true,drawing_time:time})}var main_default={render};export{main_default as default};
