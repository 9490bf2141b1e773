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
    if (this.frame) this.look(this.frame, this.unit);
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
      if (uniforms.pixel && this.unit) uniforms.pixel.value = this.unit;
    }
    this.redraw();
  }

  look(frame, unit) {
    this.frame = frame;
    this.unit = unit;
    for (const { obj } of this.materials) {
      if (obj && obj.uniforms && obj.uniforms.pixel) obj.uniforms.pixel.value = unit;
    }
    if (this.camera) this.camera.set(frame); // its renderer draws anew by itself
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
