"use strict";(()=>{var STRIPES=100;var LEAST_HEIGHT=.06;var UNPROVED="#7f7f7f";function heightOf(bound){return Math.min(
Math.max(bound,LEAST_HEIGHT),1)}function proofStrip(motion,boundAt){const layers=Array.from({length:STRIPES},
(_,i)=>{const bound=boundAt(motion.start+(i+.5)/STRIPES*(motion.end-motion.start));const[fill,height]=bound<
0?[UNPROVED,1]:["var(--accent)",heightOf(bound)];const left=100*i/(STRIPES-1);return`linear-gradient\
(${fill} 0 0) ${left}% 100%/1% ${100*height}% no-repeat`});return layers.join()}function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}function penOf(canvas){const pen=canvas.getContext("2d");if(!pen)throw new Error("this browser does \
not draw on canvases");return pen}var WHEEL_SPEED=.0015;var WHEEL_LINE=33;var LINES=1;var PINCH=5;function distance([x,y],[u,v]){return Math.
hypot(x-u,y-v)}var View=class{x=0;y=0;unit=1;width=0;height=0;constructor(changed,{up:up2=1,nearest,
farthest}){this.changed=changed;this.up=up2;this.nearest=nearest;this.farthest=farthest}toWorld([px,
py]){const x=this.x+(px-this.width/2)*this.unit;const y=this.y-this.up*(py-this.height/2)*this.unit;
return[x,y]}toScreen([x,y]){const px=(x-this.x)/this.unit+this.width/2;const py=this.up*(this.y-y)/this.
unit+this.height/2;return[px,py]}line(points){return points.map(point=>this.toScreen(point))}centreOn([
x,y]){this.x=x;this.y=y;this.changed()}pan(dx,dy){this.x-=dx*this.unit;this.y+=this.up*dy*this.unit;
this.changed()}zoom(factor,place=[this.width/2,this.height/2]){const[x,y]=this.toWorld(place);const unit=Math.
min(this.farthest,Math.max(this.nearest,this.unit*factor));this.x=x+(this.x-x)*(unit/this.unit);this.
y=y+(this.y-y)*(unit/this.unit);this.unit=unit;this.changed()}wheel(e,place){e.preventDefault();this.
zoom(Math.exp(turnOf(e)*WHEEL_SPEED*(e.ctrlKey?PINCH:1)),place)}follow(pointers,id,place){const before=pointers.
get(id)??place;const other=[...pointers].find(([one])=>one!==id)?.[1];const share=other?.5:1;pointers.
set(id,place);this.pan(share*(place[0]-before[0]),share*(place[1]-before[1]));if(!other)return;const apart=one=>Math.
max(distance(one,other),1);const middle=[(place[0]+other[0])/2,(place[1]+other[1])/2];this.zoom(apart(
before)/apart(place),middle)}};function turnOf(e){return e.deltaMode===LINES?e.deltaY*WHEEL_LINE:e.deltaY}function around(boxes){const all=side=>boxes.map(box=>box[side]);return[Math.min(...all(0)),Math.min(
...all(1)),Math.max(...all(2)),Math.max(...all(3))]}function viewOn([left,bottom,right,top],width,height,margin){
const room=1-2*margin;const unit=Math.max((right-left)/width,(top-bottom)/height)/room;return{width,
height,unit,x:(left+right)/2,y:(bottom+top)/2}}var GLIDE=600;function playedFrom(motion,time,loop){const{start,end}=motion;const span=end-start;const from=(!loop&&
time>=end?start:time)-start;const lasts=loop?Infinity:1e3*(span-from);const at=ms=>ms===lasts?end:start+
(from+ms/1e3)%span;return{plays:true,lasts,at}}function glideTo(motion,time,to){const{last,repeat}=motion;
const from=repeat==="ping-pong"&&time>last?2*last-time:time;const goal=repeat==="loop"?nearestTurn(from,
to,motion.end-motion.start):to;const at=ms=>ms<GLIDE?from+eased(ms/GLIDE)*(goal-from):goal;return{plays:false,
lasts:GLIDE,at}}function nearestTurn(from,to,span){const far=goal=>Math.abs(goal-from);const goals=[
to,to+span,to-span];return goals.reduce((best,goal)=>far(goal)<far(best)?goal:best)}function eased(share){
return share*share*(3-2*share)}var BLOCKS=[0,1,2];var Bound=class{#gl;#array;#program=null;#texture=null;#blocks=[];constructor(gl){
this.#gl=gl;this.#array=gl.createVertexArray();gl.bindVertexArray(this.#array)}note(){const gl=this.#gl;
this.#program=gl.getParameter(gl.CURRENT_PROGRAM);this.#texture=gl.getParameter(gl.TEXTURE_BINDING_2D);
this.#blocks=BLOCKS.map(i=>gl.getIndexedParameter(gl.UNIFORM_BUFFER_BINDING,i))}restore(){const gl=this.#gl;
gl.bindVertexArray(this.#array);gl.useProgram(this.#program);gl.bindTexture(gl.TEXTURE_2D,this.#texture);
for(const i of BLOCKS)gl.bindBufferBase(gl.UNIFORM_BUFFER,i,this.#blocks[i])}};var FLOAT=4;var CannotShow=class extends Error{};var Renderer=class{#gl;#program;#position;#count;#index;#points;#uniforms={};#move;#frame;constructor(canvas,gl,data,mesh,cage){
this.canvas=canvas;this.ranges=data.ranges;this.#gl=gl;this.#program=linked(gl,data.vertex,data.fragment);
gl.useProgram(this.#program);this.#position=positions(mesh);this.#points=this.#buffer(gl.ARRAY_BUFFER,
this.#position);this.#attribute("position",3,0,0);const corners=inOrder(mesh).flat();const many=mesh.
heights.length>65535;this.#count=corners.length;this.#index=many?gl.UNSIGNED_INT:gl.UNSIGNED_SHORT;this.#buffer(
gl.ELEMENT_ARRAY_BUFFER,new(many?Uint32Array:Uint16Array)(corners));this.#move=cage.length?this.#movedByShader(
cage):this.#movedByBuffer();this.#frame=data.frame;const[left,bottom,right,top]=data.frame;gl.uniform4f(
this.#uniform("frame"),left,bottom,right-left,top-bottom);gl.uniform3fv(this.#uniform("colors"),data.
colors);gl.uniform1f(this.#uniform("grid_spacing"),data.grid);gl.enable(gl.DEPTH_TEST);gl.depthFunc(
gl.LEQUAL);gl.enable(gl.BLEND);gl.blendFunc(gl.ONE,gl.ONE_MINUS_SRC_ALPHA)}setPicture(picture){const gl=this.#gl;
const most=gl.getParameter(gl.MAX_TEXTURE_SIZE);if(Math.max(picture.width,picture.height)>most){throw new CannotShow(
`This device shows pictures of at most ${most} pixels.`)}gl.bindTexture(gl.TEXTURE_2D,gl.createTexture());
gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL,true);gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL,true);gl.
pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL,gl.NONE);gl.texImage2D(gl.TEXTURE_2D,0,gl.RGBA,gl.
RGBA,gl.UNSIGNED_BYTE,picture);gl.generateMipmap(gl.TEXTURE_2D);gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_MIN_FILTER,
gl.LINEAR_MIPMAP_LINEAR);gl.texParameteri(gl.TEXTURE_2D,gl.TEXTURE_WRAP_S,gl.CLAMP_TO_EDGE);gl.texParameteri(
gl.TEXTURE_2D,gl.TEXTURE_WRAP_T,gl.CLAMP_TO_EDGE)}draw({width,height,unit,x,y,overlay,coefficients,heights,
sharpness=1,above}){const gl=this.#gl;const ratio=(window.devicePixelRatio||1)*sharpness;this.#resize(
Math.round(width*ratio),Math.round(height*ratio));gl.clear(gl.DEPTH_BUFFER_BIT|(above?0:gl.COLOR_BUFFER_BIT));
const projection=projectionMatrix(width,height,unit,x,y);gl.uniformMatrix4fv(this.#uniform("projecti\
onMatrix"),false,projection);gl.uniform1f(this.#uniform("pixel"),unit/ratio);gl.uniform1f(this.#uniform(
"overlay"),Number(overlay));gl.uniform2fv(this.#uniform("color_range"),this.ranges[overlay]??[0,1]);
if(heights)this.#lift(heights);this.#move(coefficients);gl.drawElements(gl.TRIANGLES,this.#count,this.#index,
0);const[left,bottom,right,top]=this.#frame;const{style}=this.canvas;style.backgroundSize=`${(right-
left)/unit}px ${(top-bottom)/unit}px`;style.backgroundPosition=`${(left-x)/unit+width/2}px ${(y-top)/
unit+height/2}px`}#resize(width,height){const{canvas}=this;if(canvas.width!==width||canvas.height!==
height){canvas.width=width;canvas.height=height}this.#gl.viewport(0,0,width,height)}#lift(heights){heights.
forEach((height,i)=>{this.#position[3*i+2]=height});this.#put(this.#gl.ARRAY_BUFFER,this.#points,this.#position)}#movedByShader(cage){
const gl=this.#gl;const[,coefficients,holes]=["cage","coefficients","holes"].map((name,i)=>{const block=gl.
getUniformBlockIndex(this.#program,`${name}_block`);gl.uniformBlockBinding(this.#program,block,i);const buffer=this.#buffer(
gl.UNIFORM_BUFFER,cage);gl.bindBufferBase(gl.UNIFORM_BUFFER,i,buffer);return buffer});return mixed=>{
this.#put(gl.UNIFORM_BUFFER,coefficients,mixed.subarray(0,cage.length));this.#put(gl.UNIFORM_BUFFER,
holes,mixed.subarray(cage.length))}}#movedByBuffer(){const gl=this.#gl;const images=gl.createBuffer();
gl.bindBuffer(gl.ARRAY_BUFFER,images);this.#attribute("image",2,6*FLOAT,0);this.#attribute("derivati\
ves",4,6*FLOAT,2*FLOAT);return mixed=>this.#put(gl.ARRAY_BUFFER,images,mixed)}#uniform(name){this.#uniforms[name]??=
this.#gl.getUniformLocation(this.#program,name);return this.#uniforms[name]}#attribute(name,size,stride,offset){
const gl=this.#gl;const place=gl.getAttribLocation(this.#program,name);gl.enableVertexAttribArray(place);
gl.vertexAttribPointer(place,size,gl.FLOAT,false,stride,offset)}#buffer(target,values){const buffer=this.#gl.
createBuffer();this.#put(target,buffer,values);return buffer}#put(target,buffer,values){this.#gl.bindBuffer(
target,buffer);this.#gl.bufferData(target,values,this.#gl.DYNAMIC_DRAW)}};function linked(gl,vertex,fragment){
const program=gl.createProgram();gl.attachShader(program,compiled(gl,gl.VERTEX_SHADER,vertex));gl.attachShader(
program,compiled(gl,gl.FRAGMENT_SHADER,fragment));gl.linkProgram(program);if(!gl.getProgramParameter(
program,gl.LINK_STATUS)){throw new CannotShow(gl.getProgramInfoLog(program)??"The shaders do not fit\
 together.")}return program}function compiled(gl,kind,text){const shader=gl.createShader(kind);if(!shader)
throw new CannotShow("The graphics card was lost.");gl.shaderSource(shader,text);gl.compileShader(shader);
if(!gl.getShaderParameter(shader,gl.COMPILE_STATUS)){throw new CannotShow(gl.getShaderInfoLog(shader)??
"A shader does not compile.")}return shader}function positions({source,heights}){const count=source.
length/2;const position=new Float32Array(3*count);for(let i=0;i<count;i++){position.set([source[2*i],
source[2*i+1],heights[i]],3*i)}return position}function inOrder({heights,triangles}){const height=([
a,b,c])=>heights[a]+heights[b]+heights[c];return[...triangles].sort((a,b)=>height(a)-height(b))}function projectionMatrix(width,height,unit,x,y){
const sx=2/(unit*width);const sy=2/(unit*height);return[sx,0,0,0,0,sy,0,0,0,0,-1,0,-x*sx,-y*sy,0,1]}var Layers=class{#layers;constructor(canvas,gl,data,shapes){this.#layers=shapes.map(({vertex,mesh,cage,
picture})=>{const bound=new Bound(gl);const renderer=new Renderer(canvas,gl,{...data,vertex},mesh,cage);
renderer.setPicture(picture);bound.note();return{renderer,bound}})}draw(view,states){for(const[i,{renderer,
bound}]of this.#layers.entries()){bound.restore();renderer.draw({...view,...states[i],above:i>0})}}};function down(x){return(Math.floor(1e3*x)/1e3).toFixed(3)}function up(x){return(Math.ceil(1e3*x)/1e3).toFixed(3)}function provedNow(shapes,time){const low=worstOf(
shapes.map(({proof,piece})=>proof.sigma2[piece]),Math.min);const high=worstOf(shapes.map(({proof,piece})=>proof.
sigma1[piece]),Math.max);const most=worstOf(shapes.map(({proof,piece})=>proof.k[piece]),Math.max);if(low!==
null&&high!==null&&most!==null){return`Now: σ₂ ≥ ${down(low)}, σ₁ ≤ ${up(high)}, k ≤ ${up(
most)}`}const folds=shapes.some(({proof})=>time>=proof.until);return folds?"Now: not proved":"Now: p\
roved not to fold"}function sigma2At(shapes,time){if(shapes.some(({proof})=>time>=proof.until))return-1;
return Math.min(...shapes.map(({proof,piece})=>proof.sigma2[piece]??0))}function worstOf(bounds,worst){
const known=bounds.filter(bound=>bound!==null);return known.length<bounds.length?null:worst(...known)}var SOON=.001;var Poses=class{buttons=[];#waiting=[];constructor(times,goTo,draw,drawNext){this.times=
times;this.draw=draw;this.drawNext=drawNext;this.buttons=times.map((time,i)=>{const title=`Pose ${i+
1}, at ${time.toFixed(2)} s`;const look={title,"aria-label":title,onclick:()=>goTo(time)};return make(
"button",look,make("canvas"))});const seen=new IntersectionObserver(entries=>{if(!this.#waiting.length)
requestAnimationFrame(()=>this.#drawOn());for(const{isIntersecting,target}of entries){if(!isIntersecting)
continue;this.#waiting.push(this.buttons.indexOf(target));seen.unobserve(target)}});for(const button of this.
buttons)seen.observe(button)}mark(time){this.buttons.forEach((button,i)=>{button.setAttribute("aria-\
current",String(Math.abs(this.times[i]-time)<SOON))})}drawOne(){const next=this.#waiting.shift();if(next===
void 0)return;const picture=this.draw(this.times[next]);const small=this.buttons[next].firstChild;small.
width=picture.width;small.height=picture.height;penOf(small).drawImage(picture,0,0)}#drawOn(){if(!this.#waiting.
length)return;this.drawNext();requestAnimationFrame(()=>this.#drawOn())}};var Motion=class{constructor({times,repeat},floats){this.times=times;this.repeat=repeat;this.floats=
floats;this.mixed=floats.slice(0,floats.length/times.length);this.start=times[0];this.last=times[times.
length-1];this.end=repeat==="ping-pong"?2*this.last-this.start:this.last}within(time){const{start,end}=this;
if(this.repeat==="once")return Math.min(Math.max(time,start),end);const span=end-start;return start+
((time-start)%span+span)%span}place(time){const{times,last}=this;const within=this.within(time);const there=within>
last?2*last-within:within;const next=times.findIndex((knot,i)=>i>0&&there<knot);const high=next<0?times.
length-1:next;const low=high-1;return{piece:low,share:(there-times[low])/(times[high]-times[low])}}at(time){
const{piece,share}=this.place(time);const{floats,mixed}=this;const low=piece*mixed.length;const high=low+
mixed.length;for(let i=0;i<mixed.length;i++){mixed[i]=(1-share)*floats[low+i]+share*floats[high+i]}return mixed}};function bytesOf(text){return Uint8Array.from(atob(text),letter=>letter.charCodeAt(0)).buffer}async function unpacked({
bytes,step},width){const stream=new Blob([bytesOf(bytes)]).stream().pipeThrough(new DecompressionStream(
"deflate"));const planes=new Uint8Array(await new Response(stream).arrayBuffer());const n=planes.length/
4;const whole=new Int32Array(n);for(let i=0;i<n;i++){const low=planes[i]|planes[n+i]<<8;const folded=low|
planes[2*n+i]<<16|planes[3*n+i]<<24;const second=folded>>>1^-(folded&1);whole[i]=second+2*(whole[i-width]??
0)-(whole[i-2*width]??0)}return Float32Array.from(whole,value=>step*value)}async function restored({
sizes,rows,shares},width){const few=await unpacked(rows,rows.width);const each=await unpacked(shares,
sizes.length);const values=new Float64Array(each.length/sizes.length*width);each.forEach((share,i)=>{
const k=i%sizes.length;const to=width*Math.floor(i/sizes.length);for(let j=0;j<width;j++)values[to+j]+=
share/sizes[k]*few[width*k+j]});return Float32Array.from(values)}async function cornersOf(triangles){
const numbers=await unpacked(triangles,3);return Array.from({length:numbers.length/3},(_,i)=>{const[
first,second,third]=numbers.subarray(3*i,3*i+3);return[first,first+second,first+third]})}var Shape=class _Shape{#identity;#layers;constructor(data,mesh,picture,rows,heights){this.vertex=data.
vertex;this.cage=new Float32Array(bytesOf(data.cage));this.mesh=mesh;this.picture=picture;this.proof=
data.motion;this.motion=new Motion(data.motion,rows.subarray(data.width));this.#identity=rows.subarray(
0,data.width);const{height_times:times}=data;const{repeat}=this.motion;this.#layers=times.length>1?new Motion(
{times,repeat},heights):null}static async loaded(data){const source=await unpacked(data.source,2);const rows=await restored(
data.coefficients,data.width);const heights=await restored(data.heights,source.length/2);const triangles=await cornersOf(
data.triangles);const mesh={source,heights:heights.subarray(0,source.length/2),triangles};return new _Shape(
data,mesh,await loadedPicture(data.picture),rows,heights)}at(time,undeformed=false){const coefficients=undeformed?
this.#identity:this.motion.at(time);return{coefficients,heights:this.#layers?.at(time)??null}}};function loadedPicture(address){
return new Promise((resolve,reject)=>{const picture=new Image;picture.onerror=()=>reject(new CannotShow(
"The picture in this page is damaged."));picture.onload=()=>resolve(picture);picture.src=address})}var LABELS={2:"Stretch σ₁",3:"Stretch σ₂",4:"Dilatation k"};var LOWER="3";var PLAIN="0";var STEP=1/
25;var FAST=5;var THUMBNAIL=56;function byId(id,kind){const found=document.getElementById(id);if(!(found instanceof
kind))throw new Error(`the page has no ${id}`);return found}var Page=class{overlay=byId("overlay",HTMLSelectElement);undeformed=byId(
"source",HTMLInputElement);slider=byId("time",HTMLInputElement);play=byId("play",HTMLButtonElement);clock=byId(
"clock",HTMLOutputElement);here=byId("here",HTMLOutputElement);view=new View(()=>this.draw(),{nearest:1e-4,
farthest:100});#course=null;#due=0;constructor(canvas,data,layers,shapes){this.canvas=canvas;this.data=
data;this.layers=layers;this.shapes=shapes;this.motion=shapes[0].motion;this.keyframes=shapes[0].proof.
keyframes;this.bounds=around(data.parts.map(({bounds})=>bounds));this.sourceBounds=around(data.parts.
map(({source_bounds})=>source_bounds));this.time=this.motion.start;this.poses=new Poses(this.keyframes,
time=>this.#run(glideTo(this.motion,this.time,time)),time=>this.#thumbnail(time),()=>!this.#course&&
this.draw());this.#hearPointers();this.#showColors()}begin(){if(this.keyframes.length)this.#prepareMotion();
new ResizeObserver(()=>this.fit()).observe(this.canvas);this.fit();document.documentElement.dataset.
ready="true"}fit(){const{clientWidth,clientHeight}=this.canvas;const bounds=this.undeformed.checked?
this.sourceBounds:this.bounds;Object.assign(this.view,viewOn(bounds,clientWidth,clientHeight,this.data.
margin));this.draw()}draw(){this.poses.drawOne();const{width,height,unit,x,y}=this.view;const states=this.
shapes.map(one=>one.at(this.time,this.undeformed.checked));this.layers.draw({width,height,unit,x,y,overlay:this.
overlay.value},states)}#thumbnail(time){const view=viewOn(this.bounds,THUMBNAIL,THUMBNAIL,this.data.
margin);const states=this.shapes.map(one=>one.at(time));this.layers.draw({...view,overlay:PLAIN},states);
return this.canvas}#hearPointers(){const{canvas,view}=this;const place=e=>[e.offsetX,e.offsetY];const pointers=new Map;
canvas.addEventListener("pointerdown",e=>{canvas.setPointerCapture(e.pointerId);pointers.set(e.pointerId,
place(e))});canvas.addEventListener("pointermove",e=>{if(pointers.has(e.pointerId))view.follow(pointers,
e.pointerId,place(e))});canvas.addEventListener("lostpointercapture",e=>pointers.delete(e.pointerId));
canvas.addEventListener("wheel",e=>view.wheel(e,place(e)),{passive:false});byId("fit",HTMLButtonElement).
addEventListener("click",()=>this.fit());this.undeformed.addEventListener("change",()=>this.fit())}#css(stop){
const color=this.data.colors.slice(3*stop,3*stop+3);return`rgb(${color.map(share=>Math.round(255*share))}\
)`}get#stops(){return this.data.colors.length/3}#showColors(){const colors=Array.from({length:this.#stops},
(_,i)=>this.#css(i));document.documentElement.style.setProperty("--colors",colors.join());for(const value of Object.
keys(this.data.ranges)){this.overlay.append(new Option(LABELS[value],value))}this.overlay.addEventListener(
"change",()=>{this.draw();this.#showLegend()})}#showLegend(){const{value}=this.overlay;const range=this.
data.ranges[value];const legend=byId("legend",HTMLParagraphElement);legend.hidden=!range;if(!range)return;
const end=value===LOWER?down(range[1]):up(range[1]);legend.replaceChildren(`${LABELS[value]} ${range[0]}`,
make("i"),end)}#prepareMotion(){const{motion,slider}=this;const section=document.querySelector("sect\
ion");if(section)section.hidden=false;slider.min=String(motion.start);slider.max=String(motion.end);
byId("poses",HTMLDivElement).append(...this.poses.buttons);const boundAt=time=>sigma2At(this.#provedAt(
time),time);const background=proofStrip(motion,boundAt);byId("strip",HTMLDivElement).style.background=
background;this.play.addEventListener("click",()=>this.#playOrPause());slider.addEventListener("inpu\
t",()=>this.#goTo(Number(slider.value)));document.addEventListener("keydown",e=>this.#keydown(e));this.#seek(
motion.start);this.#run(null);const still=matchMedia("(prefers-reduced-motion: reduce)").matches;if(this.
data.loop&&!still)this.#playOrPause()}#keydown(e){const target=e.target;if(e.ctrlKey||e.metaKey||e.altKey||
target.tagName==="SELECT")return;if(e.key===" "){if(target.matches("button, input[type=checkbox]"))return;
e.preventDefault();this.#playOrPause();return}const to=this.#timeOf(e);if(to===null)return;e.preventDefault();
this.#goTo(Math.min(Math.max(to,this.motion.start),this.motion.end))}#timeOf(e){const step=e.shiftKey?
FAST*STEP:STEP;if(e.key==="ArrowLeft")return this.time-step;if(e.key==="ArrowRight")return this.time+
step;if(e.key==="Home")return this.motion.start;return e.key==="End"?this.motion.end:null}#goTo(time){
this.#run(null);this.#seek(time)}#seek(time){const{motion}=this;this.time=time===motion.end?time:motion.
within(time);this.slider.value=String(this.time);this.clock.textContent=`${this.time.toFixed(2)} / ${motion.
end.toFixed(2)} s`;this.here.textContent=provedNow(this.#provedAt(this.time),this.time);this.poses.mark(
motion.within(this.time));this.draw()}#provedAt(time){return this.shapes.map(({proof,motion})=>({proof,
piece:motion.place(time).piece}))}#run(course){cancelAnimationFrame(this.#due);this.#course=course&&
{...course,began:performance.now()};if(course)this.#due=requestAnimationFrame(now=>this.#tick(now));
this.play.textContent=course?.plays?"❚❚":"▶";this.play.setAttribute("aria-label",course?.plays?
"Pause":"Play")}#tick(now){if(!this.#course)return;const{began,lasts,at}=this.#course;const passed=Math.
min(Math.max(now-began,0),lasts);this.#seek(at(passed));if(passed===lasts)this.#run(null);else this.#due=
requestAnimationFrame(next=>this.#tick(next))}#playOrPause(){const playing=this.#course?.plays;this.#run(
playing?null:playedFrom(this.motion,this.time,this.data.loop))}};function fail(message){const problem=byId(
"problem",HTMLParagraphElement);problem.textContent=message;problem.hidden=false}async function show(){
const data=JSON.parse(byId("data",HTMLScriptElement).text);const canvas=document.querySelector("canv\
as");const options={antialias:true,premultipliedAlpha:true,preserveDrawingBuffer:true};const gl=canvas?.
getContext("webgl2",options);if(!canvas||!gl||!window.DecompressionStream){throw new CannotShow("Thi\
s page needs WebGL 2 and a browser of 2023 or later.")}const shapes=await Promise.all(data.parts.map(
Shape.loaded));new Page(canvas,data,new Layers(canvas,gl,data,shapes),shapes).begin()}show().catch(error=>{
fail(error.message);if(!(error instanceof CannotShow))throw error});})();
