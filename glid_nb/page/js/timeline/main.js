// The timeline's widget: what the kernel says is shown, and the canvas is found.

import { follow } from "../pad/dom.js";
import { Timeline } from "./timeline.js";

/** @import { Context } from "../types.js" */
/** @import { TimelineTraits } from "./traits.js" */

/** @param {Context<TimelineTraits>} context */
function render(context) {
  const { model, el, signal } = context;
  const timeline = new Timeline(context);
  const { player } = timeline;

  // A tap on the space bar over the canvas of the same editor plays too.
  const tapped = (/** @type {Event} */ e) => {
    const target = /** @type {Element} */ (e.target);
    if (target.closest(".glid-editor") === el.closest(".glid-editor")) timeline.play();
  };
  window.addEventListener("glid:play", tapped, { signal });
  const keyed = (/** @type {Event} */ e) => {
    const target = /** @type {Element} */ (e.target);
    if (target.closest(".glid-editor") === el.closest(".glid-editor")) timeline.keep();
  };
  window.addEventListener("glid:key", keyed, { signal });

  follow(model, {
    "change:shown": () => timeline.showState(),
    "change:rate": () => timeline.showRate(),
    "change:motion": () => timeline.showMotion(),
    "change:heights": () => timeline.showHeights(),
    "change:part_motions": () => timeline.showOthers(),
    "change:pins": () => timeline.showPins(),
    "change:thumbnails": () => timeline.showKeys(),
  });

  const edited = () => timeline.edited();
  findStage(context, timeline).then(() => timeline.stage?.on("change:coefficients", edited));

  return () => {
    player.pause();
    timeline.stage?.off("change:coefficients", edited);
  };
}

/**
 * @param {Context<TimelineTraits>} context
 * @param {Timeline} timeline
 */
async function findStage({ model, signal }, timeline) {
  const found = await model.widget_manager.get_model(model.get("stage"));
  if (!signal.aborted) timeline.stage = found;
}

export default { render };
