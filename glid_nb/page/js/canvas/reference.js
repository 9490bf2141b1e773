// A picture behind the shape, to draw poses after. It is dimmed, and no export has it.
//
// It lies in the pane in CSS, below the renderer, and moves with the view. The renderer would draw a
// chosen background over it, so meanwhile that is the pane's background in CSS.

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

/** @typedef {{ url: string, size: Point }} Picture */

export class Reference {
  /** @type {Picture | null} */
  #picture = null;
  /** @type {Picture | null} the background below it */
  #behind = null;
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
    this.#drop();
  }

  #drop() {
    for (const picture of [this.#picture, this.#behind]) {
      if (picture) URL.revokeObjectURL(picture.url);
    }
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
    const { model } = this;
    const pictures = [model.get("reference"), model.get("behind_reference")].map(opened);
    const [picture, behind] = await Promise.all(pictures);
    if (turn !== this.#turn) return; // there is a newer one
    this.#drop();
    this.#picture = picture && { ...picture, url: URL.createObjectURL(picture.blob) };
    this.#behind = behind && { ...behind, url: URL.createObjectURL(behind.blob) };
    this.place();
  }

  /** Moves it to where it is in the view. */
  place() {
    /** @type {HTMLElement | null} */
    const pane = this.box.closest(".glid-pane");
    if (!pane) return;
    pane.classList.toggle("glid-referenced", this.#picture !== null);
    const frame = /** @type {Point} */ (this.model.get("picture_size"));
    // The background fills the frame, whatever its size: a colour is one pixel.
    this.#put(pane, "--glid-reference", this.#picture);
    this.#put(pane, "--glid-behind", this.#behind && { ...this.#behind, size: frame });
  }

  /**
   * Sets the style's variables of a picture: itself, its place and its size.
   *
   * @param {HTMLElement} pane
   * @param {string} name
   * @param {Picture | null} picture
   */
  #put({ style }, name, picture) {
    if (!picture) {
      style.removeProperty(name);
      return;
    }
    const at = placeOf(picture.size, this.model.get("picture_size"), this.view);
    style.setProperty(name, `url("${picture.url}")`);
    style.setProperty(`${name}-place`, `${at.left}px ${at.top}px`);
    style.setProperty(`${name}-size`, `${at.width}px ${at.height}px`);
  }
}

/**
 * A picture from the kernel, and its size; null for none.
 *
 * @param {DataView<ArrayBuffer>} bytes
 */
async function opened(bytes) {
  if (!bytes.byteLength) return null;
  const blob = new Blob([bytes]);
  const bitmap = await createImageBitmap(blob);
  /** @type {Point} */
  const size = [bitmap.width, bitmap.height];
  bitmap.close();
  return { blob, size };
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
