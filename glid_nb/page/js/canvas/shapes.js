// Puts the kernel's coefficients and the page's view into pythreejs's objects.

import { make, toFloats } from "../pad/dom.js";

// pythreejs keeps three.js's renderers for later, and those keep lists of all that they ever drew.
const clearLists = (_scene, { renderLists }) => renderLists.dispose();

// pythreejs draws a removed view once more if that was asked for before, and then keeps a renderer for
// it for good.
const drawNoMore = (view) => view.once("remove", () => (view.renderScene = () => {}));

export class Shapes {
  constructor(model, view) {
    Object.assign(this, { model, view, materials: [] });
    this.motion = null; // what the timeline shows instead: coefficients, or true for the kernel's frames
    this.loading = 0;
    model.on("change:materials change:camera change:renderer", () => this.load());
  }

  async load() {
    const turn = ++this.loading;
    const { model } = this;
    const references = [model.get("camera"), model.get("renderer"), ...model.get("materials")];
    const [camera, renderer, ...materials] = await Promise.all(
      references.map((r) => model.widget_manager.get_model(r.replace("IPY_MODEL_", ""))),
    );
    await Promise.all([camera, renderer, ...materials].map((m) => m.initPromise));
    if (turn !== this.loading) return; // there are newer ones
    this.forget();
    Object.assign(this, { camera, renderer, materials });
    // When the kernel changes a uniform, pythreejs replaces them all, on the event "change".
    for (const material of materials) material.on("change", this.refresh, this);
    renderer.get("scene").off("beforeRender", clearLists).on("beforeRender", clearLists);
    for (const view of Object.values(renderer.views)) view.then(drawNoMore);
    this.refresh();
  }

  forget() {
    for (const material of this.materials) material.off(null, null, this);
    this.materials = [];
  }

  // Puts the newest coefficients into every material.
  refresh() {
    const floats = this.motion?.length ? this.motion : toFloats(this.model.get("coefficients"));
    for (const { obj } of this.materials) {
      const { cage, coefficients, holes, by_margin } = obj?.uniforms ?? {};
      if (by_margin?.value) by_margin.value = this.motion ? 2 : 1;
      if (!coefficients) continue;
      const chain = cage.value.length;
      // The kernel evaluates, or another domain's coefficients arrive before its materials.
      if (floats.length !== chain + holes.value.length) continue;
      coefficients.value = floats.subarray(0, chain);
      holes.value = floats.subarray(chain);
    }
    this.see();
    this.redraw();
  }

  // Gives the picture's vertices the heights of a motion's time; null gives back those of the pose.
  lift(heights) {
    const position = this.renderer?.get("scene").obj?.children[0]?.geometry.attributes.position;
    if (!position) return;
    if (position.array !== this.lifted) this.resting = position.array; // the kernel's
    const moves = heights?.length === position.count;
    if (!moves && position.array === this.resting) return;
    if (!moves) position.setArray(this.resting);
    else if (position.array === this.resting)
      position.setArray((this.lifted = this.resting.slice()));
    if (moves)
      heights.forEach((z, i) => {
        this.lifted[3 * i + 2] = z;
      });
    position.needsUpdate = true;
  }

  // Shows what the view shows; the camera's renderer draws anew by itself.
  see() {
    const { x, y, unit, width, height } = this.view;
    const w = (width / 2) * unit;
    const h = (height / 2) * unit;
    for (const { obj } of this.materials) {
      if (obj?.uniforms?.pixel) obj.uniforms.pixel.value = unit;
    }
    this.camera?.set({ left: x - w, right: x + w, top: y + h, bottom: y - h });
  }

  redraw() {
    this.renderer?.trigger("rerender", this.renderer, {});
  }

  close() {
    this.loading++;
    this.forget();
  }
}

const NEAR = 8; // pixels: a cage lies a little outside of what is drawn

// Whether something is drawn near a place of the pad.
export function coveredNear(pad, place) {
  const drawn = pad.closest(".glid-pane").querySelector(".jupyter-threejs canvas");
  const size = 2 * NEAR;
  const pen = make("canvas", { width: size, height: size }).getContext("2d");
  pen.drawImage(
    drawn,
    ...place.map((at) => NEAR - Math.floor((at * drawn.width) / pad.clientWidth)),
  );
  return pen.getImageData(0, 0, size, size).data.some((value, i) => i % 4 === 3 && value);
}

// How many vectors of uniforms a vertex shader may have here; 0 without WebGL.
export function uniformVectors() {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2") || canvas.getContext("webgl");
  if (!gl) return 0;
  const count = gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return count;
}

const N_TIMED = 3; // drawings, after a first one that compiles the shaders

// The fastest of some drawings in milliseconds, 0 without WebGL.
export async function drawingTime(pad, shapes) {
  const times = [];
  for (let i = 0; i <= N_TIMED; i++) {
    shapes.redraw(); // the renderer draws in the next frame, before what is below
    await new Promise((go) => requestAnimationFrame(go));
    const canvas = pad.closest(".glid-pane")?.querySelector(".jupyter-threejs canvas");
    const gl = canvas && (canvas.getContext("webgl") || canvas.getContext("webgl2"));
    if (!gl) continue;
    const start = performance.now();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for all of it
    times.push(performance.now() - start);
  }
  return times.length > 1 ? Math.min(...times.slice(1)) : 0;
}
