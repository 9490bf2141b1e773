// Before every fragment shader: a colour map of N_COLORS evenly spaced colours.

precision highp float;

uniform vec3 colors[N_COLORS];

vec3 color_at(float t) {
  float place = clamp(t, 0.0, 1.0) * float(N_COLORS - 1);
  vec3 color = colors[0];
  for (int i = 1; i < N_COLORS; i++) {
    color = mix(color, colors[i], clamp(place - float(i - 1), 0.0, 1.0));
  }
  return color;
}
