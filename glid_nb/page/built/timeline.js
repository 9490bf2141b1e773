function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}function toFloats(view){if(!view)return new Float32Array;return new Float32Array(view.buffer.slice(view.
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
2)} s`}function noteOn({keyframes,recording,kernel},spans){const bad=spans.find(({reason})=>reason);
const note=state(keyframes.length,recording,bad?.reason,spans);return kernel&&spans.length&&!bad?KERNEL+
note:note}function state(count,recording,reason,spans){if(recording)return"Recording: drag a pin; it\
s movement becomes keyframes.";if(reason)return reason;if(spans.some(({status})=>status==="computing"))
return"Proving the motion between poses…";const last=spans.at(-1);if(!last)return count<2?"Key (K)\
 a second pose to see the motion between them.":"";const least=Math.min(...spans.flatMap(({sigma2})=>sigma2));
const lasts=seconds(last.end-spans[0].start);return`Proved at every instant of ${lasts}: σ₂ ≥ ${least.
toFixed(3)}.`}function scaleOf(element){const{width,height}=element.getBoundingClientRect();const across=width/element.
offsetWidth||1;return{across,down:height/element.offsetHeight||across}}var WHEEL_LINE=33;var LINES=1;function turnOf(e){return e.deltaMode===LINES?e.deltaY*WHEEL_LINE:e.deltaY}var INSET=34;var STEP=1.5;var MOST=40;var WHEEL_SPEED=.004;var LEADS=.25;function scrolledTo(share,at,width){
return Math.max(INSET+share*(width-2*INSET)-at,0)}var Zoom=class{factor=1;constructor(track,changed){
this.track=track;this.changed=changed;this.box=make("div",{className:"glid-track-view"},track);this.
box.addEventListener("wheel",e=>this.#wheel(e),{passive:false})}zoom(by,at=this.box.clientWidth/2){const{
box,track}=this;const share=(box.scrollLeft+at-INSET)/(track.offsetWidth-2*INSET);this.factor=Math.min(
Math.max(this.factor*by,1),MOST);track.style.width=`${100*this.factor}%`;box.scrollLeft=scrolledTo(share,
at,track.offsetWidth);this.changed()}reveal(at){const{box}=this;if(this.factor===1)return;const seen=at>=
box.scrollLeft&&at<=box.scrollLeft+box.clientWidth;if(!seen)box.scrollLeft=at-LEADS*box.clientWidth}#wheel(e){
const{box}=this;const step=turnOf(e);if(e.ctrlKey||e.metaKey){e.preventDefault();const at=(e.clientX-
box.getBoundingClientRect().left)/scaleOf(box).across;this.zoom(Math.exp(-step*WHEEL_SPEED),at);return}
const before=box.scrollLeft;if(!e.deltaX)box.scrollLeft+=step;if(box.scrollLeft!==before)e.preventDefault()}};var REPEATS=[["once","Once"],["loop","Loop"],["ping-pong","Ping-pong"]];var ONION="Onion skin: outli\
nes of the poses before (blue) and after (orange) the edited pose";var KEY="Key this pose and contin\
ue with a copy (K); at another time, key the shape that is shown there";var LEGEND=[["proved","prove\
d"],["computing","not yet"],["refused","not proved"]];var Bar=class{recording=false;onionOn=false;constructor({
play,keep,act,edit,zoom}){this.play=iconButton("play","Play, pause (Space)",play);this.repeat=menu("\
Play once, in a loop, or there and back",REPEATS,repeat=>act("set_repeat",{repeat}));this.clock=make(
"span",{className:"glid-time",role:"timer"});this.record=iconButton("record","Record: keep the next \
drag as keyframes",()=>act("record",{on:!this.recording}));this.onion=iconButton("onion",ONION,()=>act(
"onion",{on:!this.onionOn}));this.keep=make("button",{className:"glid-keep",title:KEY,onclick:keep},
"Key");const copy=iconButton("copy","Duplicate this pose",()=>edit("duplicate_pose"));this.remove=iconButton(
"trash","Delete this pose (Delete)",()=>edit("delete_pose"));this.save=iconButton("export","Export t\
he motion",()=>{this.save.dispatchEvent(new CustomEvent("glid:inspect",{bubbles:true}));act("export")});
this.element=make("div",{className:"glid-bar",role:"toolbar","aria-label":"Motion"},...[this.play,this.
repeat,this.clock,gap()],...[this.record,this.onion,gap()],...[this.keep,copy,this.remove,gap(),this.
save],make("span",{className:"glid-zoom"},gap(),iconButton("minus","See more of the timeline (Ctrl a\
nd wheel)",()=>zoom(1/STEP)),iconButton("plus","See less of the timeline, larger (Ctrl and wheel)",()=>zoom(
STEP))))}update({keyframes,repeat,recording,onion,exports}){const alone=keyframes.length<2;this.repeat.
value=repeat;this.remove.disabled=alone;for(const control of[this.play,this.save,this.repeat]){control.
disabled=alone}this.save.hidden=!exports;this.recording=recording;this.onionOn=onion;this.record.ariaPressed=
String(recording);this.onion.ariaPressed=String(onion)}showTime(place,end,playing){const does=playing?
"pause":"play";if(this.play.dataset.does!==does)this.play.innerHTML=icon(does);this.play.dataset.does=
does;this.clock.textContent=`${place.toFixed(2)} / ${seconds(end)}`}};function legend(){const parts=LEGEND.
map(([kind,label])=>{return make("span",{},make("i",{className:"glid-swatch","data-kind":kind}),label)});
return make("div",{className:"glid-proof-legend","aria-hidden":true},...parts)}function gap(){return make(
"span",{className:"glid-gap"})}function menu(label,choices,act){const options=choices.map(([value,text])=>new Option(
text,value));const select=make("select",{"aria-label":label,title:label},...options);select.addEventListener(
"change",()=>act(select.value));return select}var Player=class{clock=null;time=0;seen=false;only=0;later=null;#intervals=[];#frame=0;constructor(show,moved,ended=()=>{}){
this.show=show;this.moved=moved;this.ended=ended}set(intervals,repeat){this.#intervals=intervals.map(
({end,times:times2,floats})=>({end,motion:floats.length?new Motion({times:times2,repeat:"once"},floats):
null}));const first=intervals[0];const last=intervals.at(-1);const times=first&&last?[first.start,last.
end]:null;this.clock=times&&new Motion({times,repeat},new Float32Array(0));if(this.seen&&!this.playing){
if(this.later===null)this.#seek(this.time);else this.scrub(this.later)}}get playing(){return this.#frame!==
0}get place(){if(this.later!==null)return this.later;const last=this.clock?.last??Infinity;return this.
time>last?2*last-this.time:this.time}scrub(time){this.pause();const{clock}=this;const last=clock?.last??
this.only;if(time>last&&clock?.repeat!=="loop")this.#wait(time);else if(clock)this.#seek(Math.min(Math.
max(time,clock.start),last));else this.release(last)}play(){const{clock}=this;if(this.playing||!clock){
this.pause();return}this.later=null;const once=clock.repeat==="once";if(once&&this.time>=clock.end)this.
time=clock.start;let last=null;const step=async now=>{const time=this.time+(last===null?0:(now-last)/
1e3);last=now;await this.#seek(time);if(!this.playing)return;if(once&&time>=clock.end){this.pause();
this.ended()}else this.#frame=requestAnimationFrame(step)};this.#frame=requestAnimationFrame(step);this.
moved()}pause(){cancelAnimationFrame(this.#frame);this.#frame=0;this.moved()}release(time){this.pause();
this.time=time;this.later=null;if(this.seen){this.seen=false;this.show(null)}this.moved()}#wait(time){
this.later=time;this.time=this.clock?.last??this.only;this.seen=true;this.show(this.#intervals.at(-1)?.
motion?.at(this.time)??null,time);this.moved()}#seek(time){const{clock}=this;if(!clock){this.release(
0);return}this.later=null;this.time=time===clock.end?time:clock.within(time);this.seen=true;const{place}=this;
const interval=this.#intervals.find(({end})=>place<=end)??this.#intervals.at(-1);const shown=this.show(
interval?.motion?.at(place)??null,place);this.moved();return shown}};var LATER=.15;var LEAST=1.15;var MOST_LABELS=12;var LABEL=38;var STEPS=[.02,.04,.1,.2,.5,1,2,5,10,30,
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
track.append(field);field.focus();field.select()}var DOUBLE_CLICK=400;var SNAP=6;var STILL=4;var SLIM=8;var WIDE=60;var LEAST_FRAME=6;var Track=class{span=1;rate=25;keys=make(
"div",{className:"glid-keys"});head=make("div",{className:"glid-playhead"});ruler=make("div",{className:"\
glid-ruler",tabIndex:0,role:"slider","aria-label":"Time","aria-valuemin":0});#last={index:-1,at:0};#drag=null;#scrubbing=null;#shown=null;constructor(hand){
this.hand=hand;this.strip=make("div",{className:"glid-strip",role:"img",onpointerleave:()=>hand.hover(
"")});const parts=[this.ruler,this.keys,this.strip,this.head];this.element=make("div",{className:"gl\
id-track"},...parts);this.zoom=new Zoom(this.element,()=>this.#label());new ResizeObserver(()=>this.#label()).
observe(this.ruler);this.element.addEventListener("pointerdown",e=>this.#down(e));this.element.addEventListener(
"pointermove",e=>this.#scrub(e));this.element.addEventListener("lostpointercapture",e=>this.#up(e))}rename(index=this.#focused()){
const key=this.#shown?.keyframes[index];if(!key)return;const rename=name=>this.hand.rename(index,name);
nameField(this.element,this.#at(key.time),key.name,rename,()=>this.focus())}#focused(){const root=this.
keys.getRootNode();const active=root.activeElement;return[...this.keys.children].indexOf(active)}showRate(rate){
this.rate=rate;this.#label()}focus(){this.ruler.focus({preventScroll:true})}drop(){this.#drag=null;this.#scrubbing=
null;this.hand.hover("");this.hand.dropped()}landing(index,time){const least=SLIM/this.#inside().width*
this.span;return landing(this.#shown?.keyframes??[],index,time,least)}showHead(place,seen){this.head.
style.left=this.#at(place);this.head.classList.toggle("glid-seen",seen);this.head.dataset.label=place.
toFixed(2);this.element.dataset.time=String(place);this.element.dataset.span=String(this.span);this.
ruler.setAttribute("aria-valuenow",place.toFixed(2));this.ruler.setAttribute("aria-valuetext",seconds(
place));if(seen&&this.#scrubbing===null)this.zoom.reveal(this.head.offsetLeft)}showKeys(shown,thumbnails){
this.#shown=shown;if(this.#drag||this.#scrubbing!==null)return;const all=withReturn(shown);this.span=
spanOf(all);this.ruler.setAttribute("aria-valuemax",this.span.toFixed(2));const focused=this.#focused();
this.keys.replaceChildren(...all.map(({name,time,thumbnail},i)=>{const title=`${name} at ${seconds(time)}`;
const width=`${this.#wide(roomAt(all,i,this.span))} - 2px`;const own=i<shown.keyframes.length;const picture=thumbnail===
void 0?void 0:thumbnails[thumbnail];return make("button",{className:own?"glid-key":"glid-key glid-re\
turn",title:`${title}; drag it to another time`,"aria-label":title,"aria-pressed":i===shown.active,style:`\
left: ${this.#at(time)}; width: clamp(${SLIM}px, ${width}, ${WIDE}px)`,onpointerdown:e=>this.#grab(e,
i,time),onclick:e=>{if(!e.detail)this.hand.select(i%shown.keyframes.length)}},...picture?[make("img",
{src:picture,alt:"",draggable:false})]:[])}));const key=this.keys.children[focused];if(key instanceof
HTMLElement)key.focus()}showSpans(spans,label){this.strip.replaceChildren(...spans.flatMap(span=>this.#pieces(
span)));this.strip.setAttribute("aria-label",label);this.#label()}#label(){const{ruler,span,rate}=this;
const width=Math.max(ruler.clientWidth-2*INSET,0);const labels=labelledTimes(span,width,this.zoom.factor).
map(time=>{const frame2=frameAt(time,rate);const number=frame2===null?[]:[make("small",{},`${frame2}`)];
const text=`${Number(time.toFixed(2))}`;return make("span",{style:`left: ${this.#at(time)}`},text,...number)});
const frame=width/(span*rate);const ticks=make("i",{className:"glid-frames",hidden:frame<LEAST_FRAME});
ticks.style.setProperty("--glid-frame",`${frame}px`);ruler.replaceChildren(ticks,...labels)}#pieces({
start,end,status,reason,times,sigma2}){const proved=sigma2.map((bound,i)=>{const when=`from ${seconds(
times[i])} to ${seconds(times[i+1])}`;const height=heightOf(bound);const text2=`σ₂ ≥ ${bound.toFixed(
3)} ${when}`;return this.#piece(times[i],times[i+1],"proved",text2,height)});if(status==="proved")return proved;
const from=status==="fails"?times.at(-1)??start:start;const text=reason||`Not proved yet from ${seconds(
start)} to ${seconds(end)}`;return[...proved,this.#piece(from,end,status,text,1)]}#piece(start,end,kind,text,height){
const width=`calc(${this.#wide(end-start)})`;return make("div",{className:`glid-piece glid-${kind}`,
title:text,onpointerenter:()=>this.hand.hover(text),style:`left: ${this.#at(start)}; width: ${width}\
; --glid-height: ${height}`})}#wide(time){return`${time/this.span} * (100% - 2 * var(--glid-inset))`}#at(time){
return`calc(var(--glid-inset) + ${this.#wide(time)})`}#inside(){const{left,width}=this.element.getBoundingClientRect();
const length=getComputedStyle(this.element).getPropertyValue("--glid-inset");const inset=Number.parseFloat(
length)*scaleOf(this.element).across;return{left:left+inset,width:width-2*inset}}#grab(e,index,time){
if(e.button!==0)return;e.stopPropagation();const button=e.currentTarget;this.#drag={index,from:time,
x:e.clientX,time:null};button.setPointerCapture(e.pointerId);button.focus({preventScroll:true});button.
onpointermove=move=>this.#dragged(move,button);button.onlostpointercapture=()=>this.#letGo()}#dragged(e,button){
const drag=this.#drag;if(!drag)return;const moved=e.clientX-drag.x;if(drag.time===null&&Math.abs(moved)<=
STILL)return;const time=drag.from+moved/this.#inside().width*this.span;drag.time=this.landing(drag.index,
time);button.style.left=this.#at(drag.time);this.head.style.left=this.#at(drag.time);this.hand.hover(
`to ${seconds(drag.time)}`)}#letGo(){if(!this.#drag)return;const{index,time}=this.#drag;this.drop();
if(time!==null){this.focus();this.hand.move(index,time)}else if(index<(this.#shown?.keyframes.length??
0)){this.#clicked(index)}}#clicked(index){const now=performance.now();const last=this.#last;this.#last=
{index,at:now};if(last.index===index&&now-last.at<DOUBLE_CLICK)this.rename(index);else this.hand.select(
index)}#down(e){if(e.button!==0)return;this.#scrubbing=e.pointerId;this.element.setPointerCapture(e.
pointerId);this.#scrub(e)}#scrub(e){if(this.#scrubbing!==e.pointerId)return;const{left,width}=this.#inside();
const time=(e.clientX-left)/width*this.span;const near=SNAP/width*this.span;const key=this.#shown?.keyframes.
find(one=>Math.abs(one.time-time)<near);this.hand.scrub(key?.time??time)}#up(e){if(this.#scrubbing!==
e.pointerId)return;this.drop();this.hand.scrubbed()}};var NUDGE=.1;var Timeline=class{note=make("div",{className:"glid-timeline-note",role:"status","aria-\
live":"polite"});stage=null;#layers=null;#played=false;#hovered="";#playing={release:()=>this.release(),
pause:()=>{this.player.pause();return this.player.place}};constructor({model,el,signal}){this.model=
model;this.root=make("div",{className:"glid-skin glid-timeline",role:"group","aria-label":"Timeline"});
this.root.dataset.lmSuppressShortcuts="true";this.link=new Link(model,this.root,signal,()=>this.tell());
this.player=new Player((floats,time)=>this.#show(floats,time),()=>this.showHead(),()=>this.#selectHere());
this.bar=new Bar({play:()=>this.play(),keep:()=>this.keep(),act:(type,content)=>void this.act(type,content),
edit:(type,content)=>void this.edit(type,content),zoom:by=>this.track.zoom.zoom(by)});this.track=new Track(
{scrub:time=>this.#scrub(time),scrubbed:()=>this.#selectHere(),select:index=>this.select(index),move:(index,time)=>void this.
act("move_pose",{index,time}),rename:(index,name)=>void this.act("rename_pose",{index,name}),hover:text=>{
this.#hovered=text;this.tell()},dropped:()=>{this.showKeys();this.showHead()}});const parts=[this.bar.
element,this.note,legend(),this.track.zoom.box];this.root.append(make("div",{className:"glid-timelin\
e-parts"},...parts));this.root.addEventListener("keydown",e=>this.#keydown(e));this.root.addEventListener(
"keyup",e=>{if(e.key===" "&&!this.#typing(e))e.preventDefault()});this.bar.element.addEventListener(
"click",e=>{const target=e.target;if(e.detail&&target.closest("button"))this.track.focus()});el.classList.
add("glid-host");el.append(this.root)}get shown(){return this.model.get("shown")}get spans(){return this.
model.get("motion").spans}get active(){return this.shown.keyframes[this.shown.active]}act(type,content={}){
return this.link.put({type,...content})}edit(type,content={}){return this.act(type,{index:this.shown.
active,...content})}release=()=>{this.player.release(this.active.time)};select(index){if(index===this.
shown.active)this.release();else this.act("go_to_pose",{index})}tell(){const{refusal}=this.link;const bad=this.
spans.some(({reason})=>reason);const text=refusal||this.#hovered||noteOn(this.shown,this.spans);this.
note.textContent=text;this.note.title=text;this.note.dataset.tone=refusal||bad&&!this.#hovered?"bad":
""}showHead(){const{keyframes}=this.shown;if(!keyframes)return;const{place,seen,playing}=this.player;
const end=this.spans.at(-1)?.end??keyframes[keyframes.length-1].time;this.track.showHead(place,seen);
this.bar.showTime(place,end,playing)}showRate(){this.track.showRate(this.model.get("rate"))}showKeys(){
this.track.showKeys(this.shown,this.model.get("thumbnails"))}showState(){const{keyframes,active}=this.
shown;const now=`${active}/${keyframes.length}`;const moved=this.root.dataset.active!==now;this.root.
dataset.active=now;this.bar.update(this.shown);this.showKeys();this.showMotion();if(moved||!this.player.
seen)this.release()}showMotion(){const{player,shown,spans}=this;player.only=shown.keyframes?.[0].time??
0;const intervals=spans.map(span=>({...span,floats:toFloats(span.floats)}));player.set(intervals,shown.
repeat);const computing=spans.some(({status})=>status==="computing");if(shown.kernel&&!player.playing&&
player.seen&&computing)this.release();this.tell();this.track.showSpans(spans,this.note.textContent??
"");this.showHead()}showHeights(){const{times,floats}=this.model.get("heights");this.#layers=times.length?
new Motion({times,repeat:"once"},toFloats(floats)):null}#show(floats,time){const{stage}=this;if(!stage)
return;const moving=time!==void 0;const heights=moving?this.#layers?.at(time)??null:null;stage.trigger(
"glid:motion",moving?floats??true:null,this.#playing,heights);if(this.shown.kernel)return this.act("\
frame",{time:time??null,replaces:"frame"})}play(){this.player.play();if(!this.player.playing||this.#played)
return;this.#played=true;void this.act("played")}keep(){const{player}=this;this.act("keep",{time:player.
seen?player.place:this.active.time})}#scrub(time){this.player.scrub(Math.min(time,this.track.span))}#selectHere(){
const index=keyAt(this.shown.keyframes,this.player.place);if(index>=0)this.select(index)}#typing(e){
return this.bar.element.contains(e.target)}#keydown(e){const history=undoOrRedo(e);if(!history&&(e.ctrlKey||
e.metaKey))return;e.stopPropagation();const does=this.#typing(e)?null:this.#keyDoes(e);if(!history&&
!does)return;e.preventDefault();if(history)this.act(history);else does?.()}#keyDoes(e){const{keyframes}=this.
shown;switch(e.key){case" ":return()=>void(e.repeat||this.play());case"ArrowLeft":return()=>this.#step(
e,-1);case"ArrowRight":return()=>this.#step(e,1);case"F2":return()=>this.track.rename();case"Delete":case"\
Backspace":return()=>void this.edit("delete_pose");case"Home":return()=>this.select(0);case"End":return()=>this.
select(keyframes.length-1);case"Escape":return()=>{this.track.drop();this.release()};default:return null}}#step(e,sign){
const{player,track}=this;const{keyframes,active}=this.shown;if(e.altKey){const time=track.landing(active,
this.active.time+sign*NUDGE);this.edit("move_pose",{time})}else if(e.shiftKey){this.select(nextKey(keyframes,
player.place,sign)??active)}else{this.#scrub(player.place+sign/track.rate)}}};function render(context){const{model,el,signal}=context;const timeline=new Timeline(context);const{player}=timeline;
const tapped=e=>{const target=e.target;if(target.closest(".glid-editor")===el.closest(".glid-editor"))
timeline.play()};window.addEventListener("glid:play",tapped,{signal});const keyed=e=>{const target=e.
target;if(target.closest(".glid-editor")===el.closest(".glid-editor"))timeline.keep()};window.addEventListener(
"glid:key",keyed,{signal});follow(model,{"change:shown":()=>timeline.showState(),"change:rate":()=>timeline.
showRate(),"change:motion":()=>timeline.showMotion(),"change:heights":()=>timeline.showHeights(),"ch\
ange:thumbnails":()=>timeline.showKeys()});const edited=()=>{if(player.seen)timeline.release()};findStage(
context,timeline).then(()=>timeline.stage?.on("change:coefficients",edited));return()=>{player.pause();
timeline.stage?.off("change:coefficients",edited)}}async function findStage({model,signal},timeline){
const found=await model.widget_manager.get_model(model.get("stage"));if(!signal.aborted)timeline.stage=
found}var main_default={render};export{main_default as default};
