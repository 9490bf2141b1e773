// The cage tracer's page: a toolbar, the stage with picture and cage, the panel, a status line.

import { make } from "../pad/dom.js";
import { help } from "../pad/help.js";
import { drawnButton, iconButton } from "../pad/icons.js";
import { keysAround } from "../pad/keys.js";
import { Link } from "../pad/link.js";
import { Panel } from "./panel.js";
import { Stage } from "./stage.js";
import { HELP, TOOL_NAMES, TOOLS } from "./tools.js";
import { statusOf } from "./words.js";

/** @import { Context } from "../types.js" */
/** @import { Shown, Tool, TracerTraits } from "./traits.js" */

const PART = 1 << 20; // bytes of a file per message

export class Tracer {
  root = make("div", { className: "glid-skin glid-tracer" });
  status = make("div", { className: "glid-status", role: "status", "aria-live": "polite" });

  /** @param {Context<TracerTraits>} context */
  constructor({ model, el, signal }) {
    this.model = model;
    this.link = new Link(model, this.root, signal, () => {
      this.showStatus();
      if (this.link.idle && this.shown) this.#showTool(this.shown.tool);
    });
    this.stage = new Stage(this.root, this.link, (file) => this.upload(file), signal);
    this.panel = new Panel((type, content) => void this.act(type, content), this.stage);
    this.tools = TOOL_NAMES.map((name) => {
      const button = drawnButton(TOOLS[name].icon, TOOLS[name].label, undefined);
      button.dataset.tool = name;
      return button;
    });
    for (const name of TOOL_NAMES) {
      this.stage.actions[TOOLS[name].key] = () => this.#chooseTool(name);
    }
    this.undo = iconButton("undo", "Undo (Ctrl+Z)", () => this.act("undo"));
    this.redo = iconButton("redo", "Redo (Ctrl+Shift+Z)", () => this.act("redo"));
    this.discard = make(
      "button",
      {
        title: "Go back to the outline as traced",
        onclick: () => this.act("discard_edits"),
      },
      "Discard edits",
    );
    this.question = this.#askAbout();
    this.keepAll = this.#answer("Keep all as parts", () => this.act("keep_pieces"));
    this.pieces = this.#askWhichPiece();
    this.stage.element.append(this.question, this.pieces);
    const keys = help(HELP);
    this.stage.element.append(keys.table);
    this.stage.actions["?"] = keys.toggle;
    this.root.append(
      this.#toolbar(keys.button),
      make("div", { className: "glid-body" }, this.stage.element, this.panel.element),
      this.status,
    );
    keysAround(this.stage.element, (e) => this.stage.pad.keydown(e), signal, this.root);
    this.root.addEventListener("click", (e) => this.#clicked(e));
    el.classList.add("glid-host");
    el.append(this.root);
  }

  close() {
    this.stage.close();
  }

  /** The state; null while the first one is still on its way. */
  get shown() {
    const shown = this.model.get("shown");
    return shown.loops ? /** @type {Shown} */ (shown) : null;
  }

  /**
   * Asks the kernel for something, in order.
   *
   * @param {string} type
   * @param {Record<string, unknown>} content
   * @param {ArrayBuffer[]} buffers
   */
  act(type, content = {}, buffers = []) {
    return this.link.put({ type, ...content }, buffers);
  }

  /** @param {File} file */
  async upload(file) {
    const name = file.name || "the picture";
    let start = 0;
    let refused = null;
    do {
      const data = await file.slice(start, start + PART).arrayBuffer();
      const part = { name, size: file.size, start, buffered: true };
      refused = await this.act("upload", part, [data]);
      start += PART;
    } while (!refused && start < file.size);
  }

  showState() {
    const { shown, stage } = this;
    if (!shown) return;
    stage.update(shown);
    this.panel.update(shown);
    this.undo.disabled = !shown.can_undo;
    this.redo.disabled = !shown.can_redo;
    this.discard.hidden = !shown.edited;
    this.question.hidden = !shown.inside.length;
    this.pieces.hidden = (shown.cut?.shares.length ?? 1) < 2;
    this.keepAll.hidden = !shown.keeps;
    for (const button of this.tools) button.disabled = !shown.size;
    if (this.link.idle) this.#showTool(shown.tool);
    this.showStatus();
  }

  showStatus() {
    const { shown } = this;
    if (!shown) return;
    const { kind, text } = statusOf(shown, this.link.refusal, this.link.busy);
    this.root.dataset.status = kind;
    this.status.textContent = text;
  }

  async showPicture() {
    try {
      await this.stage.setPicture(this.model.get("picture"));
    } catch (error) {
      const why = error instanceof Error ? error.message : error;
      this.link.refusal = `The picture cannot be shown: ${why}`;
      this.showStatus();
    }
  }

  showHeight() {
    const height = this.model.get("height"); // without one it is as high as there is room
    this.root.style.setProperty("--glid-height", height ? `${height}px` : "");
  }

  // Asks what an outline inside the shape should be.
  #askAbout() {
    const answer = (/** @type {string} */ label, /** @type {string} */ what) =>
      this.#answer(label, () => this.act("drawn_as", { what }));
    return question(
      "What you drew",
      "What you drew lies inside the shape. It is ",
      answer("a hole", "hole"),
      answer("the new outline", "outline"),
      answer("nothing", ""),
    );
  }

  // Asks which piece to keep of a shape that was cut apart.
  #askWhichPiece() {
    const keepNext = () => {
      const { shares, kept } = this.shown?.cut ?? { shares: [], kept: 0 };
      return this.act("keep_piece", { number: (kept + 1) % shares.length });
    };
    return question(
      "Pieces of the cut",
      "Only the outlined piece is kept. ",
      this.#answer("Keep another", keepNext),
      this.keepAll,
      this.#answer("Undo the cut", () => this.act("undo")),
    );
  }

  /**
   * @param {string} label
   * @param {() => unknown} act
   */
  #answer(label, act) {
    const onclick = () => {
      act();
      this.stage.canvas.focus({ preventScroll: true });
    };
    return make("button", { onclick }, label);
  }

  /** @param {HTMLButtonElement} help */
  #toolbar(help) {
    const input = make("input", { type: "file", accept: "image/*", hidden: true });
    input.addEventListener("change", () => {
      if (input.files?.[0]) this.upload(input.files[0]);
    });
    const open = iconButton("open", "Open a picture", () => {
      input.value = "";
      input.click();
    });
    const { stage } = this;
    return make(
      "div",
      { className: "glid-toolbar", role: "toolbar", "aria-label": "Tracer" },
      ...[open, input, gap(), ...this.tools, gap(), this.undo, this.redo, this.discard],
      make("span", { className: "glid-grow" }),
      iconButton("minus", "Zoom out (-)", () => stage.zoom(false)),
      iconButton("plus", "Zoom in (+)", () => stage.zoom(true)),
      iconButton("fit", "Fit the picture (F)", () => stage.fit()),
      help,
    );
  }

  /** @param {MouseEvent} e */
  #clicked(e) {
    /** @type {HTMLElement | null} */
    const button = /** @type {Element} */ (e.target).closest("[data-tool]");
    const name = /** @type {Tool | undefined} */ (button?.dataset.tool);
    if (name) this.#chooseTool(name);
  }

  /**
   * A tool is shown at once, so that a drag right after its key does not move the view; the kernel
   * changes it after what was done with the last one.
   *
   * @param {Tool} name
   */
  #chooseTool(name) {
    if (!this.shown?.size) return;
    this.#showTool(name);
    this.act("tool", { name });
  }

  /** @param {Tool} name */
  #showTool(name) {
    if (name !== this.stage.tool) this.stage.setTool(name);
    for (const button of this.root.querySelectorAll("[data-tool]")) {
      const { tool } = /** @type {HTMLElement} */ (button).dataset;
      button.ariaPressed = String(tool === name);
    }
  }
}

function gap() {
  return make("span", { className: "glid-gap" });
}

/**
 * A question over the stage, with its answers.
 *
 * @param {string} name for screen readers
 * @param {string} text
 * @param {HTMLElement[]} answers
 */
function question(name, text, ...answers) {
  const look = { className: "glid-question", role: "group", "aria-label": name, hidden: true };
  return make("div", look, text, ...answers);
}
