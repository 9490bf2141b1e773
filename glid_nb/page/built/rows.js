function make(tag,properties={},...children){const element=document.createElement(tag);if(element instanceof
HTMLButtonElement)element.type="button";for(const[name,value]of Object.entries(properties)){if(name.
startsWith("on"))element.addEventListener(name.slice(2),value);else if(name in element&&name!=="list")
Reflect.set(element,name,value);else element.setAttribute(name,value)}element.append(...children);return element}function follow(model,listeners){for(const[names,listener]of Object.entries(listeners)){model.on(names,
listener);listener()}}function between(keys,from,to){const[a,b]=[keys.indexOf(from),keys.indexOf(to)];if(a<0||b<0)return[to];
return a<=b?keys.slice(a,b+1):keys.slice(b,a+1).reverse()}function rowAfter(key,at,count){const to={
ArrowUp:at-1,ArrowDown:at+1,Home:0,End:count-1}[key];return to===void 0||!count?null:Math.min(Math.max(
to,0),count-1)}var PATHS={edit:"M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",brush:"M13.5 2.5l-6 6 M6.7 9.2c-1.6\
-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z",eraser:"M9.2 2.8l4 4-6\
.4 6.4H4.4L2.2 11z M5.5 6.6l4 4 M7 13.2h6.5",rectangle:"M2.5 4h11v8h-11z",undo:"M5.5 3L2.5 6l3 3 M3 \
6h6.2a3.6 3.6 0 0 1 0 7.2H6",redo:"M10.5 3l3 3-3 3 M13 6H6.8a3.6 3.6 0 0 0 0 7.2H10",fit:"M2 5.5V2h3\
.5 M10.5 2H14v3.5 M14 10.5V14h-3.5 M5.5 14H2v-3.5",screen:"M10 2h4v4 M14 2L9.5 6.5 M6 14H2v-4 M2 14l\
4.5-4.5",eye:"M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8z M8 6.2a1.8 1.8 0 1 0 0 3.\
6 1.8 1.8 0 0 0 0-3.6z",plus:"M8 3v10 M3 8h10",minus:"M3 8h10",open:"M2 12.5v-9h4l1.5 2H14v7z",play:"\
M5 3l8 5-8 5z",pause:"M5.5 3v10 M10.5 3v10",record:"M8 4.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6z",
onion:"M6.2 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8z M9.8 4a4 4 0 1 1 0 8",copy:"M5.5 5.5h8v8h-8z M3 10.5v-8h8",
export:"M8 2v8 M4.8 6.8L8 10l3.2-3.2 M3 13.5h10",trash:"M3 4.5h10 M6.5 4.5v-2h3v2 M4.5 4.5l.6 9h5.8l\
.6-9"};var BODY="M4 7.5h8V13H4z";var SWITCHES={hidden:{on:`${PATHS.eye} M2.5 13.5l11-11`,off:PATHS.eye,set:"\
Hide",unset:"Show"},locked:{on:`${BODY} M5.8 7.5V5.2a2.2 2.2 0 0 1 4.4 0v2.3`,off:`${BODY} M5.8 7.5V\
4.2a2.2 2.2 0 0 1 4.2-.9`,set:"Lock",unset:"Unlock"}};var COLOURS=6;var RowView=class{shown=null;field=null;buttons=new Map;constructor(hand){
this.hand=hand;this.picture=make("img",{alt:""});this.number=make("span",{className:"glid-entry-numb\
er"});this.name=make("span",{className:"glid-entry-name"});this.detail=make("span",{className:"glid-\
entry-detail","aria-hidden":"true"});this.said=make("span",{className:"glid-entry-said"});this.group=
make("span",{className:"glid-entry-group"});this.title=make("span",{className:"glid-entry-title",role:"\
rowheader"});this.title.append(this.picture,this.number,this.name);this.place=make("span",{role:"gri\
dcell"},this.detail,this.said);this.mates=make("span",{role:"gridcell"},this.group);this.element=make(
"div",{className:"glid-entry",role:"row",tabIndex:-1});this.element.append(this.title,this.place,this.
mates);this.element.addEventListener("click",e=>this.#click(e));this.element.addEventListener("dblcl\
ick",e=>this.#doubleClick(e))}get key(){return this.shown?.key??-1}show(row){this.shown=row;const title=row.
name?`${row.number} ${row.name}`.trim():row.unnamed;this.number.hidden=!row.name||!row.number;put(this.
number,row.number);put(this.name,row.name||row.unnamed);put(this.detail,row.detail);put(this.said,row.
said);this.place.hidden=!row.detail;this.mates.hidden=!row.group;put(this.group,row.group?`${row.group}`:
"");this.group.dataset.colour=`${row.group%COLOURS}`;this.group.title=row.group?`Group ${row.group}`:
"";this.group.ariaLabel=this.group.title;this.group.role="img";this.picture.hidden=!row.picture;if(row.
picture&&this.picture.src!==row.picture)this.picture.src=row.picture;for(const[name,on]of Object.entries(
row.switches)){this.#showSwitch(name,on,title)}this.element.classList.toggle("glid-entry-away",Boolean(
row.switches.hidden))}mark(chosen,reached){const selected=String(chosen);if(this.element.ariaSelected!==
selected)this.element.ariaSelected=selected;this.element.tabIndex=reached?0:-1}#showSwitch(name,on,of){
const{set,unset,...paths}=SWITCHES[name];const button=this.buttons.get(name)??this.#addSwitch(name);
const title=`${on?unset:set} ${of}`;if(button.title!==title)Object.assign(button,{title,ariaLabel:title});
if(button.dataset.on===String(on))return;button.dataset.on=String(on);const path=on?paths.on:paths.off;
button.innerHTML=`<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${path}"/></svg>`}#addSwitch(name){
const onclick=e=>{e.stopPropagation();this.hand.set(this.key,name,!this.shown?.switches[name])};const button=make(
"button",{className:"glid-icon",tabIndex:-1,onclick});button.addEventListener("dblclick",e=>e.stopPropagation());
this.title.before(make("span",{role:"gridcell"},button));this.buttons.set(name,button);return button}#click(e){
if(e.target!==this.field)this.hand.click(this.key,e)}#doubleClick(e){if(e.target!==this.field&&!(e.shiftKey||
e.ctrlKey||e.metaKey))this.rename()}rename(){if(this.field||!this.shown)return;const{key,name}=this.
shown;const field=make("input",{type:"text",value:name,"aria-label":"Name"});const end=keep=>{if(this.
field!==field)return;const focused=field.matches(":focus");this.field=null;const typed=field.value.trim();
field.remove();if(focused)this.element.focus({preventScroll:true});if(keep&&typed!==name)this.hand.rename(
key,typed)};field.addEventListener("blur",()=>end(true));field.addEventListener("keydown",e=>{e.stopPropagation();
if(e.key==="Enter"||e.key==="Escape")end(e.key==="Enter")});this.field=field;this.title.append(field);
field.focus({preventScroll:true});field.select()}};function put(element,text){if(element.textContent!==
text)element.textContent=text}var Rows=class{views=[];#from=-1;#at=-1;constructor(model){this.model=model;this.grid=make("div",{className:"\
glid-entry-grid",role:"grid"});this.nothing=make("p",{className:"glid-entry-nothing"});this.element=
make("div",{className:"glid-skin glid-rows"},this.grid,this.nothing);this.grid.addEventListener("key\
down",e=>this.#keydown(e));this.grid.addEventListener("focusin",e=>this.#focused(e))}get#keys(){return this.
model.get("rows").map(({key})=>key)}showLabels(){this.grid.ariaLabel=this.model.get("label");this.grid.
ariaMultiSelectable=String(this.model.get("several"));this.nothing.textContent=this.model.get("nothi\
ng")}showRows(){const rows=this.model.get("rows");const held=this.grid.contains(document.activeElement);
for(const view of this.views.splice(rows.length))view.element.remove();for(const[i,row]of rows.entries()){
if(!this.views[i])this.#add();this.views[i].show(row)}this.grid.hidden=!rows.length;this.nothing.hidden=
Boolean(rows.length);this.showChosen();if(held&&!this.grid.contains(document.activeElement))this.#reached?.
element.focus()}#add(){const view=new RowView({click:(key,e)=>this.#click(key,e),set:(key,name,on)=>this.
model.send({type:"set",key,name,on}),rename:(key,name)=>this.model.send({type:"rename",key,name})});
this.views.push(view);this.grid.append(view.element)}showChosen(){const chosen=this.model.get("chose\
n");const keys=this.#keys;const last=chosen.at(-1)??-1;if(!keys.includes(this.#from)||chosen.length<
2)this.#from=last;const held=this.grid.contains(document.activeElement)&&keys.includes(this.#at);if(!held)
this.#at=keys.includes(last)?last:keys[0]??-1;for(const view of this.views)view.mark(chosen.includes(
view.key),view.key===this.#at);if(!held)this.#reveal(this.views.find(({key})=>key===last))}get#reached(){
return this.views.find(({key})=>key===this.#at)}#reveal(view){if(!view)return;const{grid}=this;const{
offsetTop:top,offsetHeight:height}=view.element;if(top<grid.scrollTop)grid.scrollTop=top;const below=top+
height-grid.clientHeight;if(below>grid.scrollTop)grid.scrollTop=below}#choose(keys){this.model.send(
{type:"choose",keys})}#click(key,e){this.#reach(key);this.#chooseBy(key,e)}#chooseBy(key,e){const several=this.
model.get("several");if(several&&e.shiftKey){this.#choose(between(this.#keys,this.#from,key));return}
this.#from=key;if(several&&(e.ctrlKey||e.metaKey))this.model.send({type:"switch",key});else this.#choose(
[key])}#reach(key){this.#at=key;const view=this.#reached;view?.element.focus({preventScroll:true});this.#reveal(
view)}#focused(e){const view=this.#viewOf(e.target);if(!view||view.key===this.#at)return;this.#at=view.
key;for(const one of this.views)one.element.tabIndex=one===view?0:-1}#viewOf(target){return this.views.
find(({element})=>element.contains(target))}#keydown(e){const view=this.#viewOf(e.target);if(!view||
view.field||e.altKey)return;const does=this.#keyDoes(e,view);if(!does)return;e.preventDefault();e.stopPropagation();
does()}#keyDoes(e,view){const onRow=e.target===view.element;const command=e.ctrlKey||e.metaKey;const to=rowAfter(
e.key,this.views.indexOf(view),this.views.length);if(to!==null)return()=>this.#go(this.views[to].key,
e);if(e.key==="ArrowLeft"||e.key==="ArrowRight"){return()=>this.#sideways(view,e.key==="ArrowLeft"?-1:
1)}if(e.key==="F2")return()=>view.rename();if(onRow&&(e.key===" "||e.key==="Enter"))return()=>this.#chooseBy(
view.key,e);if(command&&e.key==="a"&&this.model.get("several")){return()=>this.#choose(this.#keys)}return null}#go(key,e){
this.#reach(key);if(!e.ctrlKey&&!e.metaKey)this.#chooseBy(key,e)}#sideways(view,step){const stops=[view.
element,...view.buttons.values()];const at=stops.indexOf(document.activeElement);stops[Math.min(Math.
max(at+step,0),stops.length-1)].focus({preventScroll:true})}};function render({model,el}){const rows=new Rows(model);el.classList.add("glid-host");el.append(rows.
element);follow(model,{"change:label change:nothing change:several":()=>rows.showLabels(),"change:ro\
ws":()=>rows.showRows(),"change:chosen":()=>rows.showChosen()})}var main_default={render};export{main_default as default};
