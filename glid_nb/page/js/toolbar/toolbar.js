// The bar above the canvas: tools, history, what is shown, the view.

import { make } from "../pad/dom.js";
import { drawnButton, iconButton } from "../pad/icons.js";
import { ViewMenu } from "./view_menu.js";

/** @import { Icon } from "../pad/icons.js" */
/** @import { Model } from "../types.js" */
/** @import { Tool, ToolbarTraits } from "./traits.js" */

/** @type {[tool: Tool, icon: Icon, title: string][]} */
const TOOLS = [
  ["", "edit", "Select and drag pins (Esc)"],
  ["stiff", "brush", "Paint what should stay stiff (B)"],
  ["erase", "eraser", "Erase stiff areas (E)"],
];

// Not among the icons, which pages without an inspector have too.
const INSPECTOR = "M2 3h12v10H2z M10 3v10";

export class Toolbar {
  /** @param {Model<ToolbarTraits>} model */
  constructor(model) {
    this.model = model;
    this.view = new ViewMenu(model, (name) => this.#press(name));
    this.tools = TOOLS.map(([tool, icon, title]) => {
      const button = iconButton(icon, title, () => this.#press(`tool:${tool}`));
      button.dataset.tool = tool || "select";
      return button;
    });
    this.undo = iconButton("undo", "Undo (Ctrl+Z)", () => model.send({ type: "undo" }));
    this.redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => model.send({ type: "redo" }));
    this.element = make(
      "div",
      { className: "glid-skin glid-toolbar glid-tools", role: "toolbar", "aria-label": "Deform" },
      ...[...this.tools, gap(), this.undo, this.redo, gap(), this.view.button, this.view.menu],
      make("span", { className: "glid-grow" }),
      iconButton("minus", "Zoom out (wheel)", () => this.#press("zoom:out")),
      iconButton("plus", "Zoom in (wheel)", () => this.#press("zoom:in")),
      iconButton("fit", "See everything (F)", () => this.#press("f")),
      drawnButton(INSPECTOR, "Hide the inspector, show it again (I)", () => this.#press("i")),
      iconButton("screen", "Full screen (W)", () => this.#press("w")),
      this.#help(),
    );
  }

  showTool(tool = this.model.get("tool")) {
    const name = tool || "select";
    for (const button of this.tools) button.ariaPressed = String(button.dataset.tool === name);
  }

  /**
   * Shows the tool that the canvas of this editor has; the kernel hears of it later.
   *
   * @param {Event} e
   */
  canvasTook(e) {
    const editor = this.element.closest(".glid-editor");
    if (editor?.contains(/** @type {Node} */ (e.target))) {
      this.showTool(/** @type {CustomEvent<Tool>} */ (e).detail);
    }
  }

  showHistory() {
    this.undo.disabled = !this.model.get("can_undo");
    this.redo.disabled = !this.model.get("can_redo");
  }

  /** @param {string} selector */
  #find(selector) {
    return this.element.closest(".glid-editor")?.querySelector(selector);
  }

  /**
   * Does what a key on the canvas does.
   *
   * @param {string} key
   */
  #press(key) {
    const event = new CustomEvent("glid:press", { detail: key });
    this.#find(".glid-pad:not([inert])")?.dispatchEvent(event);
  }

  // The table of keys belongs to the canvas, which may come later than this bar.
  #help() {
    const title = "Keys and gestures (?)";
    const look = { className: "glid-help-button", title, "aria-label": title };
    const button = make("button", look, "?");
    const aim = () => {
      button.popoverTargetElement = this.#find(".glid-pad:not([inert]) .glid-help") ?? null;
    };
    button.addEventListener("pointerenter", aim);
    button.addEventListener("focus", aim);
    return button;
  }
}

function gap() {
  return make("span", { className: "glid-gap" });
}
