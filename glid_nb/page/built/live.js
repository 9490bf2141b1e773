"use strict";(()=>{var nt=.6931471803691238,et=19082149292705877e-26,fs=0x40000000000000,us=.6666666666666735,ms=.3999999999940942,
ps=.2857142874366239,gs=.22222198432149784,ds=.1818357216161805,ws=.15313837699209373,ys=.14798198605116586,
Ms=.3333333333333293,As=-.19999999999876483,Fs=.14285714272503466,xs=-.11111110405462356,bs=.09090887133436507,
vs=-.0769187620504483,Os=.06661073137387531,Is=-.058335701337905735,Ts=.049768779946159324,Es=-.036531572744216916,
Rs=.016285820115365782,It=[.4636476090008061,.7853981633974483,.982793723247329,1.5707963267948966],
Tt=[22698777452961687e-33,3061616997868383e-32,13903311031230998e-33,6123233995736766e-32],Ss=1862645149230957e-24,
qs=7378697629483821e4,Ot=12246467991473532e-32,Y=new Float64Array(1),W=new Int32Array(Y.buffer);Y[0]=
1;var ot=W[1]===0?0:1;function A(r,t){return Math.sqrt(r*r+t*t)}function rt(r){if(!(r>0)||r===1/0)return Gs(
r);let t=r<22250738585072014e-324;Y[0]=t?r*fs:r;let s=(W[ot]>>20)-1023-(t?54:0),n=W[ot]&1048575,e=n+
614244&1048576;return W[ot]=n|e^1072693248,Ns(s+(e>>20),Y[0]-1,n)}function Gs(r){return r===0?-1/0:r===
1/0?1/0:NaN}function Ns(r,t,s){if((1048575&2+s)<3){let l=t*t*(.5-.3333333333333333*t);return r*nt-(l-
r*et-t)}let n=t/(2+t),e=n*n,o=e*e,i=o*(ms+o*(gs+o*ws)),a=e*(us+o*(ps+o*(ds+o*ys)))+i;if((s-398458|440401-
s)>0){let l=.5*t*t;return r*nt-(l-(n*(l+a)+r*et)-t)}return r*nt-(n*(t-a)-r*et-t)}function J(r,t){if(!Number.
isFinite(t)||!Number.isFinite(r))return NaN;let s=r===0?0:_s(Math.abs(r/t));return t>=0?r<0?-s:s:r<0?
s-Ot-Math.PI:Math.PI-(s-Ot)}function _s(r){return r<.4375?r<Ss?r:r-r*Et(r):r>=qs?It[3]+Tt[3]:r<.6875?
C(0,(2*r-1)/(2+r)):r<1.1875?C(1,(r-1)/(r+1)):r<2.4375?C(2,(r-1.5)/(1+1.5*r)):C(3,-1/r)}function C(r,t){
return It[r]-(t*Et(t)-Tt[r]-t)}function Et(r){let t=r*r,s=t*t,n=t*(Ms+s*(Fs+s*(bs+s*(Os+s*(Ts+s*Rs))))),
e=s*(As+s*(xs+s*(vs+s*(Is+s*Es))));return n+e}var K=class{constructor(t){let s=[t.offset_cage,...t.offset_holes];this.cage=[t.cage,...t.holes],this.
singular=D([...s.flat(),...t.hole_points]),this.exterior=t.offset_cage.length,this.holes=t.hole_points.
length,this.vertices=s.flat().length,this.columns=this.vertices+this.holes;let{next:n,previous:e}=js(
s.map(c=>c.length));this.next=n,this.previous=e;let{edge:o,inverse:i}=Ps(this.singular,n);this.edge=
o,this.inverseEdge=i,this.largest=Us(this.singular,this.exterior),this.unit=Ds(t.cage)/20,this.free=
Ls(s.map(c=>c.length))}};function D(r){return{re:Float64Array.from(r,t=>t[0]),im:Float64Array.from(r,
t=>t[1])}}function M(r){return{re:new Float64Array(r),im:new Float64Array(r)}}function js(r){let t=r.
reduce((o,i)=>o+i,0),s=new Int32Array(t),n=new Int32Array(t),e=0;for(let o of r){for(let i=0;i<o;i++){
let c=e+(i+1)%o;s[e+i]=c,n[c]=e+i}e+=o}return{next:s,previous:n}}function Ls(r){let t=[],s=0;for(let[
n,e]of r.entries()){for(let o=n===0?1:2;o<e;o++)t.push(s+o);s+=e}return Int32Array.from(t)}function Ps(r,t){
let s=M(t.length),n=M(t.length);for(let e=0;e<t.length;e++){let o=r.re[t[e]]-r.re[e],i=r.im[t[e]]-r.
im[e],c=o*o+i*i;s.re[e]=o,s.im[e]=i,n.re[e]=o/c,n.im[e]=-i/c}return{edge:s,inverse:n}}function Us(r,t){
let s=0;for(let n=0;n<t;n++)s=Math.max(s,A(r.re[n],r.im[n]));return s}function Ds(r){let t=[0,1].map(
s=>{let n=r.map(e=>e[s]);return Math.max(...n)-Math.min(...n)});return Math.max(...t)}var T=11102230246251565e-32,x=1+9313225746154785e-25,Rt=64*T,St=64*T,zs=16*T,it=16*T,Bs=1.25,Hs=1e-140;
function ct(r,t,s,n){let e=(3*r+128)*T*t*s,o=zs/Math.PI*n;return Bs*x*(e+o)+Hs}var qt=2*Math.PI,ks=1e20;function N(r,t){let s=t.re.length,{columns:n}=r,e={count:s,columns:n,...M(s*
n),norms:new Float64Array(s)};for(let o=0;o<s;o++)e.norms[o]=_(r,t.re[o],t.im[o],e,o*n);return e}function _(r,t,s,n,e){
let{vertices:o,columns:i,next:c,singular:a}=r,l=!0;for(let f=0;f<o;f++){let u=c[f],m=a.re[f]-t,p=a.im[f]-
s,g=a.re[u]-t,d=a.im[u]-s,w=J(m*d-p*g,m*g+p*d)/qt;n.re[e+f]=w,n.im[e+f]=-rt((g*g+d*d)/(m*m+p*p))/(2*
qt),l=l&&Math.abs(w)<.5-Rt}for(let f=o;f<i;f++){let u=t-a.re[f],m=s-a.im[f],p=u*u+m*m;n.re[e+f]=u/p,
n.im[e+f]=-m/p}let h=x*Math.sqrt(Cs(n,e,i));return l&&h<ks?h:1/0}function Cs(r,t,s){let n=0;for(let e=t;e<
t+s;e++)n+=r.re[e]*r.re[e]+r.im[e]*r.im[e];return n}function j(r,[t,s]){let{vertices:n,columns:e,next:o,
previous:i,singular:c}=r,a=M(e);_(r,t,s,a,0);let l=_t(r,a),h=M(e);for(let f=0;f<n;f++){let u=i[f],m=c.
re[o[f]]-t,p=c.im[o[f]]-s,g=c.re[u]-t,d=c.im[u]-s;h.re[f]=m*l.re[f]-p*l.im[f]-(g*l.re[u]-d*l.im[u]),
h.im[f]=m*l.im[f]+p*l.re[f]-(g*l.im[u]+d*l.re[u])}for(let f=n;f<e;f++)h.re[f]=rt(A(t-c.re[f],s-c.im[f]));
return h}function V(r,t,s){let{vertices:n,columns:e,previous:o}=r,i=s+e,c={re:t.re.subarray(s,i),im:t.
im.subarray(s,i)},a=_t(r,c),l={re:Float64Array.from(c.re),im:Float64Array.from(c.im)};for(let h=0;h<
n;h++)l.re[h]=a.re[o[h]]-a.re[h],l.im[h]=a.im[o[h]]-a.im[h];return l}function _t({vertices:r,inverseEdge:t},s){
let n=M(r);for(let e=0;e<r;e++)n.re[e]=s.re[e]*t.re[e]-s.im[e]*t.im[e],n.im[e]=s.re[e]*t.im[e]+s.im[e]*
t.re[e];return n}function S(r,t){let{vertices:s,columns:n,next:e,edge:o}=r,i=new Float64Array(4*n);for(let c of[
0,2*n]){let a=t.subarray(c,c+n),l=t.subarray(c+n,c+2*n);for(let h=0;h<s;h++){let f=a[e[h]]-a[h],u=l[e[h]]-
l[h],m=o.re[h],p=o.im[h],g=m*m+p*p;i[c+h]=(f*m+u*p)/g,i[c+n+h]=(u*m-f*p)/g}for(let h=s;h<n;h++)i[c+h]=
a[h],i[c+n+h]=l[h]}return i}function jt(r,t){let{vertices:s,columns:n,next:e,inverseEdge:o}=r,i=new Float64Array(
4*n);for(let c of[0,2*n]){let a=c+n;for(let l=0;l<s;l++){let h=t[c+l]*o.re[l]+t[a+l]*o.im[l],f=t[a+l]*
o.re[l]-t[c+l]*o.im[l];i[c+e[l]]+=h,i[a+e[l]]+=f,i[c+l]-=h,i[a+l]-=f}for(let l=s;l<n;l++)i[c+l]=t[c+
l],i[a+l]=t[a+l]}return i}function E(r,t){let s=new Float64Array(4*r.count),[n,e,o,i]=F(t),[c,a,l,h]=F(
s);return Gt(r,n,e,c,a),Gt(r,o,i,l,h),s}function Gt(r,t,s,n,e){let{count:o,columns:i}=r,c=r.re,a=r.im;
for(let l=0;l<o;l+=2){let h=Math.min(l+1,o-1),f=l*i,u=h*i,m=0,p=0,g=0,d=0;for(let w=0;w<i;w++){let y=c[f+
w],b=a[f+w],O=c[u+w],I=a[u+w],q=t[w],G=s[w];m+=y*q-b*G,p+=y*G+b*q,g+=O*q-I*G,d+=O*G+I*q}n[l]=m,e[l]=
p,n[h]=g,e[h]=d}}function Lt(r,t){let s=new Float64Array(4*r.columns),[n,e,o,i]=F(s),[c,a,l,h]=F(t);
return Nt(r,c,a,n,e),Nt(r,l,h,o,i),s}function Nt(r,t,s,n,e){let{count:o,columns:i}=r,c=r.re,a=r.im;for(let l=0;l<
o;l+=2){let h=l+1<o,f=l*i,u=h?f+i:f,m=t[l],p=s[l],g=h?t[l+1]:0,d=h?s[l+1]:0;for(let w=0;w<i;w++){let y=c[f+
w],b=a[f+w],O=c[u+w],I=a[u+w];n[w]+=y*m+b*p+(O*g+I*d),e[w]+=y*p-b*m+(O*d-I*g)}}}function F(r){let t=r.
length/4;return[r.subarray(0,t),r.subarray(t,2*t),r.subarray(2*t,3*t),r.subarray(3*t)]}var L=class{#t;#s;#n;constructor(t,s){let{columns:n}=t;this.#t=t,this.count=s.length,this.#s=M(s.length*
n);for(let[e,o]of s.entries()){let i=j(t,o);this.#s.re.set(i.re,e*n),this.#s.im.set(i.im,e*n)}this.#n=
N(t,D(s))}evaluate(t){let s=S(this.#t,t);return{images:Ws(this.#s,this.count,t),samples:E(this.#n,s)}}};
function Ws({re:r,im:t},s,n){let e=new Float64Array(2*s),o=n.length/4,[i,c,a,l]=F(n),h={re:i.map((u,m)=>u+
a[m]),im:c.map((u,m)=>u+l[m])},f={re:i.map((u,m)=>u-a[m]),im:c.map((u,m)=>u-l[m])};for(let u=0;u<s;u++){
let m=u*o,p=0,g=0;for(let d=0;d<o;d++)p+=r[m+d]*h.re[d]-t[m+d]*h.im[d],g+=r[m+d]*f.im[d]+t[m+d]*f.re[d];
e[2*u]=p,e[2*u+1]=g}return e}var Ys=48;function Pt(r){let t=[],s=[];for(let[l,h]of r.cage.entries()){for(let[f,u]of h.entries())lt(
r,u,h[(f+1)%h.length],0,t);for(;s.length<t.length;)s.push(l)}let n=t.length,e=Ks(s),o=Vs(t,e),i=Qs(t,
e),c=r.cage.length,a=Xs(i,e);return{count:n,loops:c,next:e,loop:Int32Array.from(s),nodes:o,lengths:i,
weights:a}}function Ut(r){return r.cage.flatMap(t=>t.map((s,n)=>{let e=[];return at(r,s,t[(n+1)%t.length],
0,0,e),e}))}function at(r,t,s,n,e,o){if(Dt(r,t,s,e)){o.push([n,e]);return}let i=ht(t,s);at(r,t,i,2*n,
e+1,o),at(r,i,s,2*n+1,e+1,o)}function Dt(r,t,s,n){let e=A(s[0]-t[0],s[1]-t[1]);return n===Ys||e<=Js(
r,t,s)}function lt(r,t,s,n,e){if(Dt(r,t,s,n)){e.push(t);return}let o=ht(t,s);lt(r,t,o,n+1,e),lt(r,o,
s,n+1,e)}function ht(r,t){return[(r[0]+t[0])/2,(r[1]+t[1])/2]}function Js(r,t,s){let n=1/0;for(let e=0;e<
r.columns;e++)n=Math.min(n,ft(r.singular,e,t[0],t[1],s[0],s[1]));return n}function ft(r,t,s,n,e,o){let i=e-
s,c=o-n,a=r.re[t]-s,l=r.im[t]-n,h=i*i+c*c,f=(a*i+l*c)/(h>0?h:1),u=Math.min(1,Math.max(0,f));return A(
a-u*i,l-u*c)}function Ks(r){let t=new Int32Array(r.length),s=0;for(let n=0;n<r.length;n++)r[n]!==r[s]&&
(s=n),t[n]=r[n+1]===r[n]?n+1:s;return t}function Vs(r,t){let s=r.length,n=M(2*s);for(let[e,o]of r.entries()){
let i=ht(o,r[t[e]]);n.re[e]=o[0],n.im[e]=o[1],n.re[s+e]=i[0],n.im[s+e]=i[1]}return n}function Qs(r,t){
let s=Float64Array.from(r,(e,o)=>{let i=r[t[o]];return A(i[0]-e[0],i[1]-e[1])}),n=s.reduce((e,o)=>e+
o,0);return s.map(e=>e/n)}function Xs(r,t){let s=r.length,n=new Float64Array(2*s);for(let e=0;e<s;e++)
n[e]+=r[e]/6,n[t[e]]+=r[e]/6,n[s+e]=4*r[e]/6;return n}var Wt=2*Math.PI,Zs=Math.sqrt(3)/216,$s=4,P=class{#t;#s;#n;constructor(t,s,n){this.domain=t,this.panels=
s,this.rows=n;let{columns:e}=t;this.#t=new Float64Array(s.count*e),this.#s=new Float64Array(e),this.#n=
M(e);let{re:o,im:i}=s.nodes;for(let c=0;c<s.count;c++){let a=s.next[c];Bt(t,o[c],i[c],o[a],i[a],this.#t,
c*e)}}certify(t){return this.prove(t).certificate}prove(t){let s=new ut(this.domain,t),n=E(this.rows,
s.slopes);return{certificate:this.#e(s,F(n)),samples:n}}#e(t,s){let{panels:n}=this,e=new Float64Array(
n.loops),o={sigma2_lower:1/0,sigma1_upper:0,k_upper:0,halved:0,refused:-1};for(let h=0;h<n.count;h++){
let f=this.#r(t,s,h,o);if(o.sigma2_lower=Math.min(o.sigma2_lower,f.sigma2),o.sigma1_upper=Math.max(o.
sigma1_upper,f.sigma1),o.k_upper=Math.max(o.k_upper,f.k),e[n.loop[h]]+=f.turning,!(f.sigma2>0)){o.refused=
h;break}}let i=Array.from(e,h=>Math.round(h/Wt)+0),c=i.reduce((h,f)=>h+f,0),a=t.tied&&o.refused<0&&c===
0,l=a?Math.min(o.k_upper,1):o.k_upper;return{certified:a,...o,k_upper:l,windings:i}}#r(t,s,n,e){let{
panels:o}=this,i=this.#i(s,n),c=this.#i(s,o.count+n),a=this.#i(s,o.next[n]);return this.#c(t,i,c,a,this.#t,
n*t.columns,0,e)}#i([t,s,n,e],o){let{re:i,im:c}=this.panels.nodes,a=this.rows.norms[o];return{x:i[o],
y:c[o],norm:a,fr:t[o],fi:s[o],gr:n[o],gi:e[o]}}#c(t,s,n,e,o,i,c,a){let l=Math.max(s.norm,n.norm,e.norm),
[h,f]=t.errors(o,i,l),u=sn(s,n,e,h,f);if(u.sigma2>0)return u;let m=!(A(s.fr,s.fi)>A(s.gr,s.gi));if(c===
$s||m)return u;a.halved++;let p=this.#o(t,s,n,c,a);if(!(p.sigma2>0))return p;let g=this.#o(t,n,e,c,a);
return{sigma2:Math.min(p.sigma2,g.sigma2),sigma1:Math.max(p.sigma1,g.sigma1),k:Math.max(p.k,g.k),turning:p.
turning+g.turning}}#o(t,s,n,e,o){let i=this.#s,c=this.#a(t,(s.x+n.x)/2,(s.y+n.y)/2);return Bt(this.domain,
s.x,s.y,n.x,n.y,i,0),this.#c(t,s,c,n,i,0,e+1,o)}#a(t,s,n){let e=_(this.domain,s,n,this.#n,0),o=Float64Array.
of(e),i={count:1,columns:t.columns,...this.#n,norms:o},[c,a,l,h]=E(i,t.slopes);return{x:s,y:n,norm:e,
fr:c,fi:a,gr:l,gi:h}}},ut=class{constructor(t,s){let{vertices:n,columns:e}=t;this.columns=e,this.tied=
tn(s,n,e),this.slopes=S(t,s);let[o,i,c,a]=F(this.slopes);this.f=zt(t,o,i),this.g=zt(t,c,a)}errors(t,s,n){
let e=0,o=0;for(let l=0;l<this.columns;l++)e+=t[s+l]*this.f.jumps[l],o+=t[s+l]*this.g.jumps[l];let{f:i,
g:c,columns:a}=this;return[x*(e+ct(a,n,i.norm,i.sum)),x*(o+ct(a,n,c.norm,c.sum))]}};function tn(r,t,s){
let[n,e,o,i]=F(r),c=!0;for(let a=t;a<s;a++)c=c&&n[a]===o[a]&&e[a]===-i[a];return c}function zt({vertices:r,
columns:t,previous:s},n,e){let o=new Float64Array(t),i=0,c=0;for(let a=0;a<t;a++){let l=A(n[a],e[a]);
if(i+=l*l,a<r){let h=s[a],f=32*T*(l+A(n[h],e[h]));o[a]=A(n[h]-n[a],e[h]-e[a])+f,c+=l}else o[a]=l}return{
jumps:o,norm:x*Math.sqrt(i),sum:c}}function Bt(r,t,s,n,e,o,i){let c=St*r.largest,a=A(n-t,e-s);for(let l=0;l<
r.columns;l++){let f=ft(r.singular,l,t,s,n,e)*(1-32*T)-32*T*a-c,u=Math.max(f,0),m=(a+2*c)/u,p=x*Zs*m*
m*m,g=x*2*c/u;o[i+l]=l<r.vertices?(2*p+g)/Wt:(6*p+g)/u}}function sn(r,t,s,n,e){let o={fr:2*t.fr-(r.fr+
s.fr)/2,fi:2*t.fi-(r.fi+s.fi)/2,gr:2*t.gr-(r.gr+s.gr)/2,gi:2*t.gi-(r.gi+s.gi)/2},i=kt(r,Ht(r,o),t,n,
e),c=kt(t,Ht(o,s),s,n,e),a=nn(r,o,s,n),l=s.fi*r.fr-s.fr*r.fi;return{sigma2:a?Math.min(i.sigma2,c.sigma2):
-1/0,sigma1:Math.max(i.sigma1,c.sigma1),k:Math.max(i.k,c.k),turning:J(l,s.fr*r.fr+s.fi*r.fi)}}function Ht(r,t){
return{fr:(r.fr+t.fr)/2,fi:(r.fi+t.fi)/2,gr:(r.gr+t.gr)/2,gi:(r.gi+t.gi)/2}}function nn(r,t,s,n){let e=A(
r.fr,r.fi),o=A(s.fr,s.fi),i=r.fr/e+s.fr/o,c=r.fi/e+s.fi/o,a=A(i,c),l=1/0;for(let{fr:h,fi:f}of[r,t,s])
l=Math.min(l,(i*h+c*f)/a);return l>n}function kt(r,t,s,n,e){let o=Ct(r.fr,r.fi,t.fr,t.fi,s.fr,s.fi),
i=Ct(r.gr,r.gi,t.gr,t.gi,s.gr,s.gi),c=x*Math.sqrt(o.most),a=x*Math.sqrt(i.most),l=1/0,h=1/0,f=0;for(let b=0;b<
5;b++){let O=o.coefficients[b]-it*o.most,I=i.coefficients[b]+it*i.most;l=Math.min(l,O-I),h=Math.min(
h,O),f=Math.max(f,I/O)}let u=x*(c+a+n+e);if(!(u*u<1/0&&l>0))return{sigma2:-1/0,sigma1:u,k:1/0};let p=l/
((c+a)*x)-n-e,g=Math.sqrt(h),d=(Math.sqrt(f)*g+e)/(g-n),w=(u-p)/(u+p),y=x*(g>n?Math.min(d,w):w);return{
sigma2:p,sigma1:u,k:y}}function Ct(r,t,s,n,e,o){let i=r*r+t*t,c=s*s+n*n,a=e*e+o*o,l=(r*e+t*o+2*c)/3;
return{coefficients:[i,r*s+t*n,l,s*e+n*o,a],most:Math.max(i,c,a)}}var en=1e-13,Q=class{constructor(t,s,n){this.domain=t,this.k=t.free.length,this.u=1+this.k+t.holes,this.
size=2*this.u+2*this.k,this.t=M(t.columns*this.u);let e=rn(t,s,n),o=an(cn(e,t.free),this.k);this.#t(),
this.#s(o);for(let i=0;i<t.holes;i++)this.#n(i,o,e);this.#e(s.nodes.re[0],s.nodes.im[0])}#t(){for(let t=0;t<
this.domain.exterior;t++)this.t.re[t*this.u]=1}#s(t){let{k:s,u:n,t:e}=this;for(let o=0;o<s;o++)for(let i=0;i<=
o;i++){let c=this.domain.free[i]*n+1+o;e.re[c]=t.re[o*s+i],e.im[c]=-t.im[o*s+i]}}#n(t,s,n){let{domain:e,
k:o,u:i,t:c}=this,a=e.vertices+t,l=hn(n,e.free,a),h=un(s,fn(s,l,o),o),f=mn(n,e.free,h,a),u=1+o+t;for(let m=0;m<
o;m++)c.re[e.free[m]*i+u]=-h.re[m]/f,c.im[e.free[m]*i+u]=-h.im[m]/f;c.re[a*i+u]=1/f}#e(t,s){let{domain:n,
u:e,t:o}=this,i=j(n,[t,s]);for(let c=1;c<e;c++){let a=0,l=0;for(let h=0;h<n.columns;h++){let f=o.re[h*
e+c],u=o.im[h*e+c];a+=i.re[h]*f-i.im[h]*u,l+=i.re[h]*u+i.im[h]*f}for(let h=0;h<n.exterior;h++)o.re[h*
e+c]-=a,o.im[h*e+c]-=l}}toCoefficients(t){let{u:s,t:n}=this,{columns:e,vertices:o}=this.domain,i=new Float64Array(
4*e),[c,a,l,h]=F(this.#r(t));for(let f=0;f<e;f++){let u=0,m=0,p=0,g=0;for(let d=0;d<s;d++){let w=n.re[f*
s+d],y=n.im[f*s+d];u+=w*c[d]-y*a[d],m+=w*a[d]+y*c[d],p+=w*l[d]-y*h[d],g+=w*h[d]+y*l[d]}i[f]=u,i[e+f]=
m,i[2*e+f]=p,i[3*e+f]=g}return on(i,o,e),i}pulledBack(t){let{u:s,t:n}=this,{columns:e}=this.domain,o=new Float64Array(
4*s),[i,c,a,l]=F(o);for(let h=0;h<e;h++){let f=t[h],u=t[e+h],m=t[2*e+h],p=t[3*e+h];for(let g=0;g<s;g++){
let d=n.re[h*s+g],w=n.im[h*s+g];i[g]+=d*f+w*u,c[g]+=d*u-w*f,a[g]+=d*m+w*p,l[g]+=d*p-w*m}}return this.#i(
o)}#r(t){let{k:s,u:n}=this,e=new Float64Array(4*n);e.set(t.subarray(0,2*n)),e.set(t.subarray(2*n,2*n+
s),2*n+1),e.set(t.subarray(2*n+s),3*n+1);for(let o=1+s;o<n;o++)e[2*n+o]=t[o],e[3*n+o]=-t[n+o];return e}#i(t){
let{k:s,u:n}=this,e=new Float64Array(this.size);e.set(t.subarray(0,2*n)),e.set(t.subarray(2*n+1,2*n+
1+s),2*n),e.set(t.subarray(3*n+1,3*n+1+s),2*n+s);for(let o=1+s;o<n;o++)e[o]+=t[2*n+o],e[n+o]-=t[3*n+
o];return e}};function on(r,t,s){for(let n=t;n<s;n++)r[2*s+n]=r[n],r[3*s+n]=-r[s+n]}function rn(r,t,s){
let{count:n,lengths:e}=t,o={...M(r.columns*n),count:n};for(let i=0;i<n;i++){let c=Math.sqrt(e[i]),a=V(
r,s,(n+i)*r.columns);for(let l=0;l<r.columns;l++)o.re[l*n+i]=c*a.re[l],o.im[l*n+i]=c*a.im[l]}return o}
function Yt({re:r,im:t,count:s},n,e){let o=n*s,i=e*s,c=0,a=0;for(let l=0;l<s;l++)c+=r[o+l]*r[i+l]+t[o+
l]*t[i+l],a+=r[o+l]*t[i+l]-t[o+l]*r[i+l];return[c,a]}function cn(r,t){let s=t.length,n=M(s*s),e=0;for(let o=0;o<
s;o++){for(let i=0;i<=o;i++){let[c,a]=Yt(r,t[o],t[i]);n.re[o*s+i]=c,n.im[o*s+i]=a}e+=n.re[o*s+o]}for(let o=0;o<
s;o++)n.re[o*s+o]+=en*e/s;return n}function an(r,t){ln(r,t);let s=M(t*t);for(let n=0;n<t;n++){let e=r.
re[n*t+n];s.re[n*t+n]=1/e;for(let o=0;o<n;o++){let i=r.re[n*t+o]/e,c=r.im[n*t+o]/e;for(let a=0;a<=o;a++){
let l=s.re[o*t+a],h=s.im[o*t+a];s.re[n*t+a]-=i*l-c*h,s.im[n*t+a]-=i*h+c*l}}}return s}function ln({re:r,
im:t},s){for(let n=0;n<s;n++){let e=n*s;for(let o=0;o<=n;o++){let i=o*s,c=r[e+o],a=t[e+o];for(let l=0;l<
o;l++)c-=r[e+l]*r[i+l]+t[e+l]*t[i+l],a-=t[e+l]*r[i+l]-r[e+l]*t[i+l];r[e+o]=n===o?Math.sqrt(c):c/r[i+
o],t[e+o]=n===o?0:a/r[i+o]}}}function hn(r,t,s){let n=M(t.length);for(let[e,o]of t.entries()){let[i,
c]=Yt(r,o,s);n.re[e]=i,n.im[e]=c}return n}function fn(r,t,s){let n=M(s);for(let e=0;e<s;e++)for(let o=0;o<=
e;o++){let i=r.re[e*s+o],c=r.im[e*s+o];n.re[e]+=i*t.re[o]-c*t.im[o],n.im[e]+=i*t.im[o]+c*t.re[o]}return n}
function un(r,t,s){let n=M(s);for(let e=0;e<s;e++)for(let o=0;o<=e;o++){let i=r.re[e*s+o],c=-r.im[e*
s+o];n.re[o]+=i*t.re[e]-c*t.im[e],n.im[o]+=i*t.im[e]+c*t.re[e]}return n}function mn({re:r,im:t,count:s},n,e,o){
let i=0;for(let c=0;c<s;c++){let a=r[o*s+c],l=t[o*s+c];for(let[h,f]of n.entries()){let u=r[f*s+c],m=t[f*
s+c];a-=u*e.re[h]-m*e.im[h],l-=u*e.im[h]+m*e.re[h]}i+=a*a+l*l}return Math.sqrt(i)}var X=class{constructor(t){this.domain=new K(t),this.panels=Pt(this.domain),this.rows=N(this.domain,
this.panels.nodes),this.prover=new P(this.domain,this.panels,this.rows),this.whitening=new Q(this.domain,
this.panels,this.rows)}identity(){let{exterior:t,columns:s,singular:n}=this.domain,e=new Float64Array(
4*s);return e.set(n.re.subarray(0,t)),e.set(n.im.subarray(0,t),s),e}moved(t,[s,n],e){let{exterior:o,
columns:i}=this.domain,c=new Float64Array(4*i);for(let a=0;a<i;a++){let l=a<o?e:[0,0],[h,f]=[t[a],t[i+
a]],[u,m]=[t[2*i+a],t[3*i+a]];c[a]=s*h-n*f+l[0],c[i+a]=s*f+n*h+l[1],c[2*i+a]=s*u+n*m,c[3*i+a]=s*m-n*
u}return c}};function v(r,t){let s=0;for(let n=0;n<r.length;n++)s+=r[n]*t[n];return s}function U(r,t,s){for(let n=0;n<
s.length;n++)s[n]+=r*t[n]}function Z(r,t,s,n,e,o,{sign:i=1,lower:c=!1}={}){let a=new Float64Array(8);
for(let l=0;l<n;l+=4){let h=c?Math.min(l+4,e):e;for(let f=0;f<h;f+=2){pn(r,t,l,f,n,e,o,a);for(let u=0;u<
8;u++){let m=l+(u>>1),p=f+(u&1);m<n&&p<e&&(s.values[s.first+m*s.stride+p]+=i*a[u])}}}}function pn(r,t,s,n,e,o,i,c){
let a=r.values,l=t.values,h=r.first+s*r.stride,f=r.first+Math.min(s+1,e-1)*r.stride,u=r.first+Math.min(
s+2,e-1)*r.stride,m=r.first+Math.min(s+3,e-1)*r.stride,p=t.first+n*t.stride,g=t.first+Math.min(n+1,o-
1)*t.stride,d=0,w=0,y=0,b=0,O=0,I=0,q=0,G=0;for(let R=0;R<i;R++){let H=l[p+R],k=l[g+R],Ft=a[h+R],xt=a[f+
R],bt=a[u+R],vt=a[m+R];d+=Ft*H,w+=Ft*k,y+=xt*H,b+=xt*k,O+=bt*H,I+=bt*k,q+=vt*H,G+=vt*k}c[0]=d,c[1]=w,
c[2]=y,c[3]=b,c[4]=O,c[5]=I,c[6]=q,c[7]=G}function Jt(r,t){for(let s=0;s<t;s+=48){let n=Math.min(s+48,
t);if(!gn(r,t,s,n))return!1;let e={values:r,first:n*t+s,stride:t},o={values:r,first:n*t+n,stride:t};
Z(e,e,o,t-n,t-n,n-s,{sign:-1,lower:!0})}return!0}function gn(r,t,s,n){for(let e=s;e<t;e++){let o=e*t,
i=Math.min(e,n-1);for(let c=s;c<=i;c++){let a=c*t,l=r[o+c];for(let h=s;h<c;h++)l-=r[o+h]*r[a+h];if(e!==
c)r[o+c]=l/r[a+c];else if(l>0)r[o+c]=Math.sqrt(l);else return!1}}return!0}function Kt(r,t){let s=t.length,
n=Float64Array.from(t);for(let e=0;e<s;e++){let o=e*s,i=n[e];for(let c=0;c<e;c++)i-=r[o+c]*n[c];n[e]=
i/r[o+e]}for(let e=s-1;e>=0;e--){let o=e*s;n[e]/=r[o+e];let i=n[e];for(let c=0;c<e;c++)n[c]-=r[o+c]*
i}return n}var dn=30,wn=1e-12,Vt=[0,1e-9,1e-7,1e-5,.001,.01],mt=class{#t=[];constructor(t,s){this.isometric=t,this.
factor=s}direction(t){let s=Float64Array.from(t),n=this.#t.map(()=>0);for(let o=this.#t.length-1;o>=
0;o--){let{step:i,change:c,curvature:a}=this.#t[o];n[o]=v(i,s)/a,U(-n[o],c,s)}let e=Kt(this.factor,s);
for(let[o,{step:i,change:c,curvature:a}]of this.#t.entries()){let l=v(c,e)/a;U(n[o]-l,i,e)}return e.
map(o=>-o)}learn(t,s){let n=v(t,s),e=Math.sqrt(v(t,t)*v(s,s));n>wn*e&&(this.#t.push({step:t,change:s,
curvature:n}),this.#t.length>dn&&this.#t.shift())}};function Qt(r,t,s,n){let e=r.assemble(t,s,!1);return pt(
e,n,[0])??pt(r.assemble(t,s,!0),n,Vt)}function gt(r,t){return pt(r.isometric,t,Vt)}function pt(r,t,s){
let n=Math.sqrt(r.length);for(let e of s){let o=yn(Mn(r,n,e),n,t);if(Jt(o,n))return new mt(r,o)}return null}
function yn(r,t,s){for(let{reduced:n,weight:e}of s.rows)for(let o=0;o<t;o++){let i=e*n[o];for(let c=0;c<=
o;c++)r[o*t+c]+=i*n[c]}return r}function Mn(r,t,s){let n=Float64Array.from(r),e=0;for(let o=0;o<t;o++)
e+=r[o*t+o];for(let o=0;o<t;o++)n[o*t+o]+=s*e/t;return n}function wt(){return{alpha1:0,alpha2:0,beta1:0,beta2:0,beta3:0}}var dt={density(r,t){let s=r-t;return(r+
t)*(1+1/(s*s))},differentiate(r,t,s){let n=1/(r-t),e=n*n*n,o=e*n;s.alpha1=1-(r+3*t)*e,s.alpha2=1+(3*
r+t)*e,s.beta1=2*(r+5*t)*o,s.beta2=2*(5*r+t)*o,s.beta3=-6*(r+t)*o}};function An(r){let t=(s,n)=>Math.
exp(r*dt.density(s,n));return{density:t,differentiate(s,n,e){dt.differentiate(s,n,e);let o=r*t(s,n),
{alpha1:i,alpha2:c}=e;e.alpha1=o*i,e.alpha2=o*c,e.beta1=o*(e.beta1+r*i*i),e.beta2=o*(e.beta2+r*c*c),
e.beta3=o*(e.beta3+r*i*c)}}}function Fn(r){let t=(s,n)=>{let e=s-n;return Math.exp((2*r*(s+n)+1)/e+e)};
return{density:t,differentiate(s,n,e){let o=1/(s-n),i=o*o,c=i*o,a=1-(4*r*n+1)*i,l=-1+(4*r*s+1)*i,h=t(
s,n);e.alpha1=a*h,e.alpha2=l*h,e.beta1=(a*a+2*(4*r*n+1)*c)*h,e.beta2=(l*l+2*(4*r*s+1)*c)*h,e.beta3=(a*
l-(4*r*(s+n)+2)*c)*h}}}var xn={density:(r,t)=>(r+t)/(r-t),differentiate(r,t,s){let n=1/(r-t),e=n*n,o=e*
n;s.alpha1=-2*t*e,s.alpha2=2*r*e,s.beta1=4*t*o,s.beta2=4*r*o,s.beta3=-2*(r+t)*o}},bn={density:(r,t)=>2*
(r+t)-4*Math.sqrt(r)+2,differentiate(r,t,s){let n=1/Math.sqrt(r);s.alpha1=2-2*n,s.alpha2=2,s.beta1=n*
n*n,s.beta2=0,s.beta3=0}},vn={iso:()=>dt,exp:An,amips:Fn,mips:()=>xn,arap:()=>bn};function Xt(r,t=1){
return vn[r](t)}function Zt(r,t,s){let n=t.length,e=0;for(let o=0;o<n;o++){let i=s[o],c=s[n+o],a=s[2*
n+o],l=s[3*n+o],h=i*i+c*c,f=a*a+l*l;if(!(h>f))return 1/0;e+=t[o]*r.density(h,f)}return Number.isNaN(
e)?1/0:e}function $t(r,t,s){let n=t.length,e=new Float64Array(4*n),o=wt();for(let i=0;i<n;i++){let[c,
a,l,h]=[i,n+i,2*n+i,3*n+i],f=s[c]*s[c]+s[a]*s[a],u=s[l]*s[l]+s[h]*s[h];r.differentiate(f,u,o);let m=2*
t[i]*o.alpha1,p=2*t[i]*o.alpha2;e[c]=m*s[c],e[a]=m*s[a],e[l]=p*s[l],e[h]=p*s[h]}return e}var On=2.25;function In(r,t,s){return{acrossF:2*r.alpha1,acrossG:2*r.alpha2,alongFF:2*r.alpha1+4*r.beta1*
t,alongGG:2*r.alpha2+4*r.beta2*s,alongFG:4*r.beta3*Math.sqrt(t*s)}}function Tn(r){let t=(r.alongFF+r.
alongGG)/2,s=(r.alongFF-r.alongGG)/2,n=Math.hypot(s,r.alongFG),e=Math.max(t+n,0),o=Math.max(t-n,0),i=(e+
o)/2,c=n>0?(e-o)/(2*n):1;return{acrossF:Math.max(r.acrossF,0),acrossG:Math.max(r.acrossG,0),alongFF:i+
c*s,alongGG:i-c*s,alongFG:c*r.alongFG}}var $=class{constructor(t,{rows:s,weights:n,middles:e}){let{panels:o,
whitening:i,domain:c}=t;this.shape=t;let a=o.count>=On*i.u;this.first=a?o.count:0,this.nodes=s.count-
this.first,this.weights=a?e:n,this.re=new Float64Array(i.u*this.nodes),this.im=new Float64Array(i.u*
this.nodes);let l={...s,...this.#t(s)};for(let h=0;h<i.u;h+=2){let f=F(E(l,S(c,En(t,h)))),u=h*this.nodes;
this.re.set(f[0],u),this.im.set(f[1],u),h+1<i.u&&(this.re.set(f[2],u+this.nodes),this.im.set(f[3],u+
this.nodes))}}#t({columns:t,re:s,im:n}){let e=this.first*t;return{count:this.nodes,re:s.subarray(e),
im:n.subarray(e)}}assemble(t,s,n){let{u:e,size:o}=this.shape.whitening,i=this.#s(t,s,n),c=this.#n(i.
f,0),a=this.#n(i.g,1),l=new Float64Array(o*o),h=ss(c,2*this.nodes,2*e,[i.alongFF,i.acrossF]),f=ss(a,
2*this.nodes,2*(e-1),[i.alongGG,i.acrossG]),u=this.#e(c,a,i.alongFG);return this.#r(l,h,f,u),l}#s(t,s,n){
let{nodes:e,first:o,weights:i}=this,c=t.length/4,a=()=>new Float64Array(e),l={re:a(),im:a()},h={re:a(),
im:a()},f={alongFF:a(),acrossF:a(),alongGG:a(),acrossG:a(),alongFG:a()},u=wt();for(let m=0;m<e;m++){
let p=o+m,g=ts(l,m,t[p],t[c+p]),d=ts(h,m,t[2*c+p],t[3*c+p]);s.differentiate(g,d,u);let w=In(u,g,d),y=n?
Tn(w):w;f.alongFF[m]=i[m]*y.alongFF,f.acrossF[m]=i[m]*y.acrossF,f.alongGG[m]=i[m]*y.alongGG,f.acrossG[m]=
i[m]*y.acrossG,f.alongFG[m]=i[m]*y.alongFG}return{f:l,g:h,...f}}#n(t,s){let{nodes:n}=this,{u:e,k:o}=this.
shape.whitening,i=e-s,c=new Float64Array(2*i*2*n);for(let a=s;a<e;a++){let l=s===1&&a>o?-1:1,h=(a-s)*
2*n,f=(i+a-s)*2*n;for(let u=0;u<n;u++){let m=this.re[a*n+u],p=this.im[a*n+u],g=t.re[u]*m+t.im[u]*p,d=t.
re[u]*p-t.im[u]*m;c[h+u]=g,c[h+n+u]=d,c[f+u]=-l*d,c[f+n+u]=l*g}}return c}#e(t,s,n){let{nodes:e}=this,
{u:o}=this.shape.whitening,i=new Float64Array(2*o*e);for(let f=0;f<2*o;f++)for(let u=0;u<e;u++)i[f*e+
u]=n[u]*t[f*2*e+u];let c=new Float64Array(2*(o-1)*2*o),a={values:s,first:0,stride:2*e},l={values:i,first:0,
stride:e},h={values:c,first:0,stride:2*o};return Z(a,l,h,2*(o-1),2*o,e),c}#r(t,s,n,e){let{u:o,k:i,size:c}=this.
shape.whitening,a=2*(o-1);for(let h=0;h<2*o;h++)for(let f=0;f<=h;f++)t[h*c+f]=s[h*2*o+f];let l=(h,f,u)=>{
t[Math.max(h,f)*c+Math.min(h,f)]+=u};for(let h=0;h<a;h++){let f=ns(h,o,i);for(let u=0;u<=h;u++)l(f,ns(
u,o,i),n[h*a+u]);for(let u=0;u<2*o;u++){let m=e[h*2*o+u];l(f,u,f===u?2*m:m)}}}};function En({domain:r,
whitening:t},s){let{columns:n}=r,{u:e,t:o}=t,i=new Float64Array(4*n),c=Math.min(s+1,e-1);for(let a=0;a<
n;a++)i[a]=o.re[a*e+s],i[n+a]=o.im[a*e+s],i[2*n+a]=o.re[a*e+c],i[3*n+a]=o.im[a*e+c];return i}function ts(r,t,s,n){
let e=s*s+n*n,o=Math.sqrt(e);return r.re[t]=o>0?s/o:1,r.im[t]=o>0?n/o:0,e}function ss(r,t,s,[n,e]){let o=t/
2,i=new Float64Array(r.length);for(let f=0;f<r.length;f+=t)for(let u=0;u<o;u++)i[f+u]=n[u]*r[f+u],i[f+
o+u]=e[u]*r[f+o+u];let c=new Float64Array(s*s);return Z({values:i,first:0,stride:t},{values:r,first:0,
stride:t},{values:c,first:0,stride:s},s,s,t,{lower:!0}),c}function ns(r,t,s){let n=r>=t-1,e=n?r-(t-1):
r;return e<s?2*t+(n?s:0)+e:(n?t:0)+1+e}function es(r,t){let s=r.length/4,n=1/0;for(let e=0;e<s;e++){let o=yt(t,t,e,s),i=2*yt(r,t,e,s),c=yt(
r,r,e,s),a=i*i-4*o*c,l=Math.sqrt(Math.max(a,0))-i;a>=0&&l>0&&(n=Math.min(n,2*c/l))}return n}function yt(r,t,s,n){
let[e,o,i]=[n+s,2*n+s,3*n+s];return r[s]*t[s]+r[e]*t[e]-r[o]*t[o]-r[i]*t[i]}function os(r,t,s){let n=r(
0),e=.7*s,o=Math.min(1,e),i=o,c=r(i);for(;!(c<n+1e-4*i*t);){if(i*=.6,i<1e-12)return 0;c=r(i)}for(let a of i===
o?[1.3,.75]:[.75]){let l=Rn(r,i,c,a,Math.min(2,e));if(l!==i)return l}return i}function Rn(r,t,s,n,e){
let o=t,i=s;for(let c=n*t;c<=e&&c>1e-12;c*=n){let a=r(c);if(!(a<i))break;o=c,i=a}return o}var Sn=10,qn=25e9,Gn=1e13,rs=1,is=1e-4,z=class{constructor(t,s,n){this.shape=t,this.pose=s,this.weight=
n,this.coordinates=s.handles.map(o=>j(t.domain,o)),this.derivatives=cs(s).map(o=>Nn(t,s.handles[o]));
let{unit:e}=t.domain;this.images=this.coordinates.flatMap((o,i)=>{let c=s.weights?.[i]??1,a=Math.min(
n,qn/c)*c/(e*e),[l,h]=s.targets[i],f=_n(o);return[this.#t(f[0],l,a),this.#t(f[1],h,a)]}),this.turns=
[]}get rows(){return[...this.images,...this.turns]}get turned(){return this.derivatives.length>0}aim(t){
this.pose=t;for(let[s,[n,e]]of t.targets.entries())this.images[2*s].aim=n,this.images[2*s+1].aim=e}measure(t,s){
this.turns=cs(this.pose).flatMap((n,e)=>{let o=this.derivatives[e],[i,c]=Ln(o,t),a=Math.hypot(i,c),l=Math.
atan2(c,i),h=this.pose.angles?.[n]??null,f=this.pose.scales?.[n]??null,u=h===null?0:Un(h-l),m=l+Math.
max(-rs,Math.min(rs,u)),[p,g]=jn(o,m),d=this.pose.weights?.[n]??1,w=Math.min(Sn*this.weight,Gn/d)*d,
y=f===null?1:Pn(1-f/a,s);return[this.#t(p,f??0,f===null?0:w),this.#t(g,0,w*(h===null?y:1))]})}apartFrom(t){
if(t.length!==this.turns.length)return 1/0;let s=0,n=!0;for(let[e,{row:o,weight:i}]of this.turns.entries()){
let c=o.map((a,l)=>a-t[e].row[l]);s=Math.max(s,Math.sqrt(v(c,c)/v(o,o))),n=n&&Math.abs(i-t[e].weight)<=
.1*(1+i)}return n&&s<=is?0:Math.max(s,is)}#t(t,s,n){return{row:t,reduced:this.shape.whitening.pulledBack(
t),aim:s,weight:n}}residual(t){return Float64Array.from(this.rows,({row:s,aim:n})=>v(s,t)-n)}change(t){
return Float64Array.from(this.rows,({row:s})=>v(s,t))}product(t,s){return this.rows.reduce((n,{weight:e},o)=>n+
e*t[o]*s[o],0)}};function cs({handles:r,angles:t,scales:s}){return[...r.keys()].filter(e=>(t?.[e]??null)!==
null||(s?.[e]??null)!==null)}function Nn({domain:r},[t,s]){let n=M(r.columns);return _(r,t,s,n,0),V(
r,n,0)}function _n({re:r,im:t}){let s=r.map(e=>-e),n=t.map(e=>-e);return[tt([r,n,r,n]),tt([t,r,n,s])]}
function jn(r,t){let s=Math.cos(t),n=Math.sin(t),e=r.re.map((a,l)=>a*s+r.im[l]*n),o=r.im.map((a,l)=>a*
s-r.re[l]*n),i=o.map(a=>-a),c=new Float64Array(e.length);return[tt([e,i,c,c]),tt([o,e,c,c])]}function tt(r){
let t=r[0].length,s=new Float64Array(r.length*t);for(let[n,e]of r.entries())s.set(e,n*t);return s}function Ln(r,t){
let s=r.re.length,n=0,e=0;for(let o=0;o<s;o++)n+=r.re[o]*t[o]-r.im[o]*t[s+o],e+=r.re[o]*t[s+o]+r.im[o]*
t[o];return[n,e]}function Pn(r,t){return Math.min(1,Math.max(0,t*r,(1-t)*r))}function Un(r){return Math.
atan2(Math.sin(r),Math.cos(r))}function as({domain:r,panels:t,rows:s},n){let{count:e,weights:o,lengths:i}=t;if(!n)return{rows:s,weights:o,
middles:i,added:0};let{factors:c,points:a}=n,l=Float64Array.from(n.weights),h=o.map((m,p)=>m*c[p]),f=i.
map((m,p)=>m*c[e+p]),u=h.reduce((m,p,g)=>m+p-o[g],0);return{rows:Dn(s,N(r,D(a))),weights:B(h,l),middles:B(
f,l),added:l.reduce((m,p)=>m+p,u)}}function Dn(r,t){return{count:r.count+t.count,columns:r.columns,re:B(
r.re,t.re),im:B(r.im,t.im),norms:B(r.norms,t.norms)}}function B(r,t){let s=new Float64Array(r.length+
t.length);return s.set(r),s.set(t,r.length),s}var zn=1e-6,Bn=.5,Hn=12,kn=.3,Cn=.001,Wn=3,Yn=1e-9,Jn=16,Mt=1e9,Kn=.2,Vn=3,st=class r{#t;#s=null;#n=0;#e=1;constructor(t,{
energy:s="iso",s:n=1,weight:e=1e5,stiff:o=null}={}){let{domain:i,panels:c}=t;this.shape=t,this.energyMeasure=
Xt(s,n),this.weight=e,this.quadrature=as(t,o),this.prover=o?new P(i,c,this.quadrature.rows):t.prover,
this.#t=new $(t,this.quadrature),this.pins=new z(t,{handles:[],targets:[]},e),this.state=this.#a(t.identity()),
this.promised=1/0,this.factors=0,this.steps=0}withOptions(t){let s=new r(this.shape,t);return s.#h(this.
pins.pose),s.state=s.#a(this.state.coefficients),s.#f(),s}get energy(){return this.state.isometric+this.#M(
this.state.residual)}solve(t,{tolerance:s=1e-8,iterations:n=200}={}){return this.begin(t),this.#i(s,
n)}place(t,s){let n=this.#a(s);this.#h(t),this.state=n,this.#s=null,this.#f()}begin(t){let{handles:s,
targets:n}=t,[e,o]=Xn(s,n);this.#h(t),this.state=this.#a(this.shape.moved(this.shape.identity(),e,o)),
this.#s=null,this.#f()}drag(t,s=2){this.aim(t);let n="minimal";for(let e=0;e<s&&(n=this.step(1e-12),
n==="stepped");e++);for(let e=0;e<Wn&&this.#r(n);e++)this.#s=null,n=this.step(1e-12);return n}#r(t){
return t==="refused"||t==="no decrease"?this.promised>Yn:t==="stepped"&&this.promised>Cn}aim(t){Qn(this.
pins.pose,t)?this.pins.aim(t):(this.#h(t),this.#s=this.#s&&gt(this.#s,this.pins)),this.#f()}#i(t,s){
let n=1/0;for(let e=0;e<s;e++){let o=this.#s===null,i=this.energy,c=this.step(t);if(c!=="stepped"){let l=o||
c==="minimal",h=l?this.#u():!1;if(l&&!h)return c;this.#s=l?this.#s:null,n=1/0;continue}let a=i-this.
energy;!o&&a>kn*n&&(this.#s=null),n=a,this.#u()}return"stepped"}step(t){if(this.#s??=this.#w(),this.#s===
null)return"indefinite";let s=this.#g(),n=this.#s.direction(s),e=v(s,n);if(this.promised=-e/2/Math.max(
this.energy,zn),!(this.promised>t))return this.promised>=0?"minimal":"no decrease";let o=this.shape.
whitening.toCoefficients(n),i=this.#c(o,e);if(i===0)return"no decrease";let c=this.#o(o,i);if(c===0)
return"refused";let a=this.#g(),l=n.map(f=>c*f),h=a.map((f,u)=>f-s[u]);return this.#s.learn(l,h),"st\
epped"}#c(t,s){let{shape:n,state:e,pins:o}=this,i=E(this.quadrature.rows,S(n.domain,t)),c=o.change(t),
a=o.product(e.residual,e.residual)/2,l=o.product(e.residual,c),h=o.product(c,c)/2,f=new Float64Array(
i.length);return os(m=>{for(let g=0;g<f.length;g++)f[g]=e.samples[g]+m*i[g];let p=a+m*l+m*m*h;return this.#d(
f)+p},s,es(e.samples,i))}#o(t,s){let n=s;for(let e=0;e<Hn;e++){let o=Float64Array.from(this.state.coefficients);
U(n,t,o);let i=this.prover.prove(o);if(i.certificate.certified)return this.state=this.#p(o,i),this.steps++,
n;n*=Bn}return 0}#a(t){let s=this.prover.prove(t);if(!s.certificate.certified)throw new Error("the m\
ap to start from cannot be proved locally injective");return this.#p(t,s)}#p(t,{certificate:s,samples:n}){
let e=this.#d(n),o=this.pins.residual(t);return{coefficients:t,certificate:s,samples:n,isometric:e,residual:o,
gradient:null}}#g(){let{state:t,pins:s}=this;t.gradient??=this.#y();let n=Float64Array.from(t.gradient);
for(let[e,{reduced:o,weight:i}]of s.rows.entries())U(i*t.residual[e],o,n);return n}#d(t){let{energyMeasure:s,
quadrature:n}=this;return Zt(s,n.weights,t)-n.added*s.density(1,0)}#y(){let{shape:t,state:s,energyMeasure:n,
quadrature:e}=this,o=$t(n,e.weights,s.samples),i=Lt(e.rows,o);return t.whitening.pulledBack(jt(t.domain,
i))}#M(t){return this.pins.product(t,t)/2}#w(){return this.factors++,Qt(this.#t,this.state.samples,this.
energyMeasure,this.pins)}#h(t){this.pins=new z(this.shape,t,this.weight)}#f(){this.#n=0,this.#e=1,this.#u(),
this.state.residual=this.pins.residual(this.state.coefficients)}#u(){let{pins:t}=this;if(!t.turned||
this.#e===Mt)return!1;this.#n===Jn&&(this.#e=Mt);let s=t.turns;t.measure(this.state.coefficients,this.#e);
let n=t.apartFrom(s);return n===0?(t.turns=s,!1):(this.#n>0&&n>Kn&&this.#e!==Mt&&(this.#e*=Vn),this.#n++,
this.#s=this.#s&&gt(this.#s,t),this.state.residual=t.residual(this.state.coefficients),!0)}};function Qn(r,t){
let s=({handles:n,weights:e,angles:o,scales:i})=>JSON.stringify([n,e??null,o??null,i??null]);return s(
r)===s(t)}function Xn(r,t){let s=ls(r),n=ls(t),e=0,o=0;for(let[h,f]of r.entries()){let[u,m]=[f[0]-s[0],
f[1]-s[1]],[p,g]=[t[h][0]-n[0],t[h][1]-n[1]];e+=u*p+m*g,o+=u*g-m*p}let i=Math.hypot(e,o),[c,a]=i>0?[
e/i,o/i]:[1,0],l=[n[0]-c*s[0]+a*s[1],n[1]-c*s[1]-a*s[0]];return[[c,a],[l[0],l[1]]]}function ls(r){let t=Math.
max(r.length,1),s=r.reduce((e,o)=>e+o[0],0),n=r.reduce((e,o)=>e+o[1],0);return[s/t,n/t]}var Zn=1e-7,At=class{#t;#s;#n=[];#e=!1;#r=null;#i=null;#c=null;#o=null;constructor(t,s){this.#t=t,this.#s=
s}receive(t){let s=this.#n.at(-1);t.type==="drag"&&s?.type==="drag"&&this.#n.pop(),this.#n.push(t),this.#a()}#a(){
this.#e||(this.#e=!0,this.#s(()=>{this.#e=!1,this.#p()}))}#p(){let t=this.#n.shift(),s=t?.id??this.#o?.
id??0;try{t?this.#g(t):this.#o&&this.#w(this.#o.id,this.#o.pose)}catch(n){this.#o=null,this.#t({type:"\
failed",id:s,message:String(n)})}(this.#n.length>0||this.#o)&&this.#a()}#g(t){switch(this.#o=null,t.
type){case"shape":return this.#d(t.id,t.outline,t.points,t.options);case"options":return this.#y(t.id,
t.options);case"solve":return this.#M(t.id,t.pose);case"drag":return this.#w(t.id,t.pose);case"place":
return this.#h(t.id,t.pose,t.coefficients);case"points":return this.#f(t.id,t.points);case"claim":return this.#u(
t.id)}}#d(t,s,n,e){let o=new X(s);this.#r=new st(o,e),this.#i=n?new L(o.domain,n):null;let{panels:i,
domain:c}=o;this.#t({type:"ready",id:t,panels:i.count,columns:c.columns})}#y(t,s){this.#r=this.#l().
withOptions(s),this.#m(t,"minimal",!0)}#M(t,s){let n=this.#l(),e=performance.now(),o=n.steps,i=n.solve(
s);this.#m(t,i,!0,n.steps-o,performance.now()-e)}#w(t,s){let n=this.#l(),e=performance.now(),o=n.steps,
i=n.drag(s),c=i!=="stepped"||n.promised<Zn;this.#o=c?null:{id:t,pose:s},this.#m(t,i,c,n.steps-o,performance.
now()-e)}#h(t,s,n){this.#l().place(s,n),this.#m(t,"placed",!0)}#f(t,s){this.#i=new L(this.#l().shape.
domain,s),this.#m(t,"placed",!0)}#u(t){let{state:s,shape:n}=this.#l(),{coefficients:e,certificate:o}=s,
i=Ut(n.domain);this.#t({type:"claim",id:t,claim:{coefficients:e,certificate:o,panels:i}})}#l(){if(!this.#r)
throw new Error("there is no shape yet; send a request of the type shape first");return this.#r}#m(t,s,n,e=0,o=0){
let{state:i,energy:c}=this.#l(),a=i.coefficients.slice(),l=performance.now(),h=this.#i?.evaluate(a),
f=performance.now()-l,u={type:"map",id:t,settled:n,outcome:s,energy:c,coefficients:a,certificate:i.certificate,
images:h?.images??null,samples:h?.samples??null,pins:this.#A().evaluate(a),steps:e,took:o,evaluated:f};
this.#t(u)}#A(){let{shape:t,pins:s}=this.#l(),{handles:n}=s.pose;return(!this.#c||JSON.stringify(this.#c.
handles)!==JSON.stringify(n))&&(this.#c={handles:n,points:new L(t.domain,n)}),this.#c.points}};function hs(r){
let t=new MessageChannel,s=[];t.port1.onmessage=()=>s.shift()?.();let n=new At(e=>r.postMessage(e),e=>{
s.push(e),t.port2.postMessage(null)});r.onmessage=({data:e})=>n.receive(e)}hs(globalThis);})();
