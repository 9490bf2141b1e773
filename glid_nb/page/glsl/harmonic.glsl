// The harmonic map f = F + conj(G) and its Wirtinger derivatives in single precision, Equations (8),
// (9), (D.1) and (D.2). Two complex numbers, of F and of G, are a vec4.
//
// The offset cage's loops form one chain; each loop begins and ends with the same vertex. With each
// vertex comes 1 / (the edge that leads to it), 0 where a loop begins, which saves divisions.
// N_CHAIN and N_HOLES (at least 1; unused holes have zero coefficients) are defined before this.

//
// cage: vertex, 1 / edge
// coefficients: phi, psi
// holes: rho, phi; psi is its conjugate
#ifdef IN_BLOCKS  // they hold more than plain uniforms; WebGL 2 only
uniform cage_block { vec4 cage[N_CHAIN]; };
uniform coefficients_block { vec4 coefficients[N_CHAIN]; };
uniform holes_block { vec4 holes[N_HOLES]; };
#else
uniform vec4 cage[N_CHAIN];
uniform vec4 coefficients[N_CHAIN];
uniform vec4 holes[N_HOLES];
#endif

const float TWO_PI = 6.283185307179586;
const float TINY = 1e-30;

vec2 conjugate(vec2 a) {
  return vec2(a.x, -a.y);
}

vec4 multiply(vec2 a, vec4 b) {
  return a.x * b + a.y * vec4(-b.y, b.x, -b.w, b.z);
}

// f, f_z and conj(f_zbar) at z.
void harmonic_map(vec2 z, out vec2 f, out vec2 fz, out vec2 fzb_conj) {
  vec4 both = vec4(0.0), slopes = vec4(0.0);
  vec2 to_start = cage[0].xy - z;
  float start_squared = dot(to_start, to_start);
  for (int j = 1; j < N_CHAIN; j++) {
    vec2 to_end = cage[j].xy - z, inverse_edge = cage[j].zw;
    float end_squared = dot(to_end, to_end);
    if (inverse_edge != vec2(0.0)) {
      // The logarithm of to_end / to_start.
      vec2 turned = multiply(conjugate(to_start), to_end.xyxy).xy;
      float ratio = max(end_squared, TINY) / max(start_squared, TINY);
      vec2 angle = vec2(0.5 * log(ratio), atan(turned.y, turned.x));
      // phi and psi are linear along an edge; this continues them to z.
      vec4 slope = multiply(inverse_edge, coefficients[j] - coefficients[j - 1]);
      both += multiply(angle, coefficients[j - 1] - multiply(to_start, slope));
      slopes += multiply(angle, slope);
    }
    to_start = to_end;
    start_squared = end_squared;
  }
  both = multiply(vec2(0.0, -1.0 / TWO_PI), both);
  slopes = multiply(vec2(0.0, -1.0 / TWO_PI), slopes);
  for (int k = 0; k < N_HOLES; k++) {
    vec2 away = z - holes[k].xy, phi = holes[k].zw;
    vec4 pair = vec4(phi, conjugate(phi));
    float squared = max(dot(away, away), TINY);
    both += 0.5 * log(squared) * pair;
    slopes += multiply(conjugate(away) / squared, pair);
  }
  f = both.xy + conjugate(both.zw);
  fz = slopes.xy;
  fzb_conj = slopes.zw;
}
