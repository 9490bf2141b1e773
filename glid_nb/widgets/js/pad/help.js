// A "?" and the table of keys and gestures that it shows over the page.

import { make } from "./dom.js";

// Keeps an element's events from the pad below it.
export function shield(element, names = ["pointerdown", "pointermove", "wheel", "keydown"]) {
  for (const name of names) element.addEventListener(name, (e) => e.stopPropagation());
  return element;
}

// The sections of the table are [title, rows], its rows [keys, what they do].
export function help(sections) {
  const row = ([keys, what]) => make("tr", {}, make("th", {}, keys), make("td", {}, what));
  const section = ([title, rows]) => make("section", {}, make("h4", {}, title), make("table", {}, ...rows.map(row)));
  const table = make("div", { className: "glid-help", popover: "auto", autofocus: true, tabIndex: -1 }, ...sections.map(section));
  const title = "Keys and gestures (?)";
  const button = make("button", { type: "button", className: "glid-help-button", title, "aria-label": title }, "?");
  button.popoverTargetElement = table;
  for (const part of [table, button]) shield(part);
  table.addEventListener("click", () => table.hidePopover());
  return { table, button, toggle: () => table.togglePopover() };
}
