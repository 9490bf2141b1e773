// A context menu in an element.

import { make } from "./dom.js";
import { shield } from "./help.js";

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
        onpointerdown: () => {
          pressed = true;
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
  menu.style.left = within(x, element.clientWidth - menu.offsetWidth);
  menu.style.top = within(y, element.clientHeight - menu.offsetHeight);
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
 * @param {number} at CSS pixels
 * @param {number} room
 */
function within(at, room) {
  return `${Math.max(0, Math.min(at, room))}px`;
}
