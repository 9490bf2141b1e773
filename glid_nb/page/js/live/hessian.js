// The Hessian of the isometric energy (Section 7), in whitened coordinates.
//
// At one node it is B^T K B (18). K is written in the frames of f = f_z and g = conj(f_zbar): one entry
// across each of them, and a symmetric 2 x 2 block along them.

import { evenly, quarters, samplesAt, slopesOf } from "./basis.js";
import { addProduct } from "./dense.js";
import { noDifferentials } from "./energy.js";
import { arraysOf } from "./kernel.js";

/** @import { Energy } from "./energy.js" */
/** @import { Quadrature } from "./quadrature.js" */
/** @import { Shape } from "./shape.js" */
/** @import { Samples } from "./types.js" */

// Energies ignore rotation, so each node constrains one real component of f_z, not two. With fewer nodes
// per coordinate, functions that oscillate between the nodes would have no curvature.
const NODES_PER_COORDINATE = 2.25;

/**
 * K at one node.
 * @typedef {object} LocalHessian
 * @property {number} acrossF lambda_1
 * @property {number} acrossG lambda_2
 * @property {number} alongFF
 * @property {number} alongGG
 * @property {number} alongFG
 */

/**
 * (19), with x = |f_z|^2 and y = |f_zbar|^2.
 * @param {import("./energy.js").Differentials} d
 * @param {number} x
 * @param {number} y
 * @returns {LocalHessian}
 */
export function localHessian(d, x, y) {
  return {
    acrossF: 2 * d.alpha1,
    acrossG: 2 * d.alpha2,
    alongFF: 2 * d.alpha1 + 4 * d.beta1 * x,
    alongGG: 2 * d.alpha2 + 4 * d.beta2 * y,
    alongFG: 4 * d.beta3 * Math.sqrt(x * y),
  };
}

/**
 * K+ of (21), the closest positive semidefinite matrix, by (23) and (24).
 * @param {LocalHessian} k
 * @returns {LocalHessian}
 */
export function positivePart(k) {
  const mean = (k.alongFF + k.alongGG) / 2;
  const half = (k.alongFF - k.alongGG) / 2;
  const radius = Math.hypot(half, k.alongFG);
  const large = Math.max(mean + radius, 0);
  const small = Math.max(mean - radius, 0);
  const centre = (large + small) / 2;
  const stretch = radius > 0 ? (large - small) / (2 * radius) : 1;
  return {
    acrossF: Math.max(k.acrossF, 0),
    acrossG: Math.max(k.acrossG, 0),
    alongFF: centre + stretch * half,
    alongGG: centre - stretch * half,
    alongFG: stretch * k.alongFG,
  };
}

export class Assembler {
  #f;
  #g;
  #weighted;

  /**
   * @param {Shape} shape
   * @param {Quadrature} quadrature of the energy
   */
  constructor(shape, { rows, weights, middles }) {
    const { panels, whitening, domain } = shape;
    this.shape = shape;
    const few = panels.count >= NODES_PER_COORDINATE * whitening.u;
    /** The Hessian's nodes: from this one of the energy's on. The starts are left out if possible. */
    this.first = few ? panels.count : 0;
    this.nodes = rows.count - this.first;
    this.weights = few ? middles : weights;
    /** D T at the nodes: one row of `nodes` numbers for each column of T. */
    this.re = new Float64Array(whitening.u * this.nodes);
    this.im = new Float64Array(whitening.u * this.nodes);
    const row = 2 * whitening.u * 2 * this.nodes;
    [this.#f, this.#g, this.#weighted] = arraysOf(row, row, row);
    const own = { ...rows, ...this.#ownRows(rows) };
    // Two columns of T at once, as if they were phi and psi.
    for (let c = 0; c < whitening.u; c += 2) {
      const parts = quarters(samplesAt(own, slopesOf(domain, columnsOf(shape, c))));
      const first = c * this.nodes;
      this.re.set(parts[0], first);
      this.im.set(parts[1], first);
      if (c + 1 < whitening.u) {
        this.re.set(parts[2], first + this.nodes);
        this.im.set(parts[3], first + this.nodes);
      }
    }
  }

  /** @param {import("./basis.js").Rows} rows */
  #ownRows({ columns, re, im }) {
    const start = this.first * evenly(columns);
    return { count: this.nodes, re: re.subarray(start), im: im.subarray(start) };
  }

  /**
   * The lower half of the Hessian of the isometric energy, row by row.
   * @param {Samples} samples
   * @param {Energy} energy
   * @param {boolean} project whether to take K+ for K
   */
  assemble(samples, energy, project) {
    const { u, size } = this.shape.whitening;
    const local = this.#local(samples, energy, project);
    const f = this.#framed(this.#f, local.f, 0);
    const g = this.#framed(this.#g, local.g, 1);
    const h = new Float64Array(size * size);
    const phi = this.#block(f, 2 * u, local.alongFF, local.acrossF);
    const psi = this.#block(g, 2 * (u - 1), local.alongGG, local.acrossG);
    const cross = this.#crossBlock(f, g, local.alongFG);
    this.#gather(h, phi, psi, cross);
    return h;
  }

  /**
   * K times the weights, and unit vectors along f and g, at the nodes.
   * @param {Samples} samples
   * @param {Energy} energy
   * @param {boolean} project
   */
  #local(samples, energy, project) {
    const { nodes, first, weights } = this;
    const all = samples.length / 4;
    const array = () => new Float64Array(nodes);
    const f = { re: array(), im: array() };
    const g = { re: array(), im: array() };
    const k = {
      alongFF: array(),
      acrossF: array(),
      alongGG: array(),
      acrossG: array(),
      alongFG: array(),
    };
    const d = noDifferentials();
    for (let t = 0; t < nodes; t++) {
      const i = first + t;
      const x = unitInto(f, t, samples[i], samples[all + i]);
      const y = unitInto(g, t, samples[2 * all + i], samples[3 * all + i]);
      energy.differentiate(x, y, d);
      const exact = localHessian(d, x, y);
      const own = project ? positivePart(exact) : exact;
      k.alongFF[t] = weights[t] * own.alongFF;
      k.acrossF[t] = weights[t] * own.acrossF;
      k.alongGG[t] = weights[t] * own.alongGG;
      k.acrossG[t] = weights[t] * own.acrossG;
      k.alongFG[t] = weights[t] * own.alongFG;
    }
    return { f, g, ...k };
  }

  /**
   * For each real coordinate the components of its derivative along and across the frame: a row of
   * 2 x nodes numbers. The rows of the real parts come first, then those of the imaginary parts.
   * @param {Float64Array} rows
   * @param {import("./types.js").Complex} frame
   * @param {0 | 1} psi whether for g: then without the translation, and conjugate for logarithms
   */
  #framed(rows, frame, psi) {
    const { nodes } = this;
    const { u, k } = this.shape.whitening;
    const count = u - psi;
    for (let c = psi; c < u; c++) {
      const sign = psi === 1 && c > k ? -1 : 1;
      const real = (c - psi) * 2 * nodes;
      const imaginary = (count + c - psi) * 2 * nodes;
      for (let t = 0; t < nodes; t++) {
        const x = this.re[c * nodes + t];
        const y = this.im[c * nodes + t];
        const along = frame.re[t] * x + frame.im[t] * y;
        const across = frame.re[t] * y - frame.im[t] * x;
        rows[real + t] = along;
        rows[real + nodes + t] = across;
        rows[imaginary + t] = -sign * across;
        rows[imaginary + nodes + t] = sign * along;
      }
    }
    return rows;
  }

  /**
   * The lower half of rows diag(k) rows^T, with entries k along and across at each node.
   * @param {Float64Array} rows
   * @param {number} count of rows
   * @param {Float64Array} along
   * @param {Float64Array} across
   */
  #block(rows, count, along, across) {
    const { nodes } = this;
    const length = 2 * nodes;
    const weighted = this.#weighted;
    for (let first = 0; first < count * length; first += length) {
      for (let t = 0; t < nodes; t++) {
        weighted[first + t] = along[t] * rows[first + t];
        weighted[first + nodes + t] = across[t] * rows[first + nodes + t];
      }
    }
    const block = new Float64Array(count * count);
    const left = { values: weighted, first: 0, stride: length };
    const right = { values: rows, first: 0, stride: length };
    const into = { values: block, first: 0, stride: count };
    addProduct(left, right, into, count, count, length, { lower: true });
    return block;
  }

  /**
   * Rows of psi times columns of phi, through the entries along both.
   * @param {Float64Array} f
   * @param {Float64Array} g
   * @param {Float64Array} alongFG
   */
  #crossBlock(f, g, alongFG) {
    const { nodes } = this;
    const { u } = this.shape.whitening;
    const weighted = this.#weighted;
    for (let i = 0; i < 2 * u; i++) {
      for (let t = 0; t < nodes; t++) {
        weighted[i * nodes + t] = alongFG[t] * f[i * 2 * nodes + t];
      }
    }
    const block = new Float64Array(2 * (u - 1) * 2 * u);
    const left = { values: g, first: 0, stride: 2 * nodes };
    const right = { values: weighted, first: 0, stride: nodes };
    const into = { values: block, first: 0, stride: 2 * u };
    addProduct(left, right, into, 2 * (u - 1), 2 * u, nodes);
    return block;
  }

  /**
   * Adds the blocks to the Hessian. The logarithms' coordinates of psi are those of phi.
   * @param {Float64Array} h
   * @param {Float64Array} phi
   * @param {Float64Array} psi
   * @param {Float64Array} cross
   */
  #gather(h, phi, psi, cross) {
    const { u, k, size } = this.shape.whitening;
    const width = 2 * (u - 1);
    for (let i = 0; i < 2 * u; i++) {
      for (let j = 0; j <= i; j++) {
        h[i * size + j] = phi[i * 2 * u + j];
      }
    }
    /** @param {number} a @param {number} b @param {number} value */
    const add = (a, b, value) => {
      h[Math.max(a, b) * size + Math.min(a, b)] += value;
    };
    for (let i = 0; i < width; i++) {
      const row = placeOfPsi(i, u, k);
      for (let j = 0; j <= i; j++) {
        add(row, placeOfPsi(j, u, k), psi[i * width + j]);
      }
      for (let j = 0; j < 2 * u; j++) {
        const value = cross[i * 2 * u + j];
        add(row, j, row === j ? 2 * value : value);
      }
    }
  }
}

/**
 * Columns c and c + 1 of T as coefficients of phi and psi.
 * @param {Shape} shape
 * @param {number} c
 */
function columnsOf({ domain, whitening }, c) {
  const { columns } = domain;
  const { u, t } = whitening;
  const coefficients = new Float64Array(4 * columns);
  const following = Math.min(c + 1, u - 1);
  for (let j = 0; j < columns; j++) {
    coefficients[j] = t.re[j * u + c];
    coefficients[columns + j] = t.im[j * u + c];
    coefficients[2 * columns + j] = t.re[j * u + following];
    coefficients[3 * columns + j] = t.im[j * u + following];
  }
  return coefficients;
}

/**
 * The unit vector along (re, im), (1, 0) where it vanishes; returns the square.
 * @param {import("./types.js").Complex} frame
 * @param {number} t
 * @param {number} re
 * @param {number} im
 */
function unitInto(frame, t, re, im) {
  const square = re * re + im * im;
  const size = Math.sqrt(square);
  frame.re[t] = size > 0 ? re / size : 1;
  frame.im[t] = size > 0 ? im / size : 0;
  return square;
}

/**
 * Where the real coordinate j of psi's columns lies among the coordinates.
 * @param {number} j
 * @param {number} u
 * @param {number} k
 */
function placeOfPsi(j, u, k) {
  const imaginary = j >= u - 1;
  const c = imaginary ? j - (u - 1) : j;
  if (c < k) {
    return 2 * u + (imaginary ? k : 0) + c;
  }
  return (imaginary ? u : 0) + 1 + c;
}
