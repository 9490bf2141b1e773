"""axe-core on a page: faults that a screen reader, a keyboard or weak eyes meet."""

from __future__ import annotations

from playwright.sync_api import Locator, Page

from .documented import REPOSITORY

_SOURCE = REPOSITORY / "node_modules" / "axe-core" / "axe.min.js"

# A page with a loader of modules, such as JupyterLab, would keep axe to itself.
_LOAD = """(source) => {
  const {define} = window;
  window.define = undefined;
  (0, eval)(source);
  window.define = define;
}"""
# Each fault in a line or two: the rule, the element, what to mend.
_RUN = """async (root) => {
  const {violations, passes} = await window.axe.run(root, {resultTypes: ['violations']});
  const faults = violations.flatMap(({id, nodes}) => nodes.map(({html, failureSummary}) =>
    `${id}: ${html.slice(0, 200)} ${failureSummary}`));
  return [faults, passes.map(({id}) => id)];
}"""


def faults(page: Page, root: Locator | None = None) -> list[str]:
    """What axe-core finds in an element, by default in the whole page."""
    if not page.evaluate("() => Boolean(window.axe)"):
        page.evaluate(_LOAD, _SOURCE.read_text(encoding="utf-8"))
    found, passed = (root or page.locator(":root")).evaluate(_RUN)
    assert {"button-name", "color-contrast"} <= set(passed), "axe-core has looked at nothing"
    return found
