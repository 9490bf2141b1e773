// The harmonic map f = F + conj(G) and its Wirtinger derivatives, from the cage and coefficients
// (Equations (8) and (9), (D.1) and (D.2)), in single precision.
//
// The offset cage's loops stand in one chain, each beginning and ending with the same vertex;
// cage[j].z is 1 where an edge leads from vertex j - 1 to vertex j and 0 where a loop begins.
// N_CHAIN and N_HOLES (at least 1; unused holes have zero coefficients) are defined before this.

uniform vec4 cage[N_CHAIN];
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

vec2 logarithm(vec2 a) {
  return vec2(0.5 * log(max(dot(a, a), TINY)), atan(a.y, a.x));
}

vec2 conjugate(vec2 a) {
  return vec2(a.x, -a.y);
}

// f, f_z and conj(f_zbar) at z.
void harmonic_map(vec2 z, out vec2 f, out vec2 fz, out vec2 fzb_conj) {
  vec2 F = vec2(0.0), G = vec2(0.0), dF = vec2(0.0), dG = vec2(0.0);
  for (int j = 1; j < N_CHAIN; j++) {
    if (cage[j].z > 0.5) {
      vec2 to_end = cage[j].xy - z, to_start = cage[j - 1].xy - z;
      vec2 angle = logarithm(divide(to_end, to_start));
      vec2 edge = cage[j].xy - cage[j - 1].xy;
      vec2 phi = coefficients[j - 1].xy, psi = coefficients[j - 1].zw;
      // phi and psi are linear along an edge; what counts is that function, continued to z.
      vec2 phi_slope = divide(coefficients[j].xy - phi, edge);
      vec2 psi_slope = divide(coefficients[j].zw - psi, edge);
      F += multiply(angle, phi - multiply(phi_slope, to_start));
      G += multiply(angle, psi - multiply(psi_slope, to_start));
      dF += multiply(angle, phi_slope);
      dG += multiply(angle, psi_slope);
    }
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
