// A shape that follows its pins: Algorithm 1 with kept Hessians, every step proved before it is taken.

import { pulledThroughRows, pulledThroughSlopes } from "./basis.js";
import { addScaled, dot } from "./dense.js";
import { metricAt, repinned } from "./directions.js";
import { energyGradient, energyNamed, isometricEnergy } from "./energy.js";
import { Assembler } from "./hessian.js";
import { largestStep, search } from "./line_search.js";
import { Pins } from "./pins.js";
import { Prover } from "./proof.js";
import { quadratureOf } from "./quadrature.js";

/** @import { Metric } from "./directions.js" */
/** @import { Shape } from "./shape.js" */
/** @import { Certificate, Coefficients, Pose, Samples, SolverOptions } from "./types.js" */

/**
 * What became of a step. "refused": no shorter step could be proved either.
 * @typedef {"stepped" | "minimal" | "no decrease" | "refused" | "indefinite"} Outcome
 */

/**
 * A certified map and its energies.
 * @typedef {object} State
 * @property {Coefficients} coefficients
 * @property {Certificate} certificate
 * @property {Samples} samples
 * @property {number} isometric energy
 * @property {Float64Array} residual of the pins
 * @property {Float64Array | null} gradient of the isometric energy, computed once
 */

const LEAST_ENERGY = 1e-6; // decreases are compared with the energy or with this, if it is larger
const SHORTER = 0.5; // the next try after a step that is not proved
const MOST_TRIES = 12;
// A factor is kept while a step gains less than this share of what the step before gained.
const CONTRACTION = 0.3;
// A drag makes a new factor where the predicted decrease stays above this share of the energy.
const BEHIND = 1e-3;
const MOST_RENEWALS = 3; // of the factor, for one position of the targets
const ROUNDING = 1e-9; // a promise below this share of the energy may be rounding
// After this many measurements of angles and scales, their directions are fixed by this damping.
const MOST_MEASUREMENTS = 16;
const KEPT = 1e9;
// A measurement has overshot if it differs from the last one by more than this, in radians. Then the
// damping grows by this factor.
const FAR = 0.2;
const DAMPING = 3;

export class Solver {
  #assembler;
  /** @type {Metric | null} */
  #metric = null;
  #measurements = 0;
  #damping = 1;

  /**
   * @param {Shape} shape
   * @param {SolverOptions} [options]
   */
  constructor(shape, { energy = "iso", s = 1, weight = 1e5, stiff = null } = {}) {
    const { domain, panels } = shape;
    this.shape = shape;
    this.energyMeasure = energyNamed(energy, s);
    this.weight = weight;
    this.quadrature = quadratureOf(shape, stiff);
    this.prover = stiff ? new Prover(domain, panels, this.quadrature.rows) : shape.prover;
    this.#assembler = new Assembler(shape, this.quadrature);
    this.pins = new Pins(shape, { handles: [], targets: [] }, weight);
    /** @type {State} */
    this.state = this.#certified(shape.identity());
    /** How much the last direction promised, as a share of the energy. */
    this.promised = Infinity;
    /** Factors that were made so far, and certified steps that were taken. */
    this.factors = 0;
    this.steps = 0;
  }

  /**
   * A solver with the same pins at the same map.
   * @param {SolverOptions} options
   */
  withOptions(options) {
    const other = new Solver(this.shape, options);
    other.#pin(this.pins.pose);
    other.state = other.#certified(this.state.coefficients);
    other.#remeasure();
    return other;
  }

  /** The whole energy (20). */
  get energy() {
    return this.state.isometric + this.#pinEnergy(this.state.residual);
  }

  /**
   * The first solve: from the identity, moved so that the pins are closest to their targets.
   * @param {Pose} pose
   * @param {{ tolerance?: number, iterations?: number }} [options] it has converged when a step
   *   promises less than `tolerance` of the energy
   */
  solve(pose, { tolerance = 1e-8, iterations = 200 } = {}) {
    this.begin(pose);
    return this.#descend(tolerance, iterations);
  }

  /**
   * Takes up another map. Throws if it cannot be proved, and nothing changes then.
   * @param {Pose} pose
   * @param {Coefficients} coefficients
   */
  place(pose, coefficients) {
    const state = this.#certified(coefficients);
    this.#pin(pose);
    this.state = state;
    this.#metric = null; // that of another map
    this.#remeasure();
  }

  /**
   * Moves the identity rigidly towards the targets.
   * @param {Pose} pose
   */
  begin(pose) {
    const { handles, targets } = pose;
    const [turn, by] = rigidMotion(handles, targets);
    this.#pin(pose);
    this.state = this.#certified(this.shape.moved(this.shape.identity(), turn, by));
    this.#metric = null;
    this.#remeasure();
  }

  /**
   * Follows the targets by a few steps from where the map is.
   * @param {Pose} pose
   * @param {number} [steps]
   * @returns {Outcome} of the last step
   */
  drag(pose, steps = 2) {
    this.aim(pose);
    /** @type {Outcome} */
    let outcome = "minimal";
    for (let i = 0; i < steps; i++) {
      outcome = this.step(1e-12);
      if (outcome !== "stepped") {
        break;
      }
    }
    for (let i = 0; i < MOST_RENEWALS && this.#isBehind(outcome); i++) {
      this.#metric = null;
      outcome = this.step(1e-12);
    }
    return outcome;
  }

  /**
   * Whether a drag needs a new factor.
   * @param {Outcome} outcome of the last step
   */
  #isBehind(outcome) {
    const failed = outcome === "refused" || outcome === "no decrease";
    return failed ? this.promised > ROUNDING : outcome === "stepped" && this.promised > BEHIND;
  }

  /**
   * Sets the targets; pins that differ otherwise are made anew.
   * @param {Pose} pose
   */
  aim(pose) {
    if (pinsAlike(this.pins.pose, pose)) {
      this.pins.aim(pose);
    } else {
      this.#pin(pose);
      this.#metric = this.#metric && repinned(this.#metric, this.pins);
    }
    this.#remeasure();
  }

  /**
   * Steps until the energy is minimal, with a new factor where the kept one converges slowly.
   * @param {number} tolerance
   * @param {number} iterations
   * @returns {Outcome}
   */
  #descend(tolerance, iterations) {
    let gain = Infinity;
    for (let i = 0; i < iterations; i++) {
      const fresh = this.#metric === null;
      const before = this.energy;
      const outcome = this.step(tolerance);
      if (outcome !== "stepped") {
        const ends = fresh || outcome === "minimal";
        const changed = ends ? this.#measure() : false;
        if (ends && !changed) {
          return outcome;
        }
        this.#metric = ends ? this.#metric : null;
        gain = Infinity;
        continue;
      }
      const now = before - this.energy;
      if (!fresh && now > CONTRACTION * gain) {
        this.#metric = null;
      }
      gain = now;
      this.#measure();
    }
    return "stepped";
  }

  /**
   * One certified step.
   * @param {number} tolerance
   * @returns {Outcome}
   */
  step(tolerance) {
    this.#metric ??= this.#newMetric();
    if (this.#metric === null) {
      return "indefinite";
    }
    const gradient = this.#gradient();
    const direction = this.#metric.direction(gradient);
    const slope = dot(gradient, direction);
    this.promised = -slope / 2 / Math.max(this.energy, LEAST_ENERGY);
    if (!(this.promised > tolerance)) {
      return this.promised >= 0 ? "minimal" : "no decrease";
    }
    const change = this.shape.whitening.toCoefficients(direction);
    const whole = this.prover.sample(this.#moved(change, 1));
    const longest = this.#searched(change, slope, whole.samples);
    if (longest === 0) {
      return "no decrease";
    }
    const step = this.#proved(change, longest, whole);
    if (step === 0) {
      return "refused";
    }
    const after = this.#gradient();
    const moved = direction.map((value) => step * value);
    const turned = after.map((value, i) => value - gradient[i]);
    this.#metric.learn(moved, turned);
    return "stepped";
  }

  /**
   * The preferred step along a change of the coefficients, not proved yet; 0 if none lowers the energy.
   * @param {Coefficients} change
   * @param {number} slope
   * @param {Samples} whole those of the map after the step 1
   */
  #searched(change, slope, whole) {
    const { state, pins } = this;
    const rise = whole.map((value, i) => value - state.samples[i]);
    const moved = pins.change(change);
    const constant = pins.product(state.residual, state.residual) / 2;
    const linear = pins.product(state.residual, moved);
    const quadratic = pins.product(moved, moved) / 2;
    const there = new Float64Array(rise.length);
    /** @param {number} t */
    const energyAt = (t) => {
      for (let i = 0; i < there.length; i++) {
        there[i] = state.samples[i] + t * rise[i];
      }
      const pinned = constant + t * linear + t * t * quadratic;
      return this.#isometric(there) + pinned;
    };
    return search(energyAt, slope, largestStep(state.samples, rise));
  }

  /**
   * Takes the longest of some steps that is proved; returns its length, 0 if there is none.
   * @param {Coefficients} change
   * @param {number} longest
   * @param {ReturnType<Prover["sample"]>} whole the map after the step 1
   */
  #proved(change, longest, whole) {
    let step = longest;
    for (let i = 0; i < MOST_TRIES; i++) {
      const coefficients = this.#moved(change, step);
      const sampled = step === 1 ? whole : this.prover.sample(coefficients);
      const certificate = this.prover.judge(sampled);
      if (certificate.certified) {
        const { samples } = sampled;
        this.state = this.#stateOf(coefficients, { certificate, samples });
        this.steps++;
        return step;
      }
      step *= SHORTER;
    }
    return 0;
  }

  /**
   * The coefficients after a step along a change of them.
   * @param {Coefficients} change
   * @param {number} step
   */
  #moved(change, step) {
    const coefficients = Float64Array.from(this.state.coefficients);
    addScaled(step, change, coefficients);
    return coefficients;
  }

  /**
   * The state of a map that must be provable.
   * @param {Coefficients} coefficients
   */
  #certified(coefficients) {
    const proof = this.prover.prove(coefficients);
    if (!proof.certificate.certified) {
      throw new Error("the map to start from cannot be proved locally injective");
    }
    return this.#stateOf(coefficients, proof);
  }

  /**
   * @param {Coefficients} coefficients
   * @param {{ certificate: Certificate, samples: Samples }} proof of this map
   * @returns {State}
   */
  #stateOf(coefficients, { certificate, samples }) {
    const isometric = this.#isometric(samples);
    const residual = this.pins.residual(coefficients);
    return { coefficients, certificate, samples, isometric, residual, gradient: null };
  }

  /** The gradient of the whole energy. The isometric part is kept, as targets do not change it. */
  #gradient() {
    const { state, pins } = this;
    state.gradient ??= this.#isometricGradient();
    const gradient = Float64Array.from(state.gradient);
    for (const [i, { reduced, weight }] of pins.rows.entries()) {
      addScaled(weight * state.residual[i], reduced, gradient);
    }
    return gradient;
  }

  /**
   * The isometric energy, without what stiff areas add to an isometry.
   * @param {Samples} samples
   */
  #isometric(samples) {
    const { energyMeasure, quadrature } = this;
    const whole = isometricEnergy(energyMeasure, quadrature.weights, samples);
    return whole - quadrature.added * energyMeasure.density(1, 0);
  }

  #isometricGradient() {
    const { shape, state, energyMeasure, quadrature } = this;
    const bySamples = energyGradient(energyMeasure, quadrature.weights, state.samples);
    const bySlopes = pulledThroughRows(quadrature.rows, bySamples);
    return shape.whitening.pulledBack(pulledThroughSlopes(shape.domain, bySlopes));
  }

  /** @param {Float64Array} residual */
  #pinEnergy(residual) {
    return this.pins.product(residual, residual) / 2;
  }

  #newMetric() {
    this.factors++;
    return metricAt(this.#assembler, this.state.samples, this.energyMeasure, this.pins);
  }

  /** @param {Pose} pose */
  #pin(pose) {
    this.pins = new Pins(this.shape, pose, this.weight);
  }

  /** Measures angles and scales anew, for new pins or targets. */
  #remeasure() {
    this.#measurements = 0;
    this.#damping = 1;
    this.#measure();
    this.state.residual = this.pins.residual(this.state.coefficients);
  }

  /** Measures angles and scales from where the map is. Returns whether that changes the energy. */
  #measure() {
    const { pins } = this;
    if (!pins.turned || this.#damping === KEPT) {
      return false;
    }
    if (this.#measurements === MOST_MEASUREMENTS) {
      this.#damping = KEPT;
    }
    const before = pins.turns;
    pins.measure(this.state.coefficients, this.#damping);
    const apart = pins.apartFrom(before);
    if (apart === 0) {
      pins.turns = before;
      return false;
    }
    if (this.#measurements > 0 && apart > FAR && this.#damping !== KEPT) {
      this.#damping *= DAMPING;
    }
    this.#measurements++;
    this.#metric = this.#metric && repinned(this.#metric, pins);
    this.state.residual = pins.residual(this.state.coefficients);
    return true;
  }
}

/**
 * Whether two poses differ in targets only.
 * @param {Pose} a
 * @param {Pose} b
 */
function pinsAlike(a, b) {
  /** @param {Pose} pose */
  const kept = ({ handles, weights, angles, scales }) =>
    JSON.stringify([handles, weights ?? null, angles ?? null, scales ?? null]);
  return kept(a) === kept(b);
}

/**
 * The rigid motion z -> turn z + by that brings points closest to targets.
 * @param {[number, number][]} points
 * @param {[number, number][]} targets
 * @returns {[[number, number], [number, number]]}
 */
export function rigidMotion(points, targets) {
  const middle = meanOf(points);
  const aim = meanOf(targets);
  let re = 0;
  let im = 0;
  for (const [i, point] of points.entries()) {
    const [x, y] = [point[0] - middle[0], point[1] - middle[1]];
    const [u, v] = [targets[i][0] - aim[0], targets[i][1] - aim[1]];
    re += x * u + y * v;
    im += x * v - y * u;
  }
  const size = Math.hypot(re, im);
  const [cos, sin] = size > 0 ? [re / size, im / size] : [1, 0];
  const by = [
    aim[0] - cos * middle[0] + sin * middle[1],
    aim[1] - cos * middle[1] - sin * middle[0],
  ];
  return [
    [cos, sin],
    [by[0], by[1]],
  ];
}

/**
 * @param {[number, number][]} points
 * @returns {[number, number]}
 */
function meanOf(points) {
  const count = Math.max(points.length, 1);
  const x = points.reduce((sum, point) => sum + point[0], 0);
  const y = points.reduce((sum, point) => sum + point[1], 0);
  return [x / count, y / count];
}
