// A list of things with names, such as pins and parts: a grid for screen readers and keys.
//
// A click selects; with Shift all between, with Ctrl one more. A double click or F2 renames.

import { make } from "../pad/dom.js";
import { between, rowAfter } from "./choice.js";
import { RowView } from "./row.js";

/** @import { Model } from "../types.js" */
/** @import { RowTraits } from "./traits.js" */

export class Rows {
  /** @type {RowView[]} */
  views = [];

  #from = -1; // the key at which a selection by Shift begins
  #at = -1; // the key of the row to which Tab comes

  /** @param {Model<RowTraits>} model */
  constructor(model) {
    this.model = model;
    this.grid = make("div", { className: "glid-entry-grid", role: "grid" });
    this.nothing = make("p", { className: "glid-entry-nothing" });
    this.element = make("div", { className: "glid-skin glid-rows" }, this.grid, this.nothing);
    this.grid.addEventListener("keydown", (e) => this.#keydown(e));
    this.grid.addEventListener("focusin", (e) => this.#focused(e));
  }

  get #keys() {
    return this.model.get("rows").map(({ key }) => key);
  }

  showLabels() {
    this.grid.ariaLabel = this.model.get("label");
    this.grid.ariaMultiSelectable = String(this.model.get("several"));
    this.nothing.textContent = this.model.get("nothing");
  }

  showRows() {
    const rows = this.model.get("rows");
    const held = this.grid.contains(document.activeElement);
    for (const view of this.views.splice(rows.length)) view.element.remove();
    for (const [i, row] of rows.entries()) {
      if (!this.views[i]) this.#add();
      this.views[i].show(row);
    }
    this.grid.hidden = !rows.length;
    this.nothing.hidden = Boolean(rows.length);
    this.showChosen();
    // A row that had the focus is gone.
    if (held && !this.grid.contains(document.activeElement)) this.#reached?.element.focus();
  }

  #add() {
    const view = new RowView({
      click: (key, e) => this.#click(key, e),
      set: (key, name, on) => this.model.send({ type: "set", key, name, on }),
      rename: (key, name) => this.model.send({ type: "rename", key, name }),
    });
    this.views.push(view);
    this.grid.append(view.element);
  }

  showChosen() {
    const chosen = this.model.get("chosen");
    const keys = this.#keys;
    const last = chosen.at(-1) ?? -1;
    if (!keys.includes(this.#from) || chosen.length < 2) this.#from = last;
    const held = this.grid.contains(document.activeElement) && keys.includes(this.#at);
    if (!held) this.#at = keys.includes(last) ? last : (keys[0] ?? -1);
    for (const view of this.views) view.mark(chosen.includes(view.key), view.key === this.#at);
    if (!held) this.#reveal(this.views.find(({ key }) => key === last));
  }

  get #reached() {
    return this.views.find(({ key }) => key === this.#at);
  }

  /**
   * Scrolls the list, and nothing around it.
   *
   * @param {RowView | undefined} view
   */
  #reveal(view) {
    if (!view) return;
    const { grid } = this;
    const { offsetTop: top, offsetHeight: height } = view.element;
    if (top < grid.scrollTop) grid.scrollTop = top;
    const below = top + height - grid.clientHeight;
    if (below > grid.scrollTop) grid.scrollTop = below;
  }

  /** @param {number[]} keys */
  #choose(keys) {
    this.model.send({ type: "choose", keys });
  }

  /**
   * @param {number} key
   * @param {MouseEvent} e
   */
  #click(key, e) {
    this.#reach(key);
    this.#chooseBy(key, e);
  }

  /**
   * @param {number} key
   * @param {MouseEvent | KeyboardEvent} e
   */
  #chooseBy(key, e) {
    const several = this.model.get("several");
    if (several && e.shiftKey) {
      this.#choose(between(this.#keys, this.#from, key));
      return;
    }
    this.#from = key;
    if (several && (e.ctrlKey || e.metaKey)) this.model.send({ type: "switch", key });
    else this.#choose([key]);
  }

  /**
   * Puts the focus on a row.
   *
   * @param {number} key
   */
  #reach(key) {
    this.#at = key;
    const view = this.#reached;
    view?.element.focus({ preventScroll: true });
    this.#reveal(view);
  }

  /** @param {Event} e */
  #focused(e) {
    const view = this.#viewOf(e.target);
    if (!view || view.key === this.#at) return;
    this.#at = view.key;
    for (const one of this.views) one.element.tabIndex = one === view ? 0 : -1;
  }

  /** @param {EventTarget | null} target */
  #viewOf(target) {
    return this.views.find(({ element }) => element.contains(/** @type {Node} */ (target)));
  }

  /** @param {KeyboardEvent} e */
  #keydown(e) {
    const view = this.#viewOf(e.target);
    if (!view || view.field || e.altKey) return;
    const does = this.#keyDoes(e, view);
    if (!does) return;
    e.preventDefault();
    e.stopPropagation();
    does();
  }

  /**
   * What a key does; null for those of others.
   *
   * @param {KeyboardEvent} e
   * @param {RowView} view
   * @returns {(() => void) | null}
   */
  #keyDoes(e, view) {
    const onRow = e.target === view.element;
    const command = e.ctrlKey || e.metaKey;
    const to = rowAfter(e.key, this.views.indexOf(view), this.views.length);
    if (to !== null) return () => this.#go(this.views[to].key, e);
    if (e.key === "ArrowLeft" || e.key === "ArrowRight") {
      return () => this.#sideways(view, e.key === "ArrowLeft" ? -1 : 1);
    }
    if (e.key === "F2") return () => view.rename();
    if (onRow && (e.key === " " || e.key === "Enter")) return () => this.#chooseBy(view.key, e);
    if (command && e.key === "a" && this.model.get("several")) {
      return () => this.#choose(this.#keys);
    }
    return null;
  }

  /**
   * @param {number} key
   * @param {KeyboardEvent} e with Ctrl only the focus moves
   */
  #go(key, e) {
    this.#reach(key);
    if (!e.ctrlKey && !e.metaKey) this.#chooseBy(key, e);
  }

  /**
   * Moves the focus along a row: the row itself, then its buttons.
   *
   * @param {RowView} view
   * @param {1 | -1} step
   */
  #sideways(view, step) {
    const stops = [view.element, ...view.buttons.values()];
    const at = stops.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
    stops[Math.min(Math.max(at + step, 0), stops.length - 1)].focus({ preventScroll: true });
  }
}
