// A "?" and the table of keys and gestures that it shows over the page.

import { make } from "./dom.js";

/** @typedef {[keys: string, whatTheyDo: string]} Row */
/** @typedef {[title: string, rows: Row[]]} Section */

const OF_THE_PAD = ["pointerdown", "pointermove", "wheel", "keydown", "keyup", "contextmenu"];

/**
 * Keeps an element's events from the pad below it.
 *
 * @template {HTMLElement} T
 * @param {T} element
 */
export function shield(element) {
  for (const name of OF_THE_PAD) element.addEventListener(name, (e) => e.stopPropagation());
  return element;
}

/** @param {Section[]} sections */
export function help(sections) {
  const head = make(
    "div",
    { className: "glid-help-head" },
    make("h2", {}, "Keys and gestures"),
    make("button", { title: "Close", ariaLabel: "Close" }, "×"), // as a click anywhere here
  );
  // Columns of a box with a limited height would go on sideways.
  const columns = make("div", {}, ...sections.map(section));
  const look = { className: "glid-help", popover: "auto", tabIndex: -1 };
  const table = shield(make("div", look, head, columns));
  table.addEventListener("click", () => table.hidePopover());
  // Not before: a framed page may not ask for the focus when it opens.
  table.addEventListener("beforetoggle", () => Object.assign(table, { autofocus: true }));
  const title = "Keys and gestures (?)";
  const around = { className: "glid-help-button", title, "aria-label": title };
  const button = shield(make("button", { ...around, popoverTargetElement: table }, "?"));
  return { table, button, toggle: () => void table.togglePopover() };
}

/** @param {Section} section */
function section([title, rows]) {
  return make("section", {}, make("h3", {}, title), make("table", {}, ...rows.map(row)));
}

/** @param {Row} row */
function row([keys, what]) {
  return make("tr", {}, make("th", {}, keys), make("td", {}, what));
}
