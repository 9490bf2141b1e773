// The live page as a widget: the page is in a frame, and the kernel hears of the maps it comes to rest at.

import { make } from "../pad/dom.js";
import { joined } from "./joined.js";

/** @import { Context } from "../types.js" */
/** @import { Edit, Edited } from "./joined.js" */

const KERNEL = "kernel"; // who has changed the pose, if no view has

/** @param {Context} context */
function render({ model, el, signal }) {
  const view = crypto.randomUUID();
  const frame = make("iframe", {
    title: model.get("title"),
    srcdoc: model.get("page"),
    allow: "clipboard-write; fullscreen",
  });
  frame.style.cssText = `display: block; width: 100%; height: ${model.get("height")}px; border: 0`;
  const tell = (/** @type {Edit} */ edit) => {
    model.set("edit", { by: view, ...edit });
    model.save_changes();
  };
  let show = (/** @type {Edit} */ _, /** @type {boolean} */ _quiet) => {}; // the page is not open
  whenOpen(frame, (editing) => {
    show = joined(editing, tell);
    const { by, ...edit } = model.get("edit");
    if (by) show(edit, by !== KERNEL);
  });
  const follow = () => {
    const { by, ...edit } = model.get("edit");
    if (by && by !== view) show(edit, by !== KERNEL);
  };
  model.on("change:edit", follow);
  signal?.addEventListener("abort", () => model.off("change:edit", follow));
  el.append(frame);
}

/**
 * Calls `use` each time that the page has opened; a frame that is moved in its document opens it again.
 * @param {HTMLIFrameElement} frame
 * @param {(editing: Edited) => void} use
 */
function whenOpen(frame, use) {
  frame.addEventListener("load", () => {
    const root = frame.contentDocument?.documentElement;
    if (!root) return;
    const waiting = new MutationObserver(look);
    waiting.observe(root, { attributeFilter: ["data-ready"] });
    look();

    function look() {
      if (!root?.dataset.ready) return;
      waiting.disconnect();
      use(Reflect.get(frame.contentWindow ?? {}, "glidPage").editing);
    }
  });
}

export default { render };
