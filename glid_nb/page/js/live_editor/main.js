// The live page as a widget: the page is in a frame, and the kernel hears of the maps it comes to rest at.

import { make } from "../pad/dom.js";

/** @import { Context } from "../types.js" */
/** @import { Message } from "../live_page/host.js" */

const KERNEL = "kernel"; // who changed the pose, if no view did

/** @param {Context} context */
function render({ model, el, signal }) {
  const view = crypto.randomUUID();
  const frame = make("iframe", {
    title: model.get("title"),
    srcdoc: model.get("page"),
    allow: "clipboard-write; fullscreen",
    className: "glid-live-editor",
  });
  frame.style.cssText = `display: block; width: 100%; height: ${model.get("height")}px; border: 0`;

  const show = () => {
    const { by, pins, coefficients } = model.get("edit");
    if (!by || by === view) return;
    const edit = { glid: "edit", pins, coefficients, quiet: by !== KERNEL };
    frame.contentWindow?.postMessage(edit, "*");
  };
  const hear = (/** @type {MessageEvent<Message>} */ { source, data }) => {
    if (source !== frame.contentWindow) return;
    if (data.glid === "ready") show();
    if (data.glid !== "edit") return;
    model.set("edit", { by: view, pins: data.pins, coefficients: data.coefficients });
    model.save_changes();
  };
  window.addEventListener("message", hear, { signal });
  model.on("change:edit", show);
  signal?.addEventListener("abort", () => model.off("change:edit", show));
  el.append(frame);
}

export default { render };
