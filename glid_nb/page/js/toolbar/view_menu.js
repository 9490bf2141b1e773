// The menu of what the canvas shows.

import { make, save } from "../pad/dom.js";
import { icon } from "../pad/icons.js";

/** @import { Model } from "../types.js" */
/** @import { ToolbarTraits } from "./traits.js" */

const BELOW = 4; // CSS pixels between the button and the menu

export class ViewMenu {
  /**
   * @param {Model<ToolbarTraits>} model
   * @param {() => void} alone shows the picture alone
   */
  constructor(model, alone) {
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
    const picture = row("menuitem", "The picture alone", () => {
      this.menu.hidePopover();
      alone();
    });
    picture.append(make("kbd", {}, "P"));
    this.menu = make(
      "div",
      {
        className: "glid-menu glid-view-menu",
        role: "menu",
        "aria-label": "What the canvas shows",
        popover: "auto",
      },
      ...[...this.overlays, make("hr"), ...this.checks, make("hr"), picture],
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
    for (const item of this.checks) item.ariaChecked = String(shows[item.dataset.value ?? ""]);
  }

  #place() {
    const { left, bottom } = this.button.getBoundingClientRect();
    this.menu.style.left = `${left}px`;
    this.menu.style.top = `${bottom + BELOW}px`;
  }

  /** @param {ToggleEvent} e */
  #opened({ newState }) {
    this.button.ariaExpanded = String(newState === "open");
    if (newState !== "open") return;
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

/**
 * @param {string} role
 * @param {string} label
 * @param {() => void} onclick
 */
function row(role, label, onclick) {
  return make("button", { role, onclick }, make("span", {}, label));
}
