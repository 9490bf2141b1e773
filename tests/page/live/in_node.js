// For tests in Python: reads requests from stdin as JSON and writes what the modules answer.

import { readFileSync } from "node:fs";
import { samplesAt } from "../../../glid_nb/page/js/live/basis.js";
import { atan2, log } from "../../../glid_nb/page/js/live/elementary.js";
import { MapData } from "../../../glid_nb/page/js/live/proof.js";
import { Shape } from "../../../glid_nb/page/js/live/shape.js";
import { Solver } from "../../../glid_nb/page/js/live/solver.js";

/** @type {Record<string, (request: any) => unknown>} */
const ANSWERS = {
  /** Certificates of maps of one outline. */
  certify({ outline, maps }) {
    const { prover } = new Shape(outline);
    return maps.map((/** @type {number[]} */ map) => prover.certify(Float64Array.from(map)));
  },
  /** Samples of a map at the panels' nodes, and what bounds their rounding. */
  samples({ outline, map }) {
    const { domain, panels, rows } = new Shape(outline);
    const { f, g, slopes } = new MapData(domain, Float64Array.from(map));
    const [x, y] = [panels.nodes.re, panels.nodes.im].map((part) => Array.from(part));
    const samples = Array.from(samplesAt(rows, slopes));
    return { x, y, samples, norms: Array.from(rows.norms), f, g };
  },
  log: ({ x }) => x.map(log),
  atan2: ({ y, x }) =>
    y.map((/** @type {number} */ value, /** @type {number} */ i) => atan2(value, x[i])),
  /** The energy and the coefficients where a solve ends. */
  solve({ outline, pose, options }) {
    const solver = new Solver(new Shape(outline), options);
    const outcome = solver.solve(pose);
    const coefficients = Array.from(solver.state.coefficients);
    return { outcome, energy: solver.energy, coefficients };
  },
};

const requests = JSON.parse(readFileSync(0, "utf-8"));
const answers = requests.map((/** @type {any} */ request) => ANSWERS[request.ask](request));
process.stdout.write(JSON.stringify(answers));
