// Where the isometric energy is summed, and with which weights.
//
// The nodes are those of the panels, then those inside stiff areas. The energy that stiff areas add to
// an isometry is subtracted, so an isometry has the same energy everywhere.

import { emptyRows, rowsAt } from "./basis.js";
import { complexOf } from "./domain.js";

/** @import { Rows } from "./basis.js" */
/** @import { Shape } from "./shape.js" */
/** @import { Stiff } from "./types.js" */

/**
 * @typedef {object} Quadrature
 * @property {Rows} rows of the basis at the nodes
 * @property {Float64Array} weights of the energy at the nodes
 * @property {Float64Array} middles weights of the midpoint rule: at the panels' middles, and inside
 * @property {number} added the sum that stiff areas add to the weights
 */

/**
 * @param {Shape} shape
 * @param {Stiff | null} stiff
 * @returns {Quadrature}
 */
export function quadratureOf({ domain, panels, rows }, stiff) {
  const { count, weights, lengths } = panels;
  if (!stiff) {
    return { rows, weights, middles: lengths, added: 0 };
  }
  const { factors, points } = stiff;
  const inside = Float64Array.from(stiff.weights);
  const onPanels = weights.map((weight, i) => weight * factors[i]);
  const onMiddles = lengths.map((length, i) => length * factors[count + i]);
  const extra = onPanels.reduce((sum, weight, i) => sum + weight - weights[i], 0);
  return {
    rows: joinedRows(rows, rowsAt(domain, complexOf(points))),
    weights: joined(onPanels, inside),
    middles: joined(onMiddles, inside),
    added: inside.reduce((sum, weight) => sum + weight, extra),
  };
}

/**
 * @param {Rows} a
 * @param {Rows} b
 * @returns {Rows}
 */
function joinedRows(a, b) {
  const both = emptyRows(a.count + b.count, a.columns);
  for (const key of /** @type {const} */ (["re", "im", "norms"])) {
    both[key].set(joined(a[key], b[key]));
  }
  return both;
}

/**
 * @param {Float64Array} a
 * @param {Float64Array} b
 */
function joined(a, b) {
  const both = new Float64Array(a.length + b.length);
  both.set(a);
  both.set(b, a.length);
  return both;
}
