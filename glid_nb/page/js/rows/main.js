// The widget of a list of things with names.

import { follow } from "../pad/dom.js";
import { Rows } from "./rows.js";

/** @import { Context } from "../types.js" */
/** @import { RowTraits } from "./traits.js" */

/** @param {Context<RowTraits>} context */
function render({ model, el }) {
  const rows = new Rows(model);
  el.classList.add("glid-host");
  el.append(rows.element);
  follow(model, {
    "change:label change:nothing change:several": () => rows.showLabels(),
    "change:rows": () => rows.showRows(),
    "change:chosen": () => rows.showChosen(),
  });
}

export default { render };
