// A context menu in an element. Its rows are [label, key to show, act]; null draws a line.

import { make } from "./dom.js";

export function openMenu(element, [x, y], rows) {
  const close = () => {
    window.removeEventListener("pointerdown", elsewhere, true);
    menu.remove();
    element.focus({ preventScroll: true });
  };
  const elsewhere = (e) => {
    if (menu.contains(e.target)) return;
    close();
    if (e.button === 0 && element.contains(e.target)) e.stopPropagation(); // it closes the menu, no more
  };
  let pressed = false; // the end of the long touch that opens the menu chooses nothing
  const step = (by) => {
    const items = [...menu.querySelectorAll("button")];
    items.at((items.indexOf(document.activeElement) + by) % items.length).focus();
  };
  const keys = { ArrowDown: () => step(1), ArrowUp: () => step(-1), Escape: close, Tab: close };
  const menu = make("div", { className: "glid-menu", role: "menu" }, ...rows.map((row) => row ? make(
    "button", { type: "button", role: "menuitem", onclick: (e) => (pressed || !e.detail) && [close(), row[2]()] }, row[0], make("kbd", {}, row[1]),
  ) : make("hr")));
  menu.addEventListener("pointerdown", () => { pressed = true; });
  for (const name of ["pointerdown", "pointermove", "wheel", "keydown", "keyup", "contextmenu"]) {
    menu.addEventListener(name, (e) => {
      e.stopPropagation(); // the pad takes none of these
      if (!keys[e.key] && name !== "contextmenu") return;
      e.preventDefault();
      if (name === "keydown") keys[e.key]();
    });
  }
  element.querySelector(".glid-menu")?.remove();
  element.append(menu);
  menu.style.left = `${Math.max(0, Math.min(x, element.clientWidth - menu.offsetWidth))}px`;
  menu.style.top = `${Math.max(0, Math.min(y, element.clientHeight - menu.offsetHeight))}px`;
  window.addEventListener("pointerdown", elsewhere, true);
  step(1);
}
