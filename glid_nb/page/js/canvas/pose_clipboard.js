// Poses go from one canvas to another as text in the clipboard.

import { copied } from "../pad/clipboard.js";

/** @import { Canvas } from "./canvas.js" */

const COPIED = "The pose is in the clipboard; Ctrl+V on a canvas puts it there";
const NOT_COPIED = "The browser does not give access to the clipboard; use Ctrl+C and Ctrl+V";

export class PoseClipboard {
  /** @param {Canvas} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    const { model, box, pad } = canvas;
    model.on("msg:custom", async (/** @type {{ copy?: string }} */ { copy: text }) => {
      if (text && pad.focused) canvas.say((await copied(text)) ? COPIED : NOT_COPIED);
    });
    box.addEventListener("copy", (e) => {
      if (!pad.focused) return;
      e.preventDefault();
      pad.press("copy");
    });
    box.addEventListener("paste", (e) => {
      e.preventDefault();
      this.#put(e.clipboardData?.getData("text") ?? "");
    });
  }

  /** Asks the browser for the text. */
  async paste() {
    try {
      this.#put(await navigator.clipboard.readText());
    } catch {
      this.canvas.say(NOT_COPIED);
    }
  }

  /** @param {string} text */
  #put(text) {
    this.canvas.link.put({ type: "paste_pose", text });
  }
}
