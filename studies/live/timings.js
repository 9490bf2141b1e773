// Times of the page's solver in node: reads problems from stdin as JSON, writes processor times in ms.

import { readFileSync } from "node:fs";
import { compiled } from "../../glid_nb/page/js/live/kernel.js";
import { Shape } from "../../glid_nb/page/js/live/shape.js";
import { Solver } from "../../glid_nb/page/js/live/solver.js";

const { module } = compiled;

/** Processor time of this thread in ms. */
function now() {
  const { user, system } = process.threadCpuUsage();
  return (user + system) / 1000;
}

/** @param {number[]} values */
function median(values) {
  return values.toSorted((a, b) => a - b)[values.length >> 1];
}

/** Set-up, first solve to 1e-4, and the mean of a drag's steps, each a position of the pin. */
function timesOf({ outline, handles, targets, path }) {
  const began = now();
  const shape = new Shape(outline);
  const solver = new Solver(shape);
  const ready = now();
  solver.solve({ handles, targets }, { tolerance: 1e-4 });
  const solved = now();
  solver.solve({ handles, targets: path[0] });
  const start = now();
  for (const moved of path) {
    solver.drag({ handles, targets: moved });
    if (!solver.state.certificate.certified) throw new Error("a map is not certified");
  }
  return [ready - began, solved - ready, (now() - start) / path.length];
}

const { problems, repeats } = JSON.parse(readFileSync(0, "utf-8"));
const told = problems.map((problem) => {
  const taken = { plain: [], wasm: [] };
  for (let i = 0; i <= repeats; i++) {
    for (const [name, times] of Object.entries(taken)) {
      compiled.module = name === "wasm" ? module : null;
      const found = timesOf(problem);
      if (i > 0) times.push(found); // the first warms up
    }
  }
  return Object.fromEntries(
    Object.entries(taken).map(([name, times]) => {
      return [name, [0, 1, 2].map((column) => median(times.map((row) => row[column])))];
    }),
  );
});
process.stdout.write(JSON.stringify(told));
