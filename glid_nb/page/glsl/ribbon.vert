// A vertex of a line along a curve of the undeformed shape, of a width in pixels.

attribute vec3 ribbon;  // the curve's direction, and which side of it this vertex is on: -1 or 1
attribute float margin;

uniform float pixel;
uniform float half_width;  // pixels
uniform float by_margin;   // 2: by the sigma_2 of the map that is shown
uniform float full_margin;

varying float v_side;
varying float v_margin;

void main() {
  vec2 f, fz, fzb_conj;
  harmonic_map(position.xy, f, fz, fzb_conj);
  vec2 fzb = vec2(fzb_conj.x, -fzb_conj.y);
  vec2 f_x = fz + fzb, f_y = vec2(fzb.y - fz.y, fz.x - fzb.x);
  vec2 along = ribbon.x * f_x + ribbon.y * f_y;
  along /= max(length(along), 1e-12);
  float reach = half_width + 0.75;  // room for the soft edge
  vec2 shifted = f + vec2(-along.y, along.x) * ribbon.z * reach * pixel;
  v_side = ribbon.z * reach;
  v_margin = by_margin > 1.5 ? 1.0 - clamp((length(fz) - length(fzb_conj)) / full_margin, 0.0, 1.0) : margin;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(shifted, 0.0, 1.0);
}
