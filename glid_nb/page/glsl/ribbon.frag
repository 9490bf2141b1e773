// A line with soft edges, of one colour, or coloured by margin between borders of that colour;
// premultiplied by alpha.

const float BORDER = 0.9; // pixels; without it pale colours vanish on white and dark ones on black

uniform float half_width;
uniform vec4 line_color;
uniform float by_margin;

varying float v_side;
varying float v_margin;

void main() {
  float cover = clamp(half_width + 0.5 - abs(v_side), 0.0, 1.0);
  vec3 color = line_color.rgb;
  if (by_margin > 0.5) {
    float inner = clamp(half_width - BORDER + 0.5 - abs(v_side), 0.0, 1.0);
    color = mix(color, color_at(v_margin), inner);
  }
  gl_FragColor = vec4(color, 1.0) * (cover * line_color.a);
}
