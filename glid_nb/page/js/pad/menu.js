// A context menu of an element, above everything on the page.

import { make } from "./dom.js";
import { shield } from "./help.js";

const EDGE = 8; // CSS pixels between the menu and the edges of the window

/** @import { Point } from "../types.js" */
/** @typedef {[label: string, key: string, act: () => void] | null} MenuRow null draws a line */

/**
 * @param {HTMLElement} element
 * @param {Point} place
 * @param {MenuRow[]} rows
 */
export function openMenu(element, [x, y], rows) {
  const ending = new AbortController();
  let pressed = false; // the end of the long touch that opens the menu chooses nothing

  const close = () => {
    ending.abort();
    menu.remove();
    element.focus({ preventScroll: true });
  };
  const step = (/** @type {number} */ by) => {
    const items = [...menu.querySelectorAll("button")];
    const focused = /** @type {HTMLButtonElement} */ (document.activeElement);
    const present = items.indexOf(focused);
    items.at((present + by) % items.length)?.focus();
  };
  /** @type {Record<string, () => void>} */
  const keys = { ArrowDown: () => step(1), ArrowUp: () => step(-1), Escape: close, Tab: close };
  const item = (/** @type {MenuRow} */ row) => {
    if (!row) return make("hr");
    const [label, key, act] = row;
    const onclick = (/** @type {MouseEvent} */ e) => {
      if (!pressed && e.detail) return; // the pointer was pressed elsewhere
      close();
      act();
    };
    return make("button", { role: "menuitem", onclick }, label, make("kbd", {}, key));
  };
  const menu = shield(
    make(
      "div",
      {
        className: "glid-menu",
        role: "menu",
        popover: "manual", // nothing of the editor cuts it off or covers it
        onpointerdown: () => {
          pressed = true;
        },
        // The item under the pointer is the one that Enter chooses, and the only one marked.
        onpointerover: (/** @type {PointerEvent} */ e) => {
          /** @type {Element} */ (e.target).closest("button")?.focus();
        },
        oncontextmenu: (/** @type {Event} */ e) => e.preventDefault(),
        onkeydown: (/** @type {KeyboardEvent} */ e) => {
          if (!keys[e.key]) return;
          e.preventDefault();
          keys[e.key]();
        },
      },
      ...rows.map(item),
    ),
  );
  element.querySelector(".glid-menu")?.remove();
  element.append(menu);
  menu.showPopover();
  putAt(menu, onPage(element, [x, y]));
  const pressedElsewhere = (/** @type {PointerEvent} */ e) => {
    const target = /** @type {Node} */ (e.target);
    if (menu.contains(target)) return;
    close();
    if (e.button === 0 && element.contains(target)) e.stopPropagation(); // it does no more
  };
  window.addEventListener("pointerdown", pressedElsewhere, {
    capture: true,
    signal: ending.signal,
  });
  step(1);
}

/**
 * Where a place in an element is in the window, also if the page is zoomed or transformed.
 *
 * @param {HTMLElement} element
 * @param {Point} place
 * @returns {Point}
 */
function onPage(element, [x, y]) {
  const { left, top, width, height } = element.getBoundingClientRect();
  return [left + (x * width) / element.offsetWidth, top + (y * height) / element.offsetHeight];
}

/**
 * Puts a menu at a place of the window, or as near as all of it is seen.
 *
 * @param {HTMLElement} menu
 * @param {Point} place
 */
function putAt(menu, [x, y]) {
  const { width, height } = menu.getBoundingClientRect();
  const zoom = width / menu.offsetWidth || 1; // the page's lengths are not the menu's
  menu.style.left = `${within(x, window.innerWidth - width) / zoom}px`;
  menu.style.top = `${within(y, window.innerHeight - height) / zoom}px`;
}

/**
 * @param {number} at CSS pixels
 * @param {number} room
 */
function within(at, room) {
  return Math.max(EDGE, Math.min(at, room - EDGE));
}
