"""Pins that are locked, hidden and grouped, in a real browser."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import Locator

from ..support.browser import WINDOW
from .conftest import OpenNotebook
from .editor_page import EDITOR, NEW_PICTURE, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PINS = "model.add_handles([(-6, 0), (0, 0), (6, 0)])"
# Whether the pin's colour is on the paper, in a square around a place of the page.
_DRAWN = """(paper, [x, y]) => {
  const box = paper.getBoundingClientRect();
  const scale = paper.width / box.width;
  const [left, top] = [(x - box.left - 8) * scale, (y - box.top - 8) * scale];
  const {data} = paper.getContext('2d').getImageData(left, top, 16 * scale, 16 * scale);
  for (let i = 0; i < data.length; i += 4)
    if (data[i] < 40 && data[i + 1] > 190 && data[i + 2] > 200 && data[i + 3] > 200) return true;
  return false;
}"""


def test_pins_are_locked_hidden_and_grouped(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINS)
    hand.settle()
    side, paper = page.locator(".glid-side"), page.locator(".glid-paper").first

    def button(title: str) -> Locator:
        return side.get_by_title(title)

    def wait_until_drawn(point: tuple[float, float], drawn: bool) -> None:
        place = hand.place(point)
        page.wait_for_function(
            f"([paper, place, drawn]) => ({_DRAWN})(paper, place) === drawn",
            arg=[paper.element_handle(), place, drawn],
        )

    # A locked pin stays, in the page too, and says why.
    hand.click((6, 0))
    book.wait_for("model.selection == (2,)")
    button("Lock selected pins").click()
    book.wait_for("model.state.marks[2].locked")
    hand.drag(line((6, 0), (6, 2), 8))
    page.locator(".glid-notice").get_by_text("pin 3 is locked").wait_for()
    assert hand.targets[2] == [6, 0]
    wait_until_drawn((6, 0), True)
    rows = side.get_by_role("row")
    assert rows.get_by_role("button", name="Unlock").count() == 1
    assert rows.nth(2).get_by_role("button", name="Unlock Pin 3").count() == 1
    assert side.get_by_label("Angle °").is_disabled()
    book.screenshot("pin-locked")

    # A hidden pin is not drawn and not hit; the list still has it.
    hand.click((0, 0))
    book.wait_for("model.selection == (1,)")
    wait_until_drawn((0, 0), True)
    hand.pad.focus()
    page.keyboard.press("h")
    book.wait_for("model.state.marks[1].hidden")
    wait_until_drawn((0, 0), False)
    page.keyboard.press("Escape")
    side.locator(".glid-entry[aria-selected=true]").wait_for(state="detached")
    rows.nth(1).get_by_role("button", name="Show Pin 2").wait_for()
    rows.nth(1).click(position={"x": 120, "y": 14})
    book.wait_for("model.selection == (1,)")
    book.screenshot("pin-hidden")
    hand.pad.focus()
    page.keyboard.press("Shift+H")
    wait_until_drawn((0, 0), True)

    # A group moves together.
    hand.click((-6, 0))
    page.keyboard.down("Shift")
    hand.click((0, 0))
    page.keyboard.up("Shift")
    book.wait_for("set(model.selection) == {0, 1}")
    assert button("Group selected pins").inner_text().strip() == "Group"  # in words
    button("Group selected pins").click()
    book.wait_for("model.state.marks[0].group == model.state.marks[1].group == 1")
    hand.pad.focus()
    page.keyboard.press("Escape")
    book.wait_for("model.selection == ()")
    hand.drag(line((0, 0), (0, 1), 8))
    hand.wait_for_target(1, (0, 1))
    np.testing.assert_allclose(hand.targets, [[-6, 1], [0, 1], [6, 0]], atol=0.1)
    assert hand.certified()
    for theme in ("Dark", "Light"):
        book.theme(f"JupyterLab {theme}")
        book.screenshot(f"pin-group-{theme.lower()}")
    page.set_viewport_size({"width": 390, "height": 844})
    hand.wait_until_still()
    book.screenshot("pin-group-390")
    page.set_viewport_size(WINDOW)
