// A context menu in an element. Its rows are [label, key to show, act]; null draws a line.

import { make } from "./dom.js";
import { shield } from "./help.js";

export function openMenu(element, [x, y], rows) {
  const ending = new AbortController();
  const close = () => {
    ending.abort();
    menu.remove();
    element.focus({ preventScroll: true });
  };
  let pressed = false; // the end of the long touch that opens the menu chooses nothing
  const step = (by) => {
    const items = [...menu.querySelectorAll("button")];
    items.at((items.indexOf(document.activeElement) + by) % items.length).focus();
  };
  const keys = { ArrowDown: () => step(1), ArrowUp: () => step(-1), Escape: close, Tab: close };
  const row = ([label, key, act]) => {
    const onclick = (e) => (pressed || !e.detail) && [close(), act()];
    return make("button", { role: "menuitem", onclick }, label, make("kbd", {}, key));
  };
  const menu = shield(
    make(
      "div",
      {
        className: "glid-menu",
        role: "menu",
        onpointerdown: () => (pressed = true),
        oncontextmenu: (e) => e.preventDefault(),
        onkeydown: (e) => keys[e.key] && [e.preventDefault(), keys[e.key]()],
      },
      ...rows.map((one) => (one ? row(one) : make("hr"))),
    ),
  );
  element.querySelector(".glid-menu")?.remove();
  element.append(menu);
  const within = (at, room) => `${Math.max(0, Math.min(at, room))}px`;
  menu.style.left = within(x, element.clientWidth - menu.offsetWidth);
  menu.style.top = within(y, element.clientHeight - menu.offsetHeight);
  window.addEventListener(
    "pointerdown",
    (e) => {
      if (menu.contains(e.target)) return;
      close();
      if (e.button === 0 && element.contains(e.target)) e.stopPropagation(); // it does no more
    },
    { capture: true, signal: ending.signal },
  );
  step(1);
}
