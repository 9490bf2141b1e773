// A "?" and the table of keys and gestures that it shows.

import { make } from "./dom.js";

// Keeps an element's events from the pad below it.
export function shield(element, names = ["pointerdown", "pointermove", "wheel", "keydown"]) {
  for (const name of names) element.addEventListener(name, (e) => e.stopPropagation());
  return element;
}

export function help(rows) {
  const table = make("table", { className: "glid-help", hidden: true },
    ...rows.map(([keys, what]) => make("tr", {}, make("th", {}, keys), make("td", {}, what))));
  let open = new AbortController();
  const toggle = () => {
    table.hidden = !table.hidden;
    open.abort();
    if (table.hidden) return;
    open = new AbortController();
    window.addEventListener("keydown", (e) => {
      if (!table.isConnected) return open.abort();
      if (e.key !== "Escape") return;
      e.stopPropagation();
      toggle();
    }, { capture: true, signal: open.signal });
  };
  const title = "Keys and gestures (?)";
  const button = make("button", { type: "button", className: "glid-help-button", title, "aria-label": title }, "?");
  for (const part of [table, button]) shield(part).addEventListener("click", toggle);
  return { table, button, toggle };
}
