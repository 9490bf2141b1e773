"use strict";(()=>{function b(e){return Uint8Array.from(atob(e),n=>n.charCodeAt(0)).buffer}function $(e,n){return e.reduce((o,{values:r},a)=>o*r.length+n[a],0)}function v({lines:e,frames:n},o){
return n[o].map(r=>e[r]).join(`
`)}function A({controls:e,titles:n},o){let r=e.map(({name:s,values:t},c)=>`${s} = ${t[o[c]]}`),a=n[$(
e,o)];return r.join(", ")+(a&&`: ${a}`)}function S(e,n){let o=[[]];return e.forEach(({values:r,check:a},s)=>{
let c=(a?[0]:[0,-1,1]).map(i=>n[s]+i).filter(i=>i in r);o=o.flatMap(i=>c.map(l=>[...i,l]))}),o}function O(e,n,o,r){
let a=t=>{let[c,i]=n[$(e,t)];return Math.hypot(c-r[0],i-r[1])},s=o;for(;;){let t=S(e,s).reduce((c,i)=>a(
i)<a(c)?i:c);if(a(t)>=a(s))return s;s=t}}function k(e,n,o){let r=[],a=0;for(let t of e){let c=o*t[2];(!r.length||c>a)&&(r.push([]),a=n),r[r.length-
1].push(t),a-=c}let s=0;return r.flatMap(t=>{let c=(n-t.reduce((l,[,,h])=>l+o*h,0))/2,i=s;return s+=
o*Math.max(...t.map(([,,,l])=>l)),t.map(l=>{let[,,h,f]=l,d={from:l,to:[c,i,o*h,o*f]};return c+=o*h,d})})}
function x(e){return Math.max(...e.map(({to:[,n,,o]})=>n+o))}function E(e,n,o){let r=Math.min(1,n/Math.
max(...e.map(([,,t])=>t))),s=[r,.95,.9,.85,.8,.75].filter(t=>t<=r).map(t=>k(e,n,t));return s.find(t=>x(
t)<=o)??s[s.length-1]}function M(e,n,o,r){let a=e.slice(e.indexOf("<svg")).replace(/ width="[^"]*" height="[^"]*"/,
` id="whole" width="${o[0]}" height="${o[1]}"`),s=x(n),t=n.map(({from:h,to:f})=>{let[d,u,p,m]=f;return`\
<svg ${`x="${d}" y="${u}" width="${p}" height="${m}"`} viewBox="${h.join(" ")}"><use xlink:href="#wh\
ole"/></svg>`}),c='xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"',i=`\
width="${r}" height="${s}" viewBox="0 0 ${r} ${s}"`;return`<svg ${c} ${i}><defs>${a}</defs><rect wid\
th="100%" height="100%" fill="white"/>${t.join("")}</svg>`}function C(e,n,o,r){let[{from:a,to:s}]=n,
[t,c]=[s[2]/a[2],x(n)];return e.map(([i,l])=>{let[h,f]=[i*o[0]-a[0],l*o[1]-a[1]];return[(s[0]+t*h)/r,
(s[1]+t*f)/c]})}var N=matchMedia("(max-width: 600px)"),I=.7;function L({name:e,values:n,start:o,check:r},a){let s=document.
createElement("label"),t=document.createElement("input"),c=document.createElement("output"),i=l=>{c.
textContent=n[l],r?t.checked=l===1:(t.value=`${l}`,t.setAttribute("aria-valuetext",n[l]))};return r?
t.type="checkbox":Object.assign(t,{type:"range",min:"0",max:`${n.length-1}`}),t.setAttribute("aria-l\
abel",e),t.addEventListener("input",()=>{a(r?Number(t.checked):t.valueAsNumber)}),i(o),s.append(e,t),
r||s.append(c),{row:s,show:i}}function W(e,n){let o=document.createElement("div"),r=document.createElement(
"div");o.className="glid-stage",r.className="glid-ring",r.setAttribute("aria-hidden","true"),e.replaceWith(
o),o.append(e,r);let a=[0,0];return r.addEventListener("pointerdown",s=>{if(s.button!==0)return;s.preventDefault();
let{left:t,top:c,width:i,height:l}=r.getBoundingClientRect();a=[t+i/2-s.clientX,c+l/2-s.clientY],r.setPointerCapture(
s.pointerId)}),r.addEventListener("pointermove",s=>{if(!r.hasPointerCapture(s.pointerId))return;let{
left:t,top:c,width:i,height:l}=e.getBoundingClientRect();n([s.clientX+a[0]-t,s.clientY+a[1]-c],[i,l])}),
r}function R({parts:e},n){return!e?.length||!N.matches||!n?null:E(e,n,I*innerHeight)}function j(e,n){
let{controls:o,points:r}=n,a=e.querySelector("img"),s=[Number(a.getAttribute("width")),Number(a.getAttribute(
"height"))],t=o.map(({start:u})=>u),c=e.clientWidth,i=R(n,c),l=o.map((u,p)=>L(u,m=>d(t.with(p,m)))),
h=()=>{let u=r??[];return i?C(u,i,s,c):u},f=r&&W(a,(u,[p,m])=>{let y=h().map(([w,B])=>[p*w,m*B]),g=O(
o,y,t,u);g!==t&&d(g)});function d(u){t=u;let p=$(o,t),m=v(n,p),y=i?M(m,i,s,c):m;if(a.src=`data:image\
/svg+xml,${encodeURIComponent(y)}`,a.alt=A(n,t),[a.width,a.height]=i?[c,Math.round(x(i))]:s,l.forEach(
(g,w)=>{g.show(t[w])}),f){let[g,w]=h()[p];Object.assign(f.style,{left:`${100*g}%`,top:`${100*w}%`})}}
d(t),e.prepend(...l.map(({row:u})=>u)),new ResizeObserver(()=>{e.clientWidth!==c&&(c=e.clientWidth,i=
R(n,c),d(t))}).observe(e)}function D(e){let n=new Blob([b(e)]).stream();return new Response(n.pipeThrough(new DecompressionStream(
"deflate"))).json()}var T=document.querySelectorAll("figure.glid-frames[data-frames]");if(window.DecompressionStream)
for(let e of T){let n=e.dataset.frames;delete e.dataset.frames,D(n).then(o=>j(e,o))}})();
