// The isometric energies of Section 6 and Table 1, as functions of x = |f_z|^2 and y = |f_zbar|^2.

/** @import { EnergyName, Samples } from "./types.js" */

/**
 * The five scalars of Table 1 (Equations (E.3) and (E.9)).
 * @typedef {object} Differentials
 * @property {number} alpha1 dE/dx
 * @property {number} alpha2 dE/dy
 * @property {number} beta1 d2E/dx2
 * @property {number} beta2 d2E/dy2
 * @property {number} beta3 d2E/dxdy
 */

/**
 * An energy for x > y >= 0; it is infinite elsewhere.
 * @typedef {object} Energy
 * @property {(x: number, y: number) => number} density
 * @property {(x: number, y: number, into: Differentials) => void} differentiate
 */

/** @returns {Differentials} */
export function noDifferentials() {
  return { alpha1: 0, alpha2: 0, beta1: 0, beta2: 0, beta3: 0 };
}

/** @type {Energy} */
const symmetricDirichlet = {
  density(x, y) {
    const det = x - y;
    return (x + y) * (1 + 1 / (det * det));
  },
  differentiate(x, y, d) {
    const inverse = 1 / (x - y);
    const cube = inverse * inverse * inverse;
    const fourth = cube * inverse;
    d.alpha1 = 1 - (x + 3 * y) * cube;
    d.alpha2 = 1 + (3 * x + y) * cube;
    d.beta1 = 2 * (x + 5 * y) * fourth;
    d.beta2 = 2 * (5 * x + y) * fourth;
    d.beta3 = -6 * (x + y) * fourth;
  },
};

/**
 * exp(s E_iso).
 * @param {number} s
 * @returns {Energy}
 */
function exponential(s) {
  /** @param {number} x @param {number} y */
  const density = (x, y) => Math.exp(s * symmetricDirichlet.density(x, y));
  return {
    density,
    differentiate(x, y, d) {
      symmetricDirichlet.differentiate(x, y, d);
      const factor = s * density(x, y);
      const { alpha1, alpha2 } = d;
      d.alpha1 = factor * alpha1;
      d.alpha2 = factor * alpha2;
      d.beta1 = factor * (d.beta1 + s * alpha1 * alpha1);
      d.beta2 = factor * (d.beta2 + s * alpha2 * alpha2);
      d.beta3 = factor * (d.beta3 + s * alpha1 * alpha2);
    },
  };
}

/**
 * exp((2 s (x + y) + 1) / (x - y) + x - y).
 * @param {number} s
 * @returns {Energy}
 */
function amips(s) {
  /** @param {number} x @param {number} y */
  const density = (x, y) => {
    const det = x - y;
    return Math.exp((2 * s * (x + y) + 1) / det + det);
  };
  return {
    density,
    differentiate(x, y, d) {
      const inverse = 1 / (x - y);
      const square = inverse * inverse;
      const cube = square * inverse;
      const a1 = 1 - (4 * s * y + 1) * square;
      const a2 = -1 + (4 * s * x + 1) * square;
      const energy = density(x, y);
      d.alpha1 = a1 * energy;
      d.alpha2 = a2 * energy;
      d.beta1 = (a1 * a1 + 2 * (4 * s * y + 1) * cube) * energy;
      d.beta2 = (a2 * a2 + 2 * (4 * s * x + 1) * cube) * energy;
      d.beta3 = (a1 * a2 - (4 * s * (x + y) + 2) * cube) * energy;
    },
  };
}

/** @type {Energy} */
const mips = {
  density: (x, y) => (x + y) / (x - y),
  differentiate(x, y, d) {
    const inverse = 1 / (x - y);
    const square = inverse * inverse;
    const cube = square * inverse;
    d.alpha1 = -2 * y * square;
    d.alpha2 = 2 * x * square;
    d.beta1 = 4 * y * cube;
    d.beta2 = 4 * x * cube;
    d.beta3 = -2 * (x + y) * cube;
  },
};

/** @type {Energy} */
const arap = {
  density: (x, y) => 2 * (x + y) - 4 * Math.sqrt(x) + 2,
  differentiate(x, _, d) {
    const root = 1 / Math.sqrt(x);
    d.alpha1 = 2 - 2 * root;
    d.alpha2 = 2;
    d.beta1 = root * root * root;
    d.beta2 = 0;
    d.beta3 = 0;
  },
};

/**
 * The makers of energies by the package's names; `s` is the parameter of `exp` and `amips`.
 * @type {Record<EnergyName, (s: number) => Energy>}
 */
export const ENERGIES = {
  iso: () => symmetricDirichlet,
  exp: exponential,
  amips,
  mips: () => mips,
  arap: () => arap,
};

/**
 * @param {EnergyName} name
 * @param {number} [s]
 */
export function energyNamed(name, s = 1) {
  return ENERGIES[name](s);
}

/**
 * The isometric energy (12) of samples, as the sum (31); infinite if one is inverted.
 * @param {Energy} energy
 * @param {Float64Array} weights
 * @param {Samples} samples
 */
export function isometricEnergy(energy, weights, samples) {
  const count = weights.length;
  let sum = 0;
  for (let i = 0; i < count; i++) {
    const fr = samples[i];
    const fi = samples[count + i];
    const gr = samples[2 * count + i];
    const gi = samples[3 * count + i];
    const x = fr * fr + fi * fi;
    const y = gr * gr + gi * gi;
    if (!(x > y)) {
      return Infinity;
    }
    sum += weights[i] * energy.density(x, y);
  }
  return Number.isNaN(sum) ? Infinity : sum;
}

/**
 * Derivatives of the isometric energy with respect to the samples.
 * @param {Energy} energy
 * @param {Float64Array} weights
 * @param {Samples} samples
 */
export function energyGradient(energy, weights, samples) {
  const count = weights.length;
  const gradient = new Float64Array(4 * count);
  const d = noDifferentials();
  for (let i = 0; i < count; i++) {
    const [fr, fi, gr, gi] = [i, count + i, 2 * count + i, 3 * count + i];
    const x = samples[fr] * samples[fr] + samples[fi] * samples[fi];
    const y = samples[gr] * samples[gr] + samples[gi] * samples[gi];
    energy.differentiate(x, y, d);
    const alongF = 2 * weights[i] * d.alpha1;
    const alongG = 2 * weights[i] * d.alpha2;
    gradient[fr] = alongF * samples[fr];
    gradient[fi] = alongF * samples[fi];
    gradient[gr] = alongG * samples[gr];
    gradient[gi] = alongG * samples[gi];
  }
  return gradient;
}
