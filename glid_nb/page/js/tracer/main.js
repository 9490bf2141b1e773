// The tracer's widget: what the kernel says is shown.

import { follow } from "../pad/dom.js";
import { Tracer } from "./tracer.js";

/** @import { Context } from "../types.js" */
/** @import { TracerTraits } from "./traits.js" */

/** @param {Context<TracerTraits>} context */
function render(context) {
  const tracer = new Tracer(context);
  follow(context.model, {
    "change:height": () => tracer.showHeight(),
    "change:shown": () => tracer.showState(),
    "change:picture": () => tracer.showPicture(),
  });
  return () => tracer.close();
}

export default { render };
