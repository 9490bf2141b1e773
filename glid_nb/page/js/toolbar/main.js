// The widget of the bar above the canvas.

import { follow } from "../pad/dom.js";
import { Toolbar } from "./toolbar.js";

/** @import { Context } from "../types.js" */
/** @import { ToolbarTraits } from "./traits.js" */

/** @param {Context<ToolbarTraits>} context */
function render({ model, el, signal }) {
  const toolbar = new Toolbar(model);
  el.classList.add("glid-host");
  el.append(toolbar.element);
  const took = (/** @type {Event} */ e) => toolbar.canvasTook(e);
  window.addEventListener("glid:tool", took, { signal });
  follow(model, {
    "change:tool": () => toolbar.showTool(),
    "change:can_undo change:can_redo": () => toolbar.showHistory(),
    "change:overlay change:shows change:referenced": () => toolbar.view.show(),
  });
}

export default { render };
