// A vertex of the picture's mesh: where the map takes it, at the height of its part of the shape.

uniform vec4 frame;  // the picture's lower left corner and its size, world units

varying vec2 v_source;
varying vec2 v_uv;
varying vec2 v_fz;
varying vec2 v_fzb_conj;

void main() {
  vec2 f;
  harmonic_map(position.xy, f, v_fz, v_fzb_conj);
  v_source = position.xy;
  v_uv = (position.xy - frame.xy) / frame.zw;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(f, position.z, 1.0);
}
