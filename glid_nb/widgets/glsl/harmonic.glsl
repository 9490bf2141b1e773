// The harmonic map f = F + conj(G) and its Wirtinger derivatives in single precision, Equations (8),
// (9), (D.1) and (D.2).
//
// The offset cage's loops form one chain; each loop begins and ends with the same vertex. With each
// vertex comes 1 / (the edge that leads to it), 0 where a loop begins, which saves divisions.
// N_CHAIN and N_HOLES (at least 1; unused holes have zero coefficients) are defined before this.

uniform vec4 cage[N_CHAIN];          // vertex, 1 / edge
uniform vec4 coefficients[N_CHAIN];  // phi, psi
uniform vec4 holes[N_HOLES];         // rho, phi; psi is its conjugate

const vec2 MINUS_I_OVER_TWO_PI = vec2(0.0, -0.15915494309189535);
const float TINY = 1e-30;

vec2 multiply(vec2 a, vec2 b) {
  return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

vec2 divide(vec2 a, vec2 b) {
  return vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y) / max(dot(b, b), TINY);
}

vec2 conjugate(vec2 a) {
  return vec2(a.x, -a.y);
}

// f, f_z and conj(f_zbar) at z.
void harmonic_map(vec2 z, out vec2 f, out vec2 fz, out vec2 fzb_conj) {
  vec2 F = vec2(0.0), G = vec2(0.0), dF = vec2(0.0), dG = vec2(0.0);
  vec2 to_start = cage[0].xy - z;
  float start_squared = dot(to_start, to_start);
  for (int j = 1; j < N_CHAIN; j++) {
    vec2 to_end = cage[j].xy - z, inverse_edge = cage[j].zw;
    float end_squared = dot(to_end, to_end);
    if (inverse_edge != vec2(0.0)) {
      // The logarithm of to_end / to_start.
      vec2 turned = multiply(to_end, conjugate(to_start));
      float ratio = max(end_squared, TINY) / max(start_squared, TINY);
      vec2 angle = vec2(0.5 * log(ratio), atan(turned.y, turned.x));
      vec2 phi = coefficients[j - 1].xy, psi = coefficients[j - 1].zw;
      // phi and psi are linear along an edge; this continues them to z.
      vec2 phi_slope = multiply(coefficients[j].xy - phi, inverse_edge);
      vec2 psi_slope = multiply(coefficients[j].zw - psi, inverse_edge);
      F += multiply(angle, phi - multiply(phi_slope, to_start));
      G += multiply(angle, psi - multiply(psi_slope, to_start));
      dF += multiply(angle, phi_slope);
      dG += multiply(angle, psi_slope);
    }
    to_start = to_end;
    start_squared = end_squared;
  }
  F = multiply(MINUS_I_OVER_TWO_PI, F);
  G = multiply(MINUS_I_OVER_TWO_PI, G);
  dF = multiply(MINUS_I_OVER_TWO_PI, dF);
  dG = multiply(MINUS_I_OVER_TWO_PI, dG);
  for (int k = 0; k < N_HOLES; k++) {
    vec2 away = z - holes[k].xy, phi = holes[k].zw, psi = conjugate(phi);
    float distance_log = 0.5 * log(max(dot(away, away), TINY));
    F += phi * distance_log;
    G += psi * distance_log;
    dF += divide(phi, away);
    dG += divide(psi, away);
  }
  f = F + conjugate(G);
  fz = dF;
  fzb_conj = dG;
}
