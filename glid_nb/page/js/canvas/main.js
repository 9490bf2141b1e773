// The canvas's widget: what the kernel says is shown, and what the page can do is measured.

import { follow, save } from "../pad/dom.js";
import { Canvas } from "./canvas.js";
import { drawingTime, uniformVectors } from "./shapes.js";

/** @import { Context } from "../types.js" */
/** @import { CanvasTraits } from "./traits.js" */

/** @param {Context<CanvasTraits>} context */
function render(context) {
  const { model, signal } = context;
  const canvas = new Canvas(context);
  follow(model, {
    "change:width change:height change:view": () => canvas.fit(),
    "change:coefficients": () => canvas.shapes.lead || canvas.shapes.refresh(),
    "change:part_maps": () => canvas.shapes.refresh(),
    "change:solver_script change:solver change:outline": () => canvas.prepareSolver(),
    "change:rest": () => canvas.rested(),
    "change:drawing_time": () =>
      model.get("drawn") && !model.get("drawing_time") && measure(canvas, signal),
    "change:marks change:cursor change:onion change:stiff change:brush change:pins": () =>
      canvas.redraw(),
    "glid:motion": (...shown) => canvas.showMotion(...shown), // from the timeline, on the page
    "change:legend change:panel_legend change:legend_corner": () => canvas.showLegend(),
    "change:notice change:marks change:brush": () => canvas.showNotice(),
    "change:marks": () => canvas.reveal(),
    "change:brush": () => canvas.takeFocus(),
    "change:reference change:behind_reference": () => void canvas.reference.show(),
    "change:prepared": () => canvas.notices.prepare(model.get("prepared")),
  });
  measure(canvas, signal);
  if (model.get("uniform_vectors") === 0) {
    save(model, { uniform_vectors: uniformVectors() || -1 });
  }
  return () => canvas.close();
}

/**
 * Tells the kernel how long the page needs to draw.
 *
 * @param {Canvas} canvas
 * @param {AbortSignal} signal
 */
async function measure({ box, model, shapes }, signal) {
  await shapes.load();
  const time = await drawingTime(box, shapes);
  if (!signal.aborted) save(model, { drawn: true, drawing_time: time });
}

export default { render };
