// The icons of the buttons. Those of the tracer's tools are in tracer/tools.js.

import { make } from "./dom.js";

// Outlines on a 16 x 16 grid.
export const PATHS = {
  edit: "M3 2l9.5 5.2-4 1.2 2.4 4.3-1.8 1-2.4-4.3L3 12z",
  brush:
    "M13.5 2.5l-6 6 M6.7 9.2c-1.6-.5-3 .6-3.1 2.1-.1 1-.7 1.7-1.6 2 2.2.9 5.6.4 5.9-2.2 .1-.8-.4-1.6-1.2-1.9z",
  eraser: "M9.2 2.8l4 4-6.4 6.4H4.4L2.2 11z M5.5 6.6l4 4 M7 13.2h6.5",
  rectangle: "M2.5 4h11v8h-11z",
  undo: "M5.5 3L2.5 6l3 3 M3 6h6.2a3.6 3.6 0 0 1 0 7.2H6",
  redo: "M10.5 3l3 3-3 3 M13 6H6.8a3.6 3.6 0 0 0 0 7.2H10",
  fit: "M2 5.5V2h3.5 M10.5 2H14v3.5 M14 10.5V14h-3.5 M5.5 14H2v-3.5",
  screen: "M10 2h4v4 M14 2L9.5 6.5 M6 14H2v-4 M2 14l4.5-4.5",
  eye: "M1.5 8S4 3.8 8 3.8 14.5 8 14.5 8 12 12.2 8 12.2 1.5 8 1.5 8z M8 6.2a1.8 1.8 0 1 0 0 3.6 1.8 1.8 0 0 0 0-3.6z",
  plus: "M8 3v10 M3 8h10",
  minus: "M3 8h10",
  open: "M2 12.5v-9h4l1.5 2H14v7z",
  play: "M5 3l8 5-8 5z",
  pause: "M5.5 3v10 M10.5 3v10",
  record: "M8 4.2a3.8 3.8 0 1 0 0 7.6 3.8 3.8 0 0 0 0-7.6z",
  onion: "M6.2 4a4 4 0 1 0 0 8 4 4 0 0 0 0-8z M9.8 4a4 4 0 1 1 0 8",
  copy: "M5.5 5.5h8v8h-8z M3 10.5v-8h8",
  export: "M8 2v8 M4.8 6.8L8 10l3.2-3.2 M3 13.5h10",
  trash: "M3 4.5h10 M6.5 4.5v-2h3v2 M4.5 4.5l.6 9h5.8l.6-9",
};

/** @typedef {keyof typeof PATHS} Icon */

/** @param {Icon} name */
export function icon(name) {
  return drawn(PATHS[name]);
}

/** @param {string} path an outline on a 16 x 16 grid */
function drawn(path) {
  return `<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${path}"/></svg>`;
}

/**
 * @param {Icon} name
 * @param {string} title
 * @param {((e: MouseEvent) => void) | undefined} onclick
 */
export function iconButton(name, title, onclick, className = "glid-icon") {
  return drawnButton(PATHS[name], title, onclick, className);
}

/**
 * @param {string} path its icon, an outline on a 16 x 16 grid
 * @param {string} title
 * @param {((e: MouseEvent) => void) | undefined} onclick
 */
export function drawnButton(path, title, onclick, className = "glid-icon") {
  return make("button", { title, "aria-label": title, className, onclick, innerHTML: drawn(path) });
}
