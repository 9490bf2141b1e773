// The proof that a map is locally injective (Theorem 4.2), from its coefficients alone.
//
// On each panel f_z and conj(f_zbar) are compared with their quadratic interpolants at the start, the
// middle and the end. docs/proof.md ("In the page") states the lemmas. Everything is computed by +, -,
// *, / and square roots of IEEE 754 and by `log` and `atan2` of elementary.js, in plain order.

import { emptyRows, fillRow, quarters, samplesAt, slopesOf } from "./basis.js";
import { addProduct, dot } from "./dense.js";
import { atan2, modulus } from "./elementary.js";
import { arraysOf } from "./kernel.js";
import { distance } from "./panels.js";
import { BERNSTEIN, BESIDE, slack, UNIT_ROUNDOFF, UPWARD } from "./rounding.js";

/** @import { Rows } from "./basis.js" */
/** @import { Domain } from "./domain.js" */
/** @import { Panels } from "./panels.js" */
/** @import { Certificate, Coefficients, Samples } from "./types.js" */

const TAU = 2 * Math.PI;
const QUADRATIC = Math.sqrt(3) / 216; // the largest |t (t - 1/2) (t - 1)| / 3!
const MOST_HALVINGS = 4; // of a panel that is not proved at once

/**
 * What is known of a map at one node: f = f_z and g = conj(f_zbar) as computed.
 * @typedef {object} Node
 * @property {number} x
 * @property {number} y
 * @property {number} norm of the basis's row
 * @property {number} fr
 * @property {number} fi
 * @property {number} gr
 * @property {number} gi
 */

/**
 * What is proved on a panel.
 * @typedef {object} Bounds
 * @property {number} sigma2 a lower bound; the panel is proved if it is positive
 * @property {number} sigma1 an upper bound
 * @property {number} k an upper bound
 * @property {number} turning the change of arg f_z along the panel
 */

/** The constants of the proofs on a domain's panels. */
export class Prover {
  #weights;
  #jumps;
  #spare;
  #row;

  /**
   * @param {Domain} domain
   * @param {Panels} panels
   * @param {Rows} rows of the basis at the panels' nodes
   */
  constructor(domain, panels, rows) {
    this.domain = domain;
    this.panels = panels;
    this.rows = rows;
    const { columns } = domain;
    [this.#weights, this.#jumps] = arraysOf(panels.count * columns, 2 * columns);
    this.#spare = new Float64Array(columns);
    this.#row = emptyRows(1, columns);
    const { re, im } = panels.nodes;
    for (let i = 0; i < panels.count; i++) {
      const end = panels.next[i];
      fillRemainderWeights(domain, re[i], im[i], re[end], im[end], this.#weights, i * columns);
    }
  }

  /**
   * Proves a map locally injective, or says which panel refuses.
   * @param {Coefficients} coefficients
   */
  certify(coefficients) {
    return this.prove(coefficients).certificate;
  }

  /**
   * The certificate of a map, and the samples at the panels' nodes from which it was made.
   * @param {Coefficients} coefficients
   * @returns {{ certificate: Certificate, samples: Samples }}
   */
  prove(coefficients) {
    const sampled = this.sample(coefficients);
    return { certificate: this.judge(sampled), samples: sampled.samples };
  }

  /**
   * A map with its samples at the panels' nodes.
   * @param {Coefficients} coefficients
   */
  sample(coefficients) {
    const map = new MapData(this.domain, coefficients);
    return { map, samples: samplesAt(this.rows, map.slopes) };
  }

  /**
   * The certificate of a map that was sampled.
   * @param {ReturnType<Prover["sample"]>} sampled
   */
  judge({ map, samples }) {
    return this.#certificate(map, quarters(samples));
  }

  /**
   * @param {MapData} map
   * @param {Float64Array[]} samples
   * @returns {Certificate}
   */
  #certificate(map, samples) {
    const { panels } = this;
    const remainders = this.#remainders(map);
    const turning = new Float64Array(panels.loops);
    const whole = { sigma2_lower: Infinity, sigma1_upper: 0, k_upper: 0, halved: 0, refused: -1 };
    for (let i = 0; i < panels.count; i++) {
      const of = remainders.subarray(2 * i, 2 * i + 2);
      const bounds = this.#onPanel(map, samples, of, i, whole);
      whole.sigma2_lower = Math.min(whole.sigma2_lower, bounds.sigma2);
      whole.sigma1_upper = Math.max(whole.sigma1_upper, bounds.sigma1);
      whole.k_upper = Math.max(whole.k_upper, bounds.k);
      turning[panels.loop[i]] += bounds.turning;
      if (!(bounds.sigma2 > 0)) {
        whole.refused = i;
        break;
      }
    }
    const windings = Array.from(turning, (angle) => Math.round(angle / TAU) + 0); // no -0
    const zerosOfFz = windings.reduce((sum, turns) => sum + turns, 0);
    const certified = map.tied && whole.refused < 0 && zerosOfFz === 0;
    const k = certified ? Math.min(whole.k_upper, 1) : whole.k_upper;
    return { certified, ...whole, k_upper: k, windings };
  }

  /**
   * Weights . jumps of f and g on each panel.
   * @param {MapData} map
   */
  #remainders({ f, g, columns }) {
    const { count } = this.panels;
    this.#jumps.set(f.jumps);
    this.#jumps.set(g.jumps, columns);
    const left = { values: this.#weights, first: 0, stride: columns };
    const right = { values: this.#jumps, first: 0, stride: columns };
    const values = new Float64Array(2 * count);
    addProduct(left, right, { values, first: 0, stride: 2 }, count, 2, columns);
    return values;
  }

  /**
   * @param {MapData} map
   * @param {Float64Array[]} samples
   * @param {Float64Array} remainders of f and g
   * @param {number} i
   * @param {{ halved: number }} whole
   */
  #onPanel(map, samples, remainders, i, whole) {
    const { panels } = this;
    const start = this.#node(samples, i);
    const middle = this.#node(samples, panels.count + i);
    const end = this.#node(samples, panels.next[i]);
    return this.#between(map, start, middle, end, remainders, 0, whole);
  }

  /**
   * @param {Float64Array[]} samples
   * @param {number} i
   * @returns {Node}
   */
  #node([fr, fi, gr, gi], i) {
    const { re, im } = this.panels.nodes;
    const norm = this.rows.norms[i];
    return { x: re[i], y: im[i], norm, fr: fr[i], fi: fi[i], gr: gr[i], gi: gi[i] };
  }

  /**
   * Bounds on a piece of a panel; the piece is halved if that may help.
   * @param {MapData} map
   * @param {Node} start
   * @param {Node} middle
   * @param {Node} end
   * @param {Float64Array} remainders of f and g
   * @param {number} depth how often the panel was halved before
   * @param {{ halved: number }} whole
   * @returns {Bounds}
   */
  #between(map, start, middle, end, remainders, depth, whole) {
    const norm = Math.max(start.norm, middle.norm, end.norm);
    const [ef, eg] = map.errors(remainders, norm);
    const bounds = boundsOf(start, middle, end, ef, eg);
    if (bounds.sigma2 > 0) {
      return bounds;
    }
    const folded = !(modulus(start.fr, start.fi) > modulus(start.gr, start.gi));
    if (depth === MOST_HALVINGS || folded) {
      return bounds;
    }
    whole.halved++;
    const left = this.#half(map, start, middle, depth, whole);
    if (!(left.sigma2 > 0)) {
      return left;
    }
    const right = this.#half(map, middle, end, depth, whole);
    return {
      sigma2: Math.min(left.sigma2, right.sigma2),
      sigma1: Math.max(left.sigma1, right.sigma1),
      k: Math.max(left.k, right.k),
      turning: left.turning + right.turning,
    };
  }

  /**
   * @param {MapData} map
   * @param {Node} start
   * @param {Node} end
   * @param {number} depth
   * @param {{ halved: number }} whole
   */
  #half(map, start, end, depth, whole) {
    const weights = this.#spare;
    const middle = this.#fresh(map, (start.x + end.x) / 2, (start.y + end.y) / 2);
    fillRemainderWeights(this.domain, start.x, start.y, end.x, end.y, weights, 0);
    return this.#between(map, start, middle, end, map.remainders(weights), depth + 1, whole);
  }

  /**
   * @param {MapData} map
   * @param {number} x
   * @param {number} y
   * @returns {Node}
   */
  #fresh(map, x, y) {
    const norm = fillRow(this.domain, x, y, this.#row, 0);
    const [fr, fi, gr, gi] = samplesAt(this.#row, map.slopes);
    return { x, y, norm, fr, fi, gr, gi };
  }
}

/** What the errors of a map's derivatives depend on. */
export class MapData {
  /**
   * @param {Domain} domain
   * @param {Coefficients} coefficients
   */
  constructor(domain, coefficients) {
    const { vertices, columns } = domain;
    this.columns = columns;
    this.tied = areTied(coefficients, vertices, columns);
    this.slopes = slopesOf(domain, coefficients);
    const [pr, pi, qr, qi] = quarters(this.slopes);
    this.f = sizesOf(domain, pr, pi);
    this.g = sizesOf(domain, qr, qi);
  }

  /**
   * Weights . jumps of f and g on one panel.
   * @param {Float64Array} weights
   */
  remainders(weights) {
    return Float64Array.of(dot(weights, this.f.jumps), dot(weights, this.g.jumps));
  }

  /**
   * How far f_z and conj(f_zbar) may be from the computed interpolants of a panel.
   * @param {Float64Array} remainders
   * @param {number} rowNorm
   * @returns {[number, number]}
   */
  errors([ef, eg], rowNorm) {
    const { f, g, columns } = this;
    return [
      UPWARD * (ef + slack(columns, rowNorm, f.norm, f.sum)),
      UPWARD * (eg + slack(columns, rowNorm, g.norm, g.sum)),
    ];
  }
}

/**
 * Whether phi_h = conj(psi_h) for all holes, exactly.
 * @param {Coefficients} coefficients
 * @param {number} vertices
 * @param {number} columns
 */
function areTied(coefficients, vertices, columns) {
  const [pr, pi, qr, qi] = quarters(coefficients);
  let tied = true;
  for (let h = vertices; h < columns; h++) {
    tied = tied && pr[h] === qr[h] && pi[h] === -qi[h];
  }
  return tied;
}

/**
 * The norm and the sum of slopes, and bounds on their jumps: |s_{j-1} - s_j| at vertices and |phi_h| for
 * holes (Appendix H).
 * @param {Domain} domain
 * @param {Float64Array} re
 * @param {Float64Array} im
 */
function sizesOf({ vertices, columns, previous }, re, im) {
  const jumps = new Float64Array(columns);
  let squares = 0;
  let sum = 0;
  for (let j = 0; j < columns; j++) {
    const size = modulus(re[j], im[j]);
    squares += size * size;
    if (j < vertices) {
      const p = previous[j];
      const rounding = 32 * UNIT_ROUNDOFF * (size + modulus(re[p], im[p]));
      jumps[j] = modulus(re[p] - re[j], im[p] - im[j]) + rounding;
      sum += size;
    } else {
      jumps[j] = size;
    }
  }
  return { jumps, norm: UPWARD * Math.sqrt(squares), sum };
}

/**
 * Weights w: w . jumps bounds the remainder of the quadratic interpolant on a panel, and the effect of
 * nodes that lie beside their edge (Lemmas 22 and 23).
 * @param {Domain} domain
 * @param {number} ax
 * @param {number} ay
 * @param {number} bx
 * @param {number} by
 * @param {Float64Array} weights
 * @param {number} first
 */
function fillRemainderWeights(domain, ax, ay, bx, by, weights, first) {
  const off = BESIDE * domain.largest;
  const length = modulus(bx - ax, by - ay);
  for (let j = 0; j < domain.columns; j++) {
    const computed = distance(domain.singular, j, ax, ay, bx, by);
    const least = computed * (1 - 32 * UNIT_ROUNDOFF) - 32 * UNIT_ROUNDOFF * length - off;
    const d = Math.max(least, 0);
    const ratio = (length + 2 * off) / d;
    const cube = UPWARD * QUADRATIC * ratio * ratio * ratio;
    const beside = (UPWARD * 2 * off) / d;
    // |f_z'''| l^3 <= 2! / (2 pi) (l / d)^3 at a vertex, 3! / d (l / d)^3 for a hole.
    weights[first + j] = j < domain.vertices ? (2 * cube + beside) / TAU : (6 * cube + beside) / d;
  }
}

/**
 * Bounds on a panel from the quadratic interpolants of f and g (Lemmas 8 and 9), not positive where the
 * turning of f_z is unknown.
 * @param {Node} start
 * @param {Node} middle
 * @param {Node} end
 * @param {number} ef
 * @param {number} eg
 * @returns {Bounds}
 */
function boundsOf(start, middle, end, ef, eg) {
  const control = {
    fr: 2 * middle.fr - (start.fr + end.fr) / 2,
    fi: 2 * middle.fi - (start.fi + end.fi) / 2,
    gr: 2 * middle.gr - (start.gr + end.gr) / 2,
    gi: 2 * middle.gi - (start.gi + end.gi) / 2,
  };
  const left = pieceBounds(start, between(start, control), middle, ef, eg);
  const right = pieceBounds(middle, between(control, end), end, ef, eg);
  const known = inHalfPlane(start, control, end, ef);
  const crossed = end.fi * start.fr - end.fr * start.fi;
  return {
    sigma2: known ? Math.min(left.sigma2, right.sigma2) : -Infinity,
    sigma1: Math.max(left.sigma1, right.sigma1),
    k: Math.max(left.k, right.k),
    turning: atan2(crossed, end.fr * start.fr + end.fi * start.fi),
  };
}

/**
 * The values of f and g, or control points of their interpolants.
 * @typedef {Pick<Node, "fr" | "fi" | "gr" | "gi">} Values
 */

/**
 * @param {Values} a
 * @param {Values} b
 * @returns {Values}
 */
function between(a, b) {
  return {
    fr: (a.fr + b.fr) / 2,
    fi: (a.fi + b.fi) / 2,
    gr: (a.gr + b.gr) / 2,
    gi: (a.gi + b.gi) / 2,
  };
}

/**
 * Whether the control points of f lie in one half plane, further than ef from 0.
 * @param {Values} start
 * @param {Values} control
 * @param {Values} end
 * @param {number} ef
 */
function inHalfPlane(start, control, end, ef) {
  const a = modulus(start.fr, start.fi);
  const b = modulus(end.fr, end.fi);
  const x = start.fr / a + end.fr / b;
  const y = start.fi / a + end.fi / b;
  const size = modulus(x, y);
  let least = Infinity;
  for (const { fr, fi } of [start, control, end]) {
    least = Math.min(least, (x * fr + y * fi) / size);
  }
  return least > ef;
}

/**
 * Bounds from three control points of the interpolants, as in Lemma 8.
 * @param {Values} a
 * @param {Values} b
 * @param {Values} c
 * @param {number} ef
 * @param {number} eg
 */
function pieceBounds(a, b, c, ef, eg) {
  const p = squaredModulus(a.fr, a.fi, b.fr, b.fi, c.fr, c.fi);
  const q = squaredModulus(a.gr, a.gi, b.gr, b.gi, c.gr, c.gi);
  const pMost = UPWARD * Math.sqrt(p.most);
  const qMost = UPWARD * Math.sqrt(q.most);
  let least = Infinity;
  let leastP = Infinity;
  let kappa = 0;
  for (let i = 0; i < 5; i++) {
    const low = p.coefficients[i] - BERNSTEIN * p.most;
    const high = q.coefficients[i] + BERNSTEIN * q.most;
    least = Math.min(least, low - high);
    leastP = Math.min(leastP, low);
    kappa = Math.max(kappa, high / low);
  }
  const sigma1 = UPWARD * (pMost + qMost + ef + eg);
  const finite = sigma1 * sigma1 < Infinity;
  if (!(finite && least > 0)) {
    return { sigma2: -Infinity, sigma1, k: Infinity };
  }
  const sigma2 = least / ((pMost + qMost) * UPWARD) - ef - eg;
  const pLeast = Math.sqrt(leastP);
  const direct = (Math.sqrt(kappa) * pLeast + eg) / (pLeast - ef);
  const fromSigma = (sigma1 - sigma2) / (sigma1 + sigma2);
  const k = UPWARD * (pLeast > ef ? Math.min(direct, fromSigma) : fromSigma);
  return { sigma2, sigma1, k };
}

/**
 * Bernstein coefficients of the squared modulus of a quadratic, and the largest square of its control
 * points.
 * @param {number} ar
 * @param {number} ai
 * @param {number} br
 * @param {number} bi
 * @param {number} cr
 * @param {number} ci
 */
function squaredModulus(ar, ai, br, bi, cr, ci) {
  const a = ar * ar + ai * ai;
  const b = br * br + bi * bi;
  const c = cr * cr + ci * ci;
  const middle = (ar * cr + ai * ci + 2 * b) / 3;
  const coefficients = [a, ar * br + ai * bi, middle, br * cr + bi * ci, c];
  return { coefficients, most: Math.max(a, b, c) };
}
