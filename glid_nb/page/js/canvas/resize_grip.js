// The corner that changes the canvas's size.

import { make, save } from "../pad/dom.js";
import { shield } from "../pad/help.js";
import { scaleOf } from "../pad/place.js";

/** @import { Model } from "../types.js" */
/** @import { CanvasTraits } from "./traits.js" */

const LEAST_SIZE = 240; // CSS pixels

/** @param {Model<CanvasTraits>} model */
export function resizeGrip(model) {
  /** @type {{ width: number, height: number } | null} of the canvas, less the pointer's place */
  let beyond = null;
  const side = (/** @type {number} */ length) => Math.max(LEAST_SIZE, Math.round(length));
  const grip = make("div", { className: "glid-resize", title: "Drag to resize" });
  const place = (/** @type {PointerEvent} */ { clientX, clientY }) => {
    const { across, down } = scaleOf(grip);
    return [clientX / across, clientY / down];
  };
  grip.addEventListener("pointerdown", (e) => {
    e.preventDefault();
    grip.setPointerCapture(e.pointerId);
    const [x, y] = place(e);
    beyond = { width: model.get("width") - x, height: model.get("height") - y };
  });
  grip.addEventListener("pointermove", (e) => {
    if (!beyond) return;
    const [x, y] = place(e);
    save(model, { width: side(beyond.width + x), height: side(beyond.height + y) });
  });
  grip.addEventListener("lostpointercapture", () => {
    beyond = null;
  });
  return shield(grip);
}
