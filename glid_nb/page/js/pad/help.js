// A "?" and the table of keys and gestures that it shows over the page.

import { make } from "./dom.js";

const OF_THE_PAD = ["pointerdown", "pointermove", "wheel", "keydown", "keyup", "contextmenu"];

// Keeps an element's events from the pad below it.
export function shield(element) {
  for (const name of OF_THE_PAD) element.addEventListener(name, (e) => e.stopPropagation());
  return element;
}

// The sections of the table are [title, rows], its rows [keys, what they do].
export function help(sections) {
  const row = ([keys, what]) => make("tr", {}, make("th", {}, keys), make("td", {}, what));
  const section = ([title, rows]) =>
    make("section", {}, make("h4", {}, title), make("table", {}, ...rows.map(row)));
  const shown = { className: "glid-help", popover: "auto", autofocus: true, tabIndex: -1 };
  const table = shield(make("div", shown, ...sections.map(section)));
  const title = "Keys and gestures (?)";
  const look = { className: "glid-help-button", title, "aria-label": title };
  const button = shield(make("button", { ...look, popoverTargetElement: table }, "?"));
  table.addEventListener("click", () => table.hidePopover());
  return { table, button, toggle: () => table.togglePopover() };
}
