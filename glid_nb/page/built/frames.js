"use strict";(()=>{function g(n){return Uint8Array.from(atob(n),r=>r.charCodeAt(0)).buffer}function d(n,r){return n.reduce((o,{values:e},c)=>o*e.length+r[c],0)}function h({lines:n,frames:r},o){
return r[o].map(e=>n[e]).join(`
`)}function w({controls:n,titles:r},o){let e=n.map(({name:t,values:a},l)=>`${t} = ${a[o[l]]}`),c=r[d(
n,o)];return e.join(", ")+(c&&`: ${c}`)}function E(n,r){let o=[[]];return n.forEach(({values:e,check:c},t)=>{
let l=(c?[0]:[0,-1,1]).map(s=>r[t]+s).filter(s=>s in e);o=o.flatMap(s=>l.map(i=>[...s,i]))}),o}function y(n,r,o,e){
let c=a=>{let[l,s]=r[d(n,a)];return Math.hypot(l-e[0],s-e[1])},t=o;for(;;){let a=E(n,t).reduce((l,s)=>c(
s)<c(l)?s:l);if(c(a)>=c(t))return t;t=a}}function O({name:n,values:r,start:o,check:e},c){let t=document.createElement("label"),a=document.createElement(
"input"),l=document.createElement("output"),s=i=>{l.textContent=r[i],e?a.checked=i===1:(a.value=`${i}`,
a.setAttribute("aria-valuetext",r[i]))};return e?a.type="checkbox":Object.assign(a,{type:"range",min:"\
0",max:`${r.length-1}`}),a.setAttribute("aria-label",n),a.addEventListener("input",()=>{c(e?Number(a.
checked):a.valueAsNumber)}),s(o),t.append(n,a),e||t.append(l),{row:t,show:s}}function C(n,r){let o=document.
createElement("div"),e=document.createElement("div");o.className="glid-stage",e.className="glid-ring",
e.setAttribute("aria-hidden","true"),n.replaceWith(o),o.append(n,e);let c=[0,0];return e.addEventListener(
"pointerdown",t=>{if(t.button!==0)return;t.preventDefault();let{left:a,top:l,width:s,height:i}=e.getBoundingClientRect();
c=[a+s/2-t.clientX,l+i/2-t.clientY],e.setPointerCapture(t.pointerId)}),e.addEventListener("pointermo\
ve",t=>{if(!e.hasPointerCapture(t.pointerId))return;let{left:a,top:l,width:s,height:i}=n.getBoundingClientRect();
r([t.clientX+c[0]-a,t.clientY+c[1]-l],[s,i])}),e}function b(n,r){let{controls:o,points:e}=r,c=n.querySelector(
"img"),t=o.map(({start:i})=>i),a=o.map((i,u)=>O(i,f=>s(t.with(u,f)))),l=e&&C(c,(i,[u,f])=>{let p=e.map(
([x,A])=>[u*x,f*A]),m=y(o,p,t,i);m!==t&&s(m)});function s(i){t=i;let u=d(o,t);if(c.src=`data:image/s\
vg+xml,${encodeURIComponent(h(r,u))}`,c.alt=w(r,t),a.forEach((f,p)=>{f.show(t[p])}),e&&l){let[f,p]=e[u];
Object.assign(l.style,{left:`${100*f}%`,top:`${100*p}%`})}}s(t),n.prepend(...a.map(({row:i})=>i))}function $(n){let r=new Blob([g(n)]).stream();return new Response(r.pipeThrough(new DecompressionStream(
"deflate"))).json()}var v=document.querySelectorAll("figure.glid-frames[data-frames]");if(window.DecompressionStream)
for(let n of v){let r=n.dataset.frames;delete n.dataset.frames,$(r).then(o=>b(n,o))}})();
