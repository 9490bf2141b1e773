// The corner that changes the canvas's size.

import { make, save } from "../pad/dom.js";
import { shield } from "../pad/help.js";

/** @import { Model } from "../types.js" */
/** @import { CanvasTraits } from "./traits.js" */

const LEAST_SIZE = 240; // CSS pixels

/** @param {Model<CanvasTraits>} model */
export function resizeGrip(model) {
  /** @type {{ width: number, height: number } | null} of the canvas, less the pointer's place */
  let beyond = null;
  const side = (/** @type {number} */ length) => Math.max(LEAST_SIZE, Math.round(length));
  const grip = make("div", { className: "glid-resize", title: "Drag to resize" });
  grip.addEventListener("pointerdown", (e) => {
    e.preventDefault();
    grip.setPointerCapture(e.pointerId);
    beyond = { width: model.get("width") - e.clientX, height: model.get("height") - e.clientY };
  });
  grip.addEventListener("pointermove", (e) => {
    if (!beyond) return;
    const width = side(beyond.width + e.clientX);
    const height = side(beyond.height + e.clientY);
    save(model, { width, height });
  });
  grip.addEventListener("lostpointercapture", () => {
    beyond = null;
  });
  return shield(grip);
}
