// Elements of the page and traits of a model.

/** @import { Model } from "../types.js" */

/**
 * An element with properties, attributes and listeners ("onclick"), and its children.
 *
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, any>} properties
 * @param {...(Node | string)} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  if (element instanceof HTMLButtonElement) element.type = "button"; // it submits nothing
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") Reflect.set(element, name, value);
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

/**
 * Shows these children. A child that would look the same stays in the page: a press on it goes on,
 * and it keeps the focus. Its listeners stay too, so equal children must do the same.
 *
 * @param {Element} parent
 * @param {Element[]} children
 */
export function showChildren(parent, children) {
  for (const [i, child] of children.entries()) {
    const shown = parent.children[i];
    if (!shown) parent.append(child);
    else if (!shown.isEqualNode(child)) shown.replaceWith(child);
  }
  for (const child of [...parent.children].slice(children.length)) child.remove();
}

/**
 * The pen of a 2D canvas.
 *
 * @param {HTMLCanvasElement} canvas
 */
export function penOf(canvas) {
  const pen = canvas.getContext("2d");
  if (!pen) throw new Error("this browser does not draw on canvases");
  return pen;
}

/**
 * Changes a model here and in the kernel.
 *
 * @param {Model<any>} model
 * @param {Record<string, unknown>} changes
 */
export function save(model, changes) {
  for (const [name, value] of Object.entries(changes)) model.set(name, value);
  model.save_changes();
}

/**
 * The numbers in a binary trait; none before its first value came.
 *
 * @param {DataView | null} [view]
 */
export function toFloats(view) {
  if (!view) return new Float32Array();
  return new Float32Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
}

/**
 * Calls listeners now, and whenever the model tells one of their events ("change:a change:b").
 * anywidget takes them off when the view is removed.
 *
 * @param {Model<any>} model
 * @param {Record<string, (...values: any[]) => void>} listeners
 */
export function follow(model, listeners) {
  for (const [names, listener] of Object.entries(listeners)) {
    model.on(names, listener);
    listener();
  }
}
