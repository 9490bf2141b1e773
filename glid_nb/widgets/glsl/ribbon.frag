// A line with soft edges, of one colour or, within borders of this colour, coloured by margin.
// Premultiplied by alpha.

precision highp float;

const float BORDER = 0.9; // pixels; the palest colour would not be seen on white, nor the darkest on black

uniform float half_width;
uniform vec4 line_color;
uniform float by_margin;
uniform vec3 colors[N_COLORS];

varying float v_side;
varying float v_margin;

void main() {
  float cover = clamp(half_width + 0.5 - abs(v_side), 0.0, 1.0);
  vec3 color = line_color.rgb;
  if (by_margin > 0.5) {
    float place = clamp(v_margin, 0.0, 1.0) * float(N_COLORS - 1);
    vec3 value = colors[0];
    for (int i = 1; i < N_COLORS; i++) {
      value = mix(value, colors[i], clamp(place - float(i - 1), 0.0, 1.0));
    }
    color = mix(color, value, clamp(half_width - BORDER + 0.5 - abs(v_side), 0.0, 1.0));
  }
  gl_FragColor = vec4(color, 1.0) * (cover * line_color.a);
}
