"use strict";(()=>{var LN2_HIGH=.6931471803691238;var LN2_LOW=19082149292705877e-26;var TWO_TO_54=0x40000000000000;var L1=.6666666666666735;
var L2=.3999999999940942;var L3=.2857142874366239;var L4=.22222198432149784;var L5=.1818357216161805;
var L6=.15313837699209373;var L7=.14798198605116586;var A0=.3333333333333293;var A1=-.19999999999876483;
var A2=.14285714272503466;var A3=-.11111110405462356;var A4=.09090887133436507;var A5=-.0769187620504483;
var A6=.06661073137387531;var A7=-.058335701337905735;var A8=.049768779946159324;var A9=-.036531572744216916;
var A10=.016285820115365782;var ATAN_HIGH=[.4636476090008061,.7853981633974483,.982793723247329,1.5707963267948966];
var ATAN_LOW=[22698777452961687e-33,3061616997868383e-32,13903311031230998e-33,6123233995736766e-32];
var TINY=1862645149230957e-24;var HUGE=7378697629483821e4;var PI_LOW=12246467991473532e-32;var number=new Float64Array(
1);var words=new Int32Array(number.buffer);number[0]=1;var HIGH=words[1]===0?0:1;function modulus(x,y){
return Math.sqrt(x*x+y*y)}function log(x){if(!(x>0)||x===Infinity){return logOfSpecial(x)}const subnormal=x<
22250738585072014e-324;number[0]=subnormal?x*TWO_TO_54:x;const exponent=(words[HIGH]>>20)-1023-(subnormal?
54:0);const fraction=words[HIGH]&1048575;const carry=fraction+614244&1048576;words[HIGH]=fraction|carry^
1072693248;return logOfParts(exponent+(carry>>20),number[0]-1,fraction)}function logOfSpecial(x){if(x===
0){return-Infinity}return x===Infinity?Infinity:NaN}function logOfParts(k,f,fraction){if((1048575&2+
fraction)<3){const r2=f*f*(.5-.3333333333333333*f);return k*LN2_HIGH-(r2-k*LN2_LOW-f)}const s=f/(2+f);
const z=s*s;const w=z*z;const even=w*(L2+w*(L4+w*L6));const odd=z*(L1+w*(L3+w*(L5+w*L7)));const r=odd+
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
return Math.max(...values)-Math.min(...values)});return Math.max(...sides)}var UNIT_ROUNDOFF=11102230246251565e-32;var UPWARD=1+9313225746154785e-25;var CUT=64*UNIT_ROUNDOFF;var BESIDE=64*
UNIT_ROUNDOFF;var LOGARITHM=16*UNIT_ROUNDOFF;var BERNSTEIN=16*UNIT_ROUNDOFF;var LEBESGUE=1.25;var UNDERFLOW=1e-140;
function slack(columns,rowNorm,slopeNorm,slopeSum){const sums=(3*columns+128)*UNIT_ROUNDOFF*rowNorm*
slopeNorm;const logarithms=LOGARITHM/Math.PI*slopeSum;return LEBESGUE*UPWARD*(sums+logarithms)+UNDERFLOW}var TAU=2*Math.PI;var LARGEST_NORM=1e20;function rowsAt(domain,points){const count=points.re.length;
const{columns}=domain;const rows={count,columns,...zeros(count*columns),norms:new Float64Array(count)};
for(let i=0;i<count;i++){rows.norms[i]=fillRow(domain,points.re[i],points.im[i],rows,i*columns)}return rows}
function fillRow(domain,x,y,row,first){const{vertices,columns,next,singular}=domain;let safe=true;for(let e=0;e<
vertices;e++){const after=next[e];const bx=singular.re[e]-x;const by=singular.im[e]-y;const cx=singular.
re[after]-x;const cy=singular.im[after]-y;const angle=atan2(bx*cy-by*cx,bx*cx+by*cy)/TAU;row.re[first+
e]=angle;row.im[first+e]=-log((cx*cx+cy*cy)/(bx*bx+by*by))/(2*TAU);safe=safe&&Math.abs(angle)<.5-CUT}
for(let h=vertices;h<columns;h++){const bx=x-singular.re[h];const by=y-singular.im[h];const square=bx*
bx+by*by;row.re[first+h]=bx/square;row.im[first+h]=-by/square}const norm=UPWARD*Math.sqrt(squares(row,
first,columns));return safe&&norm<LARGEST_NORM?norm:Infinity}function squares(row,first,count){let sum=0;
for(let j=first;j<first+count;j++){sum+=row.re[j]*row.re[j]+row.im[j]*row.im[j]}return sum}function coordinatesAt(domain,[
x,y]){const{vertices,columns,next,previous,singular}=domain;const logarithms=zeros(columns);fillRow(
domain,x,y,logarithms,0);const over=timesInverseEdge(domain,logarithms);const c=zeros(columns);for(let j=0;j<
vertices;j++){const p=previous[j];const cx=singular.re[next[j]]-x;const cy=singular.im[next[j]]-y;const bx=singular.
re[p]-x;const by=singular.im[p]-y;c.re[j]=cx*over.re[j]-cy*over.im[j]-(bx*over.re[p]-by*over.im[p]);
c.im[j]=cx*over.im[j]+cy*over.re[j]-(bx*over.im[p]+by*over.re[p])}for(let h=vertices;h<columns;h++){
c.re[h]=log(modulus(x-singular.re[h],y-singular.im[h]))}return c}function derivativesOf(domain,row,first){
const{vertices,columns,previous}=domain;const end=first+columns;const own={re:row.re.subarray(first,
end),im:row.im.subarray(first,end)};const over=timesInverseEdge(domain,own);const d={re:Float64Array.
from(own.re),im:Float64Array.from(own.im)};for(let j=0;j<vertices;j++){d.re[j]=over.re[previous[j]]-
over.re[j];d.im[j]=over.im[previous[j]]-over.im[j]}return d}function timesInverseEdge({vertices,inverseEdge},row){
const over=zeros(vertices);for(let e=0;e<vertices;e++){over.re[e]=row.re[e]*inverseEdge.re[e]-row.im[e]*
inverseEdge.im[e];over.im[e]=row.re[e]*inverseEdge.im[e]+row.im[e]*inverseEdge.re[e]}return over}function slopesOf(domain,coefficients){
const{vertices,columns,next,edge}=domain;const slopes=new Float64Array(4*columns);for(const part of[
0,2*columns]){const re=coefficients.subarray(part,part+columns);const im=coefficients.subarray(part+
columns,part+2*columns);for(let e=0;e<vertices;e++){const x=re[next[e]]-re[e];const y=im[next[e]]-im[e];
const a=edge.re[e];const b=edge.im[e];const square=a*a+b*b;slopes[part+e]=(x*a+y*b)/square;slopes[part+
columns+e]=(y*a-x*b)/square}for(let h=vertices;h<columns;h++){slopes[part+h]=re[h];slopes[part+columns+
h]=im[h]}}return slopes}function pulledThroughSlopes(domain,g){const{vertices,columns,next,inverseEdge}=domain;
const pulled=new Float64Array(4*columns);for(const re of[0,2*columns]){const im=re+columns;for(let e=0;e<
vertices;e++){const x=g[re+e]*inverseEdge.re[e]+g[im+e]*inverseEdge.im[e];const y=g[im+e]*inverseEdge.
re[e]-g[re+e]*inverseEdge.im[e];pulled[re+next[e]]+=x;pulled[im+next[e]]+=y;pulled[re+e]-=x;pulled[im+
e]-=y}for(let h=vertices;h<columns;h++){pulled[re+h]=g[re+h];pulled[im+h]=g[im+h]}}return pulled}function samplesAt(rows,slopes){
const samples=new Float64Array(4*rows.count);const[pr,pi,qr,qi]=quarters(slopes);const[fr,fi,gr,gi]=quarters(
samples);fillProduct(rows,pr,pi,fr,fi);fillProduct(rows,qr,qi,gr,gi);return samples}function fillProduct(rows,re,im,intoRe,intoIm){
const{count,columns}=rows;const rowRe=rows.re;const rowIm=rows.im;for(let i=0;i<count;i+=2){const next=Math.
min(i+1,count-1);const first=i*columns;const second=next*columns;let x1=0;let y1=0;let x2=0;let y2=0;
for(let e=0;e<columns;e++){const a1=rowRe[first+e];const b1=rowIm[first+e];const a2=rowRe[second+e];
const b2=rowIm[second+e];const c=re[e];const d=im[e];x1+=a1*c-b1*d;y1+=a1*d+b1*c;x2+=a2*c-b2*d;y2+=a2*
d+b2*c}intoRe[i]=x1;intoIm[i]=y1;intoRe[next]=x2;intoIm[next]=y2}}function pulledThroughRows(rows,g){
const pulled=new Float64Array(4*rows.columns);const[pr,pi,qr,qi]=quarters(pulled);const[fr,fi,gr,gi]=quarters(
g);addAdjointProduct(rows,fr,fi,pr,pi);addAdjointProduct(rows,gr,gi,qr,qi);return pulled}function addAdjointProduct(rows,re,im,intoRe,intoIm){
const{count,columns}=rows;const rowRe=rows.re;const rowIm=rows.im;for(let i=0;i<count;i+=2){const both=i+
1<count;const first=i*columns;const second=both?first+columns:first;const c1=re[i];const d1=im[i];const c2=both?
re[i+1]:0;const d2=both?im[i+1]:0;for(let e=0;e<columns;e++){const a1=rowRe[first+e];const b1=rowIm[first+
e];const a2=rowRe[second+e];const b2=rowIm[second+e];intoRe[e]+=a1*c1+b1*d1+(a2*c2+b2*d2);intoIm[e]+=
a1*d1-b1*c1+(a2*d2-b2*c2)}}}function quarters(values){const n=values.length/4;return[values.subarray(
0,n),values.subarray(n,2*n),values.subarray(2*n,3*n),values.subarray(3*n)]}var FieldPoints=class{#domain;#coordinates;#rows;constructor(domain,points){const{columns}=domain;this.#domain=
domain;this.count=points.length;this.#coordinates=zeros(points.length*columns);for(const[i,point]of points.
entries()){const c=coordinatesAt(domain,point);this.#coordinates.re.set(c.re,i*columns);this.#coordinates.
im.set(c.im,i*columns)}this.#rows=rowsAt(domain,complexOf(points))}evaluate(coefficients){const slopes=slopesOf(
this.#domain,coefficients);return{images:imagesAt(this.#coordinates,this.count,coefficients),samples:samplesAt(
this.#rows,slopes)}}};function imagesAt({re,im},count,coefficients){const images=new Float64Array(2*
count);const n=coefficients.length/4;const[pr,pi,qr,qi]=quarters(coefficients);const sum={re:pr.map(
(value,j)=>value+qr[j]),im:pi.map((value,j)=>value+qi[j])};const less={re:pr.map((value,j)=>value-qr[j]),
im:pi.map((value,j)=>value-qi[j])};for(let i=0;i<count;i++){const first=i*n;let x=0;let y=0;for(let j=0;j<
n;j++){x+=re[first+j]*sum.re[j]-im[first+j]*sum.im[j];y+=re[first+j]*less.im[j]+im[first+j]*less.re[j]}
images[2*i]=x;images[2*i+1]=y}return images}var MOST_BISECTIONS=48;function gradedPanels(domain){const starts=[];const loop=[];for(const[number2,
vertices]of domain.cage.entries()){for(const[i,vertex]of vertices.entries()){appendPieces(domain,vertex,
vertices[(i+1)%vertices.length],0,starts)}while(loop.length<starts.length){loop.push(number2)}}const count=starts.
length;const next=nextOnLoop(loop);const nodes=nodesOf(starts,next);const lengths=relativeLengths(starts,
next);const loops=domain.cage.length;const weights=simpson(lengths,next);return{count,loops,next,loop:Int32Array.
from(loop),nodes,lengths,weights}}function appendPieces(domain,start,end,depth,starts){const length=modulus(
end[0]-start[0],end[1]-start[1]);if(depth===MOST_BISECTIONS||length<=clearance(domain,start,end)){starts.
push(start);return}const middle=middleOf(start,end);appendPieces(domain,start,middle,depth+1,starts);
appendPieces(domain,middle,end,depth+1,starts)}function middleOf(a,b){return[(a[0]+b[0])/2,(a[1]+b[1])/
2]}function clearance(domain,start,end){let least=Infinity;for(let j=0;j<domain.columns;j++){least=Math.
min(least,distance(domain.singular,j,start[0],start[1],end[0],end[1]))}return least}function distance(points,j,ax,ay,bx,by){
const alongX=bx-ax;const alongY=by-ay;const x=points.re[j]-ax;const y=points.im[j]-ay;const square=alongX*
alongX+alongY*alongY;const position=(x*alongX+y*alongY)/(square>0?square:1);const t=Math.min(1,Math.
max(0,position));return modulus(x-t*alongX,y-t*alongY)}function nextOnLoop(loop){const next=new Int32Array(
loop.length);let first=0;for(let i=0;i<loop.length;i++){if(loop[i]!==loop[first]){first=i}next[i]=loop[i+
1]===loop[i]?i+1:first}return next}function nodesOf(starts,next){const count=starts.length;const nodes=zeros(
2*count);for(const[i,start]of starts.entries()){const middle=middleOf(start,starts[next[i]]);nodes.re[i]=
start[0];nodes.im[i]=start[1];nodes.re[count+i]=middle[0];nodes.im[count+i]=middle[1]}return nodes}function relativeLengths(starts,next){
const lengths=Float64Array.from(starts,(start,i)=>{const end=starts[next[i]];return modulus(end[0]-start[0],
end[1]-start[1])});const perimeter=lengths.reduce((sum,length)=>sum+length,0);return lengths.map(length=>length/
perimeter)}function simpson(lengths,next){const count=lengths.length;const weights=new Float64Array(
2*count);for(let i=0;i<count;i++){weights[i]+=lengths[i]/6;weights[next[i]]+=lengths[i]/6;weights[count+
i]=4*lengths[i]/6}return weights}var TAU2=2*Math.PI;var QUADRATIC=Math.sqrt(3)/216;var MOST_HALVINGS=4;var Prover=class{#weights;#spare;#row;constructor(domain,panels,rows){
this.domain=domain;this.panels=panels;this.rows=rows;const{columns}=domain;this.#weights=new Float64Array(
panels.count*columns);this.#spare=new Float64Array(columns);this.#row=zeros(columns);const{re,im}=panels.
nodes;for(let i=0;i<panels.count;i++){const end=panels.next[i];fillRemainderWeights(domain,re[i],im[i],
re[end],im[end],this.#weights,i*columns)}}certify(coefficients){return this.prove(coefficients).certificate}prove(coefficients){
const map=new MapData(this.domain,coefficients);const samples=samplesAt(this.rows,map.slopes);return{
certificate:this.#certificate(map,quarters(samples)),samples}}#certificate(map,samples){const{panels}=this;
const turning=new Float64Array(panels.loops);const whole={sigma2_lower:Infinity,sigma1_upper:0,k_upper:0,
halved:0,refused:-1};for(let i=0;i<panels.count;i++){const bounds=this.#onPanel(map,samples,i,whole);
whole.sigma2_lower=Math.min(whole.sigma2_lower,bounds.sigma2);whole.sigma1_upper=Math.max(whole.sigma1_upper,
bounds.sigma1);whole.k_upper=Math.max(whole.k_upper,bounds.k);turning[panels.loop[i]]+=bounds.turning;
if(!(bounds.sigma2>0)){whole.refused=i;break}}const windings=Array.from(turning,angle=>Math.round(angle/
TAU2)+0);const zerosOfFz=windings.reduce((sum,turns)=>sum+turns,0);const certified=map.tied&&whole.refused<
0&&zerosOfFz===0;const k=certified?Math.min(whole.k_upper,1):whole.k_upper;return{certified,...whole,
k_upper:k,windings}}#onPanel(map,samples,i,whole){const{panels}=this;const start=this.#node(samples,
i);const middle=this.#node(samples,panels.count+i);const end=this.#node(samples,panels.next[i]);return this.#between(
map,start,middle,end,this.#weights,i*map.columns,0,whole)}#node([fr,fi,gr,gi],i){const{re,im}=this.panels.
nodes;const norm=this.rows.norms[i];return{x:re[i],y:im[i],norm,fr:fr[i],fi:fi[i],gr:gr[i],gi:gi[i]}}#between(map,start,middle,end,weights,first,depth,whole){
const norm=Math.max(start.norm,middle.norm,end.norm);const[ef,eg]=map.errors(weights,first,norm);const bounds=boundsOf(
start,middle,end,ef,eg);if(bounds.sigma2>0){return bounds}const folded=!(modulus(start.fr,start.fi)>
modulus(start.gr,start.gi));if(depth===MOST_HALVINGS||folded){return bounds}whole.halved++;const left=this.#half(
map,start,middle,depth,whole);if(!(left.sigma2>0)){return left}const right=this.#half(map,middle,end,
depth,whole);return{sigma2:Math.min(left.sigma2,right.sigma2),sigma1:Math.max(left.sigma1,right.sigma1),
k:Math.max(left.k,right.k),turning:left.turning+right.turning}}#half(map,start,end,depth,whole){const weights=this.#spare;
const middle=this.#fresh(map,(start.x+end.x)/2,(start.y+end.y)/2);fillRemainderWeights(this.domain,start.
x,start.y,end.x,end.y,weights,0);return this.#between(map,start,middle,end,weights,0,depth+1,whole)}#fresh(map,x,y){
const norm=fillRow(this.domain,x,y,this.#row,0);const norms=Float64Array.of(norm);const row={count:1,
columns:map.columns,...this.#row,norms};const[fr,fi,gr,gi]=samplesAt(row,map.slopes);return{x,y,norm,
fr,fi,gr,gi}}};var MapData=class{constructor(domain,coefficients){const{vertices,columns}=domain;this.
columns=columns;this.tied=areTied(coefficients,vertices,columns);this.slopes=slopesOf(domain,coefficients);
const[pr,pi,qr,qi]=quarters(this.slopes);this.f=sizesOf(domain,pr,pi);this.g=sizesOf(domain,qr,qi)}errors(weights,first,rowNorm){
let ef=0;let eg=0;for(let j=0;j<this.columns;j++){ef+=weights[first+j]*this.f.jumps[j];eg+=weights[first+
j]*this.g.jumps[j]}const{f,g,columns}=this;return[UPWARD*(ef+slack(columns,rowNorm,f.norm,f.sum)),UPWARD*
(eg+slack(columns,rowNorm,g.norm,g.sum))]}};function areTied(coefficients,vertices,columns){const[pr,
pi,qr,qi]=quarters(coefficients);let tied=true;for(let h=vertices;h<columns;h++){tied=tied&&pr[h]===
qr[h]&&pi[h]===-qi[h]}return tied}function sizesOf({vertices,columns,previous},re,im){const jumps=new Float64Array(
columns);let squares2=0;let sum=0;for(let j=0;j<columns;j++){const size=modulus(re[j],im[j]);squares2+=
size*size;if(j<vertices){const p=previous[j];const rounding=32*UNIT_ROUNDOFF*(size+modulus(re[p],im[p]));
jumps[j]=modulus(re[p]-re[j],im[p]-im[j])+rounding;sum+=size}else{jumps[j]=size}}return{jumps,norm:UPWARD*
Math.sqrt(squares2),sum}}function fillRemainderWeights(domain,ax,ay,bx,by,weights,first){const off=BESIDE*
domain.largest;const length=modulus(bx-ax,by-ay);for(let j=0;j<domain.columns;j++){const computed=distance(
domain.singular,j,ax,ay,bx,by);const least=computed*(1-32*UNIT_ROUNDOFF)-32*UNIT_ROUNDOFF*length-off;
const d=Math.max(least,0);const ratio=(length+2*off)/d;const cube=UPWARD*QUADRATIC*ratio*ratio*ratio;
const beside=UPWARD*2*off/d;weights[first+j]=j<domain.vertices?(2*cube+beside)/TAU2:(6*cube+beside)/
d}}function boundsOf(start,middle,end,ef,eg){const control={fr:2*middle.fr-(start.fr+end.fr)/2,fi:2*
middle.fi-(start.fi+end.fi)/2,gr:2*middle.gr-(start.gr+end.gr)/2,gi:2*middle.gi-(start.gi+end.gi)/2};
const left=pieceBounds(start,between(start,control),middle,ef,eg);const right=pieceBounds(middle,between(
control,end),end,ef,eg);const known=inHalfPlane(start,control,end,ef);const crossed=end.fi*start.fr-
end.fr*start.fi;return{sigma2:known?Math.min(left.sigma2,right.sigma2):-Infinity,sigma1:Math.max(left.
sigma1,right.sigma1),k:Math.max(left.k,right.k),turning:atan2(crossed,end.fr*start.fr+end.fi*start.fi)}}
function between(a,b){return{fr:(a.fr+b.fr)/2,fi:(a.fi+b.fi)/2,gr:(a.gr+b.gr)/2,gi:(a.gi+b.gi)/2}}function inHalfPlane(start,control,end,ef){
const a=modulus(start.fr,start.fi);const b=modulus(end.fr,end.fi);const x=start.fr/a+end.fr/b;const y=start.
fi/a+end.fi/b;const size=modulus(x,y);let least=Infinity;for(const{fr,fi}of[start,control,end]){least=
Math.min(least,(x*fr+y*fi)/size)}return least>ef}function pieceBounds(a,b,c,ef,eg){const p=squaredModulus(
a.fr,a.fi,b.fr,b.fi,c.fr,c.fi);const q=squaredModulus(a.gr,a.gi,b.gr,b.gi,c.gr,c.gi);const pMost=UPWARD*
Math.sqrt(p.most);const qMost=UPWARD*Math.sqrt(q.most);let least=Infinity;let leastP=Infinity;let kappa=0;
for(let i=0;i<5;i++){const low=p.coefficients[i]-BERNSTEIN*p.most;const high=q.coefficients[i]+BERNSTEIN*
q.most;least=Math.min(least,low-high);leastP=Math.min(leastP,low);kappa=Math.max(kappa,high/low)}const sigma1=UPWARD*
(pMost+qMost+ef+eg);const finite=sigma1*sigma1<Infinity;if(!(finite&&least>0)){return{sigma2:-Infinity,
sigma1,k:Infinity}}const sigma2=least/((pMost+qMost)*UPWARD)-ef-eg;const pLeast=Math.sqrt(leastP);const direct=(Math.
sqrt(kappa)*pLeast+eg)/(pLeast-ef);const fromSigma=(sigma1-sigma2)/(sigma1+sigma2);const k=UPWARD*(pLeast>
ef?Math.min(direct,fromSigma):fromSigma);return{sigma2,sigma1,k}}function squaredModulus(ar,ai,br,bi,cr,ci){
const a=ar*ar+ai*ai;const b=br*br+bi*bi;const c=cr*cr+ci*ci;const middle=(ar*cr+ai*ci+2*b)/3;const coefficients=[
a,ar*br+ai*bi,middle,br*cr+bi*ci,c];return{coefficients,most:Math.max(a,b,c)}}var RIDGE=1e-13;var Whitening=class{constructor(domain,panels,rows){this.domain=domain;this.k=domain.
free.length;this.u=1+this.k+domain.holes;this.size=2*this.u+2*this.k;this.t=zeros(domain.columns*this.
u);const samples=scaledDerivatives(domain,panels,rows);const inverse=inverseFactor(gramMatrix(samples,
domain.free),this.k);this.#setTranslation();this.#setSingleValued(inverse);for(let h=0;h<domain.holes;h++){
this.#setLogarithm(h,inverse,samples)}this.#vanishAt(panels.nodes.re[0],panels.nodes.im[0])}#setTranslation(){
for(let j=0;j<this.domain.exterior;j++){this.t.re[j*this.u]=1}}#setSingleValued(inverse){const{k,u,t}=this;
for(let c=0;c<k;c++){for(let j=0;j<=c;j++){const place=this.domain.free[j]*u+1+c;t.re[place]=inverse.
re[c*k+j];t.im[place]=-inverse.im[c*k+j]}}}#setLogarithm(h,inverse,samples){const{domain,k,u,t}=this;
const column=domain.vertices+h;const projections=projectionsOn(samples,domain.free,column);const along=timesAdjoint(
inverse,timesLower(inverse,projections,k),k);const rest=normOfRest(samples,domain.free,along,column);
const place=1+k+h;for(let j=0;j<k;j++){t.re[domain.free[j]*u+place]=-along.re[j]/rest;t.im[domain.free[j]*
u+place]=-along.im[j]/rest}t.re[column*u+place]=1/rest}#vanishAt(x,y){const{domain,u,t}=this;const c=coordinatesAt(
domain,[x,y]);for(let column=1;column<u;column++){let re=0;let im=0;for(let j=0;j<domain.columns;j++){
const a=t.re[j*u+column];const b=t.im[j*u+column];re+=c.re[j]*a-c.im[j]*b;im+=c.re[j]*b+c.im[j]*a}for(let j=0;j<
domain.exterior;j++){t.re[j*u+column]-=re;t.im[j*u+column]-=im}}}toCoefficients(x){const{u,t}=this;const{
columns,vertices}=this.domain;const coefficients=new Float64Array(4*columns);const[pr,pi,qr,qi]=quarters(
this.#expanded(x));for(let j=0;j<columns;j++){let phiRe=0;let phiIm=0;let psiRe=0;let psiIm=0;for(let c=0;c<
u;c++){const a=t.re[j*u+c];const b=t.im[j*u+c];phiRe+=a*pr[c]-b*pi[c];phiIm+=a*pi[c]+b*pr[c];psiRe+=
a*qr[c]-b*qi[c];psiIm+=a*qi[c]+b*qr[c]}coefficients[j]=phiRe;coefficients[columns+j]=phiIm;coefficients[2*
columns+j]=psiRe;coefficients[3*columns+j]=psiIm}tieHoles(coefficients,vertices,columns);return coefficients}pulledBack(g){
const{u,t}=this;const{columns}=this.domain;const pulled=new Float64Array(4*u);const[pr,pi,qr,qi]=quarters(
pulled);for(let j=0;j<columns;j++){const phiRe=g[j];const phiIm=g[columns+j];const psiRe=g[2*columns+
j];const psiIm=g[3*columns+j];for(let c=0;c<u;c++){const a=t.re[j*u+c];const b=t.im[j*u+c];pr[c]+=a*
phiRe+b*phiIm;pi[c]+=a*phiIm-b*phiRe;qr[c]+=a*psiRe+b*psiIm;qi[c]+=a*psiIm-b*psiRe}}return this.#folded(
pulled)}#expanded(x){const{k,u}=this;const all=new Float64Array(4*u);all.set(x.subarray(0,2*u));all.
set(x.subarray(2*u,2*u+k),2*u+1);all.set(x.subarray(2*u+k),3*u+1);for(let c=1+k;c<u;c++){all[2*u+c]=
x[c];all[3*u+c]=-x[u+c]}return all}#folded(all){const{k,u}=this;const g=new Float64Array(this.size);
g.set(all.subarray(0,2*u));g.set(all.subarray(2*u+1,2*u+1+k),2*u);g.set(all.subarray(3*u+1,3*u+1+k),
2*u+k);for(let c=1+k;c<u;c++){g[c]+=all[2*u+c];g[u+c]-=all[3*u+c]}return g}};function tieHoles(coefficients,vertices,columns){
for(let h=vertices;h<columns;h++){coefficients[2*columns+h]=coefficients[h];coefficients[3*columns+h]=
-coefficients[columns+h]}}function scaledDerivatives(domain,panels,rows){const{count,lengths}=panels;
const samples={...zeros(domain.columns*count),count};for(let i=0;i<count;i++){const root=Math.sqrt(lengths[i]);
const d=derivativesOf(domain,rows,(count+i)*domain.columns);for(let j=0;j<domain.columns;j++){samples.
re[j*count+i]=root*d.re[j];samples.im[j*count+i]=root*d.im[j]}}return samples}function inner({re,im,
count},a,b){const p=a*count;const q=b*count;let x=0;let y=0;for(let i=0;i<count;i++){x+=re[p+i]*re[q+
i]+im[p+i]*im[q+i];y+=re[p+i]*im[q+i]-im[p+i]*re[q+i]}return[x,y]}function gramMatrix(samples,chosen){
const k=chosen.length;const gram=zeros(k*k);let trace=0;for(let a=0;a<k;a++){for(let b=0;b<=a;b++){const[
re,im]=inner(samples,chosen[a],chosen[b]);gram.re[a*k+b]=re;gram.im[a*k+b]=im}trace+=gram.re[a*k+a]}
for(let a=0;a<k;a++){gram.re[a*k+a]+=RIDGE*trace/k}return gram}function inverseFactor(gram,k){complexFactor(
gram,k);const inverse=zeros(k*k);for(let a=0;a<k;a++){const diagonal=gram.re[a*k+a];inverse.re[a*k+a]=
1/diagonal;for(let j=0;j<a;j++){const x=gram.re[a*k+j]/diagonal;const y=gram.im[a*k+j]/diagonal;for(let b=0;b<=
j;b++){const re=inverse.re[j*k+b];const im=inverse.im[j*k+b];inverse.re[a*k+b]-=x*re-y*im;inverse.im[a*
k+b]-=x*im+y*re}}}return inverse}function complexFactor({re,im},k){for(let a=0;a<k;a++){const p=a*k;
for(let b=0;b<=a;b++){const q=b*k;let x=re[p+b];let y=im[p+b];for(let j=0;j<b;j++){x-=re[p+j]*re[q+j]+
im[p+j]*im[q+j];y-=im[p+j]*re[q+j]-re[p+j]*im[q+j]}re[p+b]=a===b?Math.sqrt(x):x/re[q+b];im[p+b]=a===
b?0:y/re[q+b]}}}function projectionsOn(samples,chosen,column){const projections=zeros(chosen.length);
for(const[j,row]of chosen.entries()){const[re,im]=inner(samples,row,column);projections.re[j]=re;projections.
im[j]=im}return projections}function timesLower(lower,vector,k){const product=zeros(k);for(let c=0;c<
k;c++){for(let j=0;j<=c;j++){const a=lower.re[c*k+j];const b=lower.im[c*k+j];product.re[c]+=a*vector.
re[j]-b*vector.im[j];product.im[c]+=a*vector.im[j]+b*vector.re[j]}}return product}function timesAdjoint(lower,vector,k){
const product=zeros(k);for(let c=0;c<k;c++){for(let j=0;j<=c;j++){const a=lower.re[c*k+j];const b=-lower.
im[c*k+j];product.re[j]+=a*vector.re[c]-b*vector.im[c];product.im[j]+=a*vector.im[c]+b*vector.re[c]}}
return product}function normOfRest({re,im,count},chosen,along,column){let sum=0;for(let i=0;i<count;i++){
let x=re[column*count+i];let y=im[column*count+i];for(const[j,row]of chosen.entries()){const a=re[row*
count+i];const b=im[row*count+i];x-=a*along.re[j]-b*along.im[j];y-=a*along.im[j]+b*along.re[j]}sum+=
x*x+y*y}return Math.sqrt(sum)}var Shape=class{constructor(outline){this.domain=new Domain(outline);this.panels=gradedPanels(this.domain);
this.rows=rowsAt(this.domain,this.panels.nodes);this.prover=new Prover(this.domain,this.panels,this.
rows);this.whitening=new Whitening(this.domain,this.panels,this.rows)}identity(){const{exterior,columns,
singular}=this.domain;const coefficients=new Float64Array(4*columns);coefficients.set(singular.re.subarray(
0,exterior));coefficients.set(singular.im.subarray(0,exterior),columns);return coefficients}moved(coefficients,[
cos,sin],by){const{exterior,columns:n}=this.domain;const moved=new Float64Array(4*n);for(let j=0;j<n;j++){
const shift=j<exterior?by:[0,0];const[pr,pi]=[coefficients[j],coefficients[n+j]];const[qr,qi]=[coefficients[2*
n+j],coefficients[3*n+j]];moved[j]=cos*pr-sin*pi+shift[0];moved[n+j]=cos*pi+sin*pr+shift[1];moved[2*
n+j]=cos*qr+sin*qi;moved[3*n+j]=cos*qi-sin*qr}return moved}};var BLOCK=48;function dot(a,b){let sum=0;for(let i=0;i<a.length;i++){sum+=a[i]*b[i]}return sum}function addScaled(t,x,y){
for(let i=0;i<y.length;i++){y[i]+=t*x[i]}}function addProduct(a,b,c,rows,columns,length,{sign=1,lower=false}={}){
const tile=new Float64Array(8);for(let i=0;i<rows;i+=4){const end=lower?Math.min(i+4,columns):columns;
for(let j=0;j<end;j+=2){fillTile(a,b,i,j,rows,columns,length,tile);for(let k=0;k<8;k++){const row=i+
(k>>1);const column=j+(k&1);if(row<rows&&column<columns){c.values[c.first+row*c.stride+column]+=sign*
tile[k]}}}}}function fillTile(a,b,i,j,rows,columns,length,tile){const left=a.values;const right=b.values;
const a0=a.first+i*a.stride;const a1=a.first+Math.min(i+1,rows-1)*a.stride;const a2=a.first+Math.min(
i+2,rows-1)*a.stride;const a3=a.first+Math.min(i+3,rows-1)*a.stride;const b0=b.first+j*b.stride;const b1=b.
first+Math.min(j+1,columns-1)*b.stride;let s00=0;let s01=0;let s10=0;let s11=0;let s20=0;let s21=0;let s30=0;
let s31=0;for(let t=0;t<length;t++){const x=right[b0+t];const y=right[b1+t];const p=left[a0+t];const q=left[a1+
t];const r=left[a2+t];const s=left[a3+t];s00+=p*x;s01+=p*y;s10+=q*x;s11+=q*y;s20+=r*x;s21+=r*y;s30+=
s*x;s31+=s*y}tile[0]=s00;tile[1]=s01;tile[2]=s10;tile[3]=s11;tile[4]=s20;tile[5]=s21;tile[6]=s30;tile[7]=
s31}function factorise(a,n){for(let start=0;start<n;start+=BLOCK){const end=Math.min(start+BLOCK,n);
if(!factoriseBlock(a,n,start,end)){return false}const below={values:a,first:end*n+start,stride:n};const rest={
values:a,first:end*n+end,stride:n};addProduct(below,below,rest,n-end,n-end,end-start,{sign:-1,lower:true})}
return true}function factoriseBlock(a,n,start,end){for(let i=start;i<n;i++){const row=i*n;const last=Math.
min(i,end-1);for(let j=start;j<=last;j++){const other=j*n;let rest=a[row+j];for(let k=start;k<j;k++){
rest-=a[row+k]*a[other+k]}if(i!==j){a[row+j]=rest/a[other+j]}else if(rest>0){a[row+j]=Math.sqrt(rest)}else{
return false}}}return true}function solveWith(factor,b){const n=b.length;const x=Float64Array.from(b);
for(let i=0;i<n;i++){const row=i*n;let rest=x[i];for(let j=0;j<i;j++){rest-=factor[row+j]*x[j]}x[i]=
rest/factor[row+i]}for(let i=n-1;i>=0;i--){const row=i*n;x[i]/=factor[row+i];const own=x[i];for(let j=0;j<
i;j++){x[j]-=factor[row+j]*own}}return x}var MEMORY=30;var LEAST_CURVATURE=1e-12;var RIDGES=[0,1e-9,1e-7,1e-5,.001,.01];var Metric=class{#pairs=[];constructor(isometric,factor){
this.isometric=isometric;this.factor=factor}direction(gradient){const q=Float64Array.from(gradient);
const shares=this.#pairs.map(()=>0);for(let i=this.#pairs.length-1;i>=0;i--){const{step,change,curvature}=this.#pairs[i];
shares[i]=dot(step,q)/curvature;addScaled(-shares[i],change,q)}const direction=solveWith(this.factor,
q);for(const[i,{step,change,curvature}]of this.#pairs.entries()){const share=dot(change,direction)/curvature;
addScaled(shares[i]-share,step,direction)}return direction.map(value=>-value)}learn(step,change){const curvature=dot(
step,change);const sizes=Math.sqrt(dot(step,step)*dot(change,change));if(!(curvature>LEAST_CURVATURE*
sizes)){return}this.#pairs.push({step,change,curvature});if(this.#pairs.length>MEMORY){this.#pairs.shift()}}};
function metricAt(assembler,samples,energy,pins){const exact=assembler.assemble(samples,energy,false);
const metric=factorised(exact,pins,[0]);return metric??factorised(assembler.assemble(samples,energy,
true),pins,RIDGES)}function repinned(metric,pins){return factorised(metric.isometric,pins,RIDGES)}function factorised(isometric,pins,ridges){
const size=Math.sqrt(isometric.length);for(const ridge of ridges){const whole=withPins(withRidge(isometric,
size,ridge),size,pins);if(factorise(whole,size)){return new Metric(isometric,whole)}}return null}function withPins(h,size,pins){
for(const{reduced,weight}of pins.rows){for(let i=0;i<size;i++){const x=weight*reduced[i];for(let j=0;j<=
i;j++){h[i*size+j]+=x*reduced[j]}}}return h}function withRidge(h,size,ridge){const shifted=Float64Array.
from(h);let trace=0;for(let i=0;i<size;i++){trace+=h[i*size+i]}for(let i=0;i<size;i++){shifted[i*size+
i]+=ridge*trace/size}return shifted}function noDifferentials(){return{alpha1:0,alpha2:0,beta1:0,beta2:0,beta3:0}}var symmetricDirichlet={
density(x,y){const det=x-y;return(x+y)*(1+1/(det*det))},differentiate(x,y,d){const inverse=1/(x-y);const cube=inverse*
inverse*inverse;const fourth=cube*inverse;d.alpha1=1-(x+3*y)*cube;d.alpha2=1+(3*x+y)*cube;d.beta1=2*
(x+5*y)*fourth;d.beta2=2*(5*x+y)*fourth;d.beta3=-6*(x+y)*fourth}};function exponential(s){const density=(x,y)=>Math.
exp(s*symmetricDirichlet.density(x,y));return{density,differentiate(x,y,d){symmetricDirichlet.differentiate(
x,y,d);const factor=s*density(x,y);const{alpha1,alpha2}=d;d.alpha1=factor*alpha1;d.alpha2=factor*alpha2;
d.beta1=factor*(d.beta1+s*alpha1*alpha1);d.beta2=factor*(d.beta2+s*alpha2*alpha2);d.beta3=factor*(d.
beta3+s*alpha1*alpha2)}}}function amips(s){const density=(x,y)=>{const det=x-y;return Math.exp((2*s*
(x+y)+1)/det+det)};return{density,differentiate(x,y,d){const inverse=1/(x-y);const square=inverse*inverse;
const cube=square*inverse;const a1=1-(4*s*y+1)*square;const a2=-1+(4*s*x+1)*square;const energy=density(
x,y);d.alpha1=a1*energy;d.alpha2=a2*energy;d.beta1=(a1*a1+2*(4*s*y+1)*cube)*energy;d.beta2=(a2*a2+2*
(4*s*x+1)*cube)*energy;d.beta3=(a1*a2-(4*s*(x+y)+2)*cube)*energy}}}var mips={density:(x,y)=>(x+y)/(x-
y),differentiate(x,y,d){const inverse=1/(x-y);const square=inverse*inverse;const cube=square*inverse;
d.alpha1=-2*y*square;d.alpha2=2*x*square;d.beta1=4*y*cube;d.beta2=4*x*cube;d.beta3=-2*(x+y)*cube}};var arap={
density:(x,y)=>2*(x+y)-4*Math.sqrt(x)+2,differentiate(x,_,d){const root=1/Math.sqrt(x);d.alpha1=2-2*
root;d.alpha2=2;d.beta1=root*root*root;d.beta2=0;d.beta3=0}};var ENERGIES={iso:()=>symmetricDirichlet,
exp:exponential,amips,mips:()=>mips,arap:()=>arap};function energyNamed(name,s=1){return ENERGIES[name](
s)}function isometricEnergy(energy,weights,samples){const count=weights.length;let sum=0;for(let i=0;i<
count;i++){const fr=samples[i];const fi=samples[count+i];const gr=samples[2*count+i];const gi=samples[3*
count+i];const x=fr*fr+fi*fi;const y=gr*gr+gi*gi;if(!(x>y)){return Infinity}sum+=weights[i]*energy.density(
x,y)}return Number.isNaN(sum)?Infinity:sum}function energyGradient(energy,weights,samples){const count=weights.
length;const gradient=new Float64Array(4*count);const d=noDifferentials();for(let i=0;i<count;i++){const[
fr,fi,gr,gi]=[i,count+i,2*count+i,3*count+i];const x=samples[fr]*samples[fr]+samples[fi]*samples[fi];
const y=samples[gr]*samples[gr]+samples[gi]*samples[gi];energy.differentiate(x,y,d);const alongF=2*weights[i]*
d.alpha1;const alongG=2*weights[i]*d.alpha2;gradient[fr]=alongF*samples[fr];gradient[fi]=alongF*samples[fi];
gradient[gr]=alongG*samples[gr];gradient[gi]=alongG*samples[gi]}return gradient}var NODES_PER_COORDINATE=2.25;function localHessian(d,x,y){return{acrossF:2*d.alpha1,acrossG:2*d.alpha2,
alongFF:2*d.alpha1+4*d.beta1*x,alongGG:2*d.alpha2+4*d.beta2*y,alongFG:4*d.beta3*Math.sqrt(x*y)}}function positivePart(k){
const mean=(k.alongFF+k.alongGG)/2;const half=(k.alongFF-k.alongGG)/2;const radius=Math.hypot(half,k.
alongFG);const large=Math.max(mean+radius,0);const small=Math.max(mean-radius,0);const centre=(large+
small)/2;const stretch=radius>0?(large-small)/(2*radius):1;return{acrossF:Math.max(k.acrossF,0),acrossG:Math.
max(k.acrossG,0),alongFF:centre+stretch*half,alongGG:centre-stretch*half,alongFG:stretch*k.alongFG}}
var Assembler=class{constructor(shape,{rows,weights,middles}){const{panels,whitening,domain}=shape;this.
shape=shape;const few=panels.count>=NODES_PER_COORDINATE*whitening.u;this.first=few?panels.count:0;this.
nodes=rows.count-this.first;this.weights=few?middles:weights;this.re=new Float64Array(whitening.u*this.
nodes);this.im=new Float64Array(whitening.u*this.nodes);const own={...rows,...this.#ownRows(rows)};for(let c=0;c<
whitening.u;c+=2){const parts=quarters(samplesAt(own,slopesOf(domain,columnsOf(shape,c))));const first=c*
this.nodes;this.re.set(parts[0],first);this.im.set(parts[1],first);if(c+1<whitening.u){this.re.set(parts[2],
first+this.nodes);this.im.set(parts[3],first+this.nodes)}}}#ownRows({columns,re,im}){const start=this.
first*columns;return{count:this.nodes,re:re.subarray(start),im:im.subarray(start)}}assemble(samples,energy,project){
const{u,size}=this.shape.whitening;const local=this.#local(samples,energy,project);const f=this.#framed(
local.f,0);const g=this.#framed(local.g,1);const h=new Float64Array(size*size);const phi=blockOf(f,2*
this.nodes,2*u,[local.alongFF,local.acrossF]);const psi=blockOf(g,2*this.nodes,2*(u-1),[local.alongGG,
local.acrossG]);const cross=this.#crossBlock(f,g,local.alongFG);this.#gather(h,phi,psi,cross);return h}#local(samples,energy,project){
const{nodes,first,weights}=this;const all=samples.length/4;const array=()=>new Float64Array(nodes);const f={
re:array(),im:array()};const g={re:array(),im:array()};const k={alongFF:array(),acrossF:array(),alongGG:array(),
acrossG:array(),alongFG:array()};const d=noDifferentials();for(let t=0;t<nodes;t++){const i=first+t;
const x=unitInto(f,t,samples[i],samples[all+i]);const y=unitInto(g,t,samples[2*all+i],samples[3*all+
i]);energy.differentiate(x,y,d);const exact=localHessian(d,x,y);const own=project?positivePart(exact):
exact;k.alongFF[t]=weights[t]*own.alongFF;k.acrossF[t]=weights[t]*own.acrossF;k.alongGG[t]=weights[t]*
own.alongGG;k.acrossG[t]=weights[t]*own.acrossG;k.alongFG[t]=weights[t]*own.alongFG}return{f,g,...k}}#framed(frame,psi){
const{nodes}=this;const{u,k}=this.shape.whitening;const count=u-psi;const rows=new Float64Array(2*count*
2*nodes);for(let c=psi;c<u;c++){const sign=psi===1&&c>k?-1:1;const real=(c-psi)*2*nodes;const imaginary=(count+
c-psi)*2*nodes;for(let t=0;t<nodes;t++){const x=this.re[c*nodes+t];const y=this.im[c*nodes+t];const along=frame.
re[t]*x+frame.im[t]*y;const across=frame.re[t]*y-frame.im[t]*x;rows[real+t]=along;rows[real+nodes+t]=
across;rows[imaginary+t]=-sign*across;rows[imaginary+nodes+t]=sign*along}}return rows}#crossBlock(f,g,alongFG){
const{nodes}=this;const{u}=this.shape.whitening;const weighted=new Float64Array(2*u*nodes);for(let i=0;i<
2*u;i++){for(let t=0;t<nodes;t++){weighted[i*nodes+t]=alongFG[t]*f[i*2*nodes+t]}}const block=new Float64Array(
2*(u-1)*2*u);const left={values:g,first:0,stride:2*nodes};const right={values:weighted,first:0,stride:nodes};
const into={values:block,first:0,stride:2*u};addProduct(left,right,into,2*(u-1),2*u,nodes);return block}#gather(h,phi,psi,cross){
const{u,k,size}=this.shape.whitening;const width=2*(u-1);for(let i=0;i<2*u;i++){for(let j=0;j<=i;j++){
h[i*size+j]=phi[i*2*u+j]}}const add=(a,b,value)=>{h[Math.max(a,b)*size+Math.min(a,b)]+=value};for(let i=0;i<
width;i++){const row=placeOfPsi(i,u,k);for(let j=0;j<=i;j++){add(row,placeOfPsi(j,u,k),psi[i*width+j])}
for(let j=0;j<2*u;j++){const value=cross[i*2*u+j];add(row,j,row===j?2*value:value)}}}};function columnsOf({
domain,whitening},c){const{columns}=domain;const{u,t}=whitening;const coefficients=new Float64Array(
4*columns);const following=Math.min(c+1,u-1);for(let j=0;j<columns;j++){coefficients[j]=t.re[j*u+c];
coefficients[columns+j]=t.im[j*u+c];coefficients[2*columns+j]=t.re[j*u+following];coefficients[3*columns+
j]=t.im[j*u+following]}return coefficients}function unitInto(frame,t,re,im){const square=re*re+im*im;
const size=Math.sqrt(square);frame.re[t]=size>0?re/size:1;frame.im[t]=size>0?im/size:0;return square}
function blockOf(rows,length,count,[along,across]){const nodes=length/2;const weighted=new Float64Array(
rows.length);for(let first=0;first<rows.length;first+=length){for(let t=0;t<nodes;t++){weighted[first+
t]=along[t]*rows[first+t];weighted[first+nodes+t]=across[t]*rows[first+nodes+t]}}const block=new Float64Array(
count*count);const left={values:weighted,first:0,stride:length};const right={values:rows,first:0,stride:length};
const into={values:block,first:0,stride:count};addProduct(left,right,into,count,count,length,{lower:true});
return block}function placeOfPsi(j,u,k){const imaginary=j>=u-1;const c=imaginary?j-(u-1):j;if(c<k){return 2*
u+(imaginary?k:0)+c}return(imaginary?u:0)+1+c}var RATIO=.6;var LONGER=1.3;var SHORTER=.75;var LONGEST_STEP=2;var ARMIJO=1e-4;var SAFETY=.7;var LEAST_STEP=1e-12;
function largestStep(samples,change){const count=samples.length/4;let least=Infinity;for(let i=0;i<count;i++){
const a=difference(change,change,i,count);const b=2*difference(samples,change,i,count);const c=difference(
samples,samples,i,count);const discriminant=b*b-4*a*c;const denominator=Math.sqrt(Math.max(discriminant,
0))-b;if(discriminant>=0&&denominator>0){least=Math.min(least,2*c/denominator)}}return least}function difference(a,b,i,count){
const[j,k,l]=[count+i,2*count+i,3*count+i];return a[i]*b[i]+a[j]*b[j]-a[k]*b[k]-a[l]*b[l]}function search(energyAt,slope,largest){
const start=energyAt(0);const limit=SAFETY*largest;const first=Math.min(1,limit);let step=first;let energy=energyAt(
step);while(!(energy<start+ARMIJO*step*slope)){step*=RATIO;if(step<LEAST_STEP){return 0}energy=energyAt(
step)}for(const ratio of step===first?[LONGER,SHORTER]:[SHORTER]){const better=followed(energyAt,step,
energy,ratio,Math.min(LONGEST_STEP,limit));if(better!==step){return better}}return step}function followed(energyAt,step,energy,ratio,longest){
let best=step;let least=energy;for(let next=ratio*step;next<=longest&&next>LEAST_STEP;next*=ratio){const found=energyAt(
next);if(!(found<least)){break}best=next;least=found}return best}var TURN=10;var MOST=25e9;var MOST_TURN=1e13;var FARTHEST_TURN=1;var SAME_DIRECTION=1e-4;var Pins=class{constructor(shape,pose,weight){
this.shape=shape;this.pose=pose;this.weight=weight;this.coordinates=pose.handles.map(handle=>coordinatesAt(
shape.domain,handle));this.derivatives=turnedPins(pose).map(i=>derivativesAt(shape,pose.handles[i]));
const{unit}=shape.domain;this.images=this.coordinates.flatMap((c,i)=>{const firm=pose.weights?.[i]??
1;const held=Math.min(weight,MOST/firm)*firm/(unit*unit);const[x,y]=pose.targets[i];const rows=imageRows(
c);return[this.#row(rows[0],x,held),this.#row(rows[1],y,held)]});this.turns=[]}get rows(){return[...this.
images,...this.turns]}get turned(){return this.derivatives.length>0}aim(pose){this.pose=pose;for(const[
i,[x,y]]of pose.targets.entries()){this.images[2*i].aim=x;this.images[2*i+1].aim=y}}measure(coefficients,damping){
this.turns=turnedPins(this.pose).flatMap((i,place)=>{const d=this.derivatives[place];const[re,im]=productOf(
d,coefficients);const size=Math.hypot(re,im);const own=Math.atan2(im,re);const angle=this.pose.angles?.[i]??
null;const scale=this.pose.scales?.[i]??null;const left=angle===null?0:wrapped(angle-own);const direction=own+
Math.max(-FARTHEST_TURN,Math.min(FARTHEST_TURN,left));const[along,across]=turnRows(d,direction);const firm=this.
pose.weights?.[i]??1;const held=Math.min(TURN*this.weight,MOST_TURN/firm)*firm;const bent=scale===null?
1:bend(1-scale/size,damping);return[this.#row(along,scale??0,scale===null?0:held),this.#row(across,0,
held*(angle===null?bent:1))]})}apartFrom(others){if(others.length!==this.turns.length){return Infinity}
let apart=0;let alike=true;for(const[i,{row,weight}]of this.turns.entries()){const gap=row.map((value,j)=>value-
others[i].row[j]);apart=Math.max(apart,Math.sqrt(dot(gap,gap)/dot(row,row)));alike=alike&&Math.abs(weight-
others[i].weight)<=.1*(1+weight)}return alike&&apart<=SAME_DIRECTION?0:Math.max(apart,SAME_DIRECTION)}#row(row,aim,weight){
return{row,reduced:this.shape.whitening.pulledBack(row),aim,weight}}residual(coefficients){return Float64Array.
from(this.rows,({row,aim})=>dot(row,coefficients)-aim)}change(direction){return Float64Array.from(this.
rows,({row})=>dot(row,direction))}product(a,b){return this.rows.reduce((sum,{weight},i)=>sum+weight*
a[i]*b[i],0)}};function turnedPins({handles,angles,scales}){const all=[...handles.keys()];return all.
filter(i=>(angles?.[i]??null)!==null||(scales?.[i]??null)!==null)}function derivativesAt({domain},[x,
y]){const row=zeros(domain.columns);fillRow(domain,x,y,row,0);return derivativesOf(domain,row,0)}function imageRows({
re,im}){const minusRe=re.map(value=>-value);const minusIm=im.map(value=>-value);return[joined([re,minusIm,
re,minusIm]),joined([im,re,minusIm,minusRe])]}function turnRows(d,direction){const cos=Math.cos(direction);
const sin=Math.sin(direction);const re=d.re.map((value,j)=>value*cos+d.im[j]*sin);const im=d.im.map(
(value,j)=>value*cos-d.re[j]*sin);const minusIm=im.map(value=>-value);const none=new Float64Array(re.
length);return[joined([re,minusIm,none,none]),joined([im,re,none,none])]}function joined(parts){const size=parts[0].
length;const whole=new Float64Array(parts.length*size);for(const[i,part]of parts.entries()){whole.set(
part,i*size)}return whole}function productOf(d,coefficients){const n=d.re.length;let re=0;let im=0;for(let j=0;j<
n;j++){re+=d.re[j]*coefficients[j]-d.im[j]*coefficients[n+j];im+=d.re[j]*coefficients[n+j]+d.im[j]*coefficients[j]}
return[re,im]}function bend(strain,damping){return Math.min(1,Math.max(0,damping*strain,(1-damping)*
strain))}function wrapped(angle){return Math.atan2(Math.sin(angle),Math.cos(angle))}function quadratureOf({domain,panels,rows},stiff){const{count,weights,lengths}=panels;if(!stiff){return{
rows,weights,middles:lengths,added:0}}const{factors,points}=stiff;const inside=Float64Array.from(stiff.
weights);const onPanels=weights.map((weight,i)=>weight*factors[i]);const onMiddles=lengths.map((length,i)=>length*
factors[count+i]);const extra=onPanels.reduce((sum,weight,i)=>sum+weight-weights[i],0);return{rows:joinedRows(
rows,rowsAt(domain,complexOf(points))),weights:joined2(onPanels,inside),middles:joined2(onMiddles,inside),
added:inside.reduce((sum,weight)=>sum+weight,extra)}}function joinedRows(a,b){return{count:a.count+b.
count,columns:a.columns,re:joined2(a.re,b.re),im:joined2(a.im,b.im),norms:joined2(a.norms,b.norms)}}
function joined2(a,b){const both=new Float64Array(a.length+b.length);both.set(a);both.set(b,a.length);
return both}var LEAST_ENERGY=1e-6;var SHORTER2=.5;var MOST_TRIES=12;var CONTRACTION=.3;var BEHIND=.001;var MOST_RENEWALS=3;
var ROUNDING=1e-9;var MOST_MEASUREMENTS=16;var KEPT=1e9;var FAR=.2;var DAMPING=3;var Solver=class _Solver{#assembler;#metric=null;#measurements=0;#damping=1;constructor(shape,{
energy="iso",s=1,weight=1e5,stiff=null}={}){const{domain,panels}=shape;this.shape=shape;this.energyMeasure=
energyNamed(energy,s);this.weight=weight;this.quadrature=quadratureOf(shape,stiff);this.prover=stiff?
new Prover(domain,panels,this.quadrature.rows):shape.prover;this.#assembler=new Assembler(shape,this.
quadrature);this.pins=new Pins(shape,{handles:[],targets:[]},weight);this.state=this.#certified(shape.
identity());this.promised=Infinity;this.factors=0}withOptions(options){const other=new _Solver(this.
shape,options);other.#pin(this.pins.pose);other.state=other.#certified(this.state.coefficients);other.#remeasure();
return other}get energy(){return this.state.isometric+this.#pinEnergy(this.state.residual)}solve(pose,{
tolerance=1e-8,iterations=200}={}){this.begin(pose);return this.#descend(tolerance,iterations)}begin(pose){
const{handles,targets}=pose;const[turn,by]=rigidMotion(handles,targets);this.#pin(pose);this.state=this.#certified(
this.shape.moved(this.shape.identity(),turn,by));this.#metric=null;this.#remeasure()}drag(pose,steps=2){
this.aim(pose);let outcome="minimal";for(let i=0;i<steps;i++){outcome=this.step(1e-12);if(outcome!==
"stepped"){break}}for(let i=0;i<MOST_RENEWALS&&this.#isBehind(outcome);i++){this.#metric=null;outcome=
this.step(1e-12)}return outcome}#isBehind(outcome){const failed=outcome==="refused"||outcome==="no d\
ecrease";return failed?this.promised>ROUNDING:outcome==="stepped"&&this.promised>BEHIND}aim(pose){if(pinsAlike(
this.pins.pose,pose)){this.pins.aim(pose)}else{this.#pin(pose);this.#metric=this.#metric&&repinned(this.#metric,
this.pins)}this.#remeasure()}#descend(tolerance,iterations){let gain=Infinity;for(let i=0;i<iterations;i++){
const fresh=this.#metric===null;const before=this.energy;const outcome=this.step(tolerance);if(outcome!==
"stepped"){const ends=fresh||outcome==="minimal";const changed=ends?this.#measure():false;if(ends&&!changed){
return outcome}this.#metric=ends?this.#metric:null;gain=Infinity;continue}const now=before-this.energy;
if(!fresh&&now>CONTRACTION*gain){this.#metric=null}gain=now;this.#measure()}return"stepped"}step(tolerance){
this.#metric??=this.#newMetric();if(this.#metric===null){return"indefinite"}const gradient=this.#gradient();
const direction=this.#metric.direction(gradient);const slope=dot(gradient,direction);this.promised=-slope/
2/Math.max(this.energy,LEAST_ENERGY);if(!(this.promised>tolerance)){return this.promised>=0?"minimal":
"no decrease"}const change=this.shape.whitening.toCoefficients(direction);const longest=this.#searched(
change,slope);if(longest===0){return"no decrease"}const step=this.#proved(change,longest);if(step===
0){return"refused"}const after=this.#gradient();const moved=direction.map(value=>step*value);const turned=after.
map((value,i)=>value-gradient[i]);this.#metric.learn(moved,turned);return"stepped"}#searched(change,slope){
const{shape,state,pins}=this;const rise=samplesAt(this.quadrature.rows,slopesOf(shape.domain,change));
const moved=pins.change(change);const constant=pins.product(state.residual,state.residual)/2;const linear=pins.
product(state.residual,moved);const quadratic=pins.product(moved,moved)/2;const there=new Float64Array(
rise.length);const energyAt=t=>{for(let i=0;i<there.length;i++){there[i]=state.samples[i]+t*rise[i]}
const pinned=constant+t*linear+t*t*quadratic;return this.#isometric(there)+pinned};return search(energyAt,
slope,largestStep(state.samples,rise))}#proved(change,longest){let step=longest;for(let i=0;i<MOST_TRIES;i++){
const coefficients=Float64Array.from(this.state.coefficients);addScaled(step,change,coefficients);const proof=this.
prover.prove(coefficients);if(proof.certificate.certified){this.state=this.#stateOf(coefficients,proof);
return step}step*=SHORTER2}return 0}#certified(coefficients){const proof=this.prover.prove(coefficients);
if(!proof.certificate.certified){throw new Error("the map to start from cannot be proved locally inj\
ective")}return this.#stateOf(coefficients,proof)}#stateOf(coefficients,{certificate,samples}){const isometric=this.#isometric(
samples);const residual=this.pins.residual(coefficients);return{coefficients,certificate,samples,isometric,
residual,gradient:null}}#gradient(){const{state,pins}=this;state.gradient??=this.#isometricGradient();
const gradient=Float64Array.from(state.gradient);for(const[i,{reduced,weight}]of pins.rows.entries()){
addScaled(weight*state.residual[i],reduced,gradient)}return gradient}#isometric(samples){const{energyMeasure,
quadrature}=this;const whole=isometricEnergy(energyMeasure,quadrature.weights,samples);return whole-
quadrature.added*energyMeasure.density(1,0)}#isometricGradient(){const{shape,state,energyMeasure,quadrature}=this;
const bySamples=energyGradient(energyMeasure,quadrature.weights,state.samples);const bySlopes=pulledThroughRows(
quadrature.rows,bySamples);return shape.whitening.pulledBack(pulledThroughSlopes(shape.domain,bySlopes))}#pinEnergy(residual){
return this.pins.product(residual,residual)/2}#newMetric(){this.factors++;return metricAt(this.#assembler,
this.state.samples,this.energyMeasure,this.pins)}#pin(pose){this.pins=new Pins(this.shape,pose,this.
weight)}#remeasure(){this.#measurements=0;this.#damping=1;this.#measure();this.state.residual=this.pins.
residual(this.state.coefficients)}#measure(){const{pins}=this;if(!pins.turned||this.#damping===KEPT){
return false}if(this.#measurements===MOST_MEASUREMENTS){this.#damping=KEPT}const before=pins.turns;pins.
measure(this.state.coefficients,this.#damping);const apart=pins.apartFrom(before);if(apart===0){pins.
turns=before;return false}if(this.#measurements>0&&apart>FAR&&this.#damping!==KEPT){this.#damping*=DAMPING}
this.#measurements++;this.#metric=this.#metric&&repinned(this.#metric,pins);this.state.residual=pins.
residual(this.state.coefficients);return true}};function pinsAlike(a,b){const kept=({handles,weights,
angles,scales})=>JSON.stringify([handles,weights??null,angles??null,scales??null]);return kept(a)===
kept(b)}function rigidMotion(points,targets){const middle=meanOf(points);const aim=meanOf(targets);let re=0;
let im=0;for(const[i,point]of points.entries()){const[x,y]=[point[0]-middle[0],point[1]-middle[1]];const[
u,v]=[targets[i][0]-aim[0],targets[i][1]-aim[1]];re+=x*u+y*v;im+=x*v-y*u}const size=Math.hypot(re,im);
const[cos,sin]=size>0?[re/size,im/size]:[1,0];const by=[aim[0]-cos*middle[0]+sin*middle[1],aim[1]-cos*
middle[1]-sin*middle[0]];return[[cos,sin],[by[0],by[1]]]}function meanOf(points){const count=Math.max(
points.length,1);const x=points.reduce((sum,point)=>sum+point[0],0);const y=points.reduce((sum,point)=>sum+
point[1],0);return[x/count,y/count]}var SETTLED=1e-7;var LiveWorker=class{#post;#later;#waiting=[];#scheduled=false;#solver=null;#points=null;#drag=null;constructor(post,later){
this.#post=post;this.#later=later}receive(request){const last=this.#waiting.at(-1);if(request.type===
"drag"&&last?.type==="drag"){this.#waiting.pop()}this.#waiting.push(request);this.#schedule()}#schedule(){
if(this.#scheduled){return}this.#scheduled=true;this.#later(()=>{this.#scheduled=false;this.#turn()})}#turn(){
const request=this.#waiting.shift();const id=request?.id??this.#drag?.id??0;try{if(request){this.#answer(
request)}else if(this.#drag){this.#follow(this.#drag.id,this.#drag.pose)}}catch(error){this.#drag=null;
this.#post({type:"failed",id,message:String(error)})}if(this.#waiting.length>0||this.#drag){this.#schedule()}}#answer(request){
this.#drag=null;switch(request.type){case"shape":return this.#prepare(request.id,request.outline,request.
points,request.options);case"options":return this.#change(request.id,request.options);case"solve":return this.#solve(
request.id,request.pose);case"drag":return this.#follow(request.id,request.pose)}}#prepare(id,outline,points,options){
const shape=new Shape(outline);this.#solver=new Solver(shape,options);this.#points=points?new FieldPoints(
shape.domain,points):null;const{panels,domain}=shape;this.#post({type:"ready",id,panels:panels.count,
columns:domain.columns})}#change(id,options){this.#solver=this.#ready().withOptions(options);this.#postMap(
id,"minimal",true)}#solve(id,pose){const outcome=this.#ready().solve(pose);this.#postMap(id,outcome,
true)}#follow(id,pose){const solver=this.#ready();const outcome=solver.drag(pose);const settled=outcome!==
"stepped"||solver.promised<SETTLED;this.#drag=settled?null:{id,pose};this.#postMap(id,outcome,settled)}#ready(){
if(!this.#solver){throw new Error("there is no shape yet; send a request of the type shape first")}return this.#solver}#postMap(id,outcome,settled){
const{state,energy}=this.#ready();const coefficients=state.coefficients.slice();const field=this.#points?.
evaluate(coefficients);const map={type:"map",id,settled,outcome,energy,coefficients,certificate:state.
certificate,images:field?.images??null,samples:field?.samples??null};this.#post(map)}};function serve(scope){
const turns=new MessageChannel;const queue=[];turns.port1.onmessage=()=>queue.shift()?.();const worker=new LiveWorker(
answer=>scope.postMessage(answer),turn=>{queue.push(turn);turns.port2.postMessage(null)});scope.onmessage=
({data})=>worker.receive(data)}serve(globalThis);})();
