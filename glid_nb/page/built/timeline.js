function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}
function showChildren(parent,children){for(const[i,child]of children.entries()){const shown=parent.children[i];
if(!shown)parent.append(child);else if(!shown.isEqualNode(child))shown.replaceWith(child)}for(const child of[
...parent.children].slice(children.length))child.remove()}function toFloats(view){if(!view)return new Float32Array;return new Float32Array(view.buffer.slice(view.
byteOffset,view.byteOffset+view.byteLength))}function follow(model,listeners){for(const[names,listener]of Object.
entries(listeners)){model.on(names,listener);listener()}}var Motion=class{constructor({times,repeat},floats){this.times=times;this.repeat=repeat;this.floats=
floats;this.mixed=floats.slice(0,floats.length/times.length);this.start=times[0];this.last=times[times.
length-1];this.end=repeat==="ping-pong"?2*this.last-this.start:this.last}within(time){const{start,end}=this;
if(this.repeat==="once")return Math.min(Math.max(time,start),end);const span=end-start;return start+
((time-start)%span+span)%span}place(time){const{times,last}=this;const within=this.within(time);const there=within>
last?2*last-within:within;const next=times.findIndex((knot,i)=>i>0&&there<knot);const high=next<0?times.
length-1:next;const low=high-1;return{piece:low,share:(there-times[low])/(times[high]-times[low])}}at(time){
const{piece,share}=this.place(time);const{floats,mixed}=this;const low=piece*mixed.length;const high=low+
mixed.length;for(let i=0;i<mixed.length;i++){mixed[i]=(1-share)*floats[low+i]+share*floats[high+i]}return mixed}};var LAST_LATIN="ɏ";var LATIN={Comma:",<",Period:".>",Slash:"/?",Minus:"-_",Equal:"=+",BracketLeft:"\
[{",BracketRight:"]}"};function keyOf({key,code="",shiftKey=false}){if(key.length>1||key<=LAST_LATIN)
return key;const[,letter,digit]=code.match(/^(?:Key([A-Z])|(?:Digit|Numpad)([0-9]))$/)??[];if(letter)
return shiftKey?letter:letter.toLowerCase();return digit??LATIN[code]?.[Number(shiftKey)]??key}function undoOrRedo(e){
if(!e.ctrlKey&&!e.metaKey)return null;const key=keyOf(e).toLowerCase();if(key==="z")return e.shiftKey?
"redo":"undo";return key==="y"?"redo":null}var BUSY_AFTER=250;var ACKNOWLEDGE_TIMEOUT=2e3;var Link=class{busy=false;refusal=null;view=Math.random().
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
"_cleanSubshells")&&connect.call(status,slot,receiver)}var PATHS={edit:"M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",brush:"M13.5 2.5l-6 6 M6.7 9.2c-1.6\
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
glid-icon"){return make("button",{title,"aria-label":title,className,onclick,innerHTML:drawn(path)})}var KERNEL="Played by the kernel (too large for shaders). ";function seconds(time){return`${time.toFixed(
2)} s`}function noteOn({keyframes,recording,kernel},segments){if(recording){const text="Recording: d\
rag a pin; its movement becomes keyframes.";return{text,kind:"recording"}}const bad=segments.find(({
reason})=>reason);if(bad)return{text:reasonOf(bad),kind:"bad"};if(!segments.length){const alone=keyframes.
length<2;const text=alone?"Key (K) a second pose to see the motion between them.":"";return{text,kind:"\
advice"}}return{text:(kernel?KERNEL:"")+proofOf(segments),kind:"state"}}function reasonOf({start,end,
reason,part}){const text=reason||`Not proved yet from ${seconds(start)} to ${seconds(end)}`;return part?
`${part}: ${text}`:text}function boundOf({start,end,sigma2,part}){const text=`σ₂ ≥ ${sigma2.toFixed(
3)} from ${seconds(start)} to ${seconds(end)}`;return part?`${text}; the worst part is ${part}`:text}
function proofOf(segments){if(segments.some(({status})=>status==="computing")){return"Proving the mo\
tion between poses…"}const pieces=segments.flatMap(segment=>segment.pieces);const{sigma2,part}=pieces.
reduce((a,b)=>b.sigma2<a.sigma2?b:a);const lasts=seconds(segments[segments.length-1].end-segments[0].
start);const where=part?` (${part})`:"";return`Proved at every instant of ${lasts}: σ₂ ≥ ${sigma2.
toFixed(3)}${where}.`}function scaleOf(element){const{width,height}=element.getBoundingClientRect();const across=width/element.
offsetWidth||1;return{across,down:height/element.offsetHeight||across}}function placeIn(element,{clientX,
clientY}){const{left,top}=element.getBoundingClientRect();const{across,down}=scaleOf(element);return[
(clientX-left)/across,(clientY-top)/down]}var WHEEL_LINE=33;var LINES=1;function turnOf(e){return e.deltaMode===LINES?e.deltaY*WHEEL_LINE:e.deltaY}var INSET=34;var STEP=1.5;var MOST=40;var WHEEL_SPEED=.004;var LEADS=.25;function scrolledTo(share,at,width){
return Math.max(INSET+share*(width-2*INSET)-at,0)}var Zoom=class{factor=1;constructor(track,changed){
this.track=track;this.changed=changed;this.box=make("div",{className:"glid-track-view"},track);this.
box.addEventListener("wheel",e=>this.#wheel(e),{passive:false})}zoom(by,at=this.box.clientWidth/2){const{
box,track}=this;const share=(box.scrollLeft+at-INSET)/(track.offsetWidth-2*INSET);this.factor=Math.min(
Math.max(this.factor*by,1),MOST);track.style.width=`${100*this.factor}%`;box.scrollLeft=scrolledTo(share,
at,track.offsetWidth);this.changed()}reveal(at){const{box}=this;if(this.factor===1)return;const seen=at>=
box.scrollLeft&&at<=box.scrollLeft+box.clientWidth;if(!seen)box.scrollLeft=at-LEADS*box.clientWidth}#wheel(e){
const{box}=this;const step=turnOf(e);if(e.ctrlKey||e.metaKey){e.preventDefault();const at=(e.clientX-
box.getBoundingClientRect().left)/scaleOf(box).across;this.zoom(Math.exp(-step*WHEEL_SPEED),at);return}
const before=box.scrollLeft;if(!e.deltaX)box.scrollLeft+=step;if(box.scrollLeft!==before)e.preventDefault()}};var REPEATS=[["once","Once"],["loop","Loop"],["ping-pong","Ping-pong"]];var OF_RANGE=["range","Loop \
range"];var ONION="Onion skin: outlines of the poses before (blue) and after (orange) the edited pos\
e";var KEY="Key this pose and continue with a copy (K); at another time, key the shape that is shown\
 there";var LEGEND=[["proved","proved"],["computing","not yet"],["refused","not proved"]];var EASE="\
M2.5 13.5C8 13.5 8 2.5 13.5 2.5";var Bar=class{recording=false;onionOn=false;#range=new Option(OF_RANGE[1],
OF_RANGE[0]);constructor({play,keep,act,edit,zoom,ease}){this.play=iconButton("play","Play, pause (S\
pace)",play);this.repeat=menu("Play once, in a loop, or there and back",REPEATS,repeat=>{if(repeat!==
OF_RANGE[0])act("play_all",{repeat})});this.clock=make("span",{className:"glid-time",role:"timer"});
this.record=iconButton("record","Record: keep the next drag as keyframes",()=>act("record",{on:!this.
recording}));this.onion=iconButton("onion",ONION,()=>act("onion",{on:!this.onionOn}));this.keep=make(
"button",{className:"glid-keep",title:KEY,onclick:keep},"Key");const copy=iconButton("copy","Duplica\
te this pose",()=>edit("duplicate_pose"));this.ease=drawnButton(EASE,"Easing of the motion that leav\
es this pose (Enter)",ease);this.ease.ariaHasPopup="dialog";this.remove=iconButton("trash","Delete t\
his pose (Delete)",()=>edit("delete_pose"));this.save=iconButton("export","Export the motion",()=>{this.
save.dispatchEvent(new CustomEvent("glid:inspect",{bubbles:true}));act("export")});this.element=make(
"div",{className:"glid-bar",role:"toolbar","aria-label":"Motion"},...[this.play,this.repeat,this.clock,
gap()],...[this.record,this.onion,gap()],...[this.keep,copy,this.remove,this.ease,gap(),this.save],make(
"span",{className:"glid-zoom"},gap(),iconButton("minus","See more of the timeline (Ctrl and wheel)",
()=>zoom(1/STEP)),iconButton("plus","See less of the timeline, larger (Ctrl and wheel)",()=>zoom(STEP))))}update({
keyframes,repeat,range,recording,onion,exports}){const alone=keyframes.length<2;if(range)this.repeat.
append(this.#range);else this.#range.remove();this.repeat.value=range?OF_RANGE[0]:repeat;this.remove.
disabled=alone;for(const control of[this.play,this.save,this.repeat,this.ease]){control.disabled=alone}
this.save.hidden=!exports;this.recording=recording;this.onionOn=onion;this.record.ariaPressed=String(
recording);this.onion.ariaPressed=String(onion)}showTime(place,end,playing){const does=playing?"paus\
e":"play";if(this.play.dataset.does!==does)this.play.innerHTML=icon(does);this.play.dataset.does=does;
this.clock.textContent=`${place.toFixed(2)} / ${seconds(end)}`}};function legend(){const parts=LEGEND.
map(([kind,label])=>{return make("span",{},make("i",{className:"glid-swatch","data-kind":kind}),label)});
return make("div",{className:"glid-proof-legend","aria-hidden":true},...parts)}function gap(){return make(
"span",{className:"glid-gap"})}function menu(label,choices,act){const options=choices.map(([value,text])=>new Option(
text,value));const select=make("select",{"aria-label":label,title:label},...options);select.addEventListener(
"change",()=>act(select.value));return select}var HELD=.99;var THIRD=1/3;var NAMED={linear:{label:"Even",handles:[THIRD,THIRD,2*THIRD,2*THIRD]},in:{
label:"Ease in",handles:[THIRD,0,2*THIRD,THIRD]},out:{label:"Ease out",handles:[THIRD,2*THIRD,2*THIRD,
1]},"in-out":{label:"Ease in, out",handles:[THIRD,0,2*THIRD,1]}};var HOLD="hold";var PRESETS=[...Object.
entries(NAMED).map(([name,{label}])=>[name,label]),[HOLD,"Hold"]];function handlesOf(easing){return typeof easing===
"string"?NAMED[easing]?.handles??null:easing}function nameOf(easing){return PRESETS.find(([name])=>name===
easing)?.[1]??"Curve"}function pathOf(easing,size){const at=(x,y)=>`${Number((x*size).toFixed(2))} ${Number(
((1-y)*size).toFixed(2))}`;const handles=handlesOf(easing);if(!handles)return`M${at(0,0)} L${at(HELD,
0)} L${at(1,1)}`;const[x1,y1,x2,y2]=handles;return`M${at(0,0)} C${at(x1,y1)} ${at(x2,y2)} ${at(1,1)}`}
function stretchedCurve(easing){const path=pathOf(easing,100);return`<svg viewBox="0 0 100 100" pres\
erveAspectRatio="none" aria-hidden="true"><path vector-effect="non-scaling-stroke" d="${path}"/></sv\
g>`}function withHandle(easing,which,place){const[x,y]=place.map(one=>Math.round(100*Math.min(Math.max(
one,0),1))/100);const[x1,y1,x2,y2]=handlesOf(easing)??NAMED.linear.handles;return which===0?[x,y,x2,
y2]:[x1,y1,x,y]}var SIZE=140;var MARGIN=14;var GAP=6;var STEP2=.02;var LONG_STEP=.1;var NUMBERS=[["x1","How it leave\
s: share of the time"],["y1","How it leaves: share of the way"],["x2","How it arrives: share of the \
time"],["y2","How it arrives: share of the way"]];var ARROWS={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowDown:[
0,-1],ArrowUp:[0,1]};var EaseEditor=class{index=-1;#easing="linear";#held=null;constructor(set,closed){
this.set=set;this.closed=closed;this.title=make("h4",{});this.curve=make("div",{className:"glid-ease\
-curve"});this.drawing=make("div",{className:"glid-ease-drawing"});this.handles=[this.#handle(0),this.#handle(
1)];this.numbers=NUMBERS.map(([label,title],i)=>this.#number(label,title,i));this.presets=PRESETS.map(
([easing,label])=>make("button",{title:label,onclick:()=>this.#choose(easing),innerHTML:curveIcon(easing)},
make("span",{},label)));this.curve.append(this.drawing,...this.handles);this.element=make("div",{className:"\
glid-ease",role:"dialog",popover:"auto","aria-label":"Easing"},this.title,this.curve,make("div",{className:"\
glid-ease-numbers"},...this.numbers.map(one=>one.field)),make("div",{className:"glid-ease-presets",role:"\
group"},...this.presets));this.element.addEventListener("keydown",e=>this.#keydown(e));this.element.
addEventListener("keyup",e=>e.stopPropagation());this.element.addEventListener("pointerdown",e=>e.stopPropagation());
this.element.addEventListener("toggle",e=>this.#toggled(e))}open(index,title,easing,at){const{element}=this;
this.element.hidePopover();this.index=index;this.show(title,easing);element.showPopover();const{left,
width,top,bottom}=at.getBoundingClientRect();const room=element.getBoundingClientRect();const over=this.
element.parentElement?.getBoundingClientRect().top??top;const places=[over,top].map(edge=>edge-room.
height-GAP);const x=Math.min(left+(width-room.width)/2,window.innerWidth-room.width-GAP);element.style.
left=`${Math.max(x,GAP)}px`;element.style.top=`${places.find(one=>one>=0)??bottom+GAP}px`;const pressed=this.
presets.find(button=>button.ariaPressed==="true");(pressed??this.handles[0]).focus({preventScroll:true})}show(title,easing){
if(this.#held!==null)return;this.title.textContent=title;this.#draw(easing)}close(){this.element.hidePopover()}#draw(easing){
this.#easing=easing;const handles=handlesOf(easing);this.drawing.innerHTML=drawing(easing,handles);this.
handles.forEach((handle,i)=>{handle.hidden=!handles;if(!handles)return;const[x,y]=handles.slice(2*i);
handle.style.left=`${MARGIN+x*SIZE}px`;handle.style.top=`${MARGIN+(1-y)*SIZE}px`;handle.ariaValueNow=
`${Math.round(100*x)}`;handle.ariaValueText=`time ${Math.round(100*x)} %, way ${Math.round(100*y)} %`});
for(const[i,{field,input}]of this.numbers.entries()){field.hidden=!handles;if(handles)input.value=`${Number(
handles[i].toFixed(2))}`}for(const[i,[name]]of PRESETS.entries()){this.presets[i].ariaPressed=String(
name===easing)}this.drawing.title=nameOf(easing)}#choose(easing){this.#draw(easing);this.set(this.index,
easing)}#number(label,title,i){const limits={type:"number",min:"0",max:"1",step:"0.01"};const input=make(
"input",{...limits,title,"aria-label":title});input.addEventListener("change",()=>{const handles=handlesOf(
this.#easing);if(!handles||!Number.isFinite(input.valueAsNumber))return this.#draw(this.#easing);const which=i>>
1;const place=handles.slice(2*which,2*which+2);place[i%2]=input.valueAsNumber;this.#draw(withHandle(
this.#easing,which,place));this.set(this.index,this.#easing)});return{input,field:make("label",{},label,
input)}}#handle(which){const name=which===0?"How it leaves":"How it arrives";const handle=make("butt\
on",{className:"glid-ease-handle",role:"slider","aria-label":name,"aria-valuemin":0,"aria-valuemax":100,
title:`${name}: drag it, or arrow keys`});handle.addEventListener("pointerdown",e=>{if(e.button!==0)
return;e.preventDefault();handle.focus({preventScroll:true});handle.setPointerCapture(e.pointerId);this.#held=
which});handle.addEventListener("pointermove",e=>{if(this.#held===which&&handle.hasPointerCapture(e.
pointerId)){const[x,y]=placeIn(this.curve,e);this.#move(which,[(x-MARGIN)/SIZE,1-(y-MARGIN)/SIZE])}});
handle.addEventListener("lostpointercapture",()=>this.#letGo());handle.addEventListener("keydown",e=>this.#nudge(
e,which));handle.addEventListener("keyup",()=>this.#letGo());handle.addEventListener("blur",()=>this.#letGo());
return handle}#move(which,place){this.#held=which;this.#draw(withHandle(this.#easing,which,place))}#letGo(){
if(this.#held===null)return;this.#held=null;this.set(this.index,this.#easing)}#nudge(e,which){const arrow=ARROWS[e.
key];const handles=handlesOf(this.#easing);if(!arrow||!handles||e.ctrlKey||e.metaKey||e.altKey)return;
e.preventDefault();const step=e.shiftKey?LONG_STEP:STEP2;const[x,y]=handles.slice(2*which);this.#move(
which,[x+step*arrow[0],y+step*arrow[1]])}#keydown(e){if(!e.ctrlKey&&!e.metaKey)e.stopPropagation()}#toggled({
newState}){if(newState==="open"||this.element.matches(":popover-open"))return;const{index}=this;this.
index=-1;this.closed(index)}};function curveIcon(easing){const path=pathOf(easing,12);return`<svg vi\
ewBox="-2 -2 16 16" aria-hidden="true"><path d="${path}"/></svg>`}function drawing(easing,handles){const up=y=>(1-
y)*SIZE;const arms=handles&&[`M0 ${SIZE} L${handles[0]*SIZE} ${up(handles[1])}`,`M${SIZE} 0 L${handles[2]*
SIZE} ${up(handles[3])}`];const box=[-MARGIN,-MARGIN,SIZE+2*MARGIN,SIZE+2*MARGIN].join(" ");return`<\
svg viewBox="${box}" aria-hidden="true"><rect width="${SIZE}" height="${SIZE}"/><path class="glid-ea\
se-arms" d="${arms?arms.join(" "):""}"/><path d="${pathOf(easing,SIZE)}"/></svg>`}var LEAST_GAP=.001;function pinsAt({spans,poses,keyframes},at){const time=Math.round(100*at)/100;const index=keyframes.
findIndex(key=>Math.abs(key-time)<LEAST_GAP);if(index>=0)return ofPose(poses[index%poses.length]);const span=spans.
find(({end})=>at<=end)??spans.at(-1);const floats=toFloats(span?.floats);if(!span||!floats.length)return{
places:[],locked:[]};const motion=new Motion({times:span.times,repeat:"once"},floats);return{places:pairs(
motion.at(at)),locked:span.locked}}function pinsLater({poses}){return ofPose(poses.at(-1))}function ofPose(pins){
return{places:pairs(toFloats(pins?.floats)),locked:pins?.locked??[]}}function pairs(numbers){return Array.
from({length:numbers.length/2},(_,i)=>[numbers[2*i],numbers[2*i+1]])}var Player=class{clock=null;time=0;seen=false;only=0;range=null;later=null;#intervals=[];#others=new Map;#frame=0;constructor(show,moved,ended=()=>{}){
this.show=show;this.moved=moved;this.ended=ended}set(intervals,repeat,others={}){this.#intervals=intervals.
map(partOf);const entries=Object.entries(others);this.#others=new Map(entries.map(([key,theirs])=>[key,
theirs.map(partOf)]));const first=intervals[0];const last=intervals.at(-1);const times=first&&last?[
first.start,last.end]:null;this.clock=times&&new Motion({times,repeat},new Float32Array(0));if(this.
seen&&!this.playing){if(this.later===null)this.#seek(this.time);else this.scrub(this.later)}}get playing(){
return this.#frame!==0}get place(){if(this.later!==null)return this.later;const last=this.clock?.last??
Infinity;return this.time>last?2*last-this.time:this.time}scrub(time){this.#stop();const{clock}=this;
const last=clock?.last??this.only;if(time>last&&clock?.repeat!=="loop")this.#wait(time);else if(clock)
this.#seek(Math.min(Math.max(time,clock.start),last));else this.release(last)}play(){const{clock}=this;
if(this.playing||!clock){this.pause();return}this.later=null;const once=clock.repeat==="once"&&!this.
range;if(once&&this.time>=clock.end)this.time=clock.start;let last=null;const step=async now=>{const time=this.#inRange(
this.time+(last===null?0:(now-last)/1e3));last=now;await this.#seek(time);if(!this.playing)return;if(once&&
time>=clock.end){this.pause();this.ended()}else this.#frame=requestAnimationFrame(step)};this.#frame=
requestAnimationFrame(step);this.moved()}#inRange(time){if(!this.range)return time;const[start,end]=this.
range;if(time>=start&&time<end)return time;return time<start||this.time>=end?start:start+(time-start)%
(end-start)}pause(){const{playing}=this;this.#stop();if(playing)this.renew();this.moved()}renew(){if(!this.
seen||this.playing)return;if(this.later===null)this.#showAt(this.place,this.place);else this.#showAt(
this.time,this.later)}#stop(){cancelAnimationFrame(this.#frame);this.#frame=0}release(time){this.#stop();
this.time=time;this.later=null;if(this.seen){this.seen=false;this.show(null)}this.moved()}#wait(time){
this.later=time;this.time=this.clock?.last??this.only;this.seen=true;this.#showAt(this.time,time);this.
moved()}#seek(time){const{clock}=this;if(!clock){this.release(0);return}this.later=null;this.time=time===
clock.end?time:clock.within(time);this.seen=true;const{place}=this;const shown=this.#showAt(place,place);
this.moved();return shown}#showAt(place,time){const own=partAt(this.#intervals,place);const others=[
...this.#others].map(([key,parts])=>({key,part:partAt(parts,place)}));const untils=others.map(({part})=>part?.
until??place);const at=Math.min(place,own?.until??place,...untils);const moved=others.flatMap(({key,
part})=>{const floats=part?.motion?.at(at);return floats?[[key,floats]]:[]});return this.show(own?.motion?.
at(at)??null,time,Object.fromEntries(moved),at)}};function partOf({end,until,times,floats}){const motion=floats.
length?new Motion({times,repeat:"once"},floats):null;return{end,until,motion}}function partAt(parts,place){
return parts.find(({end})=>place<=end)??parts.at(-1)}var LATER=.15;var LEAST=1.15;var MOST_LABELS=12;var LABEL=48;var STEPS=[.02,.04,.1,.2,.5,1,2,5,10,30,
60,300,600];var LONGEST_STEP=1800;var SAME=1e-9;var WHOLE=1e-6;var ROUNDING=.006;function withReturn({
keyframes,repeat,back}){const last=keyframes.at(-1);if(repeat!=="loop"||keyframes.length<2||!last)return keyframes;
const[first]=keyframes;return[...keyframes,{...first,time:last.time+back,name:`Back to ${first.name}`}]}
function spanOf(keyframes){const last=keyframes.at(-1)?.time??0;return last+Math.max(LEAST,LATER*last)}
function roomAt(keyframes,index,span){const{time}=keyframes[index];const before=index>0?time-keyframes[index-
1].time:span;const after=index+1<keyframes.length?keyframes[index+1].time-time:span;return Math.min(
before,after)}function labelledTimes(span,width=0,zoom=1){const most=width?Math.min(width/LABEL,MOST_LABELS*
zoom):MOST_LABELS;const step=STEPS.find(one=>span/one<=most)??LONGEST_STEP;return Array.from({length:Math.
floor(span/step)+1},(_,i)=>i*step)}function frameAt(time,rate){const frame=Math.round(time*rate);return Math.
abs(frame-time*rate)<WHOLE?frame:null}function keyAt(keyframes,time){return keyframes.findIndex(key=>Math.
abs(key.time-time)<SAME)}function nextKey(keyframes,time,sign){const beyond=[...keyframes.keys()].filter(
i=>sign*(keyframes[i].time-time)>SAME);return(sign>0?beyond[0]:beyond.at(-1))??null}function landing(keyframes,index,time,least){
const gap2=Math.ceil(100*least)/100;const others=keyframes.filter((_,i)=>i!==index).map(key=>key.time);
const earliest=index<keyframes.length?0:(others.at(-1)??0)+gap2;const free=at=>at>=earliest&&others.
every(other=>Math.abs(at-other)>gap2-ROUNDING);const places=[Math.max(time,earliest),...others.flatMap(
other=>[other-gap2,other+gap2])];const far=at=>Math.abs(at-time);return places.map(at=>Math.round(100*
at)/100).filter(free).sort((a,b)=>far(a)-far(b))[0]}var LEAST_HEIGHT=.06;function heightOf(bound){return Math.min(Math.max(bound,LEAST_HEIGHT),1)}function nameField(track,left,name,rename,ended){let open=true;const end=keep=>{if(!open)return;open=
false;const typed=field.value.trim();field.remove();ended();if(keep&&typed&&typed!==name)rename(typed)};
const field=make("input",{className:"glid-name-field",type:"text",value:name,"aria-label":"Name of t\
he pose",style:`left: clamp(52px, ${left}, 100% - 52px)`,onpointerdown:e=>e.stopPropagation(),onblur:()=>end(
true),onkeydown:e=>{e.stopPropagation();if(e.key==="Enter"||e.key==="Escape")end(e.key==="Enter")}});
track.append(field);field.focus();field.select()}var SAME2=1e-6;function withEnd(range,whole,which,time,frame){const[start,end]=range;const least=Math.
min(frame,whole[1]-whole[0]);const made=which===0?[Math.max(Math.min(time,end-least),whole[0]),end]:
[start,Math.min(Math.max(time,start+least),whole[1])];return made.every((one,i)=>Math.abs(one-whole[i])<
SAME2)?null:made}function keyedEnd(range,whole,which,time,frame){const from=range?[...range]:[...whole];
if(range&&Math.abs(from[which]-time)<SAME2)return withEnd(from,whole,which,whole[which],frame);const other=which===
0?1:0;if(which===0?time>=from[1]:time<=from[0])from[other]=whole[other];return withEnd(from,whole,which,
time,frame)}var RangeMarks=class{band=make("i",{className:"glid-range"});#range=null;#whole=null;#dragged=void 0;constructor(ruler){
this.ruler=ruler;this.marks=[this.#mark(0),this.#mark(1)];this.elements=[this.band,...this.marks]}show(range,whole){
this.#range=range;this.#whole=whole;if(this.#dragged===void 0)this.#draw(range)}drop(){this.#dragged=
void 0;this.#draw(this.#range)}key(which,time){if(this.#whole){this.#set(keyedEnd(this.#range,this.#whole,
which,time,this.ruler.frame()))}}#draw(range){const ends=range??this.#whole;for(const element of this.
elements){element.hidden=!ends;element.dataset.set=String(range!==null)}if(!ends||!this.#whole)return;
const{at}=this.ruler;this.band.style.left=at(ends[0]);this.band.style.right=`calc(100% - ${at(ends[1])}\
)`;for(const[i,mark]of this.marks.entries()){mark.style.left=at(ends[i]);mark.ariaValueMin=this.#whole[0].
toFixed(2);mark.ariaValueMax=this.#whole[1].toFixed(2);mark.ariaValueNow=ends[i].toFixed(2);mark.ariaValueText=
seconds(ends[i])}}#mark(which){const name=which===0?"Start of the loop range":"End of the loop range";
const key=which===0?"Shift+Home":"Shift+End";const mark=make("button",{className:"glid-range-mark",role:"\
slider","aria-label":name,title:`${name}: drag it, or ${key} at the playhead; Delete plays all`});mark.
dataset.end=which===0?"start":"end";mark.addEventListener("pointerdown",e=>{if(e.button!==0)return;e.
preventDefault();e.stopPropagation();mark.focus({preventScroll:true});mark.setPointerCapture(e.pointerId);
this.#dragged=this.#range});mark.addEventListener("pointermove",e=>{if(this.#dragged!==void 0&&mark.
hasPointerCapture(e.pointerId))this.#drag(which,e)});mark.addEventListener("lostpointercapture",()=>this.#letGo());
mark.addEventListener("dblclick",()=>this.#set(null));mark.addEventListener("keydown",e=>this.#keydown(
e,which));return mark}#drag(which,e){if(!this.#whole)return;const{ruler}=this;const from=this.#range??
this.#whole;this.#dragged=withEnd(from,this.#whole,which,ruler.timeOf(e),ruler.frame());this.#draw(this.#dragged);
const[start,end]=this.#dragged??this.#whole;ruler.hover(this.#dragged?`Plays from ${seconds(start)} \
to ${seconds(end)}`:"Plays all")}#letGo(){const dragged=this.#dragged;if(dragged===void 0)return;this.#dragged=
void 0;this.ruler.hover("");const same=JSON.stringify(dragged)===JSON.stringify(this.#range);if(!same)
this.#set(dragged)}#set(range){this.#range=range;this.#draw(range);this.ruler.set(range)}#keydown(e,which){
if(e.ctrlKey||e.metaKey||e.altKey||e.shiftKey||!this.#whole)return;const step={ArrowLeft:-1,ArrowRight:1}[e.
key];const clears=e.key==="Delete"||e.key==="Backspace";if(!step&&!clears)return;e.preventDefault();
e.stopPropagation();const{ruler}=this;const from=this.#range??this.#whole;const time=from[which]+(step??
0)*ruler.frame();this.#set(clears?null:withEnd(from,this.#whole,which,time,ruler.frame()))}};var DOUBLE_CLICK=400;var SNAP=6;var STILL=4;var SLIM=8;var WIDE=60;var EASE2=34;var LEAST_FRAME=6;var Track=class{span=1;rate=25;diamonds=make(
"div",{className:"glid-diamonds","aria-hidden":true});keys=make("div",{className:"glid-keys"});eases=make(
"div",{className:"glid-eases"});head=make("div",{className:"glid-playhead"});ruler=make("div",{className:"\
glid-ruler",tabIndex:0,role:"slider","aria-label":"Time","aria-valuemin":0});#last={index:-1,at:0};#drag=null;#scrubbing=null;#shown=null;constructor(hand){
this.hand=hand;this.strip=make("div",{className:"glid-strip",role:"img",onpointerleave:()=>hand.hover(
"")});this.range=new RangeMarks({at:time=>this.#at(time),timeOf:e=>this.#timeNear(e,true),frame:()=>1/
this.rate,set:range=>hand.range(range),hover:text=>hand.hover(text)});const{elements}=this.range;const rows=[
this.ruler,this.diamonds,this.keys,this.eases,this.strip];const parts=[...rows,...elements,this.head];
this.element=make("div",{className:"glid-track"},...parts);this.zoom=new Zoom(this.element,()=>this.#label());
new ResizeObserver(()=>this.#label()).observe(this.ruler);this.element.addEventListener("pointerdown",
e=>this.#down(e));this.element.addEventListener("pointermove",e=>this.#scrub(e));this.element.addEventListener(
"lostpointercapture",e=>this.#up(e))}rename(index=this.#focused()){const key=this.#shown?.keyframes[index];
if(!key)return;const rename=name=>this.hand.rename(index,name);nameField(this.element,this.#at(key.time),
key.name,rename,()=>this.focus())}#focused(row=this.keys){const root=row.getRootNode();const active=root.
activeElement;return[...row.children].indexOf(active)}showRate(rate){this.rate=rate;this.#label()}focus(){
this.ruler.focus({preventScroll:true})}drop(){this.#drag=null;this.#scrubbing=null;this.range.drop();
this.hand.hover("");this.hand.dropped()}landing(index,time){const least=SLIM/this.#inside().width*this.
span;return landing(this.#shown?.keyframes??[],index,time,least)}showHead(place,seen){this.head.style.
left=this.#at(place);this.head.classList.toggle("glid-seen",seen);this.head.dataset.label=place.toFixed(
2);this.element.dataset.time=String(place);this.element.dataset.span=String(this.span);this.ruler.setAttribute(
"aria-valuenow",place.toFixed(2));this.ruler.setAttribute("aria-valuetext",seconds(place));if(seen&&
this.#scrubbing===null)this.zoom.reveal(this.head.offsetLeft)}showKeys(shown,thumbnails){this.#shown=
shown;if(this.#drag||this.#scrubbing!==null)return;const all=withReturn(shown);this.span=spanOf(all);
this.ruler.setAttribute("aria-valuemax",this.span.toFixed(2));const focused=this.#focused();showChildren(
this.keys,all.map(({name,time,thumbnail},i)=>{const title=`${name} at ${seconds(time)}`;const width=`${this.#wide(
roomAt(all,i,this.span))} - 2px`;const own=i<shown.keyframes.length;const picture=thumbnail===void 0?
void 0:thumbnails[thumbnail];return make("button",{className:own?"glid-key":"glid-key glid-return",title:`${title}\
; drag it to another time`,"aria-label":title,"aria-pressed":i===shown.active,style:`left: ${this.#at(
time)}; width: clamp(${SLIM}px, ${width}, ${WIDE}px)`,onpointerdown:e=>this.#grab(e,i,time),onclick:e=>{
if(!e.detail)this.hand.select(i%shown.keyframes.length)}},...picture?[make("img",{src:picture,alt:"",
draggable:false})]:[])}));const key=this.keys.children[focused];if(key instanceof HTMLElement)key.focus();
this.#showDiamonds(all);this.#showEases(all);const{time:end}=all[all.length-1];this.range.show(shown.
range,all.length>1?[all[0].time,end]:null)}#showDiamonds(all){showChildren(this.diamonds,all.map(({time},i)=>{
const{title,ariaPressed}=this.keys.children[i];const diamond=make("i",{title,style:`left: ${this.#at(
time)}`,onpointerdown:e=>this.#grab(e,i,time)});diamond.dataset.selected=ariaPressed??"false";return diamond}))}#showEases(all){
const focused=this.#focused(this.eases);showChildren(this.eases,all.slice(1).map(({name,time},i)=>{const start=all[i];
const title=`From ${start.name} to ${name}: ${nameOf(start.easing)}`;const button2=make("button",{className:"\
glid-segment-ease",title,"aria-label":title,"aria-haspopup":"dialog",innerHTML:`${stretchedCurve(start.
easing)}<span>${nameOf(start.easing)}</span>`,style:`left: ${this.#at(start.time)}; width: calc(${this.#wide(
time-start.time)})`,onpointerdown:e=>{e.stopPropagation();this.hand.easePressed()},onclick:()=>this.
hand.ease(i,button2)});button2.dataset.seconds=`${time-start.time}`;return button2}));this.#hideNarrow();
const button=this.eases.children[focused];if(button instanceof HTMLElement)button.focus()}#hideNarrow(){
const perSecond=Math.max(this.ruler.clientWidth-2*INSET,0)/this.span;for(const button of this.eases.
children){button.hidden=Number(button.dataset.seconds)*perSecond<WIDE+EASE2}}showSegments(segments,label){
this.strip.replaceChildren(...segments.flatMap(segment=>this.#pieces(segment)));this.strip.setAttribute(
"aria-label",label);this.#label()}#label(){const{ruler,span,rate}=this;const width=Math.max(ruler.clientWidth-
2*INSET,0);const labels=labelledTimes(span,width,this.zoom.factor).map(time=>{const frame2=frameAt(time,
rate);const number=frame2===null?[]:[make("b",{},`${frame2}`)];const second=make("small",{},`${Number(
time.toFixed(2))} s`);return make("span",{style:`left: ${this.#at(time)}`},...number,second)});const frame=width/
(span*rate);const ticks=make("i",{className:"glid-frames",hidden:frame<LEAST_FRAME});ticks.style.setProperty(
"--glid-frame",`${frame}px`);ruler.replaceChildren(ticks,...labels);this.#hideNarrow()}#pieces(segment){
const{end,status,until,pieces}=segment;const proved=pieces.map(piece=>{const height=heightOf(piece.sigma2);
return this.#piece(piece.start,piece.end,"proved",boundOf(piece),height)});if(status==="proved")return proved;
return[...proved,this.#piece(until,end,status,reasonOf(segment),1)]}#piece(start,end,kind,text,height){
const width=`calc(${this.#wide(end-start)})`;return make("div",{className:`glid-piece glid-${kind}`,
title:text,onpointerenter:()=>this.hand.hover(text),style:`left: ${this.#at(start)}; width: ${width}\
; --glid-height: ${height}`})}#wide(time){return`${time/this.span} * (100% - 2 * var(--glid-inset))`}#at(time){
return`calc(var(--glid-inset) + ${this.#wide(time)})`}#inside(){const{left,width}=this.element.getBoundingClientRect();
const length=getComputedStyle(this.element).getPropertyValue("--glid-inset");const inset=Number.parseFloat(
length)*scaleOf(this.element).across;return{left:left+inset,width:width-2*inset}}#grab(e,index,time){
if(e.button!==0)return;e.stopPropagation();const button=this.keys.children[index];this.#drag={index,
from:time,x:e.clientX,time:null};button.setPointerCapture(e.pointerId);button.focus({preventScroll:true});
button.onpointermove=move=>this.#dragged(move,button);button.onlostpointercapture=()=>this.#letGo()}#dragged(e,button){
const drag=this.#drag;if(!drag)return;const moved=e.clientX-drag.x;if(drag.time===null&&Math.abs(moved)<=
STILL)return;const time=drag.from+moved/this.#inside().width*this.span;drag.time=this.landing(drag.index,
time);const diamond=this.diamonds.children[drag.index];button.style.left=this.#at(drag.time);diamond.
style.left=this.#at(drag.time);this.head.style.left=this.#at(drag.time);this.hand.hover(`to ${seconds(
drag.time)}`)}#letGo(){if(!this.#drag)return;const{index,time}=this.#drag;this.drop();if(time!==null){
this.focus();this.hand.move(index,time)}else if(index<(this.#shown?.keyframes.length??0)){this.#clicked(
index)}}#clicked(index){const now=performance.now();const last=this.#last;this.#last={index,at:now};
if(last.index===index&&now-last.at<DOUBLE_CLICK)this.rename(index);else this.hand.select(index)}#down(e){
if(e.button!==0)return;this.#scrubbing=e.pointerId;this.element.setPointerCapture(e.pointerId);this.#scrub(
e)}#scrub(e){if(this.#scrubbing===e.pointerId)this.hand.scrub(this.#timeNear(e))}#timeNear(e,framed=false){
const{left,width}=this.#inside();const time=(e.clientX-left)/width*this.span;const near=SNAP/width*this.
span;const key=this.#shown?.keyframes.find(one=>Math.abs(one.time-time)<near);return key?.time??(framed?
Math.round(time*this.rate)/this.rate:time)}#up(e){if(this.#scrubbing!==e.pointerId)return;this.drop();
this.hand.scrubbed()}};var BADNESS={proved:0,computing:1,fails:2,refused:2};function worstOf([own,...others]){return own.spans.
map((span,i)=>{const all=[{name:own.name,span}];for(const{name,spans}of others){all.push({name,span:spans[i]??
untold(span)})}return worst(all)})}function untold(span){return{...span,status:"computing",reason:"",
until:span.start,sigma2:[]}}function worst(all){const until=Math.min(...all.map(({span})=>provedUntil(
span)));const bad=all.reduce((one,next)=>isWorse(next.span,one.span)?next:one);const{start,end,status,
reason}=bad.span;const part=status==="proved"?"":bad.name;return{start,end,status,reason,until,part,
pieces:piecesOf(all,until)}}function isWorse(span,other){const more=BADNESS[span.status]-BADNESS[other.
status];return more>0||more===0&&provedUntil(span)<provedUntil(other)}function provedUntil({status,end,
until}){return status==="proved"?end:until}function piecesOf(all,until){const knots=all.flatMap(({span})=>span.
times.slice(0,span.sigma2.length+1));const known=new Set([...knots.filter(time=>time<=until),until]);
const times=[...known].sort((a,b)=>a-b);return times.slice(1).flatMap((end,i)=>{const start=times[i];
const bounds=all.map(({name:name2,span})=>({name:name2,sigma2:boundAt(span,(start+end)/2)}));const{name,
sigma2}=bounds.reduce((a,b)=>b.sigma2<a.sigma2?b:a);return sigma2>0?[{start,end,sigma2,part:name}]:[]})}
function boundAt({times,sigma2},time){const piece=times.findIndex((knot,i)=>knot<=time&&time<=times[i+
1]);return sigma2[piece]??0}var NUDGE=.1;var Timeline=class{note=make("div",{className:"glid-timeline-note",role:"status"});stage=null;#layers=null;#otherLayers={};#easeBefore=-1;#goal=null;#played=false;#hovered="";#playing={
release:()=>this.release(),pause:()=>{this.player.pause();this.#goal=this.player.place;return this.player.
place},reach:()=>{const{keyframes,active}=this.shown;if(keyAt(keyframes,this.player.place)===active)
this.release()}};constructor({model,el,signal}){this.model=model;this.root=make("div",{className:"gl\
id-skin glid-timeline",role:"group","aria-label":"Timeline"});this.root.dataset.lmSuppressShortcuts=
"true";this.link=new Link(model,this.root,signal,()=>this.tell());this.player=new Player((...shown)=>this.#show(
...shown),()=>this.showHead(),()=>this.#selectHere());this.bar=new Bar({play:()=>this.play(),keep:()=>this.
keep(),act:(type,content)=>void this.act(type,content),edit:(type,content)=>void this.edit(type,content),
zoom:by=>this.track.zoom.zoom(by),ease:()=>this.#ease()});this.bar.ease.addEventListener("pointerdow\
n",()=>this.#easePressed());this.ease=new EaseEditor((index,easing)=>void this.act("set_easing",{index,
easing}),index=>this.#easeClosed(index));this.track=new Track({scrub:time=>this.#scrub(time),scrubbed:()=>this.#selectHere(),
select:index=>this.select(index),move:(index,time)=>void this.act("move_pose",{index,time}),rename:(index,name)=>void this.
act("rename_pose",{index,name}),range:range=>void this.act("set_loop_range",{range}),ease:(index,button)=>this.#openEase(
index,button),easePressed:()=>this.#easePressed(),hover:text=>{this.#hovered=text;this.tell()},dropped:()=>{
this.showKeys();this.showHead()}});const parts=[this.bar.element,this.note,legend(),this.track.zoom.
box];this.root.append(make("div",{className:"glid-timeline-parts"},...parts),this.ease.element);this.
root.addEventListener("keydown",e=>this.#keydown(e));this.root.addEventListener("keyup",e=>{if(e.key===
" "&&!this.#typing(e))e.preventDefault()});this.bar.element.addEventListener("click",e=>{const target=e.
target;if(e.detail&&target.closest("button"))this.track.focus()});el.classList.add("glid-host");el.append(
this.root)}get shown(){return this.model.get("shown")}get spans(){return this.model.get("motion").spans}get segments(){
const others=this.model.get("part_motions");return worstOf([{name:this.shown.part??"",spans:this.spans},
...others])}get active(){return this.shown.keyframes[this.shown.active]}act(type,content={}){return this.
link.put({type,...content})}edit(type,content={}){return this.act(type,{index:this.shown.active,...content})}release=()=>{
this.#goal=null;this.player.release(this.active.time)};edited(){if(this.player.seen)this.player.release(
this.#goal??this.active.time)}select(index){if(index===this.shown.active)this.release();else this.#go(
"go_to_pose",{index},this.shown.keyframes[index].time)}async#go(type,content,time){this.#goal=time;await this.
act(type,content);if(this.#goal===time)this.#goal=null}tell(){const{note}=this;const{text,kind}=this.#told();
note.ariaLive=kind==="state"||kind==="hover"?"off":"polite";if(note.textContent!==text)note.textContent=
text;note.title=text;note.dataset.kind=kind;note.dataset.tone=kind==="bad"?"bad":""}#told(){const{refusal}=this.
link;if(refusal)return{text:refusal,kind:"bad"};if(this.#hovered)return{text:this.#hovered,kind:"hov\
er"};return noteOn(this.shown,this.segments)}showHead(){const{keyframes}=this.shown;if(!keyframes)return;
const{place,seen,playing}=this.player;const end=this.spans.at(-1)?.end??keyframes[keyframes.length-1].
time;this.track.showHead(place,seen);this.bar.showTime(place,end,playing);this.#tellElsewhere(seen&&
place!==this.active.time)}#tellElsewhere(elsewhere){const now=elsewhere?this.active.name:"";if((this.
root.dataset.elsewhere??"")===now)return;const editor=this.root.closest(".glid-editor");if(elsewhere){
this.root.dataset.elsewhere=now;editor?.style.setProperty("--glid-edited",JSON.stringify(`${now}:`))}else{
delete this.root.dataset.elsewhere;editor?.style.removeProperty("--glid-edited")}}showRate(){this.track.
showRate(this.model.get("rate"))}showKeys(){this.track.showKeys(this.shown,this.model.get("thumbnail\
s"));const segment=this.#segment(this.ease.index);if(segment)this.ease.show(segment.title,segment.easing);else
this.ease.close()}showState(){const{keyframes,active}=this.shown;const now=`${active}/${keyframes.length}`;
const moved=this.root.dataset.active!==now;this.root.dataset.active=now;this.bar.update(this.shown);
this.showKeys();this.showMotion();if(moved)this.release();else if(!this.player.seen&&!this.player.playing){
this.player.release(this.#goal??this.active.time)}}showMotion(){const{player,shown,spans}=this;player.
only=shown.keyframes?.[0].time??0;player.range=shown.range??null;player.set(intervalsOf(spans),shown.
repeat,this.#others);const computing=spans.some(({status})=>status==="computing");if(shown.kernel&&!player.
playing&&player.seen&&computing)this.release();this.tell();this.track.showSegments(this.segments,noteOn(
shown,this.segments).text);this.showHead()}get#others(){const motions=this.model.get("part_motions");
return Object.fromEntries(motions.map(({key,spans})=>[key,intervalsOf(spans)]))}showOthers(){const layers=this.
model.get("part_motions").map(one=>[one.key,layersOf(one.heights)]);this.#otherLayers=Object.fromEntries(
layers);this.showMotion()}showPins(){this.player.renew()}showHeights(){this.#layers=layersOf(this.model.
get("heights"))}#show(floats,time,others={},at=void 0){const{stage}=this;if(!stage)return;const moving=time!==
void 0;const heights=moving?this.#layers?.at(time)??null:null;const parts=Object.entries(others).map(
([key,theirs])=>{return[key,{floats:theirs,heights:this.#otherLayers[key]?.at(time??0)??null}]});const seen=moving?
floats??true:null;const pins=at===void 0?null:this.#pinsAt(at);stage.trigger("glid:motion",seen,this.#playing,
heights,Object.fromEntries(parts),pins);if(this.shown.kernel)return this.act("frame",{time:time??null,
replaces:"frame"})}#pinsAt(at){const{player,model}=this;if(player.playing)return null;const pins=model.
get("pins");return player.later===null?pinsAt(pins,at):pinsLater(pins)}play(){this.player.play();if(!this.
player.playing||this.#played)return;this.#played=true;void this.act("played")}keep(){const{player}=this;
if(player.seen)this.#go("keep",{time:player.place},player.place);else this.act("keep",{time:this.active.
time})}#segment(index){const[start,end]=withReturn(this.shown).slice(index,index+2);return index>=0&&
end?{title:`${start.name} → ${end.name}`,easing:start.easing}:null}#ease(){const{active,keyframes}=this.
shown;const last=withReturn(this.shown).length-2;const{bar,track}=this;const index=Math.min(active,last);
const own=track.eases.children[index];if(keyframes.length>1)this.#openEase(index,own&&!own.hidden?own:
bar.ease)}#easePressed(){this.#easeBefore=this.ease.index}#openEase(index,at){const segment=this.#segment(
index);if(segment&&this.#easeBefore!==index){this.ease.open(index,segment.title,segment.easing,at)}this.#easeBefore=
-1}#easeClosed(index){const{activeElement}=document;const lost=!activeElement||activeElement===document.
body;if(!lost&&!this.ease.element.contains(activeElement))return;const button=this.track.eases.children[index];
if(button instanceof HTMLElement&&!button.hidden)button.focus({preventScroll:true});else this.track.
focus()}#scrub(time){this.player.scrub(Math.min(time,this.track.span))}#selectHere(){const index=keyAt(
this.shown.keyframes,this.player.place);if(index>=0)this.select(index)}#typing(e){return this.bar.element.
contains(e.target)}#keydown(e){const history=undoOrRedo(e);if(!history&&(e.ctrlKey||e.metaKey))return;
e.stopPropagation();const does=this.#typing(e)?null:this.#keyDoes(e);if(!history&&!does)return;e.preventDefault();
if(history)this.act(history);else does?.()}#rangeEnd(which){const{player}=this;this.track.range.key(
which,player.seen?player.place:this.active.time)}#keyDoes(e){const{keyframes}=this.shown;switch(e.key){case"\
 ":return()=>void(e.repeat||this.play());case"ArrowLeft":return()=>this.#step(e,-1);case"ArrowRight":
return()=>this.#step(e,1);case"Enter":return e.target===this.track.ruler?()=>this.#ease():null;case"\
F2":return()=>this.track.rename();case"Delete":case"Backspace":return()=>void this.edit("delete_pose");case"\
Home":return()=>e.shiftKey?this.#rangeEnd(0):this.select(0);case"End":return()=>e.shiftKey?this.#rangeEnd(
1):this.select(keyframes.length-1);case"Escape":return()=>{this.track.drop();this.release()};default:
return null}}#step(e,sign){const{player,track}=this;const{keyframes,active}=this.shown;if(e.altKey){
const time=track.landing(active,this.active.time+sign*NUDGE);this.edit("move_pose",{time})}else if(e.
shiftKey){this.select(nextKey(keyframes,player.place,sign)??active)}else{this.#scrub(player.place+sign/
track.rate)}}};function intervalsOf(spans){return spans.map(span=>({...span,floats:toFloats(span.floats)}))}
function layersOf({times,floats}){return times.length?new Motion({times,repeat:"once"},toFloats(floats)):
null}function render(context){const{model,el,signal}=context;const timeline=new Timeline(context);const{player}=timeline;
const tapped=e=>{const target=e.target;if(target.closest(".glid-editor")===el.closest(".glid-editor"))
timeline.play()};window.addEventListener("glid:play",tapped,{signal});const keyed=e=>{const target=e.
target;if(target.closest(".glid-editor")===el.closest(".glid-editor"))timeline.keep()};window.addEventListener(
"glid:key",keyed,{signal});follow(model,{"change:shown":()=>timeline.showState(),"change:rate":()=>timeline.
showRate(),"change:motion":()=>timeline.showMotion(),"change:heights":()=>timeline.showHeights(),"ch\
ange:part_motions":()=>timeline.showOthers(),"change:pins":()=>timeline.showPins(),"change:thumbnail\
s":()=>timeline.showKeys()});const edited=()=>timeline.edited();findStage(context,timeline).then(()=>timeline.
stage?.on("change:coefficients",edited));return()=>{player.pause();timeline.stage?.off("change:coeff\
icients",edited)}}async function findStage({model,signal},timeline){const found=await model.widget_manager.
get_model(model.get("stage"));if(!signal.aborted)timeline.stage=found}var main_default={render};export{main_default as default};
