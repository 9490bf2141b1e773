// Names of the editor's controls for screen readers. ipywidgets gives icons and sliders none: a
// button with an icon is read as a character of the icon font.

const CONTROLS = "button, select, input, img, [role=slider]";
const SAYS_SOMETHING = /[\p{L}\p{N}]/u; // icons are characters without a meaning

/**
 * Names all controls in an element, now and whenever some are added.
 *
 * @param {Element} root
 * @param {AbortSignal} signal ends it
 */
export function nameControls(root, signal) {
  const name = () => {
    for (const control of root.querySelectorAll(CONTROLS)) nameOne(control);
  };
  const observer = new MutationObserver(name);
  const what = { childList: true, subtree: true, attributes: true, attributeFilter: ["title"] };
  observer.observe(root, what);
  signal.addEventListener("abort", () => observer.disconnect());
  name();
}

/** @param {Element} control */
function nameOne(control) {
  for (const icon of control.querySelectorAll("i")) icon.ariaHidden = "true"; // not read before words
  const isImage = control instanceof HTMLImageElement;
  const attribute = isImage ? "alt" : "aria-label";
  const given = control.getAttribute(attribute);
  if (given !== null && control.getAttribute("data-glid-name") !== given) return; // its own
  if (isNamed(control)) return;
  const name = nameAround(control);
  if (!name || name === given) return;
  control.setAttribute(attribute, name);
  control.setAttribute("data-glid-name", name);
}

/** @param {Element} control */
function isNamed(control) {
  if (control instanceof HTMLButtonElement) return SAYS_SOMETHING.test(control.textContent ?? "");
  const labels = "labels" in control ? /** @type {HTMLInputElement} */ (control).labels : null;
  return [...(labels ?? [])].some((label) => SAYS_SOMETHING.test(label.textContent ?? ""));
}

/**
 * The tooltip of a control, or the label or the tooltip of its widget, or a label before the widget.
 *
 * @param {Element} control
 */
function nameAround(control) {
  const own = control.getAttribute("title");
  if (own) return own;
  if (control.matches(".glid-plots, .glid-plots *")) return "Plots of the solve";
  const widget = control.closest(".jupyter-widgets");
  const label = widget?.querySelector(".widget-label")?.textContent?.trim();
  return label || widget?.getAttribute("title") || labelBefore(widget ?? control);
}

/** @param {Element} one */
function labelBefore(one) {
  let before = one.previousElementSibling;
  while (before && !before.matches(".widget-label")) before = before.previousElementSibling;
  return before?.textContent?.trim() ?? "";
}
