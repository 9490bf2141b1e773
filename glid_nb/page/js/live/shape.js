// All that depends on a cage only: made once in the page, in some ten milliseconds.

import { rowsAt } from "./basis.js";
import { Domain } from "./domain.js";
import { gradedPanels } from "./panels.js";
import { Prover } from "./proof.js";
import { Whitening } from "./whitening.js";

/** @import { Coefficients, Outline } from "./types.js" */

export class Shape {
  /** @param {Outline} outline */
  constructor(outline) {
    this.domain = new Domain(outline);
    this.panels = gradedPanels(this.domain);
    /** Of the basis at the panels' nodes. */
    this.rows = rowsAt(this.domain, this.panels.nodes);
    this.prover = new Prover(this.domain, this.panels, this.rows);
    this.whitening = new Whitening(this.domain, this.panels, this.rows);
  }

  /**
   * The identity.
   * @returns {Coefficients}
   */
  identity() {
    const { exterior, columns, singular } = this.domain;
    const coefficients = new Float64Array(4 * columns);
    coefficients.set(singular.re.subarray(0, exterior));
    coefficients.set(singular.im.subarray(0, exterior), columns);
    return coefficients;
  }

  /**
   * A map followed by z -> turn z + by, for complex numbers (re, im).
   * @param {Coefficients} coefficients
   * @param {[number, number]} turn of modulus 1
   * @param {[number, number]} by
   * @returns {Coefficients}
   */
  moved(coefficients, [cos, sin], by) {
    const { exterior, columns: n } = this.domain;
    const moved = new Float64Array(4 * n);
    for (let j = 0; j < n; j++) {
      const shift = j < exterior ? by : [0, 0];
      const [pr, pi] = [coefficients[j], coefficients[n + j]];
      const [qr, qi] = [coefficients[2 * n + j], coefficients[3 * n + j]];
      moved[j] = cos * pr - sin * pi + shift[0];
      moved[n + j] = cos * pi + sin * pr + shift[1];
      // psi is conjugated in the map.
      moved[2 * n + j] = cos * qr + sin * qi;
      moved[3 * n + j] = cos * qi - sin * qr;
    }
    return moved;
  }
}
