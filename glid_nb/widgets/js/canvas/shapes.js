// The three.js side: puts the kernel's coefficients and the view into pythreejs' objects, so that a
// frame is the coefficients alone and a pan costs nothing on the wire.

function modelOf(manager, reference) {
  return manager.get_model(reference.replace("IPY_MODEL_", ""));
}

export class Shapes {
  constructor(model) {
    this.model = model;
    this.materials = [];
    this.loading = 0;
    this.onMaterials = () => this.load();
    model.on("change:materials change:camera change:renderer", this.onMaterials);
  }

  async load() {
    const turn = ++this.loading;
    const manager = this.model.widget_manager;
    const references = this.model.get("materials");
    const [camera, renderer, ...materials] = await Promise.all(
      [this.model.get("camera"), this.model.get("renderer"), ...references].map((r) => modelOf(manager, r)),
    );
    await Promise.all([camera, renderer, ...materials].map((m) => m.initPromise));
    if (turn !== this.loading) return; // there are newer ones
    this.forget();
    Object.assign(this, { camera, renderer, materials });
    // When the kernel changes a uniform, pythreejs replaces them all, on the event "change".
    this.onUniforms = () => this.refresh();
    for (const material of materials) material.on("change", this.onUniforms);
    this.refresh();
  }

  forget() {
    for (const material of this.materials) material.off("change", this.onUniforms);
    this.materials = [];
  }

  // The newest coefficients into every material.
  refresh() {
    const bytes = this.model.get("coefficients");
    const floats = bytes && bytes.byteLength
      ? new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength))
      : null;
    for (const material of this.materials) {
      const uniforms = material.obj && material.obj.uniforms;
      if (!uniforms) continue;
      if (floats && uniforms.coefficients) {
        const chain = uniforms.cage.value.length;
        // Another domain's coefficients may arrive before its materials.
        if (floats.length === chain + uniforms.holes.value.length) {
          uniforms.coefficients.value = floats.subarray(0, chain);
          uniforms.holes.value = floats.subarray(chain);
        }
      }
    }
    this.see();
    this.redraw();
  }

  // The view, in the terms of an orthographic camera.
  look({ x, y, unit, width, height }) {
    const w = (width / 2) * unit, h = (height / 2) * unit;
    this.frame = { left: x - w, right: x + w, top: y + h, bottom: y - h };
    this.unit = unit;
    this.see();
  }

  see() {
    for (const { obj } of this.materials) {
      if (obj?.uniforms?.pixel) obj.uniforms.pixel.value = this.unit;
    }
    if (this.camera && this.frame) this.camera.set(this.frame); // its renderer draws anew by itself
  }

  redraw() {
    if (this.renderer) this.renderer.trigger("rerender", this.renderer, {});
  }

  close() {
    this.loading++;
    this.forget();
    this.model.off("change:materials change:camera change:renderer", this.onMaterials);
  }
}

// How many vectors of uniforms a vertex shader may have here.
export function uniformVectors() {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2") || canvas.getContext("webgl");
  if (!gl) return 0;
  const count = gl.getParameter(gl.MAX_VERTEX_UNIFORM_VECTORS);
  const lose = gl.getExtension("WEBGL_lose_context");
  if (lose) lose.loseContext();
  return count;
}

const N_TIMED = 3; // drawings, after a first one that compiles the shaders

// Milliseconds of the quickest of some drawings, 0 where there is nothing to draw on.
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
  const quickest = Math.min(...times.slice(1));
  return Number.isFinite(quickest) ? quickest : 0;
}
