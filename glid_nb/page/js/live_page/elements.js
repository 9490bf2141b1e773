// Elements of html/live_page.html.

/** @param {string} id */
export function byId(id) {
  return byKind(id, HTMLElement);
}

/**
 * @template {HTMLElement} T
 * @param {string} id
 * @param {new () => T} kind
 */
export function byKind(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${id}`);
  return found;
}
