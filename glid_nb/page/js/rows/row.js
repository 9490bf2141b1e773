// One row of a list: its switches, its picture, its name, its detail, its group. It is changed in
// place, so nothing flickers and the focus stays.

import { make } from "../pad/dom.js";
import { PATHS } from "../pad/icons.js";

/** @import { Row, Switch } from "./traits.js" */

// Outlines on a 16 x 16 grid. Not among the icons, which pages without an inspector have too.
const BODY = "M4 7.5h8V13H4z";
/** @type {Record<Switch, { on: string, off: string, set: string, unset: string }>} */
const SWITCHES = {
  hidden: { on: `${PATHS.eye} M2.5 13.5l11-11`, off: PATHS.eye, set: "Hide", unset: "Show" },
  locked: {
    on: `${BODY} M5.8 7.5V5.2a2.2 2.2 0 0 1 4.4 0v2.3`,
    off: `${BODY} M5.8 7.5V4.2a2.2 2.2 0 0 1 4.2-.9`,
    set: "Lock",
    unset: "Unlock",
  },
};
const COLOURS = 6; // of groups, in rows.css

/**
 * What a hand on a row does.
 *
 * @typedef {object} Hand
 * @property {(key: number, e: MouseEvent) => void} click
 * @property {(key: number, name: Switch, on: boolean) => void} set
 * @property {(key: number, name: string) => void} rename
 */

export class RowView {
  /** @type {Row | null} */
  shown = null;
  /** @type {HTMLInputElement | null} in which the name is typed */
  field = null;
  /** @type {Map<Switch, HTMLButtonElement>} */
  buttons = new Map();

  /** @param {Hand} hand */
  constructor(hand) {
    this.hand = hand;
    this.picture = make("img", { alt: "" });
    this.number = make("span", { className: "glid-entry-number" });
    this.name = make("span", { className: "glid-entry-name" });
    this.detail = make("span", { className: "glid-entry-detail", "aria-hidden": "true" });
    this.said = make("span", { className: "glid-entry-said" });
    this.group = make("span", { className: "glid-entry-group" });
    this.title = make("span", { className: "glid-entry-title", role: "rowheader" });
    this.title.append(this.picture, this.number, this.name);
    this.place = make("span", { role: "gridcell" }, this.detail, this.said);
    this.mates = make("span", { role: "gridcell" }, this.group);
    this.element = make("div", { className: "glid-entry", role: "row", tabIndex: -1 });
    this.element.append(this.title, this.place, this.mates);
    this.element.addEventListener("click", (e) => this.#click(e));
    this.element.addEventListener("dblclick", (e) => this.#doubleClick(e));
  }

  get key() {
    return this.shown?.key ?? -1;
  }

  /** @param {Row} row */
  show(row) {
    this.shown = row;
    const title = row.name ? `${row.number} ${row.name}`.trim() : row.unnamed;
    this.number.hidden = !row.name || !row.number;
    put(this.number, row.number);
    put(this.name, row.name || row.unnamed);
    put(this.detail, row.detail);
    put(this.said, row.said);
    this.place.hidden = !row.detail;
    this.mates.hidden = !row.group;
    put(this.group, row.group ? `${row.group}` : "");
    this.group.dataset.colour = `${row.group % COLOURS}`;
    this.group.title = row.group ? `Group ${row.group}` : "";
    this.group.ariaLabel = this.group.title;
    this.group.role = "img";
    this.picture.hidden = !row.picture;
    if (row.picture && this.picture.src !== row.picture) this.picture.src = row.picture;
    for (const [name, on] of /** @type {[Switch, boolean][]} */ (Object.entries(row.switches))) {
      this.#showSwitch(name, on, title);
    }
    this.element.classList.toggle("glid-entry-away", Boolean(row.switches.hidden));
  }

  /**
   * @param {boolean} chosen
   * @param {boolean} reached whether the Tab key comes to this row
   */
  mark(chosen, reached) {
    const selected = String(chosen);
    if (this.element.ariaSelected !== selected) this.element.ariaSelected = selected;
    this.element.tabIndex = reached ? 0 : -1;
  }

  /**
   * @param {Switch} name
   * @param {boolean} on
   * @param {string} of what
   */
  #showSwitch(name, on, of) {
    const { set, unset, ...paths } = SWITCHES[name];
    const button = this.buttons.get(name) ?? this.#addSwitch(name);
    const title = `${on ? unset : set} ${of}`;
    if (button.title !== title) Object.assign(button, { title, ariaLabel: title });
    if (button.dataset.on === String(on)) return;
    button.dataset.on = String(on);
    const path = on ? paths.on : paths.off;
    button.innerHTML = `<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${path}"/></svg>`;
  }

  /** @param {Switch} name */
  #addSwitch(name) {
    const onclick = (/** @type {MouseEvent} */ e) => {
      e.stopPropagation(); // the row would be selected
      this.hand.set(this.key, name, !this.shown?.switches[name]);
    };
    const button = make("button", { className: "glid-icon", tabIndex: -1, onclick });
    button.addEventListener("dblclick", (e) => e.stopPropagation());
    this.title.before(make("span", { role: "gridcell" }, button));
    this.buttons.set(name, button);
    return button;
  }

  /** @param {MouseEvent} e */
  #click(e) {
    if (e.target !== this.field) this.hand.click(this.key, e);
  }

  /** @param {MouseEvent} e */
  #doubleClick(e) {
    if (e.target !== this.field && !(e.shiftKey || e.ctrlKey || e.metaKey)) this.rename();
  }

  /** Opens a field for the name. */
  rename() {
    if (this.field || !this.shown) return;
    const { key, name } = this.shown;
    const field = make("input", { type: "text", value: name, "aria-label": "Name" });
    const end = (/** @type {boolean} */ keep) => {
      if (this.field !== field) return; // removing a field takes its focus
      const focused = field.matches(":focus");
      this.field = null;
      const typed = field.value.trim();
      field.remove();
      if (focused) this.element.focus({ preventScroll: true });
      if (keep && typed !== name) this.hand.rename(key, typed);
    };
    field.addEventListener("blur", () => end(true));
    field.addEventListener("keydown", (e) => {
      e.stopPropagation();
      if (e.key === "Enter" || e.key === "Escape") end(e.key === "Enter");
    });
    this.field = field;
    this.title.append(field);
    field.focus({ preventScroll: true });
    field.select();
  }
}

/**
 * @param {HTMLElement} element
 * @param {string} text
 */
function put(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
