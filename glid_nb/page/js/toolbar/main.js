// The widget of the bar above the canvas.

import { follow } from "../pad/dom.js";
import { Toolbar } from "./toolbar.js";

/** @import { Context } from "../types.js" */
/** @import { ToolbarTraits } from "./traits.js" */

/** @param {Context<ToolbarTraits>} context */
function render({ model, el }) {
  const toolbar = new Toolbar(model);
  el.classList.add("glid-host");
  el.append(toolbar.element);
  follow(model, {
    "change:tool": () => toolbar.showTool(),
    "change:can_undo change:can_redo": () => toolbar.showHistory(),
    "change:overlay change:shows change:referenced": () => toolbar.view.show(),
  });
}

export default { render };
