// With the kernel in WebAssembly and without it, the solver computes the same bits.

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { pulledThroughRows, rowsAt, samplesAt } from "../../../glid_nb/page/js/live/basis.js";
import { addProduct, factorise, solveWith } from "../../../glid_nb/page/js/live/dense.js";
import { arraysOf, compiled, kernelOf } from "../../../glid_nb/page/js/live/kernel.js";
import { Shape } from "../../../glid_nb/page/js/live/shape.js";
import { Solver } from "../../../glid_nb/page/js/live/solver.js";
import { KERNEL, kernelCode } from "../../../tools/build_page.js";
import { boundary, golden, random } from "./golden.js";

const { module } = compiled;

/**
 * What a function returns with the kernel, then without.
 * @template T
 * @param {() => T} compute
 */
function bothOf(compute) {
  compiled.module = module;
  const fast = compute();
  compiled.module = null;
  const plain = compute();
  compiled.module = module;
  return [fast, plain];
}

/**
 * @param {number} size
 * @param {number} seed
 */
function numbers(size, seed) {
  const next = random(seed);
  return Float64Array.from({ length: size }, () => next());
}

/** @param {Float64Array} values in the kernel's reach, if there is one */
function reachable(values) {
  const [array] = arraysOf(values.length);
  array.set(values);
  return array;
}

test("the code is what kernel.wat makes, byte by byte", async () => {
  assert.equal(await readFile(KERNEL, "utf-8"), await kernelCode());
});

test("this node has the kernel", () => {
  assert.ok(module);
  assert.ok(kernelOf(reachable(numbers(3, 1))));
});

for (const name of ["bar", "gecko"]) {
  test(`samples of ${name}, and derivatives by slopes`, () => {
    for (const less of [0, 1]) {
      const [fast, plain] = bothOf(() => {
        const { domain, panels } = boundary(golden(name).outline);
        const { re, im } = panels.nodes;
        const points = { re: re.subarray(less), im: im.subarray(less) };
        const rows = rowsAt(domain, points);
        const samples = samplesAt(rows, numbers(4 * domain.columns, 2));
        return [samples, pulledThroughRows(rows, numbers(4 * rows.count, 3))];
      });
      assert.deepEqual(fast, plain);
    }
  });
}

test("products, factors and solutions of all small sizes", () => {
  for (let n = 1; n < 12; n++) {
    const [fast, plain] = bothOf(() => {
      const values = reachable(numbers(n * n, n));
      const product = new Float64Array(n * n);
      const part = { values, first: 0, stride: n };
      addProduct(part, part, { values: product, first: 0, stride: n }, n, n, n);
      const factor = Float64Array.from(product);
      assert.ok(factorise(factor, n));
      return [product, factor, solveWith(factor, numbers(n, 5))];
    });
    assert.deepEqual(fast, plain);
  }
});

for (const name of ["bar", "teapot"]) {
  test(`a solve and a drag of ${name}: the same maps with the same certificates`, () => {
    const { outline, pose } = golden(name);
    const [fast, plain] = bothOf(() => {
      const solver = new Solver(new Shape(outline));
      solver.solve(pose);
      const first = solver.state;
      for (let i = 1; i <= 10; i++) {
        const targets = pose.targets.map(
          ([x, y]) => /** @type {[number, number]} */ ([x + i / 20, y]),
        );
        solver.drag({ ...pose, targets });
      }
      return [first, solver.state].map(({ coefficients, certificate, isometric }) => {
        return { coefficients, certificate, isometric };
      });
    });
    assert.deepEqual(fast, plain);
  });
}
