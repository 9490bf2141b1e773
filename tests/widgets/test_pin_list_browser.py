"""The inspector's list of pins, by mouse, keys and fingers, in a real browser."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator

from ..support.axe import faults
from ..support.browser import WINDOW, bring_into_view
from .conftest import OpenNotebook
from .editor_page import EDITOR, NEW_PICTURE, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PINS = "model.add_handles([(x, 0) for x in range(-7, 8, 2)]); model.select([])"
PHONE = {"width": 390, "height": 844}
_FULL = "one => one.scrollHeight > one.clientHeight"
# Whether the list's height and the identity of its rows stay, frame by frame, until told to stop.
_WATCH = """(grid) => {
  const rows = [...grid.children];
  window.flickered = false;
  const watch = () => {
    const same = rows.every((row, i) => grid.children[i] === row && row.isConnected);
    if (!same || rows.length !== grid.children.length) window.flickered = true;
    window.flickering = requestAnimationFrame(watch);
  };
  watch();
}"""


def test_the_list_selects_renames_locks_and_hides(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    side = page.locator(".glid-side")
    book.value("None", setup="model.tell('hand')")
    side.locator(".glid-rows").get_by_text("No pins yet").wait_for()
    book.value("None", setup=PINS)
    hand.settle()
    grid = side.get_by_role("grid", name="Pins")
    rows = grid.get_by_role("row")
    rows.nth(7).wait_for()

    def name_of(row: int) -> Locator:
        return rows.nth(row).locator(".glid-entry-name")

    def selects(*pins: int) -> None:
        book.wait_for(f"model.selection == {pins}")
        page.wait_for_function(
            "([grid, pins]) => pins.every((pin) => grid.children[pin].ariaSelected === 'true')"
            " && grid.querySelectorAll('[aria-selected=true]').length === pins.length",
            arg=[grid.element_handle(), list(pins)],
        )

    # By mouse: one, all between, one more and one less.
    name_of(1).click()
    selects(1)
    name_of(3).click(modifiers=["Shift"])
    selects(1, 2, 3)
    name_of(0).click(modifiers=["Control"])
    selects(1, 2, 3, 0)
    name_of(2).click(modifiers=["Control"])
    selects(1, 3, 0)
    book.screenshot("pin-list-several")

    # By a double click, and by F2: the name.
    name_of(2).dblclick()
    field = rows.nth(2).get_by_label("Name")
    field.fill("elbow")
    field.press("Enter")
    book.wait_for("model.pose.names[2] == 'elbow'")
    page.keyboard.press("F2")
    field.fill("never")
    field.press("Escape")
    field.wait_for(state="detached")
    name_of(2).get_by_text("elbow").wait_for()

    # The eye and the padlock act on their row alone.
    rows.nth(0).get_by_role("button", name="Lock Pin 1").click()
    book.wait_for("model.state.marks[0].locked and model.selection == (2,)")
    rows.nth(0).get_by_role("button", name="Unlock Pin 1").wait_for()
    rows.nth(1).get_by_role("button", name="Hide Pin 2").click()
    book.wait_for("model.state.marks[1].hidden")

    # By keys: rows, buttons of a row, and the keys of the canvas.
    name_of(2).click()
    page.keyboard.press("ArrowDown")
    selects(3)
    page.keyboard.press("Shift+ArrowDown")
    selects(3, 4)
    page.keyboard.press("g")
    book.wait_for("model.state.marks[3].group == model.state.marks[4].group == 1")
    rows.nth(3).get_by_title("Group 1").wait_for()
    page.keyboard.press("Control+Home")  # without Shift only the focus moves
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    selects(3, 4)
    page.keyboard.press("Space")
    book.wait_for("not model.state.marks[0].locked")
    page.keyboard.press("l")
    book.wait_for("model.state.marks[3].locked and model.state.marks[4].locked")
    page.keyboard.press("l")
    book.wait_for("not model.state.marks[4].locked")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("h")
    book.wait_for("not model.state.marks[1].hidden")
    page.keyboard.press("Control+a")
    selects(*range(8))
    page.keyboard.press("Escape")
    selects()

    # It scrolls, and shows the pin that is selected on the canvas. A drag replaces no row.
    assert grid.evaluate(_FULL)
    assert grid.evaluate("one => one.scrollTop") == 0
    hand.pad.focus()
    hand.click((7, 0))
    selects(7)
    assert rows.nth(7).is_visible()
    assert grid.evaluate("one => one.scrollTop + one.clientHeight >= one.lastChild.offsetTop + 28")
    grid.evaluate(_WATCH)
    hand.drag(line((7, 0), (7, 2), 20))
    hand.wait_for_target(7, (7, 2))
    rows.nth(7).get_by_text("7.00, 2.00").wait_for()
    assert not page.evaluate("cancelAnimationFrame(window.flickering) ?? window.flickered")

    for theme in ("Dark", "Light"):
        book.theme(f"JupyterLab {theme}")
        assert faults(page, side) == []
        book.screenshot(f"pin-list-{theme.lower()}")
    page.set_viewport_size(PHONE)
    page.locator(".glid-editor.glid-narrow").wait_for()
    hand.wait_until_still()
    bring_into_view(grid)
    book.screenshot("pin-list-390")
    page.set_viewport_size(WINDOW)


def test_a_finger_hits_each_button_of_the_list(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR], viewport=PHONE, has_touch=True)
    hand, page = Hand(book), book.page
    book.value("None", setup=PINS + "; model.tell('hand')")
    hand.settle()
    grid = page.locator(".glid-side").get_by_role("grid", name="Pins")
    bring_into_view(grid)
    lock = grid.get_by_role("button", name="Lock Pin 2")
    box = lock.bounding_box()
    assert box is not None
    assert min(box["width"], box["height"]) >= 43
    lock.tap()
    book.wait_for("model.state.marks[1].locked")
    grid.get_by_role("row").nth(2).locator(".glid-entry-name").tap()
    book.wait_for("model.selection == (2,)")
    assert grid.evaluate(_FULL)
    book.screenshot("pin-list-touch")
