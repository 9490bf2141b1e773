"""axe-core finds no fault in the editor and in the pages that it exports, light and dark."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from glid_nb import HarmonicMap, Motion
from glid_nb.export import animate, live_page_html

from ..support import shapes
from ..support.axe import faults
from ..support.browser import watched_page
from .conftest import OpenNotebook
from .editor_page import ROOMY_EDITOR, SETUP, Hand

pytestmark = [pytest.mark.browser, pytest.mark.slow]

POSES = """
model.add_handles([(-6.0, 0.0), (6.0, 0.0)]); model.save_pose(); model.drag(1, (6.0, 2.0))
model.select([0])
"""
NARROW = {"width": 390, "height": 844}
WIDE = {"width": 1366, "height": 768}


def _no_faults(page: Page, what: str) -> None:
    editor = page.locator(".glid-editor")
    assert faults(page, editor) == [], what
    assert not re.findall("[\ue000-\uf8ff]", editor.aria_snapshot()), what  # of icon fonts


def test_nothing_is_wrong_with_the_editor(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=POSES)
    hand.settle()
    book.value("None", setup="model.tell('hand')")
    page.get_by_label("Depth").wait_for()
    try:
        for theme in ("JupyterLab Light", "JupyterLab Dark"):
            book.theme(theme)
            for section in ("Motion", "Files", "Proof", "Pin"):
                page.get_by_role("tab", name=section, exact=True).click()
                _no_faults(page, f"{section}, {theme}")
            _open_and_check_menus(page, hand, theme)
            page.get_by_role("tab", name="Trace", exact=True).click()
            page.locator(".glid-tracer").wait_for()
            _no_faults(page, f"Trace, {theme}")
            page.get_by_role("tab", name="Deform", exact=True).click()
            page.set_viewport_size(NARROW)
            page.locator(".glid-editor.glid-narrow").wait_for()
            _no_faults(page, f"a phone, {theme}")
            page.set_viewport_size(WIDE)
            page.locator(".glid-editor:not(.glid-narrow)").wait_for()
    finally:
        book.theme("JupyterLab Light")


def _open_and_check_menus(page: Page, hand: Hand, theme: str) -> None:
    page.locator(".glid-view-button").click()
    page.locator(".glid-view-menu").wait_for()
    _no_faults(page, f"the menu of what is shown, {theme}")
    page.keyboard.press("Escape")
    hand.click([-6.0, 0.0], button="right")
    page.locator(".glid-pad .glid-menu").wait_for()
    _no_faults(page, f"a pin's menu, {theme}")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Keys and gestures").first.click()
    page.locator(".glid-help:popover-open").wait_for()
    _no_faults(page, f"the table of keys, {theme}")
    page.keyboard.press("Escape")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_wrong_with_the_exported_pages(
    browser: Browser, tmp_path: Path, scheme: str
) -> None:
    motion = Motion([HarmonicMap.identity(shapes.domain()), shapes.bent()], repeat="loop")
    (walk,) = animate(tmp_path / "walk.html", shapes.picture(), motion)
    live = tmp_path / "live.html"
    live.write_text(live_page_html(shapes.picture(), motion, title="Ring"), encoding="utf-8")
    found = {}
    for path in (walk, live):
        with watched_page(browser, color_scheme=scheme, reduced_motion="reduce") as page:
            page.goto(path.as_uri())
            page.wait_for_selector("html[data-ready=true]", state="attached")
            found[path.name] = faults(page)
    assert found == {"walk.html": [], "live.html": []}
