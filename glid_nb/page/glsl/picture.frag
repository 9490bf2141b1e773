// The picture, or a colour for its distortion; premultiplied by alpha.

uniform float overlay;       // 0 picture, 1 picture and grid, 2 sigma_1, 3 sigma_2, 4 k, 5 energy
uniform vec2 color_range;    // values at the ends of the colour map
uniform float pixel;         // world units of one pixel on the screen
uniform float grid_spacing;  // world units of the undeformed picture
uniform sampler2D map;

varying vec2 v_source;
varying vec2 v_uv;
varying vec2 v_fz;
varying vec2 v_fzb_conj;

const float HALF_LINE = 0.6;  // pixels

// The share of this pixel that a grid line covers; the rows of the inverse Jacobian give the
// distance in the undeformed picture per pixel of the screen.
float grid_cover() {
  vec2 a = v_fz, b = vec2(v_fzb_conj.x, -v_fzb_conj.y);
  vec2 f_x = a + b, f_y = vec2(b.y - a.y, a.x - b.x);
  float determinant = max(f_x.x * f_y.y - f_x.y * f_y.x, 1e-6);
  vec2 per_pixel = vec2(length(f_y), length(f_x)) / determinant * pixel;
  vec2 away = abs(fract(v_source / grid_spacing - 0.5) - 0.5) * grid_spacing / per_pixel;
  vec2 cover = clamp(HALF_LINE + 0.5 - away, 0.0, 1.0);
  return max(cover.x, cover.y);
}

void main() {
  vec4 texel = texture2D(map, v_uv);
  if (texel.a < 0.004) discard;  // it must not hide what is behind
  if (overlay < 0.5) {
    gl_FragColor = texel;
    return;
  }
  if (overlay < 1.5) {
    gl_FragColor = mix(texel, vec4(vec3(0.12), 1.0) * (0.9 * texel.a), 0.7 * grid_cover());
    return;
  }
  float r = length(v_fz), g = length(v_fzb_conj);
  float value = r + g;
  if (overlay > 2.5) value = r - g;
  if (overlay > 3.5) value = g / max(r, 1e-6);
  if (overlay > 4.5) value = energy_density(r * r, g * g);
  vec3 color = color_at((value - color_range.x) / (color_range.y - color_range.x));
  // The picture's brightness shows through.
  float shade = dot(texel.rgb, vec3(0.299, 0.587, 0.114)) / max(texel.a, 1e-3);
  gl_FragColor = vec4(color * mix(0.72, 1.12, shade), 1.0) * texel.a;
}
