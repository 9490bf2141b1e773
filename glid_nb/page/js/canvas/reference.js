// A picture behind the shape, to draw poses after. It is dimmed, and no export has it.
//
// It is the background of the pane in CSS, below the renderer, and moves with the view.

import { make, penOf, save } from "../pad/dom.js";

/** @import { Model, Point } from "../types.js" */
/** @import { View } from "../pad/view.js" */
/** @import { CanvasTraits } from "./traits.js" */

const LONGEST = 1600; // pixels; larger files are sent to the kernel smaller
const QUALITY = 0.85; // of WebP
const WORLD = 20; // world units of the longer side of the editor's picture

/**
 * Where the reference is on the screen: in the middle of the editor's picture, as large as it fits.
 *
 * @param {Point} size of the reference
 * @param {number[]} picture the size of the editor's picture
 * @param {View} view
 */
export function placeOf([width, height], picture, view) {
  const world = picture.map((side) => (WORLD * side) / Math.max(...picture));
  const scale = Math.min(world[0] / width, world[1] / height) / view.unit;
  const [x, y] = view.toScreen([0, 0]);
  const [wide, high] = [scale * width, scale * height];
  return { left: x - wide / 2, top: y - high / 2, width: wide, height: high };
}

export class Reference {
  #url = "";
  /** @type {Point | null} */
  #size = null;
  #turn = 0; // counts the pictures, to tell the newest

  /**
   * @param {HTMLElement} box the pad, inside the pane
   * @param {Model<CanvasTraits>} model
   * @param {View} view
   */
  constructor(box, model, view) {
    this.box = box;
    this.model = model;
    this.view = view;
  }

  close() {
    this.#turn += 1;
    URL.revokeObjectURL(this.#url);
  }

  /** Lets the user choose a file, or takes the reference away if there is one. */
  toggle() {
    if (this.model.get("reference").byteLength) {
      save(this.model, { reference: new DataView(new ArrayBuffer(0)) });
      return;
    }
    const input = make("input", { type: "file", accept: "image/*" });
    input.addEventListener("change", () => input.files?.[0] && this.#take(input.files[0]));
    input.click();
  }

  /** @param {File} file */
  async #take(file) {
    try {
      save(this.model, { reference: new DataView(await shrunk(file)), notice: "" });
    } catch {
      save(this.model, { notice: `${file.name} is not a picture that this browser can show` });
    }
  }

  /** Shows the kernel's reference. */
  async show() {
    this.#turn += 1;
    const turn = this.#turn;
    const bytes = this.model.get("reference");
    const blob = new Blob([bytes]);
    const bitmap = bytes.byteLength ? await createImageBitmap(blob) : null;
    if (turn !== this.#turn) return; // there is a newer one
    URL.revokeObjectURL(this.#url);
    this.#url = bitmap ? URL.createObjectURL(blob) : "";
    this.#size = bitmap && [bitmap.width, bitmap.height];
    bitmap?.close();
    this.place();
  }

  /** Moves it to where it is in the view. */
  place() {
    /** @type {HTMLElement | null} */
    const pane = this.box.closest(".glid-pane");
    if (!pane) return;
    pane.classList.toggle("glid-referenced", this.#size !== null);
    if (!this.#size) return;
    const at = placeOf(this.#size, this.model.get("picture_size"), this.view);
    pane.style.setProperty("--glid-reference", `url("${this.#url}")`);
    pane.style.setProperty("--glid-reference-place", `${at.left}px ${at.top}px`);
    pane.style.setProperty("--glid-reference-size", `${at.width}px ${at.height}px`);
  }
}

/**
 * The bytes of a picture, not larger than it can be seen.
 *
 * @param {File} file
 */
async function shrunk(file) {
  const bitmap = await createImageBitmap(file);
  const scale = Math.min(1, LONGEST / Math.max(bitmap.width, bitmap.height));
  const width = Math.max(1, Math.round(scale * bitmap.width));
  const height = Math.max(1, Math.round(scale * bitmap.height));
  const canvas = make("canvas", { width, height });
  penOf(canvas).drawImage(bitmap, 0, 0, width, height);
  bitmap.close();
  /** @type {Blob} */
  const blob = await new Promise((done, fail) => {
    canvas.toBlob((made) => (made ? done(made) : fail()), "image/webp", QUALITY);
  });
  return blob.arrayBuffer();
}
