// The basis, the panels and the energies are those of the package.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  coordinatesAt,
  pulledThroughRows,
  pulledThroughSlopes,
  samplesAt,
  slopesOf,
} from "../../../glid_nb/page/js/live/basis.js";
import {
  energyGradient,
  energyNamed,
  isometricEnergy,
  noDifferentials,
} from "../../../glid_nb/page/js/live/energy.js";
import { boundary, ENERGY_CASES, golden, random, SAMPLES } from "./golden.js";

/**
 * @param {number} found
 * @param {number} wanted
 * @param {number} tolerance relative
 */
function assertNear(found, wanted, tolerance) {
  const error = Math.abs(found - wanted);
  assert.ok(error <= tolerance * Math.abs(wanted), `${found} is not ${wanted}`);
}

for (const name of SAMPLES) {
  const data = golden(name);
  const { domain, panels, rows } = boundary(data.outline);
  const coefficients = Float64Array.from(data.coefficients);

  test(`the panels of ${name} are the package's`, () => {
    assert.equal(panels.count, data.panels);
    const { re, im } = panels.nodes;
    let sum = 0;
    let perimeter = 0;
    for (let i = 0; i < panels.count; i++) {
      const end = panels.next[i];
      sum += Math.hypot(re[i], im[i]);
      perimeter += Math.hypot(re[end] - re[i], im[end] - im[i]);
    }
    assertNear(sum, data.starts[0], 1e-13);
    assertNear(perimeter, data.starts[1], 1e-13);
    const whole = panels.weights.reduce((total, weight) => total + weight, 0);
    assertNear(whole, 1, 1e-13);
  });

  test(`the energies of a map of ${name} are the package's to 1e-12`, () => {
    const samples = samplesAt(rows, slopesOf(domain, coefficients));
    for (const [i, [energy, s]] of ENERGY_CASES.entries()) {
      const found = isometricEnergy(energyNamed(energy, s), panels.weights, samples);
      assertNear(found, data.energies[i], 1e-12);
    }
  });

  test(`the images of points of ${name} are the package's`, () => {
    const n = domain.columns;
    for (const [i, point] of data.points.entries()) {
      const c = coordinatesAt(domain, point);
      let x = 0;
      let y = 0;
      for (let j = 0; j < n; j++) {
        const [pr, pi] = [coefficients[j], coefficients[n + j]];
        const [qr, qi] = [coefficients[2 * n + j], coefficients[3 * n + j]];
        x += c.re[j] * (pr + qr) - c.im[j] * (pi + qi);
        y += c.re[j] * (pi - qi) + c.im[j] * (pr - qr);
      }
      const off = Math.hypot(x - data.images[i][0], y - data.images[i][1]);
      assert.ok(off < 1e-11, `off by ${off} at ${point}`);
    }
  });
}

test("gradients are the derivatives of energies", () => {
  const data = golden("teapot");
  const { domain, panels, rows } = boundary(data.outline);
  const coefficients = Float64Array.from(data.coefficients);
  const next = random(7);
  const direction = coefficients.map(() => next());
  const h = 1e-6;
  for (const [name, s] of ENERGY_CASES) {
    const energy = energyNamed(name, s);
    /** @param {number} t */
    const at = (t) => {
      const moved = coefficients.map((value, j) => value + t * direction[j]);
      return isometricEnergy(energy, panels.weights, samplesAt(rows, slopesOf(domain, moved)));
    };
    const samples = samplesAt(rows, slopesOf(domain, coefficients));
    const bySamples = energyGradient(energy, panels.weights, samples);
    const gradient = pulledThroughSlopes(domain, pulledThroughRows(rows, bySamples));
    const slope = gradient.reduce((sum, g, j) => sum + g * direction[j], 0);
    assertNear((at(h) - at(-h)) / (2 * h), slope, 1e-6);
  }
});

test("second derivatives are the derivatives of the first", () => {
  const [plus, minus, here] = [noDifferentials(), noDifferentials(), noDifferentials()];
  const [x, y, h] = [1.3, 0.2, 1e-6];
  for (const [name, s] of ENERGY_CASES) {
    const energy = energyNamed(name, s);
    energy.differentiate(x, y, here);
    assertNear((energy.density(x + h, y) - energy.density(x - h, y)) / (2 * h), here.alpha1, 1e-7);
    energy.differentiate(x + h, y, plus);
    energy.differentiate(x - h, y, minus);
    assert.ok(Math.abs((plus.alpha1 - minus.alpha1) / (2 * h) - here.beta1) < 1e-6);
    assert.ok(Math.abs((plus.alpha2 - minus.alpha2) / (2 * h) - here.beta3) < 1e-6);
    energy.differentiate(x, y + h, plus);
    energy.differentiate(x, y - h, minus);
    assert.ok(Math.abs((plus.alpha2 - minus.alpha2) / (2 * h) - here.beta2) < 1e-6);
  }
});
