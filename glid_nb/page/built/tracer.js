function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}
function showChildren(parent,children){for(const[i,child]of children.entries()){const shown=parent.children[i];
if(!shown)parent.append(child);else if(!shown.isEqualNode(child))shown.replaceWith(child)}for(const child of[
...parent.children].slice(children.length))child.remove()}function penOf(canvas){const pen=canvas.getContext(
"2d");if(!pen)throw new Error("this browser does not draw on canvases");return pen}function follow(model,listeners){for(const[names,listener]of Object.entries(listeners)){model.on(names,
listener);listener()}}var OF_THE_PAD=["pointerdown","pointermove","wheel","keydown","keyup","contextmenu"];function shield(element){
for(const name of OF_THE_PAD)element.addEventListener(name,e=>e.stopPropagation());return element}function help(sections){
const head=make("div",{className:"glid-help-head"},make("h2",{},"Keys and gestures"),make("button",{
title:"Close",ariaLabel:"Close"},"×"));const columns=make("div",{},...sections.map(section));const look={
className:"glid-help",popover:"auto",tabIndex:-1};const table=shield(make("div",look,head,columns));
table.addEventListener("click",()=>table.hidePopover());table.addEventListener("beforetoggle",()=>Object.
assign(table,{autofocus:true}));const title="Keys and gestures (?)";const around={className:"glid-he\
lp-button",title,"aria-label":title};const button=shield(make("button",{...around,popoverTargetElement:table},
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
this.#number}put(event,buffers=[]){this.#number+=1;const number=this.#number;const last=this.#queue.
at(-1);if(last?.replaces&&last.replaces===event.replaces)this.#queue.pop();this.#queue.push({...event,
seq:number});this.#buffers.push(...buffers);this.element.dataset.idle="false";this.#flush();return new Promise(
resolve=>this.#promised.push({number,resolve}))}#flush(){if(this.#waiting||!this.#queue.length)return;
this.#waiting=true;this.#awaited=this.#number;try{const{kernel}=this.model.widget_manager;if(kernel===
null||kernel?.isDisposed)throw new Error("the kernel was shut down");this.model.send({view:this.view,
events:this.#queue},void 0,this.#buffers)}catch{this.#markDisconnected();return}this.#queue=[];this.#buffers=
[];this.#overdue=setTimeout(()=>{this.busy=true;this.report()},BUSY_AFTER);this.#timeout=setTimeout(
()=>this.#release(),ACKNOWLEDGE_TIMEOUT)}#markDisconnected(){const around=this.element.closest(".gli\
d-editor")??this.element.closest(".glid-host");around?.classList.add("jupyter-widgets-disconnected")}#answered({
ack,refusal}){if(ack===this.#awaited)clearTimeout(this.#overdue);this.#acknowledged=Math.max(this.#acknowledged,
ack);this.busy=false;this.refusal=refusal;this.element.dataset.idle=String(this.idle);const due=this.#promised.
filter(({number})=>number<=ack);this.#promised=this.#promised.filter(({number})=>number>ack);for(const{
resolve}of due)resolve(refusal);this.report();if(ack<this.#awaited)return;if(document.hidden)this.#release();else
this.#drawing=requestAnimationFrame(()=>this.#release())}#release(){this.#stop();this.#waiting=false;
this.#flush()}#stop(){clearTimeout(this.#overdue);clearTimeout(this.#timeout);cancelAnimationFrame(this.#drawing)}};
function connectNoMoreComms(kernel){const status=kernel?.statusChanged;const connect=status?.connect;
if(!connect||Object.hasOwn(status,"connect"))return;status.connect=(slot,receiver)=>!String(slot).includes(
"_cleanSubshells")&&connect.call(status,slot,receiver)}var NUMBERS=[{name:"threshold",label:"Threshold",unit:"0–1",title:"Smallest value of the foregroun\
d",end:1,power:1,digits:3},{name:"smoothing",label:"Smoothing",unit:"px",title:"Blur before tracing \
the outline",end:.01,power:2,digits:1},{name:"offset",label:"Offset",unit:"px",title:"How far the ca\
ge stays from the shape",end:.05,power:1.5,digits:1},{name:"simplify",label:"Simplify",unit:"px",title:"\
How far simplification may move the outline",end:.03,power:1.5,digits:1},{name:"min_hole_area",label:"\
Smallest hole",unit:"px²",title:"Smaller holes are filled",end:.1,power:4,digits:0}];var STEPS=1e3;
var NumberControl=class{#most=1;#gesture=null;constructor(option,choose){const{name,label,unit,title,
digits}=option;this.option=option;this.slider=make("input",{type:"range",className:"glid-slider",min:0,
max:STEPS,step:1,"aria-label":label});this.number=make("input",{type:"number",className:"glid-number",
min:0,step:"any",placeholder:"auto","aria-label":`${label} (${unit})`});this.auto=make("button",{className:"\
glid-auto",title:"Let the tracer choose"},"auto");this.element=make("div",{className:"glid-control",
title,"data-name":name},make("label",{},label),this.auto,this.number,make("span",{className:"glid-un\
it"},unit),this.slider);this.slider.addEventListener("input",()=>{this.#gesture??=Math.random().toString(
36);const value=valueAt(this.#share,this.#most,option);this.number.value=value.toFixed(digits);this.
auto.ariaPressed="false";choose({[name]:value},this.#gesture)});this.slider.addEventListener("change",
()=>{this.#gesture=null});this.number.addEventListener("change",()=>{const{value}=this.number;choose(
{[name]:value===""?null:Number(value)})});this.auto.addEventListener("click",()=>choose({[name]:null}))}get#share(){
return Number(this.slider.value)/STEPS}update(shown){const{name,digits}=this.option;const value=shown.
options[name];const seen=value??shown.automatic?.[name]??null;this.#most=endOf(this.option,shown);this.
auto.ariaPressed=String(value===null);if(this.#gesture)return;this.number.value=seen===null?"":String(
Number(seen.toFixed(digits)));if(seen===valueAt(this.#share,this.#most,this.option))return;this.slider.
value=String(Math.round(STEPS*shareAt(seen,this.#most,this.option)))}};function endOf({unit,end},{size,
component_area:area}){const whole={"0–1":1,px:Math.max(...size??[0]),"px²":area}[unit];return Math.
max(end*whole,1e-9)}function valueAt(share,most,{power,digits}){return Number((most*share**power).toFixed(
digits))}function shareAt(value,most,{power}){return Math.min(Math.max(value/most,0),1)**(1/power)}function statusOf(shown,refusal,busy){if(refusal)return{kind:"bad",text:refusal};if(busy)return{kind:"\
busy",text:"Working…"};if(!shown.size)return{kind:"idle",text:"No picture yet"};if(shown.problems.
length){const kept="This is not a valid cage; the last valid cage is kept";return{kind:"bad",text:shown.
loops.length?kept:"There is no cage yet"}}const{doubt}=shown;if(doubt)return{kind:"guess",text:`No o\
utline yet, as ${doubt} · paint over the shape`};return{kind:"ok",text:cutOf(shown)+cageOf(shown)+moreOn(
shown)}}function cutOf({cut}){if(!cut)return"";const{shares,kept,in_middle:inMiddle}=cut;if(shares.length>
1){const percent=Math.round(100*shares[kept]);const rest=shares.length>2?"the others are left out":"\
the other one is left out";return`Cut into ${shares.length} pieces: ${percent} % of the shape is kep\
t, ${rest} · `}return inMiddle?"Cut inside the shape, as a thin hole · ":"Cut open along the line \
· "}function cageOf({loops}){return`Cage with ${loops.flat().length} vertices and ${holesIn(loops.length-
1)}`}function moreOn({discarded,component,n_components:count}){if(discarded)return" · your edits wer\
e lost with the old outline; Undo brings them back";if(count<2)return"";const which=component?`compo\
nent ${component+1}`:"the largest";return` · ${which} of ${count} components`}function holesIn(count){
if(count<1)return"no holes";return count===1?"1 hole":`${count} holes`}var METHODS=[["auto","Auto","Chosen for the picture"],["alpha","Alpha","Pixels that are not transpar\
ent"],["threshold","Brightness","Pixels darker, or brighter, than a threshold"],["color","Colour","P\
ixels that differ from the background's colour"],["scribbles","Scribbles","Pixels like those under p\
ainted strokes"]];var OUTLINES=[["foreground","Paint over it","A few strokes over the shape, then ov\
er the background"],["polygon","Draw its outline","Click the corners in turn, or draw around the sha\
pe"],["rectangle","Rectangle","Drag a rectangle"]];var MOST_LISTED=50;var LARGE=1e4;var Panel=class{constructor(act,stage){
this.act=act;this.stage=stage;this.numbers=NUMBERS.map(option=>{return new NumberControl(option,(changes,gesture)=>this.#choose(
changes,gesture))});this.methods=METHODS.map(([method,label,title2])=>{const onclick=()=>this.#choose(
{method});return make("button",{title:title2,role:"radio","data-value":method,onclick},label)});this.
invert=make("input",{type:"checkbox",onchange:()=>this.#choose({invert:this.invert.checked})});this.
inverts=make("label",{className:"glid-row"},this.invert,"Swap foreground and background");this.pickColor=
make("button",{"data-tool":"color"},"Pick the background's colour");this.scribbles=row2(brush("foreg\
round","Shape"),brush("background","Background"),make("button",{onclick:()=>act("clear_scribbles")},
"Clear"));this.knife=make("input",{type:"number",className:"glid-number",min:0,step:"any",placeholder:"\
auto","aria-label":"Width of the knife (px)",onchange:()=>{const{value}=this.knife;act("knife",{width:value===
""?null:Number(value)})}});this.knives=row2(make("span",{className:"glid-grow"},"Width of the knife"),
this.knife,make("span",{className:"glid-unit"},"px"));this.knives.classList.add("glid-knife");this.knives.
title="How wide the slit is; empty: as narrow as is good";this.component=make("select",{"aria-label":"\
Component",onchange:()=>this.#choose({component:Number(this.component.value),component_at:null})});this.
components=row2(make("span",{className:"glid-grow"},"Component"),this.component,make("button",{"data\
-tool":"component"},"Pick"));this.keep=row2(make("button",{onclick:()=>act("keep_pieces")},"Keep all\
 as parts"));this.doubt=make("p");const title="Show the outline as it was found, and use it";this.guess=
make("button",{title,onclick:()=>act("accept_guess")},"Use the guess");const byHand=[this.doubt,...this.#outlines(),
this.guess];this.byHand=make("div",{className:"glid-by-hand"},...byHand);this.holesTitle=make("h4");
this.holes=make("div",{className:"glid-holes"});this.notes=make("ul");this.notesBox=make("details",{
className:"glid-notes"},make("summary",{},"Notes"),this.notes);this.element=this.#laidOut()}#laidOut(){
const group={className:"glid-methods",role:"radiogroup","aria-label":"Method"};const[threshold,smoothing,
offset,simplify,leastHole]=this.numbers.map(({element})=>element);return make("div",{className:"glid\
-panel"},make("h4",{},"By hand"),this.byHand,this.knives,make("h4",{},"Foreground"),make("div",group,
...this.methods),...[this.scribbles,this.pickColor,threshold,this.inverts,smoothing,this.components],
this.keep,make("h4",{},"Outline"),...[offset,simplify,this.holesTitle,leastHole,this.holes,this.notesBox])}#outlines(){
const buttons=OUTLINES.map(([tool,label,title2])=>{return make("button",{title:title2,"data-tool":tool},
label)});const title="Everything, the background too";const whole=make("button",{title,onclick:()=>this.
act("draw")},"Whole picture");return[...buttons,whole]}#choose(changes,gesture){this.act("set_option\
s",{changes,gesture,replaces:gesture})}update(shown){this.element.hidden=!shown.size;if(!shown.size)
return;for(const control of this.numbers)control.update(shown);this.#showMethod(shown);this.#showDoubt(
shown);this.#showComponents(shown);this.#showHoles(shown);this.knives.hidden=shown.tool!=="knife";this.
knife.value=shown.knife_width===null?"":String(shown.knife_width);this.notesBox.hidden=!shown.notes.
length;this.notes.replaceChildren(...shown.notes.map(note=>make("li",{},note)))}#showMethod({options,
automatic}){const{method,invert}=options;const used=method==="auto"?automatic?.method:method;for(const button of this.
methods){button.ariaChecked=String(button.dataset.value===method);button.classList.toggle("glid-used",
button.dataset.value===used)}this.scribbles.hidden=used!=="scribbles";this.pickColor.hidden=used!=="\
color";this.inverts.hidden=used!=="color"&&used!=="threshold";this.invert.checked=invert===true;this.
invert.indeterminate=invert===null&&used==="threshold"}#showDoubt({doubt,loops}){const guess=Boolean(
doubt)||!loops.length;this.byHand.classList.toggle("glid-guess",guess);this.doubt.hidden=!guess;this.
guess.hidden=!doubt;const why=doubt?`The outline is not clear: ${doubt}. `:"";this.doubt.textContent=
`${why}Show it the shape:`}#showComponents({component,n_components:count,keeps}){this.components.hidden=
count<2;this.keep.hidden=count<2||!keeps;const listed=Math.min(count,MOST_LISTED);if(this.component.
length!==listed){const options=Array.from({length:listed},(_,i)=>{return new Option(i?`${i+1}.`:"Lar\
gest",String(i))});this.component.replaceChildren(...options)}this.component.value=String(component)}#showHoles({
holes:listed,n_holes:count,n_filled:filled,loops,doubt}){const small=filled?`, ${filled} small fille\
d`:"";this.holesTitle.textContent=`${holesIn(loops.length-1)} in the cage${small}`;this.holesTitle.hidden=
Boolean(doubt);const rows=listed.map((hole,i)=>this.#holeRow(hole,i));const left=count-listed.length;
const more=make("div",{className:"glid-unit"},`and ${left} smaller ones`);const root=this.holes.getRootNode();
const focused=[...this.holes.children].findIndex(one=>one.contains(root.activeElement));showChildren(
this.holes,left?[...rows,more]:rows);const boxes=this.holes.querySelectorAll("input");for(const[i,{kept}]of listed.
entries())boxes[i].checked=kept;boxes[focused]?.focus()}#holeRow(hole,i){const size=hole.area>=LARGE?
`${(hole.area/1e3).toFixed(0)}k px²`:`${hole.area.toFixed(0)} px²`;const made=hole.by_offset?" (ma\
de by the offset)":"";return make("label",{className:"glid-hole",onpointerenter:()=>this.stage.highlightHole(
i),onpointerleave:()=>this.stage.highlightHole(null)},make("input",{type:"checkbox",checked:hole.kept,
onchange:()=>this.act("toggle_hole",{number:i})}),make("span",{className:"glid-grow"},`Hole ${i+1}${made}`),
make("span",{className:"glid-unit"},size))}};function row2(...parts){return make("div",{className:"g\
lid-row"},...parts)}function brush(tool,label){return make("button",{className:`glid-brush glid-${tool}`,
"data-tool":tool},label)}var ZOOM=1.25;var WHEEL_SPEED=.0015;var WHEEL_LINE=33;var LINES=1;var PINCH=5;function distance([x,y],[
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
LINES?e.deltaY*WHEEL_LINE:e.deltaY}function nearest(things,reach){let best=null;let least=Infinity;for(const thing of things){const far=thing.
d+(thing.loss??0);if(!(thing.d<=reach)||far>=least)continue;best=thing;least=far}return best}function nearestVertex(loops,point,reach){
const vertices=loops.flatMap((loop,i)=>loop.map((vertex,j)=>({loop:i,index:j,d:distance(vertex,point)})));
return nearest(vertices,reach)}function nearestEdge(loops,point,reach){const edges=loops.flatMap(loop=>loop.
map((start,j)=>{const foot=footOn(start,loop[(j+1)%loop.length],point);return{foot,d:distance(foot,point)}}));
return nearest(edges,reach)}function footOn(start,end,point){const along=[end[0]-start[0],end[1]-start[1]];
const dot=(point[0]-start[0])*along[0]+(point[1]-start[1])*along[1];const share=Math.min(Math.max(dot/
(distance(start,end)**2||1e-30),0),1);return[start[0]+share*along[0],start[1]+share*along[1]]}function holeAt(holes,point){
let found=-1;holes.forEach((hole,i)=>{if((found<0||hole.area<holes[found].area)&&encloses(hole.loop,
point))found=i});return found}function encloses(loop,[x,y]){let winding=0;loop.forEach(([x0,y0],i)=>{
const[x1,y1]=loop[(i+1)%loop.length];const left=(x1-x0)*(y-y0)-(x-x0)*(y1-y0);if(y0<=y&&y1>y&&left>0)
winding+=1;if(y0>y&&y1<=y&&left<0)winding-=1});return winding!==0}var NEARLY_NOTHING="rgba(255, 255, 255, 0.004)";function painter(canvas,view,signal,draw){let due=0;
signal.addEventListener("abort",()=>cancelAnimationFrame(due));return()=>{if(due)return;due=requestAnimationFrame(
()=>{due=0;draw(clearedPen(canvas,view))})}}function clearedPen(canvas,{width,height}){const ratio=window.
devicePixelRatio||1;const wide=Math.round(width*ratio);const high=Math.round(height*ratio);if(canvas.
width!==wide||canvas.height!==high){canvas.width=wide;canvas.height=high}const pen=penOf(canvas);pen.
setTransform(ratio,0,0,ratio,0,0);pen.clearRect(0,0,width,height);pen.fillStyle=NEARLY_NOTHING;pen.fillRect(
0,0,width,height);return pen}function circle(pen,[x,y],radius,strokes,dash){pen.beginPath();pen.arc(
x,y,radius,0,2*Math.PI);strokePath(pen,strokes,dash)}function disk(pen,place,radius,fill,stroke,width=1){
circle(pen,place,radius,[]);pen.fillStyle=fill;pen.fill();if(stroke)strokePath(pen,[[width,stroke]])}
function tracePath(pen,lines,closed=true){pen.beginPath();for(const line of lines){line.forEach(([x,
y],i)=>{if(i)pen.lineTo(x,y);else pen.moveTo(x,y)});if(closed)pen.closePath()}}function rectangle([left,
top],[right,bottom]){return[[left,top],[right,top],[right,bottom],[left,bottom]]}function fillPath(pen,lines,style,rule="\
evenodd"){tracePath(pen,lines);pen.fillStyle=style;pen.fill(rule)}function strokePath(pen,strokes,dash=[]){
pen.setLineDash(dash);for(const[width,style]of strokes){pen.lineWidth=width;pen.strokeStyle=style;pen.
stroke()}pen.setLineDash([])}function scaleOf(element){const{width,height}=element.getBoundingClientRect();const across=width/element.
offsetWidth||1;return{across,down:height/element.offsetHeight||across}}function placeIn(element,{clientX,
clientY}){const{left,top}=element.getBoundingClientRect();const{across,down}=scaleOf(element);return[
(clientX-left)/across,(clientY-top)/down]}var CLICK=4;var LONG_PRESS=600;var LONG_PRESS_GRACE=100;var LONG_PRESS_SLACK=8;var PATH_STEP=3;var Pad=class{pointers=new Map;mode=null;grip=null;held=new Map;path=[];encloses=null;found=null;rests=null;#start=[
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
return this.#space?"grab":this.behaviour.cursor(this.found)}};var HALO="rgba(255, 255, 255, 0.9)";var SPECK=12;var CHECK=8;function drawStage(pen,stage,scene,hover){
const{shown,colors,loops}=scene;const{view}=stage;const[width,height]=shown.size??[0,0];const corner=view.
toScreen([0,0]);drawPicture(pen,stage,colors,corner,[width/view.unit,height/view.unit]);if(loops.length&&
!stage.painting){const frame=rectangle(corner,view.toScreen([width,height]));fillPath(pen,[...loops,
frame],colors.veil)}drawHoles(pen,stage,scene,hover);if(stage.brushing||shown.options.method==="scri\
bbles")drawStrokes(pen,stage,scene);if(loops.length)drawCage(pen,stage,scene,hover);if(stage.drawing||
shown.inside.length)drawOutline(pen,stage,scene);if(stage.cutting)drawKnife(pen,stage,scene);for(const{
point}of shown.problems){if(!point)continue;circle(pen,view.toScreen(point),13,[[5,HALO],[2.25,colors.
warn]])}}function drawPicture(pen,{bitmap,view},colors,corner,extent){pen.fillStyle=checks(pen,colors);
pen.fillRect(...corner,...extent);if(!bitmap)return;pen.imageSmoothingEnabled=6*view.unit>1;pen.imageSmoothingQuality=
"high";pen.drawImage(bitmap,...corner,...extent)}function checks(pen,colors){const tile=make("canvas",
{width:2*CHECK,height:2*CHECK});const ink=penOf(tile);ink.fillStyle=colors["check-light"];ink.fillRect(
0,0,tile.width,tile.height);ink.fillStyle=colors["check-dark"];for(const at of[0,CHECK])ink.fillRect(
at,at,CHECK,CHECK);return pen.createPattern(tile,"repeat")??colors["check-light"]}function strokeLoops(pen,loops,style,width,dash){
pen.lineJoin="round";tracePath(pen,loops);strokePath(pen,[[width+2.25,HALO]]);strokePath(pen,[[width,
style]],dash)}function drawHoles(pen,{view},{shown,colors},hover){shown.holes.forEach((hole,i)=>{const loop=view.
line(hole.loop);const hovered=hover?.hole===i;if(hovered)fillPath(pen,[loop],colors[hole.kept?"warn-\
soft":"accent-soft"]);const visible=Math.sqrt(hole.area)>SPECK*view.unit;if(hovered||!hole.kept&&visible)
strokeLoops(pen,[loop],colors.faint,1.25,[4,3])})}function drawStrokes(pen,{view,brushing,tool,pad:{
path}},{shown,colors}){const painted=[[shown.strokes.background,colors.background],[shown.strokes.foreground,
colors.foreground]];if(brushing&&path.length)painted.push([[path],colors[tool]]);pen.lineCap="round";
pen.lineJoin="round";for(const[lines,color]of painted){for(const line of lines){tracePath(pen,[view.
line([...line,line[line.length-1]])],false);strokePath(pen,[[8,HALO],[5,color]])}}}function drawOutline(pen,stage,{
shown,colors}){const{view}=stage;const color=colors.foreground;tracePath(pen,[view.line(stage.drawn())],
false);strokePath(pen,[[4.5,HALO],[2,color]]);for(const corner of shown.corners)disk(pen,view.toScreen(
corner),4,"white",color,2)}function drawKnife(pen,{view,pad:{path}},{colors}){if(!path.length)return;
pen.lineCap="butt";pen.lineJoin="round";tracePath(pen,[view.line(path)],false);strokePath(pen,[[5,HALO]]);
strokePath(pen,[[2.25,colors.warn]],[7,4])}function drawCage(pen,{view,painting},{shown,colors,loops},hover){
const color=shown.problems.length?colors.warn:colors.accent;strokeLoops(pen,loops,color,1.75);if(painting)
return;const radius=vertexRadius(loops);const strong=new Set([hover?.mark,...shown.selected.map(vertex=>vertex.
join(":"))]);loops.forEach((loop,i)=>{loop.forEach((vertex,j)=>{const seen=strong.has(`${i}:${j}`);const r=seen?
radius+1.75:radius;disk(pen,vertex,r+1,HALO);disk(pen,vertex,r,seen?color:"white",color,1.5)})});if(hover?.
edge)drawPlus(pen,view.toScreen(hover.edge.foot),color)}function vertexRadius(loops){let total=0;let count=0;
for(const loop of loops){loop.forEach(([x,y],i)=>{const[u,v]=loop[(i+1)%loop.length];total+=Math.hypot(
u-x,v-y)});count+=loop.length}return Math.min(4,Math.max(1.75,total/Math.max(count,1)*.16))}function drawPlus(pen,[
x,y],color){disk(pen,[x,y],7,"white",color,1.5);const across=[[x-3.5,y],[x+3.5,y]];const upright=[[x,
y-3.5],[x,y+3.5]];tracePath(pen,[across,upright],false);pen.stroke()}var TOOLS={edit:{key:"v",icon:PATHS.edit,label:"Edit vertices and holes (V)",hint:"Drag a vertex · d\
ouble-click an edge to add one · right-click a vertex to delete it · click a hole to drop it"},foreground:{
key:"b",icon:"M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-\
.8-.4-1.6-1.2-1.9z M9.5 12.5h5 M12 10v5",label:"Paint over the shape (B)",hint:"Paint over the shape"},
background:{key:"n",icon:"M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4\
 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z M9.5 12.5h5",label:"Paint over the background (N)",hint:"Paint over t\
he background around the shape"},color:{key:"i",icon:"M9 4l3 3 M10 3.2l1-1a1.6 1.6 0 0 1 2.8 2.2l-1.\
1 1.1 M9.6 5.2L3.4 11.4 2.5 13.5l2.1-.9 6.2-6.2",label:"Pick the background's colour (I)",hint:"Clic\
k a pixel that shows the background's colour"},component:{key:"c",icon:"M8 1.5v3 M8 11.5v3 M1.5 8h3 \
M11.5 8h3 M8 5.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 0 0-5.6z",label:"Pick the component to trace (C)",hint:"\
Click the part of the picture to trace"},polygon:{key:"p",icon:"M8 2l5.5 4-2 7h-7l-2-7z",label:"Draw\
 the outline by hand (P)",hint:"Click the corners in turn, or draw around the shape · double-click o\
r Enter closes it · Esc starts over"},rectangle:{key:"r",icon:PATHS.rectangle,label:"Draw a rectang\
le (R)",hint:"Drag a rectangle over the shape"},knife:{key:"k",icon:"M8 8l4.4-4.4a1.41 1.41 0 0 1 2 \
2L10 10z M8 8l-6 6c4 .1 6.6-1.2 8-4",label:"Cut with the knife (K)",hint:"Draw a line: the shape is \
cut along it · begin or end outside to cut a part loose"}};var TOOL_NAMES=["edit","foreground","bac\
kground","color","component","polygon","rectangle","knife"];var HELP=[["Outline",[["V","edit: drag a\
 vertex, double-click an edge to add one, click a hole to drop or keep it"],["Right-click, Delete","\
remove a vertex"],["[ ]","select the vertex before, the next vertex"],["Arrow keys","nudge the selec\
ted vertex, with Shift farther"],["Ctrl+Z, Ctrl+Shift+Z","undo, redo"]]],["By hand",[["B, N","paint \
over the shape, over the background"],["I, C","pick the background's colour, the component"],["K","k\
nife: draw a line along which the shape is cut; Esc while drawing discards it; its width is in the p\
anel"],["P, R","draw the outline or a hole in it, a rectangle; Enter closes it, Esc discards it"]]],
["View",[["Wheel, + -, F","zoom after a click on the picture, fit the picture"],["Drag beside the ou\
tline","move the view"]]]];var REACH={mouse:9,pen:12,touch:18};var MARGIN=24;var HINT=8;var CALLOUT=24;var EDGE=8;var MOST_ZOOM=40;
var FARTHEST=1e3;var COLORS=["accent","accent-soft","warn","warn-soft","faint","veil","foreground","\
background","check-light","check-dark"];var KEYS=/^(Arrow\w+|Delete|Backspace|Escape|Enter|[[\]])$/;
var Stage=class{canvas=make("canvas",{className:"glid-canvas",role:"application","aria-label":"Pictu\
re and cage"});callout=make("div",{className:"glid-callout",role:"alert",hidden:true});hintText=make(
"div",{className:"glid-hint"});drop=make("div",{className:"glid-drop",hidden:true},"Drop a picture h\
ere");empty=make("div",{className:"glid-empty"},make("p",{},"Drop a picture here, or open one from a\
 file."));shown=null;bitmap=null;tool="edit";colors=null;#turn=0;#closed=false;#listed=null;#fitted=true;constructor(root,link,upload,signal){
this.root=root;const parts=[this.canvas,this.empty,this.callout,this.hintText,this.drop];this.element=
make("div",{className:"glid-stage"},...parts);const moved=()=>{this.#fitted=false;this.changed()};this.
view=new View(moved,{up:-1,nearest:1/MOST_ZOOM,farthest:FARTHEST});this.changed=painter(this.canvas,
this.view,signal,pen=>this.#draw(pen));this.pad=new Pad(this.canvas,this.view,link,this);this.#takeFiles(
upload);this.resizer=new ResizeObserver(()=>this.#resize());this.resizer.observe(this.element);const themeChanged=()=>{
this.colors=null;this.changed()};this.themes=new MutationObserver(themeChanged);this.themes.observe(
document.body,{attributes:true});for(const theme of["(prefers-color-scheme: dark)","(forced-colors: \
active)"]){matchMedia(theme).addEventListener("change",themeChanged,{signal})}}close(){this.resizer.
disconnect();this.themes.disconnect();this.#closed=true;this.bitmap?.close();this.bitmap=null}#takeFiles(upload){
const{drop,element}=this;const on=(name,act)=>element.addEventListener(name,e=>{e.preventDefault();e.
stopPropagation();act(e)});const invite=()=>{drop.hidden=false};on("dragenter",invite);on("dragover",
invite);on("dragleave",e=>{const inside=element.contains(e.relatedTarget);if(!inside)drop.hidden=true});
on("drop",e=>{drop.hidden=true;const file=e.dataTransfer?.files[0];if(file)upload(file)})}update(shown){
const before=this.shown?.size;this.shown=shown;this.empty.hidden=Boolean(shown.size);if(shown.size&&
String(before)!==String(shown.size))this.fit();this.pad.hover()}async setPicture(bytes){this.#turn+=
1;const turn=this.#turn;const bitmap=bytes?.byteLength?await createImageBitmap(new Blob([bytes])):null;
if(turn!==this.#turn||this.#closed){bitmap?.close();return}this.bitmap?.close();this.bitmap=bitmap;this.
changed()}setTool(tool){this.tool=tool;this.pad.hover()}highlightHole(index){this.#listed=index===null?
null:{hole:index};this.changed()}fit(){const{view,element}=this;if(!this.shown?.size)return;const[w,
h]=this.shown.size;this.hintText.textContent=this.#hint(null);const below=Math.max(this.hintText.offsetHeight+
2*HINT,MARGIN);const wide=Math.max(element.clientWidth-2*MARGIN,1);const high=Math.max(element.clientHeight-
MARGIN-below,1);const unit=Math.min(Math.max(w/wide,h/high),FARTHEST);view.x=w/2;view.y=h/2+unit*(below-
MARGIN)/2;view.unit=unit;view.farthest=4*unit;this.#fitted=true;this.changed()}zoom(closer){this.view.
zoom(closer?1/ZOOM:ZOOM)}#resize(){const{clientWidth,clientHeight}=this.element;if(!clientWidth||!clientHeight)
return;if(this.#fitted)this.fit();this.view.width=clientWidth;this.view.height=clientHeight;this.changed()}get loops(){
const loops=this.shown?.loops??[];const{held}=this.pad;if(!held.size)return loops;return loops.map((loop,i)=>loop.
map((point,j)=>held.get(`${i}:${j}`)??point))}get brushing(){return this.tool==="foreground"||this.tool===
"background"}get drawing(){return this.tool==="polygon"||this.tool==="rectangle"}get cutting(){return this.
tool==="knife"}reach=REACH;keys=KEYS;actions={"+":()=>this.zoom(true),"=":()=>this.zoom(true),"-":()=>this.
zoom(false),f:()=>this.fit()};get painting(){return this.brushing||this.drawing||this.cutting}find(point,reach){
if(this.tool!=="edit"||!this.shown?.size)return null;const{holes,reach_shares:shares}=this.shown;const hole=holeAt(
holes,point);const near=hole<0?reach:shares.in_hole*reach;const vertex=nearestVertex(this.loops,point,
near);if(vertex)return{vertex,mark:`${vertex.loop}:${vertex.index}`};const edge=nearestEdge(this.loops,
point,shares.edge*near);if(edge)return{edge};return hole<0?null:{hole}}held({vertex,mark}){if(!vertex||
mark===void 0)return new Map;return new Map([[mark,this.loops[vertex.loop][vertex.index]]])}pans(found){
return!found?.vertex&&!this.painting}cursor(found){if(this.tool==="component")return"pointer";if(this.
tool!=="edit")return"crosshair";if(found?.vertex)return"grab";if(found?.edge)return"copy";return found?.
hole===void 0?"default":"pointer"}#draw(pen){const{shown,pad,view}=this;if(!shown||!view.width)return;
this.colors??=this.#readColors();const below=pad.mode==="pan"?null:pad.found;const hover=this.#listed??
below;if(shown.size)drawStage(pen,this,this.#scene(shown,this.colors),hover);const[left,top]=view.toScreen(
[0,0]);this.element.dataset.viewport=`${1/view.unit} ${left} ${top}`;this.#placeCallout(shown);this.
hintText.textContent=shown.size?this.#hint(hover):""}#scene(shown,colors){return{shown,colors,loops:this.
loops.map(loop=>this.view.line(loop))}}drawn(){const{path,rests}=this.pad;const inside=this.shown?.inside??
[];if(inside.length)return[...inside,inside[0]];const now=rests?[this.view.toWorld(rests)]:[];if(this.
tool==="polygon"){const corners=this.shown?.corners??[];return corners.concat(path.length?path:now)}
if(!path.length||!now.length)return[];return[...rectangle(path[0],now[0]),path[0]]}#hint(hover){const hole=hover?.
hole===void 0?void 0:this.shown?.holes[hover.hole];if(hole)return hole.kept?"Click to drop this hole":
"Click to keep this hole";if(hover?.edge)return"Double-click to add a vertex here";if(hover?.vertex)
return"Drag to move · right-click or Delete to delete";return TOOLS[this.tool].hint}#readColors(){const probe=this.
root.appendChild(make("span"));probe.style.setProperty("forced-color-adjust","none");const color=name=>{
probe.style.color=`var(--glid-${name})`;return getComputedStyle(probe).color};const colors=Object.fromEntries(
COLORS.map(name=>[name,color(name)]));probe.remove();return colors}#placeCallout(shown){const{callout,
view}=this;const problem=shown.problems[0];callout.hidden=!problem||this.pad.mode==="pan";if(!problem)
return;callout.textContent=problem.message;const{offsetWidth:w,offsetHeight:h}=callout;const[x,y]=problem.
point?view.toScreen(problem.point):[view.width/2,-16];const fitsBelow=!problem.point||y+CALLOUT+h<=view.
height;const beside=fitsBelow?y+CALLOUT:y-CALLOUT-h;const left=Math.min(Math.max(x-w/2,EDGE),view.width-
w-EDGE);const top=Math.min(Math.max(beside,EDGE),view.height-h-EDGE);callout.style.transform=`transl\
ate(${left}px, ${top}px)`}};var PART=1<<20;var Tracer=class{root=make("div",{className:"glid-skin glid-tracer"});status=make("di\
v",{className:"glid-status",role:"status","aria-live":"polite"});constructor({model,el,signal}){this.
model=model;this.link=new Link(model,this.root,signal,()=>{this.showStatus();if(this.link.idle&&this.
shown)this.#showTool(this.shown.tool)});this.stage=new Stage(this.root,this.link,file=>this.upload(file),
signal);this.panel=new Panel((type,content)=>void this.act(type,content),this.stage);this.tools=TOOL_NAMES.
map(name=>{const button=drawnButton(TOOLS[name].icon,TOOLS[name].label,void 0);button.dataset.tool=name;
return button});for(const name of TOOL_NAMES){this.stage.actions[TOOLS[name].key]=()=>this.#chooseTool(
name)}this.undo=iconButton("undo","Undo (Ctrl+Z)",()=>this.act("undo"));this.redo=iconButton("redo",
"Redo (Ctrl+Shift+Z)",()=>this.act("redo"));this.discard=make("button",{title:"Go back to the outlin\
e as traced",onclick:()=>this.act("discard_edits")},"Discard edits");this.question=this.#askAbout();
this.keepAll=this.#answer("Keep all as parts",()=>this.act("keep_pieces"));this.pieces=this.#askWhichPiece();
this.stage.element.append(this.question,this.pieces);const keys=help(HELP);this.stage.element.append(
keys.table);this.stage.actions["?"]=keys.toggle;this.root.append(this.#toolbar(keys.button),make("di\
v",{className:"glid-body"},this.stage.element,this.panel.element),this.status);keysAround(this.stage.
element,e=>this.stage.pad.keydown(e),signal,this.root);this.root.addEventListener("click",e=>this.#clicked(
e));el.classList.add("glid-host");el.append(this.root)}close(){this.stage.close()}get shown(){const shown=this.
model.get("shown");return shown.loops?shown:null}act(type,content={},buffers=[]){return this.link.put(
{type,...content},buffers)}async upload(file){const name=file.name||"the picture";let start=0;let refused=null;
do{const data=await file.slice(start,start+PART).arrayBuffer();const part={name,size:file.size,start,
buffered:true};refused=await this.act("upload",part,[data]);start+=PART}while(!refused&&start<file.size)}showState(){
const{shown,stage}=this;if(!shown)return;stage.update(shown);this.panel.update(shown);this.undo.disabled=
!shown.can_undo;this.redo.disabled=!shown.can_redo;this.discard.hidden=!shown.edited;this.question.hidden=
!shown.inside.length;this.pieces.hidden=(shown.cut?.shares.length??1)<2;this.keepAll.hidden=!shown.keeps;
for(const button of this.tools)button.disabled=!shown.size;if(this.link.idle)this.#showTool(shown.tool);
this.showStatus()}showStatus(){const{shown}=this;if(!shown)return;const{kind,text}=statusOf(shown,this.
link.refusal,this.link.busy);this.root.dataset.status=kind;this.status.textContent=text}async showPicture(){
try{await this.stage.setPicture(this.model.get("picture"))}catch(error){const why=error instanceof Error?
error.message:error;this.link.refusal=`The picture cannot be shown: ${why}`;this.showStatus()}}showHeight(){
const height=this.model.get("height");this.root.style.setProperty("--glid-height",height?`${height}p\
x`:"")}#askAbout(){const answer=(label,what)=>this.#answer(label,()=>this.act("drawn_as",{what}));return question(
"What you drew","What you drew lies inside the shape. It is ",answer("a hole","hole"),answer("the ne\
w outline","outline"),answer("nothing",""))}#askWhichPiece(){const keepNext=()=>{const{shares,kept}=this.
shown?.cut??{shares:[],kept:0};return this.act("keep_piece",{number:(kept+1)%shares.length})};return question(
"Pieces of the cut","Only the outlined piece is kept. ",this.#answer("Keep another",keepNext),this.keepAll,
this.#answer("Undo the cut",()=>this.act("undo")))}#answer(label,act){const onclick=()=>{act();this.
stage.canvas.focus({preventScroll:true})};return make("button",{onclick},label)}#toolbar(help2){const input=make(
"input",{type:"file",accept:"image/*",hidden:true});input.addEventListener("change",()=>{if(input.files?.[0])
this.upload(input.files[0])});const open=iconButton("open","Open a picture",()=>{input.value="";input.
click()});const{stage}=this;return make("div",{className:"glid-toolbar",role:"toolbar","aria-label":"\
Tracer"},...[open,input,gap(),...this.tools,gap(),this.undo,this.redo,this.discard],make("span",{className:"\
glid-grow"}),iconButton("minus","Zoom out (-)",()=>stage.zoom(false)),iconButton("plus","Zoom in (+)",
()=>stage.zoom(true)),iconButton("fit","Fit the picture (F)",()=>stage.fit()),help2)}#clicked(e){const button=e.
target.closest("[data-tool]");const name=button?.dataset.tool;if(name)this.#chooseTool(name)}#chooseTool(name){
if(!this.shown?.size)return;this.#showTool(name);this.act("tool",{name})}#showTool(name){if(name!==this.
stage.tool)this.stage.setTool(name);for(const button of this.root.querySelectorAll("[data-tool]")){const{
tool}=button.dataset;button.ariaPressed=String(tool===name)}}};function gap(){return make("span",{className:"\
glid-gap"})}function question(name,text,...answers){const look={className:"glid-question",role:"grou\
p","aria-label":name,hidden:true};return make("div",look,text,...answers)}function render(context){const tracer=new Tracer(context);follow(context.model,{"change:height":()=>tracer.
showHeight(),"change:shown":()=>tracer.showState(),"change:picture":()=>tracer.showPicture()});return()=>tracer.
close()}var main_default={render};export{main_default as default};
