"use strict";(()=>{function m(t){return Uint8Array.from(atob(t),e=>e.charCodeAt(0)).buffer}function u(t,e){return t.reduce((o,{values:r},s)=>o*r.length+e[s],0)}function i({lines:t,frames:e},o){
return e[o].map(r=>t[r]).join(`
`)}function p({controls:t,titles:e},o){let r=t.map(({name:a,values:n},c)=>`${a} = ${n[o[c]]}`),s=e[u(
t,o)];return r.join(", ")+(s&&`: ${s}`)}function g({name:t,values:e,start:o,check:r},s){let a=document.createElement("label"),n=document.createElement(
"input"),c=document.createElement("output"),f=l=>{c.textContent=e[l],r||n.setAttribute("aria-valuete\
xt",e[l])};return r?Object.assign(n,{type:"checkbox",checked:o===1}):(Object.assign(n,{type:"range",
min:"0",max:`${e.length-1}`}),n.value=`${o}`),n.setAttribute("aria-label",t),n.addEventListener("inp\
ut",()=>{let l=r?Number(n.checked):n.valueAsNumber;f(l),s(l)}),f(o),a.append(t,n),r||a.append(c),a}function d(t,e){
let o=t.querySelector("img"),r=e.controls.map(({start:n})=>n),s=()=>{let n=i(e,u(e.controls,r));o.src=
`data:image/svg+xml,${encodeURIComponent(n)}`,o.alt=p(e,r)},a=e.controls.map((n,c)=>g(n,f=>{r[c]=f,s()}));
s(),t.prepend(...a)}function w(t){let e=new Blob([m(t)]).stream();return new Response(e.pipeThrough(new DecompressionStream(
"deflate"))).json()}var h=document.querySelectorAll("figure.glid-frames[data-frames]");if(window.DecompressionStream)
for(let t of h){let e=t.dataset.frames;delete t.dataset.frames,w(e).then(o=>d(t,o))}})();
