// Puts text that the kernel sends into the clipboard, and saves files that it sends.

import { copied } from "../pad/clipboard.js";
import { make } from "../pad/dom.js";

/** @import { Context } from "../types.js" */
/** @typedef {{ number: number, text?: string, name?: string }} Message with a text, or a file */

const KEPT = 60_000; // ms for which the browser may still read a file

/** @type {Set<number>} the numbers of files, which another view of the same widget may hold */
const saved = new Set();

/**
 * @param {string} name
 * @param {DataView<ArrayBuffer>} data
 */
function download(name, data) {
  const href = URL.createObjectURL(new Blob([data]));
  make("a", { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), KEPT);
}

/** @param {Context} context */
function render({ model }) {
  model.on("msg:custom", async (/** @type {Message} */ { number, text, name }, [data]) => {
    if (text !== undefined) model.send({ number, copied: await copied(text) });
    else if (name && !saved.has(number)) download(name, data);
    saved.add(number);
  });
}

export default { render };
