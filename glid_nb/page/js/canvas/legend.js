// The colour bars in a corner of the canvas.

import { make } from "../pad/dom.js";

/** @import { Model } from "../types.js" */
/** @import { CanvasTraits, ColorBar } from "./traits.js" */

export class Legend {
  element = make("div", { className: "glid-legend" });

  /**
   * @param {Model<CanvasTraits>} model
   * @param {boolean} moving whether a motion is seen
   */
  show(model, moving) {
    const bars = [model.get("legend"), model.get("panel_legend")].filter((bar) => bar.title);
    this.element.replaceChildren(
      ...bars.map((bar) => colorBar(/** @type {ColorBar} */ (bar), moving)),
    );
    this.element.hidden = !bars.length;
    this.element.dataset.corner = model.get("legend_corner");
  }
}

/**
 * @param {ColorBar} bar
 * @param {boolean} moves
 */
function colorBar({ title, moving, colors, ticks, about }, moves) {
  const gradient = `background: linear-gradient(to right, ${colors.join(", ")})`;
  const labels = ticks.map((tick) => make("span", {}, tick));
  return make(
    "div",
    { className: "glid-legend-part", title: about },
    make("div", { className: "glid-legend-title" }, (moves && moving) || title),
    make("div", { className: "glid-legend-bar", style: gradient }),
    make("div", { className: "glid-legend-ticks" }, ...labels),
  );
}
