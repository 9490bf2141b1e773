// As harmonic.glsl, but computed by the kernel, for cages that are too large for a shader.

attribute vec2 image;
attribute vec4 derivatives;  // f_z, conj(f_zbar)

void harmonic_map(vec2 z, out vec2 f, out vec2 fz, out vec2 fzb_conj) {
  f = image;
  fz = derivatives.xy;
  fzb_conj = derivatives.zw;
}
