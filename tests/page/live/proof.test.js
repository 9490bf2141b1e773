// Proofs in the page: true, and nearly as tight as the package's.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Prover } from "../../../glid_nb/page/js/live/proof.js";
import { boundary, golden, SAMPLES } from "./golden.js";

for (const name of SAMPLES) {
  const data = golden(name);
  const { domain, panels, rows } = boundary(data.outline);
  const prover = new Prover(domain, panels, rows);
  const coefficients = Float64Array.from(data.coefficients);

  test(`the certificate of a map of ${name} is nearly the package's`, () => {
    const proof = prover.certify(coefficients);
    assert.ok(proof.certified);
    assert.deepEqual(proof.windings, data.windings);
    // The package halves panels until its bounds are within 2 % of values that the map attains.
    assert.ok(proof.sigma2_lower <= 1.021 * data.sigma2_lower);
    assert.ok(proof.sigma1_upper >= data.sigma1_upper / 1.021);
    assert.ok(proof.k_upper >= data.k_upper / 1.05);
    assert.ok(proof.sigma2_lower > 0.9 * data.sigma2_lower, `${proof.sigma2_lower}`);
    assert.ok(proof.sigma1_upper < 1.1 * data.sigma1_upper, `${proof.sigma1_upper}`);
    assert.ok(proof.k_upper < data.k_upper + 0.1, `${proof.k_upper} ${data.k_upper}`);
  });

  test(`a similar map of ${name} has similar bounds, whatever its scale`, () => {
    const proof = prover.certify(coefficients);
    for (const scale of [1e-8, 1e-4, 1e4, 1e8]) {
      const scaled = prover.certify(coefficients.map((value) => scale * value));
      assert.ok(scaled.certified);
      assert.ok(Math.abs(scaled.sigma2_lower / scale / proof.sigma2_lower - 1) < 1e-6);
    }
    assert.ok(!prover.certify(coefficients.map((value) => 1e-160 * value)).certified);
    assert.ok(!prover.certify(coefficients.map((value) => 1e160 * value)).certified);
  });

  test(`nothing is proved of maps of ${name} that are not numbers`, () => {
    for (const bad of [NaN, Infinity, -Infinity, 1e308]) {
      for (const j of [0, domain.columns + 3, 4 * domain.columns - 1]) {
        const spoilt = coefficients.slice();
        spoilt[j] = bad;
        assert.ok(!prover.certify(spoilt).certified);
      }
    }
  });

  test(`a reflection of ${name} is refused`, () => {
    const n = domain.columns;
    const reflected = new Float64Array(4 * n);
    reflected.set(coefficients.subarray(0, 2 * n), 2 * n);
    reflected.set(coefficients.subarray(2 * n), 0);
    for (let j = domain.vertices; j < n; j++) {
      reflected[n + j] = -reflected[3 * n + j];
    }
    assert.ok(!prover.certify(reflected).certified);
  });
}
