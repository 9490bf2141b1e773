// A "?" and the table of keys and gestures that it shows.

import { make } from "./dom.js";

export function help(rows) {
  const table = make("table", { className: "glid-help", hidden: true },
    ...rows.map(([keys, what]) => make("tr", {}, make("th", {}, keys), make("td", {}, what))));
  const toggle = () => (table.hidden = !table.hidden);
  const title = "Keys and gestures (?)";
  const button = make("button", { type: "button", className: "glid-help-button", title, "aria-label": title }, "?");
  for (const part of [table, button]) {
    part.addEventListener("click", toggle);
    // The pad takes none of these.
    for (const name of ["pointerdown", "pointermove", "wheel", "keydown"]) {
      part.addEventListener(name, (e) => e.stopPropagation());
    }
  }
  return { table, button, toggle };
}
