"use strict";(()=>{var E=class extends Error{},G=class{#t;#e;#s;#o;#n;#r;#h={};#i;constructor(t,e,s,n,o){this.canvas=t,
this.ranges=s.ranges,this.#t=e,this.#e=Be(e,s.vertex,s.fragment),e.useProgram(this.#e),this.#s=De(n),
this.#r=this.#u(e.ARRAY_BUFFER,this.#s),this.#p("position",3,0,0);let r=Ue(n).flat(),a=n.heights.length>
65535;this.#o=r.length,this.#n=a?e.UNSIGNED_INT:e.UNSIGNED_SHORT,this.#u(e.ELEMENT_ARRAY_BUFFER,new(a?
Uint32Array:Uint16Array)(r)),this.#i=o.length?this.#d(o):this.#m();let[h,c,l,u]=s.frame;e.uniform4f(
this.#l("frame"),h,c,l-h,u-c),e.uniform3fv(this.#l("colors"),s.colors),e.uniform1f(this.#l("grid_spa\
cing"),s.grid),e.enable(e.DEPTH_TEST),e.depthFunc(e.LEQUAL),e.enable(e.BLEND),e.blendFunc(e.ONE,e.ONE_MINUS_SRC_ALPHA)}setPicture(t){
let e=this.#t,s=e.getParameter(e.MAX_TEXTURE_SIZE);if(Math.max(t.width,t.height)>s)throw new E(`This\
 device shows pictures of at most ${s} pixels.`);e.bindTexture(e.TEXTURE_2D,e.createTexture()),e.pixelStorei(
e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!0),e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!0),e.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,
e.NONE),e.texImage2D(e.TEXTURE_2D,0,e.RGBA,e.RGBA,e.UNSIGNED_BYTE,t),e.generateMipmap(e.TEXTURE_2D),
e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,e.LINEAR_MIPMAP_LINEAR),e.texParameteri(e.TEXTURE_2D,
e.TEXTURE_WRAP_S,e.CLAMP_TO_EDGE),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_T,e.CLAMP_TO_EDGE)}draw({
width:t,height:e,unit:s,x:n,y:o,overlay:r,coefficients:a,heights:h,sharpness:c=1}){let l=this.#t,u=(window.
devicePixelRatio||1)*c;this.#f(Math.round(t*u),Math.round(e*u)),l.clear(l.COLOR_BUFFER_BIT|l.DEPTH_BUFFER_BIT);
let d=Ge(t,e,s,n,o);l.uniformMatrix4fv(this.#l("projectionMatrix"),!1,d),l.uniform1f(this.#l("pixel"),
s/u),l.uniform1f(this.#l("overlay"),Number(r)),l.uniform2fv(this.#l("color_range"),this.ranges[r]??[
0,1]),h&&this.#a(h),this.#i(a),l.drawElements(l.TRIANGLES,this.#o,this.#n,0)}#f(t,e){let{canvas:s}=this;
(s.width!==t||s.height!==e)&&(s.width=t,s.height=e),this.#t.viewport(0,0,t,e)}#a(t){t.forEach((e,s)=>{
this.#s[3*s+2]=e}),this.#c(this.#t.ARRAY_BUFFER,this.#r,this.#s)}#d(t){let e=this.#t,[,s,n]=["cage",
"coefficients","holes"].map((o,r)=>{let a=e.getUniformBlockIndex(this.#e,`${o}_block`);e.uniformBlockBinding(
this.#e,a,r);let h=this.#u(e.UNIFORM_BUFFER,t);return e.bindBufferBase(e.UNIFORM_BUFFER,r,h),h});return o=>{
this.#c(e.UNIFORM_BUFFER,s,o.subarray(0,t.length)),this.#c(e.UNIFORM_BUFFER,n,o.subarray(t.length))}}#m(){
let t=this.#t,e=t.createBuffer();return t.bindBuffer(t.ARRAY_BUFFER,e),this.#p("image",2,24,0),this.#p(
"derivatives",4,24,8),s=>this.#c(t.ARRAY_BUFFER,e,s)}#l(t){return this.#h[t]??=this.#t.getUniformLocation(
this.#e,t),this.#h[t]}#p(t,e,s,n){let o=this.#t,r=o.getAttribLocation(this.#e,t);o.enableVertexAttribArray(
r),o.vertexAttribPointer(r,e,o.FLOAT,!1,s,n)}#u(t,e){let s=this.#t.createBuffer();return this.#c(t,s,
e),s}#c(t,e,s){this.#t.bindBuffer(t,e),this.#t.bufferData(t,s,this.#t.DYNAMIC_DRAW)}};function Be(i,t,e){
let s=i.createProgram();if(i.attachShader(s,Lt(i,i.VERTEX_SHADER,t)),i.attachShader(s,Lt(i,i.FRAGMENT_SHADER,
e)),i.linkProgram(s),!i.getProgramParameter(s,i.LINK_STATUS))throw new E(i.getProgramInfoLog(s)??"Th\
e shaders do not fit together.");return s}function Lt(i,t,e){let s=i.createShader(t);if(!s)throw new E(
"The graphics card was lost.");if(i.shaderSource(s,e),i.compileShader(s),!i.getShaderParameter(s,i.COMPILE_STATUS))
throw new E(i.getShaderInfoLog(s)??"A shader does not compile.");return s}function De({source:i,heights:t}){
let e=i.length/2,s=new Float32Array(3*e);for(let n=0;n<e;n++)s.set([i[2*n],i[2*n+1],t[n]],3*n);return s}
function Ue({heights:i,triangles:t}){let e=([s,n,o])=>i[s]+i[n]+i[o];return[...t].sort((s,n)=>e(s)-e(
n))}function Ge(i,t,e,s,n){let o=2/(e*i),r=2/(e*t);return[o,0,0,0,0,r,0,0,0,0,-1,0,-s*o,-n*r,0,1]}function $e(i){return Uint8Array.from(atob(i),t=>t.charCodeAt(0)).buffer}async function L({bytes:i,step:t},e){
let s=new Blob([$e(i)]).stream().pipeThrough(new DecompressionStream("deflate")),n=new Uint8Array(await new Response(
s).arrayBuffer()),o=n.length/4,r=new Int32Array(o);for(let a=0;a<o;a++){let c=n[a]|n[o+a]<<8|n[2*o+a]<<
16|n[3*o+a]<<24,l=c>>>1^-(c&1);r[a]=l+2*(r[a-e]??0)-(r[a-2*e]??0)}return Float32Array.from(r,a=>t*a)}
async function Rt({sizes:i,rows:t,shares:e},s){let n=await L(t,t.width),o=await L(e,i.length),r=new Float64Array(
o.length/i.length*s);return o.forEach((a,h)=>{let c=h%i.length,l=s*Math.floor(h/i.length);for(let u=0;u<
s;u++)r[l+u]+=a/i[c]*n[s*c+u]}),Float32Array.from(r)}async function Pt(i){let t=await L(i,3);return Array.
from({length:t.length/3},(e,s)=>{let[n,o,r]=t.subarray(3*s,3*s+3);return[n,n+o,n+r]})}function w([i,t],[e,s]){return Math.hypot(i-e,t-s)}var $=class{x=0;y=0;unit=1;width=0;height=0;constructor(t,{
up:e=1,nearest:s,farthest:n}){this.changed=t,this.up=e,this.nearest=s,this.farthest=n}toWorld([t,e]){
let s=this.x+(t-this.width/2)*this.unit,n=this.y-this.up*(e-this.height/2)*this.unit;return[s,n]}toScreen([
t,e]){let s=(t-this.x)/this.unit+this.width/2,n=this.up*(this.y-e)/this.unit+this.height/2;return[s,
n]}line(t){return t.map(e=>this.toScreen(e))}centreOn([t,e]){this.x=t,this.y=e,this.changed()}pan(t,e){
this.x-=t*this.unit,this.y+=this.up*e*this.unit,this.changed()}zoom(t,e=[this.width/2,this.height/2]){
let[s,n]=this.toWorld(e),o=Math.min(this.farthest,Math.max(this.nearest,this.unit*t));this.x=s+(this.
x-s)*(o/this.unit),this.y=n+(this.y-n)*(o/this.unit),this.unit=o,this.changed()}wheel(t,e){t.preventDefault();
let s=t.deltaMode===1?t.deltaY*33:t.deltaY;this.zoom(Math.exp(s*.0015*(t.ctrlKey?5:1)),e)}follow(t,e,s){
let n=t.get(e)??s,o=[...t].find(([c])=>c!==e)?.[1],r=o?.5:1;if(t.set(e,s),this.pan(r*(s[0]-n[0]),r*(s[1]-
n[1])),!o)return;let a=c=>Math.max(w(c,o),1),h=[(s[0]+o[0])/2,(s[1]+o[1])/2];this.zoom(a(n)/a(s),h)}};var H=class{#t=[];#e=[];get canUndo(){return this.#t.length>0}get canRedo(){return this.#e.length>0}note(t){
this.#t.push(t),this.#e=[]}drop(){return this.#t.pop()}undo(t){let e=this.#t.pop();return e!==void 0&&
this.#e.push(t),e}redo(t){let e=this.#e.pop();return e!==void 0&&this.#t.push(t),e}};function He({source:i,heights:t,triangles:e}){let s=[...i],n=[...t],o=new Map,r=t.length,a=(c,l)=>{let u=Math.
min(c,l)*r+Math.max(c,l),d=o.get(u);if(d!==void 0)return d;let p=n.length;return s.push((s[2*c]+s[2*
l])/2,(s[2*c+1]+s[2*l+1])/2),n.push((n[c]+n[l])/2),o.set(u,p),p},h=e.flatMap(([c,l,u])=>{let[d,p,b]=[
a(c,l),a(l,u),a(u,c)];return[[c,d,b],[d,l,p],[b,p,u],[d,p,b]]});return{source:Float32Array.from(s),heights:Float32Array.
from(n),triangles:h}}function ft(i,t){return t>0?ft(He(i),t-1):i}function dt({source:i}){return Array.
from({length:i.length/2},(t,e)=>[i[2*e],i[2*e+1]])}function _t({source:i,heights:t,triangles:e},s,[n,
o]){let r=-1/0,a=null;for(let[h,c,l]of e){let[u,d]=[s[2*h],s[2*h+1]],[p,b]=[s[2*c]-u,s[2*c+1]-d],[k,
O]=[s[2*l]-u,s[2*l+1]-d],ut=p*O-b*k,A=((n-u)*O-(o-d)*k)/ut,g=(p*(o-d)-b*(n-u))/ut;if(!(A>=0&&g>=0&&A+
g<=1))continue;let M=1-A-g,Ot=M*t[h]+A*t[c]+g*t[l];Ot<=r||(r=Ot,a=[M*i[2*h]+A*i[2*c]+g*i[2*l],M*i[2*
h+1]+A*i[2*c+1]+g*i[2*l+1]])}return a}function K(i){let[t,e,s,n]=[1/0,1/0,-1/0,-1/0];for(let o=0;o<i.
length;o+=2)t=Math.min(t,i[o]),s=Math.max(s,i[o]),e=Math.min(e,i[o+1]),n=Math.max(n,i[o+1]);return[t,
e,s,n]}function z(i,t){return{handle:i,target:t,angle:null,scale:null,weight:1,name:""}}function x(i){return{
handles:i.map(({handle:t})=>t),targets:i.map(({target:t})=>t),weights:i.map(({weight:t})=>t),angles:i.
map(({angle:t})=>t),scales:i.map(({scale:t})=>t)}}function W(i,t,e){return i.map((s,n)=>t.includes(n)?
{...s,...e(s,n)}:s)}function Nt(i,t){return i.filter((e,s)=>!t.includes(s))}function Ft(i){return Math.
min(20,Math.max(.05,i))}function pt(i){return Math.atan2(Math.sin(i),Math.cos(i))}function Ct(i,t,e){
return i?((t??(e>0?-1:i))+e+i)%i:-1}function Bt(i,t,e,s){let n=new Map(i.map(h=>[It(h),h])),o=new Map(
t.map(h=>[It(h),h])),r=[...new Set([...n.keys(),...o.keys()])],a=[[],[]];for(let h of r){let c=n.get(
h)??o.get(h),l=o.get(h)??c;a[0].push(n.has(h)?c:z(c.handle,e(c.handle))),a[1].push(o.has(h)?l:z(l.handle,
s(l.handle)))}return a}function Dt(i,t,e){let s=(n,o)=>n+e*(o-n);return i.map((n,o)=>{let r=t[o],a=n.
angle===null||r.angle===null?null:pt(r.angle-n.angle);return{...n,target:[s(n.target[0],r.target[0]),
s(n.target[1],r.target[1])],weight:s(n.weight,r.weight),angle:n.angle===null||a===null?null:n.angle+
e*a,scale:n.scale===null||r.scale===null?null:s(n.scale,r.scale)}})}function It({handle:i}){return i.
join()}var Ke=.15,j=class{pins=[];selected=[];inGesture=!1;#t=new H;#e=0;#s=0;constructor(t,e,s,n=s.coefficients){
this.solving=t,this.mesh=e,this.rest=n,this.frame=s,this.told=()=>{},t.onmap=o=>this.#f(o)}begin(t){
this.#h({pins:t,selected:[],coefficients:this.frame.coefficients})}get now(){let{pins:t,selected:e,frame:s}=this;
return{pins:t,selected:e,coefficients:s.coefficients}}get canUndo(){return this.#t.canUndo}get canRedo(){
return this.#t.canRedo}get settled(){return this.frame.settled&&this.frame.id>=this.#s}get marks(){let t=this.
pins.map(({target:s})=>s),e=this.pins.map((s,n)=>this.imageOf(n));return{targets:t,images:e,selected:[
...this.selected],hidden:[],ring:this.#o()}}imageOf(t){let{images:e}=this.frame.pins;return this.#n?
[e[2*t],e[2*t+1]]:this.pins[t].target}get missed(){return this.settled?[...this.pins.keys()].filter(
t=>{let[e,s]=this.imageOf(t),[n,o]=this.pins[t].target;return Math.hypot(e-n,s-o)>Ke}):[]}get refused(){
return this.frame.outcome==="refused"}#o(){let t=this.selected.at(-1);if(t===void 0)return[];let{angle:e,
scale:s}=this.turnOf(t),n=this.pins[t];return[e,s,n.angle!==null,n.scale!==null]}turnOf(t){let{samples:e}=this.
frame.pins,s=e.length/4,[n,o]=this.#n?[e[t],e[s+t]]:[1,0],{angle:r,scale:a}=this.pins[t];return{angle:r??
Math.atan2(o,n),scale:a??Math.hypot(n,o)}}get#n(){return this.frame.pins.images.length===2*this.pins.
length}sourceAt(t){return _t(this.mesh,this.frame.images??[],t)}select(t){this.selected=[...new Set(
t)],this.told()}selectNext(t){let e=Ct(this.pins.length,this.selected.at(-1),t);e>=0&&this.select([e])}pin(t){
let e=this.sourceAt(t);return e?(this.#r([...this.pins,z(e,t)],[this.pins.length]),!0):!1}remove(){this.
selected.length&&this.#r(Nt(this.pins,this.selected),[])}move(t){let e=(s,n)=>({target:t.get(n)??s.target});
this.#r(W(this.pins,[...t.keys()],e),this.selected)}nudge([t,e]){let s=({target:[n,o]})=>({target:[n+
t,o+e]});this.#r(W(this.pins,this.selected,s),this.selected)}turn(t){let e=(s,n)=>{let{angle:o,scale:r}=t(
n);return{...o===void 0?{}:{angle:o===null?null:pt(o)},...r===void 0?{}:{scale:r===null?null:Ft(r)}}};
this.selected.length&&this.#r(W(this.pins,this.selected,e),this.selected)}beginGesture(){this.inGesture||
(this.#t.note(this.now),this.inGesture=!0)}endGesture(){this.inGesture&&(this.inGesture=!1,this.told())}cancelGesture(){
if(!this.inGesture)return;this.inGesture=!1;let t=this.#t.drop();t&&this.#h(t)}undo(){let t=this.#t.
undo(this.now);t&&this.#h(t)}redo(){let t=this.#t.redo(this.now);t&&this.#h(t)}replace(t,e){this.#t.
note(this.now),this.#h({pins:t,selected:[],coefficients:e})}#r(t,e){this.inGesture||this.#t.note(this.
now);let s=t.length<this.pins.length;this.pins=t,this.selected=e,t.length?this.#s=this.solving.drag(
x(t)):this.#i(this.rest),s&&(this.#e=this.#s),this.told()}#h({pins:t,selected:e,coefficients:s}){this.
pins=t,this.selected=e.filter(n=>n<t.length),this.#i(s),t.length&&(this.#s=this.solving.drag(x(t))),
this.told()}#i(t){let e=this.solving.place(x(this.pins),t);this.#s=e,this.#e=e}#f(t){t.id<this.#e||!t.
certificate.certified||(this.frame=t,this.told())}};function m(i){return V(i,HTMLElement)}function V(i,t){let e=document.getElementById(i);if(!(e instanceof
t))throw new Error(`the page has no ${i}`);return e}function f(i,t={},...e){let s=document.createElement(i);s instanceof HTMLButtonElement&&(s.type="but\
ton");for(let[n,o]of Object.entries(t))n.startsWith("on")?s.addEventListener(n.slice(2),o):n in s&&n!==
"list"?Reflect.set(s,n,o):s.setAttribute(n,o);return s.append(...e),s}function T(i){let t=i.getContext(
"2d");if(!t)throw new Error("this browser does not draw on canvases");return t}var ze="rgba(255, 255, 255, 0.004)";function Ut(i,t,e,s){let n=0;return e.addEventListener("abort",()=>cancelAnimationFrame(
n)),()=>{n||(n=requestAnimationFrame(()=>{n=0,s(We(i,t))}))}}function We(i,{width:t,height:e}){let s=window.
devicePixelRatio||1,n=Math.round(t*s),o=Math.round(e*s);(i.width!==n||i.height!==o)&&(i.width=n,i.height=
o);let r=T(i);return r.setTransform(s,0,0,s,0,0),r.clearRect(0,0,t,e),r.fillStyle=ze,r.fillRect(0,0,
t,e),r}function N(i,[t,e],s,n,o){i.beginPath(),i.arc(t,e,s,0,2*Math.PI),v(i,n,o)}function R(i,t,e,s,n,o=1){
N(i,t,e,[]),i.fillStyle=s,i.fill(),n&&v(i,[[o,n]])}function P(i,t,e=!0){i.beginPath();for(let s of t)
s.forEach(([n,o],r)=>{r?i.lineTo(n,o):i.moveTo(n,o)}),e&&i.closePath()}function X([i,t],[e,s]){return[
[i,t],[e,t],[e,s],[i,s]]}function Y(i,t,e,s="evenodd"){P(i,t),i.fillStyle=e,i.fill(s)}function v(i,t,e=[]){
i.setLineDash(e);for(let[s,n]of t)i.lineWidth=s,i.strokeStyle=n,i.stroke();i.setLineDash([])}function Gt(i,t){let e=null,s=1/0;for(let n of i){let o=n.d+(n.loss??0);n.d>t||o>=s||(e=n,s=o)}return e}var _=6,je=4,Ve=42,Xe=24,$t=14,Ht=[36,112];function mt(i,t,e){let s=t.selected.at(-1),[n,o]=t.ring;if(n===void 0||o===void 0||s===void 0||!t.targets[s])
return null;let r=i.toScreen(e?.get(s)??t.targets[s]),a=Ve*Math.min(2.5,Math.max(.5,o));return{centre:r,
radius:a,knob:Ye(i,r,a,n)}}function Ye(i,t,e,s){let n=[0,1,-1,2,-2,3,-3,4].map(o=>{let r=s+o*Math.PI/
4,a=t[0]+e*Math.cos(r),h=t[1]-e*Math.sin(r);return[q(a,i.width),q(h,i.height)]});return n.find(o=>w(
o,t)>=Xe)??n[0]}function zt(i,t,e,s){let n=mt(i,t);return n?w(e,n.knob)<=Math.max(_+je,s)?{part:"knob"}:Math.abs(w(e,
n.centre)-n.radius)<=s?{part:"turn"}:null:null}function Z(i,t,e){return Kt(i,!1,t,e)??Kt(i,!0,t,e)}function Kt(i,t,e,s){
let o=(t?i.images:i.targets).map((r,a)=>{let h=i.hidden.includes(a)?s/3:0;return{mark:a,reached:t,d:w(
r,e),loss:h}});return Gt(o,s)}function Wt(i,t){return t.filter(e=>!qe(i,e)).map(e=>{let[s,n]=i.toScreen(
e),o=q(n,i.height),r=o<Ht[1]?Ht[0]:0,a=q(s,i.width-r);return{at:[a,o],target:e,angle:Math.atan2(n-o,
s-a)}})}function qe(i,t){let[e,s]=i.toScreen(t);return e>=0&&s>=0&&e<=i.width&&s<=i.height}function q(i,t){return Math.
min(t-$t,Math.max($t,i))}var jt=7.5,Vt=3.5,Xt=12,Ze=2,F="rgba(255,255,255,0.85)",qt="rgba(255,255,255,0.9)",Je="#2b2b2b",Zt="\
#00d5e0",Jt="#063f45",Qe="#067a82",Qt="#0072b2",gt="#d55e00",Yt="rgba(40,40,40,0.75)";function wt(i,t,e){i.lineCap="round",P(i,t,!1),v(i,e)}function te(i,t,e){Y(i,[t.line(e)],"rgba(0,114,178,0.12)"),v(i,[[3,F],[1.4,Qt]],[5,3])}function ee(i,t,e,{
hovered:s,held:n,cursor:o}){let r=t.line(e.targets.map((h,c)=>n.get(c)??h)),a=t.line(e.images);ts(i,
r,a),r.forEach((h,c)=>{e.selected.includes(c)?R(i,h,Xt,"rgba(0,114,178,0.28)",Qt,2):c===s&&R(i,h,Xt,
"rgba(0,114,178,0.14)"),es(i,h,e.hidden.includes(c))}),ss(i,t,e,n),ns(i,t,e),a.forEach((h,c)=>{e.hidden.
includes(c)||(R(i,h,Vt+1,qt),R(i,h,Vt,"#111"))}),o&&is(i,t.toScreen(o))}function ts(i,t,e){let n=t.map(
(o,r)=>[e[r],o]).filter(([o,r])=>o&&w(o,r)>=Ze);wt(i,n,[[3.6,F],[1.6,Je]])}function es(i,t,e){if(!e){
R(i,t,jt,Zt,Jt,1.4);return}N(i,t,jt,[[3.4,F],[1.6,Qe]],[3.5,2.4])}function ss(i,t,e,s){let n=mt(t,e,
s);if(!n)return;let[,,o,r]=e.ring,{centre:a,radius:h,knob:c}=n,[l,u]=c,d=o?gt:Yt;N(i,a,h,[[4,F]]),N(
i,a,h,[[2,d]],o?[]:[6,4]),wt(i,[[a,c]],[[3,F],[1.2,d]]);let p=X([l-_,u-_],[l+_,u+_]);Y(i,[p],r?gt:"#\
fff"),v(i,[[1.6,r?"#fff":Yt]])}function ns(i,t,e){for(let{at:s,angle:n}of Wt(t,e.targets)){let o=(r,a)=>[
s[0]+a*Math.cos(n+r),s[1]+a*Math.sin(n+r)];Y(i,[[o(0,11),o(2.4,9),o(-2.4,9)]],Zt),v(i,[[1.6,Jt]])}}function is(i,[
t,e]){let s=(n,o)=>[[t+4*n,e+4*o],[t+13*n,e+13*o]];wt(i,[s(1,0),s(-1,0),s(0,1),s(0,-1)],[[4,qt],[1.6,
gt]])}var os=["pointerdown","pointermove","wheel","keydown","keyup","contextmenu"];function se(i){for(let t of os)
i.addEventListener(t,e=>e.stopPropagation());return i}function ne(i){let t=se(f("div",{className:"gl\
id-help",popover:"auto",tabIndex:-1},...i.map(rs)));t.addEventListener("click",()=>t.hidePopover()),
t.addEventListener("beforetoggle",()=>Object.assign(t,{autofocus:!0}));let e="Keys and gestures (?)",
n=se(f("button",{...{className:"glid-help-button",title:e,"aria-label":e},popoverTargetElement:t},"?"));
return{table:t,button:n,toggle:()=>{t.togglePopover()}}}function rs([i,t]){return f("section",{},f("\
h4",{},i),f("table",{},...t.map(as)))}function as([i,t]){return f("tr",{},f("th",{},i),f("td",{},t))}var hs={edit:"M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",foreground:"M13.5 2.5l-6 6 M6.7 9.2c-1\
.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z M9.5 12.5h5 M12 10v5",
background:"M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8\
-.4-1.6-1.2-1.9z M9.5 12.5h5",brush:"M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 \
2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z",eraser:"M9.2 2.8l4 4-6.4 6.4H4.4L2.2 11z M5.5 6.6l4 4 M7 \
13.2h6.5",color:"M9 4l3 3 M10 3.2l1-1a1.6 1.6 0 0 1 2.8 2.2l-1.1 1.1 M9.6 5.2L3.4 11.4 2.5 13.5l2.1-\
.9 6.2-6.2",component:"M8 1.5v3 M8 11.5v3 M1.5 8h3 M11.5 8h3 M8 5.2a2.8 2.8 0 1 0 0 5.6 2.8 2.8 0 0 \
0 0-5.6z",polygon:"M8 2l5.5 4-2 7h-7l-2-7z",rectangle:"M2.5 4h11v8h-11z",undo:"M5.5 3L2.5 6l3 3 M3 6\
h6.2a3.6 3.6 0 0 1 0 7.2H6",redo:"M10.5 3l3 3-3 3 M13 6H6.8a3.6 3.6 0 0 0 0 7.2H10",fit:"M2 5.5V2h3.\
5 M10.5 2H14v3.5 M14 10.5V14h-3.5 M5.5 14H2v-3.5",screen:"M10 2h4v4 M14 2L9.5 6.5 M6 14H2v-4 M2 14l4\
.5-4.5",eye:"M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8z M8 6.2a1.8 1.8 0 1 0 0 3.6\
 1.8 1.8 0 0 0 0-3.6z",plus:"M8 3v10 M3 8h10",minus:"M3 8h10",open:"M2 12.5v-9h4l1.5 2H14v7z",play:"\
M5 3l8 5-8 5z",pause:"M5.5 3v10 M10.5 3v10",record:"M8 4.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6z",
onion:"M6.2 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8z M9.8 4a4 4 0 1 1 0 8",copy:"M5.5 5.5h8v8h-8z M3 10.5v-8h8",
export:"M8 2v8 M4.8 6.8L8 10l3.2-3.2 M3 13.5h10",trash:"M3 4.5h10 M6.5 4.5v-2h3v2 M4.5 4.5l.6 9h5.8l\
.6-9"};function cs(i){return`<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${hs[i]}"/></svg>`}
function S(i,t,e,s="glid-icon"){return f("button",{title:t,"aria-label":t,className:s,onclick:e,innerHTML:cs(
i)})}var ls={Comma:",<",Period:".>",Slash:"/?",Minus:"-_",Equal:"=+",BracketLeft:"[{",BracketRight:"]}"};
function yt({key:i,code:t="",shiftKey:e=!1}){if(i.length>1||i<="ɏ")return i;let[,s,n]=t.match(/^(?:Key([A-Z])|(?:Digit|Numpad)([0-9]))$/)??
[];return s?e?s:s.toLowerCase():n??ls[t]?.[Number(e)]??i}function J(i){if(!i.ctrlKey&&!i.metaKey)return null;
let t=yt(i).toLowerCase();return t==="z"?i.shiftKey?"redo":"undo":t==="y"?"redo":null}function us(i){let{width:t,height:e}=i.getBoundingClientRect(),s=t/i.offsetWidth||1;return{across:s,
down:e/i.offsetHeight||s}}function ie(i,{clientX:t,clientY:e}){let{left:s,top:n}=i.getBoundingClientRect(),
{across:o,down:r}=us(i);return[(t-s)/o,(e-n)/r]}var oe=4,fs=600,ds=100,ps=8,ms=3,Q=class{pointers=new Map;mode=null;grip=null;held=new Map;path=[];encloses=null;found=null;rests=null;#t=[
0,0];#e=!1;#s=!1;#o=!1;#n;constructor(t,e,s,n){this.element=t,this.view=e,this.link=s,this.behaviour=
n,t.tabIndex=0,s.signal.addEventListener("abort",()=>clearTimeout(this.#n)),t.addEventListener("poin\
terdown",o=>this.#f(o)),t.addEventListener("pointermove",o=>this.#u(o)),t.addEventListener("pointeru\
p",o=>this.#g(o,"up")),t.addEventListener("pointercancel",o=>this.#g(o,"cancel")),t.addEventListener(
"lostpointercapture",o=>this.#g(o,"cancel")),t.addEventListener("pointerleave",()=>this.hover(null)),
t.addEventListener("wheel",o=>this.#v(o),{passive:!1}),t.addEventListener("contextmenu",o=>this.#l(o)),
t.addEventListener("keydown",o=>this.keydown(o)),t.addEventListener("keyup",o=>this.#r(o)),t.addEventListener(
"focus",()=>n.changed()),t.addEventListener("blur",()=>{this.#w(!1),n.changed()})}get focused(){return this.
element.matches(":focus")}place(t){return ie(this.element,t)}send(t,e,s={},n={}){let[o,r]=this.view.
toWorld(e),{unit:a}=this.view;return this.link.put({type:t,x:o,y:r,unit:a,reach:this.#h(s.pointerType)*
a,button:s.button??0,shift:!!s.shiftKey,alt:!!s.altKey,time:s.timeStamp??performance.now(),...n})}press(t,e){
this.send("key",[this.view.width/2,this.view.height/2],e,{key:t})}hover(t=this.rests){this.rests=t,this.
mode===null&&(this.found=t&&this.#i(t,"mouse"),this.#b(),this.behaviour.changed())}keydown(t){let e=yt(
t),s=t.ctrlKey||t.metaKey,n=s?void 0:this.behaviour.actions[e.toLowerCase()],o=J(t);!o&&!n&&e!==" "&&
(t.altKey||!this.behaviour.keys.test(e)||s&&e!=="a")||(t.preventDefault(),t.stopPropagation(),e===" "?
(t.repeat||(this.#o=!0),this.#w(!0)):n?n():((e==="Escape"||o)&&this.#E(),this.press(o??e,t)))}#r(t){
t.key===" "&&(this.#w(!1),this.#o&&this.behaviour.tapped?.())}#h(t){return this.behaviour.reach[t??"\
mouse"]??this.behaviour.reach.mouse}#i(t,e){return this.behaviour.find(this.view.toWorld(t),this.#h(
e)*this.view.unit)}#f(t){if(this.pointers.has(t.pointerId)||this.pointers.size>1)return;t.preventDefault(),
this.element.focus({preventScroll:!0}),this.#o=!1;let e=this.place(t);this.pointers.set(t.pointerId,
e),this.element.setPointerCapture(t.pointerId);let s=this.pointers.size===2;s&&this.#p(t),this.#t=e,
this.mode=s||t.button===1||t.button===0&&this.#s?"pan":"hand",this.mode==="hand"&&this.#a(e,t),this.#b()}#a(t,e){
let{behaviour:s}=this,n=this.#i(t,e.pointerType),o=e.button===0;o&&!e.shiftKey&&!e.altKey&&n?.mark!==
void 0&&(this.grip={from:this.view.toWorld(t),points:s.held(n)}),this.#e=o&&!!s.pans?.(n,e),this.encloses=
o&&!s.painting?s.encloses?.(n,e):null,this.path=o?[this.view.toWorld(t)]:[],this.send("down",t,e,{part:n?.
part,at:o?s.pressedAt?.():void 0}),e.pointerType==="touch"&&s.menu&&!s.painting&&(this.#n=setTimeout(
()=>this.#d(e,t),fs)),s.changed()}#d(t,e){this.#n=setTimeout(()=>{this.#p(t),this.mode=null,this.#m(
e,"touch")},ds)}#m(t,e){this.behaviour.menu?.(t,this.#i(t,e))}#l(t){t.preventDefault(),t.stopPropagation();
let e=t instanceof PointerEvent&&t.pointerType==="touch";t.button===2&&!e&&this.#m(this.place(t),"mo\
use")}#p(t){this.mode==="hand"&&this.send("cancel",this.#t,t),this.#E()}#u(t){let e=this.place(t),s=t.
pointerType==="touch";if(!this.pointers.has(t.pointerId)){s||this.hover(e);return}s||(this.rests=e);
let n=w(e,this.#t);if(n>ps&&clearTimeout(this.#n),this.mode==="hand"&&this.#e&&n>oe&&(this.#p(t),this.
mode="pan",this.#b()),this.mode==="pan"){this.view.follow(this.pointers,t.pointerId,e);return}this.pointers.
set(t.pointerId,e),this.mode==="hand"&&this.#c(e,t,n)}#c(t,e,s){let n=this.view.toWorld(t);if(this.#y(
t,n,s),!this.encloses&&!this.behaviour.painting&&this.send("move",t,e,{replaces:`move ${e.pointerId}`}),
this.grip){let o=n[0]-this.grip.from[0],r=n[1]-this.grip.from[1];for(let[a,[h,c]]of this.grip.points)
this.held.set(a,[h+o,c+r])}this.behaviour.changed()}#y(t,e,s){if(this.encloses==="box"){let[o]=this.
path;this.path=s>oe?X(o,e):[o];return}let n=this.path.at(-1);n&&w(t,this.view.toScreen(n))>=ms&&this.
path.push(e)}#g(t,e){if(!this.pointers.has(t.pointerId))return;let s=this.place(t);if(this.pointers.
delete(t.pointerId),this.mode==="hand"){let{path:n}=this;this.send(e,s,t,{path:n,encloses:!!this.encloses}).
then(()=>{this.grip||this.held.clear(),this.path===n&&(this.path=[]),this.behaviour.changed()})}this.#x(),
this.pointers.size||(this.mode=null),this.#b()}#x(){clearTimeout(this.#n),this.grip=null,this.behaviour.
changed()}#E(){this.#x(),this.held.clear(),this.path=[]}#v(t){!this.behaviour.ownsWheel&&!this.focused&&
!t.ctrlKey||(t.stopPropagation(),this.view.wheel(t,this.place(t)))}#w(t){this.#s=t,this.#b()}#b(){this.
element.style.cursor=this.#A()}#A(){return this.mode==="pan"||this.grip?"grabbing":this.#s?"grab":this.
behaviour.cursor(this.found)}};async function re(i){try{return await navigator.clipboard.writeText(i),!0}catch{return gs(i)}}function gs(i){
let t=document.activeElement,e=document.createElement("textarea");e.value=i,e.setAttribute("readonly",
""),Object.assign(e.style,{position:"fixed",top:"0",left:"0",opacity:"0"}),document.body.append(e),e.
select();try{return document.execCommand("copy")}catch{return!1}finally{e.remove(),t instanceof HTMLElement&&
t.focus({preventScroll:!0})}}function ws(i){let t=new DataView(new ArrayBuffer(8));t.setFloat64(0,i);let e=t.getBigUint64(0),s=e>>
63n?"-":"",n=Number(e>>BigInt(52)&0x7ffn),o=e&(1n<<BigInt(52))-1n;if(!n&&!o)return`${s}0x0.0p+0`;let r=n?
n-1023:-1022,a=o.toString(16).padStart(52/4,"0");return`${s}0x${n?1:0}.${a}p${r<0?"":"+"}${r}`}function ae(i,{
coefficients:t,certificate:e,panels:s}){let n=t.length/4,o=(g,M)=>[t[g*n+M]+0,t[(g+1)*n+M]+0],r=Array.
from({length:n},(g,M)=>M),{cage:a,holes:h,offset_cage:c,offset_holes:l,hole_points:u}=i,d={cage:a,holes:h,
offset_cage:c,offset_holes:l,hole_points:u,phi:r.map(g=>o(0,g)),psi:r.map(g=>o(2,g))},{sigma2_lower:p,
sigma1_upper:b,k_upper:k,windings:O}=e,A={format:"glid_nb-proof",version:1,...xt({...d,...{sigma2_lower:p,
sigma1_upper:b,k_upper:k}}),windings:O,panels:s};return{map:JSON.stringify({format:"glid_nb-map",version:1,
...d}),proof:JSON.stringify(A)}}function xt(i){if(typeof i=="number")return ws(i+0);if(Array.isArray(
i))return i.map(xt);let t=Object.entries(i);return Object.fromEntries(t.map(([e,s])=>[e,xt(s)]))}var ys={iso:"SymmetricDirichlet",exp:"ExponentialSymmetricDirichlet",amips:"AMIPS",mips:"MIPS",arap:"\
ARAP"},xs=["exp","amips"],he=1e5;function ce(i,{energy:t="iso",s:e=1,weight:s=he},n){let o=["import \
glid_nb as glid","",`image = glid.read_image(${JSON.stringify(n)})  # the picture of the page`,"doma\
in = glid.Domain.from_cage(glid.trace(image).cage)","pose = glid.Pose(",`    handles=${C(i.map(({handle:h})=>C(
h.map(Et))))},`,`    targets=${C(i.map(({target:h})=>C(h.map(Et))))},`,...bt("angles",i,({angle:h})=>h),
...bt("scales",i,({scale:h})=>h),...bt("weights",i,({weight:h})=>h===1?null:h,"1.0"),")"],r=`glid.en\
ergies.${ys[t]}(${xs.includes(t)?e:""})`,a=s===he?"":`, glid.Options(p2p_weight=${s})`;return`${[...o,
`result = glid.solve(domain, pose, ${r}${a})`].join(`
`)}
`}function bt(i,t,e,s="None"){let n=t.map(e);if(n.every(r=>r===null))return[];let o=n.map(r=>r===null?
s:Et(r));return[`    ${i}=${C(o)},`]}function C(i){return`[${i.join(", ")}]`}function Et(i){return String(
Number(i.toFixed(6))+0)}var bs=4096,Es=6e4,vs="0";function At({title:i}){return i.replace(/[^\w-]+/g,"-")||"picture"}async function le(i,{
pins:t}){let e=ce(t,i.options,`${At(i)}.png`);return await re(e)?"The lines are in the clipboard.":"\
The browser did not allow copying."}function ue(i,t,e){let[s,n,o,r]=K(e.images??[]),a=i.size[0]/(i.frame[2]-
i.frame[0]),h=bs/Math.max(o-s,r-n),c=Math.min(a,h)/(window.devicePixelRatio||1),l=Math.ceil((o-s)*c),
u=Math.ceil((r-n)*c),d={x:(s+o)/2,y:(n+r)/2};t.paint(e,{width:l,height:u,unit:1/c,...d},vs),t.canvas.
toBlob(p=>p&&vt(`${At(i)}-posed.png`,p))}async function fe(i,{solving:t}){let e=await t.ask({type:"c\
laim"});if(e.type!=="claim")throw new Error("the worker did not answer with a claim");let{map:s,proof:n}=ae(
i.outline,e.claim),o=At(i);return vt(`${o}.map.json`,new Blob([s])),vt(`${o}.proof.json`,new Blob([n])),
`Check them: glid-check ${o}.map.json ${o}.proof.json`}function vt(i,t){let e=URL.createObjectURL(t);
f("a",{href:e,download:i}).click(),setTimeout(()=>URL.revokeObjectURL(e),Es)}function de(i,t,e){let{start:s,end:n}=i,o=n-s,r=(!e&&t>=n?s:t)-s,a=e?1/0:1e3*(o-r);return{plays:!0,lasts:a,
at:c=>c===a?n:s+(r+c/1e3)%o}}function pe(i,t,e){let{last:s,repeat:n}=i,o=n==="ping-pong"&&t>s?2*s-t:
t,r=n==="loop"?As(o,e,i.end-i.start):e;return{plays:!1,lasts:600,at:h=>h<600?o+Ms(h/600)*(r-o):r}}function As(i,t,e){
let s=o=>Math.abs(o-i);return[t,t+e,t-e].reduce((o,r)=>s(r)<s(o)?r:o)}function Ms(i){return i*i*(3-2*
i)}var ks=.001,tt=class{buttons=[];#t=[];constructor(t,e,s,n){this.times=t,this.draw=s,this.drawNext=n,
this.buttons=t.map((r,a)=>{let h=`Pose ${a+1}, at ${r.toFixed(2)} s`;return f("button",{title:h,"ari\
a-label":h,onclick:()=>e(r)},f("canvas"))});let o=new IntersectionObserver(r=>{this.#t.length||requestAnimationFrame(
()=>this.#e());for(let{isIntersecting:a,target:h}of r)a&&(this.#t.push(this.buttons.indexOf(h)),o.unobserve(
h))});for(let r of this.buttons)o.observe(r)}mark(t){this.buttons.forEach((e,s)=>{e.setAttribute("ar\
ia-current",String(Math.abs(this.times[s]-t)<ks))})}drawOne(){let t=this.#t.shift();if(t===void 0)return;
let e=this.draw(this.times[t]),s=this.buttons[t].firstChild;s.width=e.width,s.height=e.height,T(s).drawImage(
e,0,0)}#e(){this.#t.length&&(this.drawNext(),requestAnimationFrame(()=>this.#e()))}};var et=class{constructor({times:t,repeat:e},s){this.times=t,this.repeat=e,this.floats=s,this.mixed=s.
slice(0,s.length/t.length),this.start=t[0],this.last=t[t.length-1],this.end=e==="ping-pong"?2*this.last-
this.start:this.last}within(t){let{start:e,end:s}=this;if(this.repeat==="once")return Math.min(Math.
max(t,e),s);let n=s-e;return e+((t-e)%n+n)%n}place(t){let{times:e,last:s}=this,n=this.within(t),o=n>
s?2*s-n:n,r=e.findIndex((c,l)=>l>0&&o<c),a=r<0?e.length-1:r,h=a-1;return{piece:h,share:(o-e[h])/(e[a]-
e[h])}}at(t){let{piece:e,share:s}=this.place(t),{floats:n,mixed:o}=this,r=e*o.length,a=r+o.length;for(let h=0;h<
o.length;h++)o[h]=(1-s)*n[r+h]+s*n[a+h];return o}};var me=12;async function we(i,t,e,s){let n=[...t.pins,...e.pins],o=await ge(i,n,s),r=await ge(i,n,e.
frame.coefficients),[a,h]=Bt(t.pins,e.pins,o,r);await i.map({type:"place",pose:x(a),coefficients:s});
let c=[];for(let l=1;l<=me;l++){let u=Dt(a,h,Ts(l/me)),{coefficients:d,certificate:p}=await i.map({type:"\
drag",pose:x(u)});c.push({coefficients:d,sigma2:p.sigma2_lower})}return c}async function ge(i,t,e){let s=t.
map(({handle:r})=>r),n={handles:s,targets:s},{pins:o}=await i.map({type:"place",pose:n,coefficients:e});
return r=>{let a=s.findIndex(([h,c])=>h===r[0]&&c===r[1]);return[o.images[2*a],o.images[2*a+1]]}}function Ts(i){
return i*i*(3-2*i)}var ye=1,xe=100,Ss=1/25,st=class{kept=[];seen=!1;element=f("div",{className:"film",hidden:!0});#t=f(
"div",{className:"poses",role:"group","aria-label":"Kept poses"});#e=f("button",{className:"play",title:"\
Play or pause (Space)"});#s=f("input",{type:"range",step:String(Ss),"aria-label":"Time, seconds"});#o=f(
"i",{title:"Certified σ₂ at the knots"});#n=f("output",{className:"clock"});#r=S("trash","Remove \
this pose",()=>this.#A());#h=new WeakMap;#i=null;#f=[];#a=0;#d=0;#m=null;#l=0;#p=null;#u=!1;#c=null;#y=!0;#g=null;#x=null;constructor(t,e){
this.start=t,this.screen=e;let s=f("div",{className:"track"},this.#s,this.#o),n=f("div",{className:"\
player"},this.#e,s,this.#n);this.player=n,this.element.append(this.#t,this.#r,n),this.#e.addEventListener(
"click",()=>this.playOrPause()),this.#s.addEventListener("input",()=>this.#C(Number(this.#s.value))),
this.#S()}#E(){return this.#p??=this.start(),this.#p}get playing(){return!!this.#m?.plays}drawOne(){
this.#x?.drawOne()}async load(t,e){let s=await this.#E(),n=[];for(let[o,r]of t.keyframes.entries()){
let{coefficients:a}=t.knots[t.times.indexOf(r)],h=e[o]??[],c=await s.map({type:"place",pose:x(h),coefficients:a});
n.push({pins:h,frame:c})}this.kept=n,this.#L(t),this.#v()}async keep(t){this.kept=[...this.kept,t],this.#g=
null,this.#a=this.#w[this.kept.length-1],this.#v(),await this.#O()}release(){this.#k(null),this.#y=!0,
this.#c=null,this.seen&&(this.seen=!1,this.screen.show(null),this.#M())}playOrPause(){let t=this.#i;
if(!t)return;let e=this.seen?this.#a:t.start;this.#k(this.playing?null:de(t,e,!0))}#v(){let t=this.#w,
e=s=>this.kept[t.indexOf(s)];this.#x=new tt(t,s=>this.#b(s,e(s)),s=>this.screen.thumbnail(e(s).frame),
()=>this.screen.redraw()),this.#t.replaceChildren(...this.#x.buttons),this.element.hidden=this.kept.
length===0,this.player.hidden=this.kept.length<2,this.#M(),this.screen.redraw()}get#w(){return this.
kept.map((t,e)=>this.#g?.[e]??e*ye)}#b(t,e){let s=this.#i;if(!s||!this.seen){this.#a=t,this.screen.take(
e),this.#M();return}this.#k(pe(s,this.#a,t),()=>{this.release(),this.screen.take(e),this.#M()})}#A(){
let t=this.#T;t<0||(this.release(),this.kept=this.kept.filter((e,s)=>s!==t),this.#g=null,this.#a=0,this.#v(),
this.#O())}get#T(){return this.#w.findIndex(t=>Math.abs(t-this.#a)<.001)}async#O(){this.#d+=1;let t=this.#d;
if(this.#g=null,this.#i=null,this.#S(),!(this.kept.length<2)){this.#n.textContent="finding the way…";
try{let e=await this.#I(()=>t!==this.#d);if(t!==this.#d)return;let s=e.map((n,o)=>o*ye*(this.kept.length-
1)/(e.length-1));this.#L({times:s,knots:e,keyframes:this.#w,repeat:"ping-pong"})}catch(e){if(t!==this.#d)
return;this.#n.textContent="no way was found",this.screen.say(`The poses cannot be joined: ${e.message}`)}}}async#I(t){
let{kept:e}=this,{coefficients:s,certificate:n}=e[0].frame,o=[{coefficients:s,sigma2:n.sigma2_lower}];
for(let r=0;r+1<e.length&&!t();r++)o.push(...await this.#N(e[r],e[r+1],o[o.length-1].coefficients));
return o}async#N(t,e,s){let n=this.#h.get(t);if(n?.to===e&&n.start===s)return n.knots;let o=await we(
await this.#E(),t,e,s);return this.#h.set(t,{start:s,to:e,knots:o}),o}#L({times:t,knots:e,keyframes:s,
repeat:n}){let o=e[0].coefficients.length,r=new Float64Array(o*e.length);for(let[a,{coefficients:h}]of e.
entries())r.set(h,a*o);this.#i=new et({times:t,repeat:n},r),this.#f=e,this.#g=s,this.#a=Math.min(Math.
max(this.#a,this.#i.start),this.#i.end),this.#s.min=String(this.#i.start),this.#s.max=String(this.#i.
end),this.#o.style.background=this.#F(this.#i),this.#P(),this.#S()}#F(t){return`linear-gradient(to r\
ight, ${Array.from({length:xe},(s,n)=>{let o=t.start+(n+.5)/xe*(t.end-t.start),{piece:r}=t.place(o);
return`rgb(0 114 178/${Math.min(this.#f[r].sigma2,this.#f[r+1].sigma2)}) ${n}% ${n+1}%`})})`}#C(t){this.#k(
null),this.#R(t)}#R(t){let e=this.#i;e&&(this.#a=t===e.end?t:e.within(t),this.#c=this.#a,this.#y=!1,
this.#P(),this.#u||this.#B(e))}async#B(t){this.#u=!0;try{let e=await this.#E();for(;this.#c!==null;){
let s=t.at(this.#c).slice();this.#c=null;let n=await e.map({type:"place",pose:x([]),coefficients:s});
if(this.#y)break;this.seen=!0,this.screen.show(n)}}catch{this.screen.say("This instant is not proved\
, so the frame before stays.")}finally{this.#u=!1}}#P(){let t=this.#i;t&&(this.#s.value=String(this.#a),
this.#n.textContent=`${this.#a.toFixed(1)} / ${t.end.toFixed(1)} s`,this.#M())}#M(){let{repeat:t,last:e=0}=this.#i??
{},s=t==="ping-pong"&&this.#a>e;this.#x?.mark(s?2*e-this.#a:this.#a),this.#r.hidden=this.#T<0}#k(t,e=()=>{}){
cancelAnimationFrame(this.#l),this.#m=t&&{...t,began:performance.now()},t&&(this.#l=requestAnimationFrame(
s=>this.#_(s,e))),this.#S()}#_(t,e){if(!this.#m)return;let{began:s,lasts:n,at:o}=this.#m,r=Math.min(
Math.max(t-s,0),n);if(this.#R(o(r)),r<n){this.#l=requestAnimationFrame(a=>this.#_(a,e));return}this.#k(
null),e()}#S(){let{playing:t}=this;this.#e.disabled=!this.#i,this.#s.disabled=!this.#i,this.#e.textContent=
t?"❚❚":"▶",this.#e.setAttribute("aria-label",t?"Pause":"Play")}};var Os={mouse:13,pen:16,touch:26},Ls=/^(Arrow\w+|Delete|Backspace|Escape|Enter|[0fax,.<>+=-])$/i,Rs=2,
Ps=5,_s=.1,Is=.5,Ns=6,Fs=30,Cs=12,Bs=.06,Ds=.12,be=Math.PI/36,Mt=1.05,Ee={ArrowLeft:[-1,0],ArrowRight:[
1,0],ArrowUp:[0,1],ArrowDown:[0,-1]},Us={"<":[be,1],">":[-be,1],"+":[0,Mt],"=":[0,Mt],"-":[0,1/Mt]},
nt=class{reach=Os;keys=Ls;ownsWheel=window===window.top;signal=new AbortController().signal;cursorAt=null;#t=null;#e=[
0,0];constructor(t,e,s){this.editing=t,this.view=e,this.around=s,this.actions={"?":s.help}}changed(){
this.around.redraw()}tapped(){this.around.play()}find(t,e){let{marks:s}=this.editing;this.#e=t;let n=()=>zt(
this.view,s,this.view.toScreen(t),e/this.view.unit/2);return Z(s,t,e)??n()}held({mark:t}){let{pins:e,
selected:s}=this.editing,n=Number(t),o=s.includes(n)?s:[n];return new Map(o.map(r=>[r,e[r].target]))}encloses(t,e){
return e.shiftKey?"box":null}cursor(t){return t?"grab":"crosshair"}pans(t,e){return!t&&!e.shiftKey&&
this.editing.sourceAt(this.#e)===null}async put(t){let e=t;return t.type==="down"&&this.#s(e),t.type===
"move"&&this.#r(e),t.type==="up"&&this.#i(e),t.type==="cancel"&&this.#a(),t.type==="key"&&this.#m(e.
key??"",e),null}#s(t){let{editing:e}=this;if(this.#a(),this.cursorAt=null,t.button!==0)return;let s=[
t.x,t.y],n=Z(e.marks,s,t.reach)?.mark,o={start:s,onShape:!1,targets:new Map,part:"",turns:new Map,dragging:!1,
turning:!1,scaling:!1};if(n!==void 0){let r=Number(n);if(t.shift)return this.#n(r);e.selected.includes(
r)||e.select([r]),t.alt?this.#o(o,"turn"):o.targets=new Map(e.selected.map(a=>[a,e.pins[a].target]))}else
t.part?(this.#o(o,t.part),o.onShape=t.part==="turn"&&e.sourceAt(s)!==null):o.onShape=!t.shift&&e.sourceAt(
s)!==null;this.#t=o}#o(t,e){let{editing:s}=this;t.part=e,t.turning=e==="turn",t.turns=new Map(s.selected.
map(n=>[n,s.turnOf(n)]))}#n(t){let{selected:e}=this.editing,s=e.filter(n=>n!==t);this.editing.select(
e.includes(t)?s:[...e,t])}#r(t){let{editing:e}=this,s=this.#t;if(!s)return;let n=[t.x,t.y],o=s.part||
s.targets.size?Rs:Ps;if(!s.dragging&&w(n,s.start)<=o*t.unit||!s.part&&!s.targets.size&&!s.onShape)return;
if(s.dragging||e.beginGesture(),s.dragging=!0,s.part){this.#h(s,n,Cs*t.unit);return}s.targets.size||
(e.pin(s.start),s.targets=new Map([[e.pins.length-1,s.start]]));let[r,a]=[n[0]-s.start[0],n[1]-s.start[1]],
h=[...s.targets].map(([c,[l,u]])=>[c,[l+r,u+a]]);e.move(new Map(h))}#h(t,e,s){let{editing:n}=this,o=n.
selected.at(-1);if(o===void 0)return;let[r,a]=n.pins[o].target,h=[t.start[0]-r,t.start[1]-a],c=[e[0]-
r,e[1]-a],l=Math.hypot(h[0],h[1]);if(l<s){t.start=e;return}let u=h[0]*c[1]-h[1]*c[0],d=Math.atan2(u,
h[0]*c[0]+h[1]*c[1]),p=Math.max(Math.hypot(c[0],c[1])/l,1e-9);t.part==="knob"&&(t.turning||=Math.abs(
d)>Bs,t.scaling||=Math.abs(Math.log(p))>Ds),!(!t.turning&&!t.scaling)&&n.turn(b=>{let{angle:k,scale:O}=t.
turns.get(b)??{angle:0,scale:1};return{...t.turning?{angle:k+d}:{},...t.scaling?{scale:O*p}:{}}})}#i({
path:t=[],encloses:e}){let{editing:s}=this,n=this.#t;if(this.#t=null,e&&t.length>2){this.#f(t);return}
n&&(n.dragging?s.endGesture():n.onShape?this.#d(n.start):!n.targets.size&&!n.part&&s.select([]))}#f(t){
let[e,s]=[t.map(([h])=>h),t.map(([,h])=>h)],n=(h,c)=>h>=Math.min(...c)&&h<=Math.max(...c),{pins:o,selected:r}=this.
editing,a=[...o.keys()].filter(h=>{let[c,l]=o[h].target;return n(c,e)&&n(l,s)});this.editing.select(
[...r,...a])}#a(){this.#t=null,this.editing.cancelGesture()}#d(t){this.editing.pin(t)||this.around.say(
"There is no shape here. Choose a place on it.")}#m(t,e){let{editing:s,around:n}=this,o={undo:()=>s.
undo(),redo:()=>s.redo(),Delete:()=>s.remove(),Backspace:()=>s.remove(),Escape:()=>this.#p(),Enter:()=>this.#y(
e),0:n.reset,f:n.fit,a:()=>s.select([...s.pins.keys()]),x:()=>s.turn(()=>({angle:null,scale:null})),
",":()=>this.#u(-1),".":()=>this.#u(1)},r=Us[t];Ee[t]?this.#c(Ee[t],e):r?this.#l(r):(o[t]??o[t.toLowerCase()])?.(),
n.redraw()}#l([t,e]){let{editing:s}=this;s.turn(n=>{let{angle:o,scale:r}=s.turnOf(n);return t?{angle:o+
t}:{scale:r*e}})}#p(){if(this.editing.inGesture){this.#a();return}this.editing.select([]),this.cursorAt=
null}#u(t){this.editing.selectNext(t),this.cursorAt=null}#c([t,e],{x:s,y:n,unit:o,shift:r}){let{editing:a}=this;
if(a.selected.length&&!this.cursorAt){let u=r?Is:_s;a.nudge([u*t,u*e]);return}let h=(r?Fs:Ns)*o,[c,l]=this.
cursorAt??[s,n];this.cursorAt=[c+h*t,l+h*e]}#y({x:t,y:e,reach:s}){let n=this.cursorAt;if(!n){this.cursorAt=
[t,e];return}let o=Z(this.editing.marks,n,s)?.mark;this.cursorAt=null,o===void 0?this.#d(n):this.editing.
select([Number(o)])}};var ve=[["Pins",[["Click or tap the shape","pin a point"],["Drag a pin, or the shape","move it there\
; the shape follows, and never folds"],["Drag the ring; Alt on the pin","turn the shape there; the k\
nob scales it too"],["< >, + -, X","turn, scale; free both again"],["Delete","remove the selected pi\
ns"],["Arrow keys","nudge selected pins, with Shift farther; else move a cursor"],["Enter","show the\
 cursor; pin or select there"],[", .","select the pin before, the next pin"],["Shift-click, Shift an\
d drag, A","select several pins, those in a box, all"],["Esc","cancel a drag; select nothing"]]],["V\
iew and poses",[["Wheel, two fingers","zoom, move the view"],["Drag beside the shape","move the view"],
["F","fit the window"],["Space","play the kept poses, pause"],["Ctrl+Z, Ctrl+Shift+Z","undo, redo"],
["0","back to the undeformed shape"]]]];var Gs="#9a3b00";function Ae(i,t,e,s,n){let o=n?"would fold: the shape stays here":"as far as the sh\
ape goes";i.font="600 12px system-ui, sans-serif",i.textBaseline="middle";let r=i.measureText(o).width+
16;for(let a of s){let[h,c]=t.toScreen(e.targets[a]),l=Math.min(Math.max(h-r/2,4),t.width-r-4),u=c>62?
c-20-22:c+20;i.beginPath(),i.roundRect(l,u,r,22,22/2),i.fillStyle=Gs,i.fill(),i.fillStyle="#fff",i.fillText(
o,l+8,u+22/2)}}function $s(i){return(Math.floor(1e3*i)/1e3).toFixed(3)}function kt(i){if(!(i>0)||i>=.01)return $s(i);
let t=Math.floor(Math.log10(i));return`${Math.floor(.999999*i/10**(t-1))/10}e${t}`}function Tt(i){return(Math.
ceil(1e3*i)/1e3).toFixed(3)}var Me=90,it=2;function Hs(i,t,e,s){let[n,o]=s??[Math.min(...i),Math.max(...i)],r=Math.max(o-n,1e-12),
a=(t-2*it)/(Me-1);return i.map((h,c)=>{let l=Math.min(Math.max((h-n)/r,0),1);return[t-it-(i.length-1-
c)*a,e-it-l*(e-2*it)]})}var I=class{#t=[];constructor(t,e,s,n){this.range=s,this.words=n,this.value=
f("output",{}),this.canvas=f("canvas",{"aria-hidden":"true"});let o=f("dt",{},t);this.element=f("div",
{className:"plot",title:e},o,this.value,this.canvas)}add(t){this.#t.push(t),this.#t.length>Me&&this.#t.
shift()}draw(){let{canvas:t}=this,{clientWidth:e,clientHeight:s}=t;if(!e||!s)return;let n=window.devicePixelRatio||
1;t.width=Math.round(e*n),t.height=Math.round(s*n);let o=T(t);o.scale(n,n);let r=Hs(this.#t,e,s,this.
range),a=r.at(-1);if(!a)return;this.value.textContent=this.words(this.#t[r.length-1]);let h=getComputedStyle(
t).color,[c]=r;P(o,[[...r,[a[0],s],[c[0],s]]]),o.globalAlpha=.12,o.fillStyle=h,o.fill(),o.globalAlpha=
1,o.lineJoin="round",P(o,[r],!1),v(o,[[1.5,h]]),o.beginPath(),o.arc(a[0],a[1],2,0,2*Math.PI),o.fillStyle=
h,o.fill()}};var Ks=5e3,zs=.02,ot=class{#t=new I("Certificate","The least stretch anywhere, as proved. The map fo\
lds nowhere while this is above 0",[0,1+zs],t=>`σ₂ ≥ ${kt(t)}`);#e=new I("Energy","The distorti\
on of the shape, and of the pins",null,t=>t.toPrecision(4));#s=new I("Step","Time of a certified ste\
p",null,t=>`${t.toFixed(1)} ms`);#o=-1;#n;constructor(){m("plots").append(this.#t.element,this.#e.element,
this.#s.element)}plot({id:t,certificate:e,energy:s,steps:n,took:o}){t===this.#o&&!n||(this.#o=t,this.#t.
add(e.sigma2_lower),this.#e.add(s),n&&this.#s.add(o/n))}draw(){for(let t of[this.#t,this.#e,this.#s])
t.draw()}proved({certificate:{sigma2_lower:t,sigma1_upper:e,k_upper:s}}){let n=`σ₂ ≥ ${kt(t)}, \
σ₁ ≤ ${Tt(e)}, k ≤ ${Tt(s)}`;m("proved").title=`Proved in this page for the map that is shown\
: ${n}`,m("bound").textContent=n}pins(t){let e=Ws(t);e&&this.tell(e)}tell(t){let e=m("status");e.textContent!==
t&&(e.textContent=t)}say(t){let e=m("notice");e.textContent=t,e.hidden=!1,clearTimeout(this.#n),this.#n=
setTimeout(()=>{e.hidden=!0},Ks)}};function Ws({pins:i,selected:t,missed:e,inGesture:s}){if(e.length&&
!s)return`The shape does not reach pin ${e.map(h=>h+1).join(", ")}`;let n=t.at(-1);if(n===void 0)return"";
let[o,r]=i[n].target;return`Pin ${n+1} of ${i.length}, at ${ke(o)}, ${ke(r)}`}function ke(i){return(Math.
round(10*i)/10+0).toFixed(1)}var Te=80;function B(i){let t=i.getBoundingClientRect(),e=m("free").getBoundingClientRect();return{left:e.
left-t.left,top:e.top-t.top,width:Math.max(e.width,Te),height:Math.max(e.height,Te),size:{width:t.width,
height:t.height}}}function D(i,t,e){let[s,n,o,r]=K(i),a=(o-s)/t.width,h=(r-n)/t.height,c=Math.max(a,
h)/(1-2*e),l=(s+o)/2+c*(t.size.width/2-t.left-t.width/2),u=(n+r)/2-c*(t.size.height/2-t.top-t.height/
2);return{unit:c,x:l,y:u}}var rt=class{#t;#e;#s;#o;constructor(t,{chain:e,shaderHoles:s}){let n=[t.offset_cage,...t.offset_holes];
this.#e=t,this.#o={chain:e,holes:s},this.#t=js(n.map(o=>o.length)),this.#s=n.flat(),this.cage=this.#n()}#n(){
let t=new Float32Array(4*this.#o.chain),e=this.#s[this.#s.length-1];for(let s=0;s<this.#o.chain;s++){
let n=this.#t[s],[o,r]=n?this.#s[n.vertex]:e,a=n&&!n.first?this.#r(s):[0,0];t.set([o,r,...a],4*s)}return t}#r(t){
let[e,s]=this.#s[this.#t[t].vertex],[n,o]=this.#s[this.#t[t-1].vertex],[r,a]=[e-n,s-o],h=r*r+a*a;return[
r/h,-a/h]}of(t){let{chain:e,holes:s}=this.#o,n=t.length/4,o=new Float32Array(4*(e+s));for(let[h,{vertex:c}]of this.#t.
entries())for(let l=0;l<4;l++)o[4*h+l]=t[l*n+c];let r=1e3*Math.max(...this.#s.map(([h,c])=>Math.hypot(
h,c))),a=this.#e.hole_points;for(let h=0;h<s;h++){let c=this.#s.length+h,l=h<a.length?[...a[h],t[c],
t[n+c]]:[r];o.set(l,4*(e+h))}return o}};function js(i){let t=[],e=0;for(let s of i){t.push({vertex:e+
s-1,first:!0});for(let n=0;n<s;n++)t.push({vertex:e+n,first:!1});e+=s}return t}function Se({images:i,
samples:t}){if(!i||!t)throw new Error("the map was not evaluated at the mesh");let e=i.length/2,s=new Float32Array(
6*e);for(let n=0;n<e;n++){s[6*n]=i[2*n],s[6*n+1]=i[2*n+1];for(let o=0;o<4;o++)s[6*n+2+o]=t[o*e+n]}return s}
function Oe(i,t){let e=i.length/4,s=new Float64Array(4*e);for(let n=0;n<e;n++){let o=n>=e-t;s[n]=i[2*
n],s[e+n]=i[2*n+1],s[2*e+n]=o?i[2*n]:i[2*(e+n)],s[3*e+n]=o?-i[2*n+1]:i[2*(e+n)+1]}return s}function U(i){
let e=[...i.offset_cage,...i.offset_holes.flat()].length+i.hole_points.length,s=new Float64Array(4*e);
return i.offset_cage.forEach(([o,r],a)=>{s[a]=o,s[e+a]=r}),s}var Le={0:"Picture",1:"Grid",2:"Stretch σ₁",3:"Stretch σ₂",4:"Dilatation k"},Vs="0",Re=56,at=class{report=new ot;#t=m(
"pad");#e=f("select",{id:"overlay","aria-label":"What is shown"});#s=S("undo","Undo (Ctrl+Z)",()=>this.#u(
"undo"));#o=S("redo","Redo (Ctrl+Shift+Z)",()=>this.#u("redo"));#n=S("trash","Remove the selected pi\
ns (Delete)",()=>this.#u("Delete"));#r=ne(ve);#h=null;#i=0;#f=!0;#a;constructor(t,{stage:e,editing:s,
view:n},o){this.data=t,this.stage=e,this.editing=s,this.view=n,this.film=new st(o,{show:a=>this.#x(a),
thumbnail:a=>this.#E(a),redraw:()=>this.redraw(),take:({pins:a,frame:h})=>s.replace(a,h.coefficients),
say:a=>this.report.say(a)}),this.hand=new nt(s,n,{fit:()=>this.fit(),reset:()=>this.#c(),redraw:()=>this.
redraw(),play:()=>this.film.playOrPause(),say:a=>this.report.say(a),help:this.#r.toggle}),this.pad=new Q(
this.#t,n,this.hand,this.hand);let r=f("canvas",{className:"paper"});this.#t.append(r),this.#a=Ut(r,
n,this.hand.signal,a=>this.#v(a)),n.changed=()=>this.redraw(),s.told=()=>{this.#f=!0,document.documentElement.
dataset.settled="false",this.report.plot(s.frame),this.redraw()},this.#d(),this.#l(),this.redraw()}#d(){
for(let[h,c]of Object.entries(Le))this.#e.append(new Option(c,h));let t=f("div",{id:"menu",popover:"\
auto"},...this.#m());t.addEventListener("click",()=>t.hidePopover());let e=S("export","Copy, downloa\
d, reset",void 0);e.popoverTargetElement=t;let s=[this.#s,this.#o,this.#n];m("tools").append(...s,this.#e,
e,this.#r.button),document.body.append(t,this.#r.table);let n=f("b",{"aria-hidden":"true"},"+"),r=f(
"button",{className:"keep",title:"Keep this pose",onclick:()=>this.#y()});r.append(n,"Keep pose"),m(
"dock").prepend(r,this.film.element),this.data.poses[0].length&&(m("hint").textContent="Drag a pin.");
let a=Array.from({length:this.#b},(h,c)=>this.#A(c));document.documentElement.style.setProperty("--c\
olors",a.join())}#m(){let{data:t,editing:e,report:s}=this,n=(o,r)=>f("button",{onclick:r},o);return[
n("Copy the pose as Python",async()=>s.say(await le(t,e))),n("Download the picture",()=>{ue(t,this.stage,
this.shown),this.redraw()}),n("Download the map and its proof",async()=>{this.film.release(),s.say(await fe(
t,e))}),n("Fit the window",()=>this.fit()),n("Back to the undeformed shape",()=>this.#c())]}#l(){this.#e.
addEventListener("change",()=>{this.#T(),this.redraw()});let t=n=>{!this.film.seen||n.button===1||(this.
film.release(),n.stopImmediatePropagation(),n.preventDefault())};this.#t.addEventListener("pointerdo\
wn",t,{capture:!0}),document.addEventListener("keydown",n=>this.#p(n));let{dataset:e}=this.#t;document.
addEventListener("keydown",()=>Object.assign(e,{keys:""}),!0),document.addEventListener("pointerdown",
()=>delete e.keys,!0),new ResizeObserver(()=>this.fit()).observe(this.#t),matchMedia("(prefers-color\
-scheme: dark)").addEventListener("change",()=>this.report.draw())}#p(t){let e=t.target;if(this.#t.contains(
e)||t.key==="Tab")return;let s=e.matches("input, select")&&!J(t),n=e.matches("button")&&/^(Enter| )$/.
test(t.key);if(!(s||n)){if(t.key!==" "){this.pad.keydown(t);return}t.preventDefault(),this.film.playOrPause()}}#u(t){
this.film.release(),this.pad.press(t)}#c(){this.film.release(),this.editing.replace([],U(this.data.outline))}#y(){
this.film.release();let{pins:t,frame:e}=this.editing;this.film.keep({pins:t,frame:e}),this.report.tell(
`Pose ${this.film.kept.length} is kept`),m("hint").hidden=!0}get shown(){return this.#h??this.editing.
frame}fit(){let t=B(this.#t),e=this.shown.images??[];Object.assign(this.view,t.size,D(e,t,this.data.
margin)),this.report.draw(),this.redraw()}redraw(){this.#a(),!this.#i&&(this.#i=requestAnimationFrame(
()=>{this.#i=0,this.#f&&this.#w(),this.film.drawOne();let{width:t,height:e,unit:s,x:n,y:o}=this.view,
r={width:t,height:e,unit:s,x:n,y:o};this.stage.paint(this.shown,r,this.#e.value,this.#g),document.documentElement.
dataset.drawn=String(this.shown.id)}))}get#g(){return this.pad.held.size>0||this.film.playing||!this.
editing.settled}#x(t){this.#h=t,this.report.proved(this.shown),this.redraw()}#E(t){let e={width:Re,height:Re},
s={...e,left:0,top:0,size:e},n=D(t.images??[],s,this.data.margin);return this.stage.paint(t,{...e,...n},
Vs),this.stage.canvas}#v(t){let{editing:e,pad:s,hand:n,view:o}=this;if(this.#h)return;let r=s.focused?
n.cursorAt:null,{marks:a}=e;ee(t,o,a,{hovered:s.found?.mark,held:s.held,cursor:r}),Ae(t,o,a,e.missed,
e.refused),s.encloses&&s.path.length>2&&te(t,o,s.path)}#w(){let{editing:t,report:e}=this;this.#f=!1,
this.#s.disabled=!t.canUndo,this.#o.disabled=!t.canRedo,this.#n.disabled=t.selected.length===0,t.canUndo&&
(m("hint").hidden=!0),e.draw(),e.proved(this.shown),e.pins(t),document.documentElement.dataset.settled=
String(t.settled)}get#b(){return this.data.colors.length/3}#A(t){return`rgb(${this.data.colors.slice(
3*t,3*t+3).map(s=>Math.round(255*s))})`}#T(){let{value:t}=this.#e,e=this.data.ranges[t],s=m("legend");
s.hidden=!e,e&&s.replaceChildren(`${Le[t]} ${e[0]}`,f("i"),`${e[1]}`)}};var ht=class{#t;#e=0;#s=new Map;constructor(t,e=()=>{}){this.#t=t,this.onmap=e,t.onmessage=({data:s})=>this.#n(
s)}ask(t){let e=this.#o(t);return new Promise((s,n)=>this.#s.set(e,{resolve:s,reject:n}))}async map(t){
let e=await this.ask(t);if(e.type!=="map")throw new Error(`the answer is no map but of type ${e.type}`);
return e}drag(t){return this.#o({type:"drag",pose:t})}place(t,e){return this.#o({type:"place",pose:t,
coefficients:e})}#o(t){return this.#e+=1,this.#t.postMessage({...t,id:this.#e}),this.#e}#n(t){let e=this.#s.
get(t.id);t.type==="map"&&this.onmap(t),!(t.type==="map"&&!t.settled)&&(this.#s.delete(t.id),t.type===
"failed"?e?.reject(new Error(t.message)):e?.resolve(t))}};function Pe(i){let t=i.toSorted((e,s)=>e-s);return t[Math.floor(t.length/2)]}function _e(i){return i<=
4}function St(i){return i<=8}function Ie(i,t){return t&&i>16?.5:1}function Ne(i,t,e){return t+e<i?"m\
odule":"shader"}var ct=1,Xs=2,Ys=5,lt=class{mover="shader";frameTime=0;#t;#e;#s;#o;#n;constructor(t,e,s,n,o){this.canvas=
t,this.#t=e,this.#e=s,this.#s=n,this.#o=new rt(s.outline,s),this.mover=s.vertex?"shader":"module",this.
mesh=n,this.#n=this.#r(ct),this.#n.setPicture(o)}#r(t){let{vertex:e,painting:s,fragment:n,frame:o,colors:r,
grid:a,ranges:h}=this.#e,c=this.mover==="shader",l={vertex:c?e:s,fragment:n,frame:o,colors:r,grid:a,
ranges:h},u=ft(this.#s,t),d=c?this.#o.cage:new Float32Array;return this.mesh=u,new G(this.canvas,this.#t,
l,u,d)}async choose(t,e){let s=o=>t.map({type:"points",points:dt(o)}),n=await s(this.#s);if(this.mover===
"shader"){let o=this.#i(n,e);if(_e(o)&&this.#h(n,e),St(o))return n;this.mover="module",this.#n=this.#r(
ct),n=await s(this.mesh);let r=this.#i(n,e);return Ne(o,r,n.evaluated)==="module"?n:(this.mover="sha\
der",this.frameTime=o,this.#n=this.#r(ct),s(this.#s))}return s(this.mesh)}#h(t,e){this.#n=this.#r(Xs),
!St(this.#i(t,e))&&(this.#n=this.#r(ct))}#i(t,e){let s=this.#t,n=new Uint8Array(4),o=Array.from({length:Ys},
()=>{let r=performance.now();return this.paint(t,e,"0"),s.readPixels(0,0,1,1,s.RGBA,s.UNSIGNED_BYTE,
n),performance.now()-r});return this.frameTime=Pe(o),this.frameTime}paint(t,e,s,n=!1){let o=this.mover===
"shader"?this.#o.of(t.coefficients):Se(t),r=Ie(this.frameTime,n);this.#n.draw({...e,overlay:s,coefficients:o,
heights:null,sharpness:r})}get points(){return dt(this.mover==="shader"?this.#s:this.mesh)}};var Ce=Reflect.get(globalThis,"glidPage"),{data:y,worker:qs}=Ce;async function Fe(){let i=URL.createObjectURL(
new Blob([qs],{type:"text/javascript"})),t=new Worker(i);URL.revokeObjectURL(i);let e=new ht(t),{outline:s,
options:n,start:o,poses:r}=y;await e.ask({type:"shape",outline:s,options:n});let a=o.length?Float64Array.
from(o):U(s);return await e.map({type:"place",pose:x(r[0]),coefficients:a}),e}async function Zs(){let i=await L(
y.source,2),t=await L(y.heights,1),e=await Pt(y.triangles);return{source:i,heights:t,triangles:e}}async function Js(){
let i=V("source",HTMLImageElement);return await i.decode().catch(()=>{throw new E("The picture in th\
is page is damaged.")}),i}function Qs(i){let t=i.getContext("webgl2",{antialias:!0,premultipliedAlpha:!0,
preserveDrawingBuffer:!0});if(!t)throw new E("This page needs WebGL 2 and a browser of 2023 or later\
.");return t}async function tn({coefficients:i,width:t,times:e,keyframes:s,repeat:n,sigma2:o}){let r=await Rt(
i,t),a=y.outline.hole_points.length,h=e.map((c,l)=>({coefficients:Oe(r.subarray(l*t,(l+1)*t),a),sigma2:Math.
min(o[l-1]??1/0,o[l]??1/0)}));return{times:e,knots:h,keyframes:s,repeat:n}}async function en(){let i=V(
"picture",HTMLCanvasElement),t=Qs(i),[e,s,n]=await Promise.all([Fe(),Zs(),Js()]),o=new $(()=>{},{nearest:1e-4,
farthest:1});Object.assign(o,B(m("pad")).size),Object.assign(o,D(s.source,B(m("pad")),y.margin));let r=new lt(
i,t,y,s,n),a=await r.choose(e,o),h=new j(e,s,a,U(y.outline)),c=new at(y,{stage:r,editing:h,view:o},async()=>{
let u=await Fe();return await u.map({type:"points",points:r.points}),u});h.begin(y.poses[0]),y.motion&&
await c.film.load(await tn(y.motion),y.poses),Object.assign(Ce,{view:o,editing:h});let{dataset:l}=document.
documentElement;l.mover=r.mover,l.frame=r.frameTime.toFixed(1),l.ready="true"}en().catch(i=>{let t=m(
"problem");if(t.textContent=i.message,t.hidden=!1,!(i instanceof E))throw i});})();
