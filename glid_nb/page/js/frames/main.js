// Adds the sliders of all figures that do not have them yet. Each figure's output contains this
// script, so it runs again for every figure that a notebook shows.

import { bytesOf } from "../exported/unpack.js";
import { addControls } from "./figure.js";

/** @import { Frames } from "./data.js" */

/**
 * @param {string} text base64 of deflated JSON
 * @returns {Promise<Frames>}
 */
function unpacked(text) {
  const stream = new Blob([bytesOf(text)]).stream();
  return new Response(stream.pipeThrough(new DecompressionStream("deflate"))).json();
}

/** @type {NodeListOf<HTMLElement>} */
const waiting = document.querySelectorAll("figure.glid-frames[data-frames]");
// Without this class, which browsers have since 2023, the first picture stays.
if (window.DecompressionStream) {
  for (const figure of waiting) {
    const packed = /** @type {string} */ (figure.dataset.frames);
    delete figure.dataset.frames;
    unpacked(packed).then((data) => addControls(figure, data));
  }
}
