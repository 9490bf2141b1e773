"""The editor in Notebook and under Voila, and keys that the notebook around it uses, too."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ..support.browser import LabNotebook, VoilaPage
from .conftest import OpenNotebook
from .editor_page import EDITOR, NEW_PICTURE, ROOMY_EDITOR, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

INTERFACES = {
    "notebook": functools.partial(LabNotebook, interface="notebook"),
    "voila": VoilaPage,
}


@pytest.mark.parametrize("name", INTERFACES)
def test_a_handle_is_dragged(open_notebook: OpenNotebook, name: str) -> None:
    book = open_notebook([SETUP, EDITOR], INTERFACES[name])
    hand = Hand(book)
    hand.click((-6.0, 0.0))
    book.wait_for("len(model.pose) == 1")
    # Pulling the shape pins the point and moves it.
    hand.drag(line((6.0, 0.0), (6.5, 2.0), 15))
    book.wait_for("len(model.pose) == 2")
    hand.wait_for_target(1, (6.5, 2.0))
    np.testing.assert_allclose(hand.handles, [(-6.0, 0.0), (6.0, 0.0)], atol=0.1)
    assert hand.certified()
    gap = book.value("float(abs(model.map(model.pose.handles) - model.pose.targets).max())")
    assert gap < 0.01
    # The page shows the map: 10 pixels of the picture are one unit, green and blue count them.
    points = [[-3.0, 1.0], [2.5, -0.5], [5.5, 1.0]]
    for (x, _), image in zip(points, book.value(f"model.map({points}).tolist()"), strict=True):
        wanted = np.array([100 + 10 * x, 155 - 10 * x])
        hand.wait_for_color(image, lambda seen, w=wanted: bool(abs(seen[1:3] - w).max() < 6))
    book.page.locator(".glid-foot").get_by_text("Converged").first.wait_for()
    book.screenshot(f"editor-{name}")


@pytest.mark.parametrize(("name", "least"), [("notebook", 0.8), ("voila", 0.9)])
def test_the_editor_uses_the_window(open_notebook: OpenNotebook, name: str, least: float) -> None:
    """Voila's page has no bars of its own, so the canvas gets their room."""
    book = open_notebook([SETUP, NEW_PICTURE, ROOMY_EDITOR], INTERFACES[name])
    Hand(book).wait_until_still()
    root = book.page.locator(".glid-editor")
    root.evaluate("one => one.scrollIntoView()")
    part = root.evaluate("one => one.getBoundingClientRect().height / innerHeight")
    assert least < part < 1


CELLS = """() => (window.jupyterapp.shell.currentWidget.content.model ??
  window.jupyterapp.shell.currentWidget.model).toJSON().cells.map((c) => [c.cell_type, c.source])"""


@pytest.mark.parametrize("name", [None, "notebook"])
def test_no_key_in_the_editor_is_the_notebooks(
    open_notebook: OpenNotebook, name: str | None
) -> None:
    """A, B and M act on the editor wherever it has the focus. They change no cell, and X cuts
    none."""
    book = open_notebook([SETUP, EDITOR], INTERFACES.get(name or ""))
    hand, page, cells = Hand(book), book.page, book.page.evaluate(CELLS)
    for x in (-6.0, 6.0):
        hand.click((x, 0.0))
    book.wait_for("len(model.pose) == 2")
    page.keyboard.press("Escape")
    book.wait_for("model.selection == ()")
    places = (
        page.locator(".glid-tools [data-tool=select]"),
        page.get_by_role("tab", name="Proof"),
        page.locator(".glid-solver-panel .widget-label").first,
        page.locator(".glid-solver-panel .noUi-handle").first,
        page.locator(".glid-foot").first,
        page.locator(".glid-pad").first,
    )
    for place in places:
        # Also if the focus was on another cell, as after Shift+Enter.
        page.evaluate("() => document.querySelector('.jp-Cell').focus()")
        place.click(position={"x": 5, "y": 5})
        for key in "xmd":
            page.keyboard.press(key)
            page.keyboard.press(key)
        page.keyboard.press("b")
        book.wait_for("canvas.brush.tool")
        page.keyboard.press("Escape")
        book.wait_for("not canvas.brush.tool")
        page.keyboard.press("a")
        book.wait_for("model.selection == (0, 1)")
        page.keyboard.press("Escape")
        book.wait_for("model.selection == ()")
    # The hint is also true after a click on the button.
    page.locator(".glid-tools [data-tool=stiff]").click()
    page.get_by_text("Esc when done").wait_for()
    page.keyboard.press("Escape")
    page.get_by_text("Esc when done").wait_for(state="hidden")
    # A list uses letters itself, and the tracer has its own keys.
    page.locator(".glid-timeline select").first.focus()
    page.keyboard.press("b")
    page.get_by_role("tab", name="Trace").click()
    page.get_by_role("button", name="Draw a rectangle (R)").click()
    for key in "xxmmdda":
        page.keyboard.press(key)
    page.keyboard.press("n")
    book.wait_for("editor.tracer.gestures.tool == 'background'")
    assert page.evaluate(CELLS) == cells
