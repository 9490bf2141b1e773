// Keys in the editor around a pad.

const TEXT = "textarea, [contenteditable], input:not([type=checkbox], [type=range], [type=radio])";

const LAST_LATIN = "\u024f"; // of Latin Extended-B

// What a keyboard with Latin letters types by its other keys, without and with Shift.
/** @type {Record<string, string>} */
const LATIN = {
  Comma: ",<",
  Period: ".>",
  Slash: "/?",
  Minus: "-_",
  Equal: "=+",
  BracketLeft: "[{",
  BracketRight: "]}",
};

/** @typedef {{ key: string, code?: string, shiftKey?: boolean }} Pressed */

/**
 * The name of a pressed key. Keyboards of other scripts type no Latin characters, so there the key's
 * place decides: "я" on the key of Z is "z".
 *
 * @param {Pressed} e
 */
export function keyOf({ key, code = "", shiftKey = false }) {
  if (key.length > 1 || key <= LAST_LATIN) return key;
  const [, letter, digit] = code.match(/^(?:Key([A-Z])|(?:Digit|Numpad)([0-9]))$/) ?? [];
  if (letter) return shiftKey ? letter : letter.toLowerCase();
  return digit ?? LATIN[code]?.[Number(shiftKey)] ?? key;
}

/**
 * What a key does to the history: "undo", "redo" or null.
 *
 * @param {Pressed & { ctrlKey: boolean, metaKey: boolean, shiftKey: boolean }} e
 */
export function undoOrRedo(e) {
  if (!e.ctrlKey && !e.metaKey) return null;
  const key = keyOf(e).toLowerCase();
  if (key === "z") return e.shiftKey ? "redo" : "undo";
  return key === "y" ? "redo" : null;
}

/**
 * Hands keys that are pressed in the editor around an element to it: undo, redo, single characters,
 * Escape and Delete go to act(e) while the element is seen, unless it has the focus itself, or a
 * field that takes them. Jupyter takes none: its X cuts the cell, its M makes it text.
 *
 * @param {HTMLElement} element
 * @param {(e: KeyboardEvent) => void} act
 * @param {AbortSignal} signal ends it
 * @param {HTMLElement} whole stands for the editor where there is none
 */
export function keysAround(element, act, signal, whole = element) {
  const editorAround = (/** @type {Event} */ e) => {
    const editor = /** @type {HTMLElement} */ (element.closest(".glid-editor") ?? whole);
    const inside = editor.contains(/** @type {Node} */ (e.target)) && element.checkVisibility();
    return inside ? editor : null;
  };

  // Keeps the focus in the editor: a click on any part can focus it. A click on a tab focuses it.
  // So does a button that has the focus and is disabled, such as Undo when nothing is left.
  const refocus = (/** @type {Event} */ e) => {
    const editor = editorAround(e);
    if (!editor) return;
    editor.tabIndex = -1;
    const target = /** @type {HTMLButtonElement} */ (e.target);
    const lost = e.type === "focusout" ? target.disabled : target.closest("[role=tab]");
    if (lost) editor.focus({ preventScroll: true });
  };

  const keydown = (/** @type {KeyboardEvent} */ e) => {
    const editor = editorAround(e);
    if (!editor) return;
    const target = /** @type {Element} */ (e.target);
    const command = e.ctrlKey || e.metaKey;
    const outside = !element.contains(target);
    const runsTheCell = outside && e.shiftKey && e.key === "Enter";
    const ours = undoOrRedo(e) !== null || !(command || runsTheCell);
    target.toggleAttribute("data-lm-suppress-shortcuts", ours);
    editor.onkeydown = ours ? (bubbled) => bubbled.stopPropagation() : null;
    if (outside && !target.matches(TEXT) && isForThePad(e, target)) act(e);
  };

  const options = { capture: true, signal };
  window.addEventListener("pointerdown", refocus, options);
  window.addEventListener("focusout", refocus, options);
  window.addEventListener("keydown", keydown, options);
}

/**
 * @param {KeyboardEvent} e
 * @param {Element} target
 */
function isForThePad(e, target) {
  if (undoOrRedo(e)) return !e.altKey;
  if (e.ctrlKey || e.metaKey || target.matches("select")) return false;
  if (keyOf(e) === "Escape" && target.closest(":popover-open")) return false; // it closes the menu
  const free = target.closest(".glid-timeline") ? /^[^ ]$/ : /^([^ ]|Escape|Delete)$/;
  return free.test(keyOf(e));
}
