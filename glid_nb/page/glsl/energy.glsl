// The density of an energy of Table 1; each class of glid_nb.energies holds its expression.

uniform vec2 energy;  // which energy, and its parameter s

// E(x, y) with x = |f_z|^2 and y = |f_zbar|^2.
float energy_density(float x, float y) {
  float s = energy.y;
  return ENERGY_DENSITY;
}
