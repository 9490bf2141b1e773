// The menu of what the canvas shows.

import { make, save } from "../pad/dom.js";
import { icon } from "../pad/icons.js";

/** @import { Model } from "../types.js" */
/** @import { ToolbarTraits } from "./traits.js" */

const BELOW = 4; // CSS pixels between the button and the menu

export class ViewMenu {
  /**
   * @param {Model<ToolbarTraits>} model
   * @param {(action: string) => void} press has the canvas do something
   */
  constructor(model, press) {
    this.model = model;
    this.overlays = model.get("overlays").map(([name, label]) => {
      const item = row("menuitemradio", label, () => save(model, { overlay: name }));
      item.dataset.value = name;
      return item;
    });
    this.checks = model.get("checks").map(([name, label, title]) => {
      const item = row("menuitemcheckbox", label, () => {
        const shows = model.get("shows");
        save(model, { shows: { ...shows, [name]: !shows[name] } });
      });
      item.dataset.value = name;
      item.title = title;
      return item;
    });
    const closing = (/** @type {string} */ label, /** @type {string} */ action) =>
      row("menuitem", label, () => {
        this.menu.hidePopover();
        press(action);
      });
    const picture = closing("The picture alone", "p");
    this.reference = closing("", "reference");
    this.reference.title = "A picture behind the shape, to draw poses after; no export has it";
    picture.append(make("kbd", {}, "P"));
    this.menu = make(
      "div",
      {
        className: "glid-menu glid-view-menu",
        role: "menu",
        "aria-label": "What the canvas shows",
        popover: "auto",
      },
      group("Show", this.overlays),
      group("Overlays", this.checks),
      ...[make("hr"), this.reference, picture],
    );
    this.label = make("span", { className: "glid-view-label" });
    this.button = make("button", {
      className: "glid-view-button",
      title: "What the shape shows",
      "aria-haspopup": "menu",
      popoverTargetElement: this.menu,
      innerHTML: icon("eye"),
    });
    this.button.append(this.label, make("span", { className: "glid-chevron" }));
    this.menu.addEventListener("beforetoggle", () => this.#place());
    this.menu.addEventListener("toggle", (e) => this.#opened(/** @type {ToggleEvent} */ (e)));
    this.menu.addEventListener("keydown", (e) => this.#step(e));
  }

  show() {
    const overlay = this.model.get("overlay");
    const shows = this.model.get("shows");
    for (const item of this.overlays) {
      const chosen = item.dataset.value === overlay;
      item.ariaChecked = String(chosen);
      if (chosen) this.label.textContent = item.textContent;
    }
    const { firstElementChild: label } = this.reference;
    const has = this.model.get("referenced");
    if (label) label.textContent = has ? "Remove the reference" : "Reference picture…";
    for (const item of this.checks) item.ariaChecked = String(shows[item.dataset.value ?? ""]);
  }

  #place() {
    const { left, bottom } = this.button.getBoundingClientRect();
    const lowest = window.innerHeight - this.menu.offsetHeight - BELOW; // all of it is to be seen
    const rightmost = window.innerWidth - this.menu.offsetWidth - BELOW;
    this.menu.style.left = `${Math.max(BELOW, Math.min(left, rightmost))}px`;
    this.menu.style.top = `${Math.max(BELOW, Math.min(bottom + BELOW, lowest))}px`;
  }

  /** @param {ToggleEvent} e */
  #opened({ newState }) {
    this.button.ariaExpanded = String(newState === "open");
    if (newState !== "open") return;
    this.#place(); // only now its height is known
    this.overlays.find((item) => item.ariaChecked === "true")?.focus({ preventScroll: true });
  }

  /** @param {KeyboardEvent} e */
  #step(e) {
    const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    if (!by) return;
    e.preventDefault();
    e.stopPropagation();
    const items = [...this.menu.querySelectorAll("button")];
    const focused = items.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
    items.at((focused + by) % items.length)?.focus();
  }
}

let groups = 0; // of all menus in the page

/**
 * Items below a head, which names them for screen readers too.
 *
 * @param {string} name
 * @param {HTMLElement[]} items
 */
function group(name, items) {
  groups += 1;
  const id = `glid-view-group-${groups}`;
  const head = make("div", { id, className: "glid-menu-head", role: "presentation" }, name);
  return make("div", { role: "group", "aria-labelledby": id }, head, ...items);
}

/**
 * @param {string} role
 * @param {string} label
 * @param {() => void} onclick
 */
function row(role, label, onclick) {
  return make("button", { role, onclick }, make("span", {}, label));
}
