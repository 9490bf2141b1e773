"""The inspector's numbers of pins while the hand moves them, in a real browser."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from .conftest import OpenNotebook
from .editor_page import NEW_PICTURE, ROOMY_EDITOR, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PINNED = "model.add_handles([(-6.0, 0.0), (6.0, 0.0)]); model.select([0]); model.tell('hand')"
BAR = "editor._parts['pins'].children[0]"
WORDS = ("Remove", "Keep shape", "Mirror", "Rest pose", "Lock", "Hide", "Group", "Ungroup")
RING = 42  # CSS pixels from a pin to its ring


def text_of(x: float, y: float) -> str:
    """A place as the list has it."""
    return f"{x:.2f}, {y:.2f}".replace("-", "−")


def test_the_numbers_follow_the_hand(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINNED)
    hand.settle()
    side = page.locator(".glid-side")
    x, y, angle = (side.get_by_label(name, exact=True) for name in ("x", "y", "Angle °"))
    cells = side.locator(".glid-entry-detail")
    expect(x).to_have_value("-6")

    def press(points: list[list[float]]) -> None:
        places = hand.places(points)
        page.mouse.move(*places[0])
        page.mouse.down()
        for place in places[1:]:
            page.mouse.move(*place)

    # The page writes what the hand holds; the kernel's fields wait for the end of the drag. The
    # dragged pin was not selected before.
    press(line((6, 0), (5, 1), 8))
    expect(y).not_to_have_value("0")
    page.locator(".glid-pad[data-idle=true]").first.wait_for()
    at = float(x.input_value()), float(y.input_value())
    assert at == pytest.approx((5, 1), abs=0.05)
    expect(cells.nth(1)).to_have_text(text_of(*at))
    expect(cells.nth(0)).to_have_text(text_of(-6, 0))
    assert book.value(f"[{BAR}.x.value, {BAR}.y.value]") == ["6", "0"]
    book.screenshot("numbers-dragging")

    # Escape takes the drag back, and the numbers with it.
    page.keyboard.press("Escape")
    expect(x).to_have_value("6")
    expect(y).to_have_value("0")
    expect(cells.nth(1)).to_have_text(text_of(6, 0))
    page.mouse.up()
    assert hand.targets[1] == [6, 0]

    # After a drag they are the kernel's.
    press(line((6, 0), (5, 1), 8))
    page.mouse.up()
    hand.wait_for_target(1, (5, 1))
    kept = hand.targets[1]
    expect(x).to_have_value(f"{round(kept[0], 3):.8g}")
    expect(cells.nth(1)).to_have_text(text_of(*kept))
    assert book.value(f"{BAR}.y.value") == y.input_value()

    # The turn follows the ring, whose pin stays.
    turn = book.value("canvas.pane.stage.marks['ring'][0]")
    reach = RING * book.value("canvas.pane.stage.view[2]")
    ring = [
        [kept[0] + reach * np.cos(turn + a), kept[1] + reach * np.sin(turn + a)]
        for a in np.linspace(0.8, 1.3, 9)
    ]
    expect(angle).to_have_value("")
    press(ring)
    expect(angle).not_to_have_value("")
    assert book.value(f"{BAR}.angle.value") == ""
    page.mouse.up()
    book.wait_for("model.pose.oriented[1] and not model.dragged")
    hand.settle()
    expect(angle).to_have_value(book.value(f"{BAR}.angle.value"))
    expect(x).to_have_value(f"{round(kept[0], 3):.8g}")


def test_the_fields_of_several_pins_are_those_of_all(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    pinned = "model.add_handles([(-6.0, 0.0), (6.0, 0.0), (6.0, 1.0)]); model.tell('hand')"
    book.value("None", setup=f"{pinned}; model.set_pins([0], weights=0.01); model.select([0, 1])")
    hand.settle()
    side = page.locator(".glid-side")
    x, y = (side.get_by_label(name, exact=True) for name in "xy")
    readout = side.locator(".glid-mixed .widget-readout")
    said = "(one) => getComputedStyle(one, '::after').content"
    expect(side.get_by_text("2 pins", exact=True)).to_be_visible()
    expect(x).to_have_value("")
    expect(x).to_have_attribute("placeholder", "mixed")
    expect(y).to_have_value("0")
    assert readout.evaluate(said) == '"mixed"'

    # While both are dragged, the page keeps to that.
    places = hand.places(line((6, 0), (5, 1), 8))
    page.mouse.move(*places[0])
    page.mouse.down()
    for place in places[1:]:
        page.mouse.move(*place)
    expect(y).not_to_have_value("0")
    assert float(y.input_value()) == pytest.approx(1, abs=0.05)
    expect(x).to_have_value("")
    page.keyboard.press("Escape")
    expect(y).to_have_value("0")
    page.mouse.up()
    hand.settle()

    # What is typed holds for both, and is undone in one step.
    x.fill("3")
    x.press("Enter")
    book.wait_for("model.pose.targets.tolist() == [[3, 0], [3, 0], [6, 1]]")
    expect(x).to_have_value("3")
    book.value("None", setup="model.undo()")
    expect(x).to_have_value("")
    assert hand.targets == [[-6, 0], [6, 0], [6, 1]]
    book.value("None", setup="model.select([1])")
    expect(x).to_have_value("6")
    expect(readout).to_have_count(0)
    expect(side.get_by_text("2 pins", exact=True)).to_be_hidden()


@pytest.mark.parametrize("size", [(1366, 768), (390, 844)])
def test_the_buttons_of_pins_are_in_words(
    open_notebook: OpenNotebook, size: tuple[int, int]
) -> None:
    book = open_notebook([SETUP, NEW_PICTURE + ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup=PINNED)
    hand.settle()
    page.set_viewport_size({"width": size[0], "height": size[1]})
    try:
        buttons = page.locator(".glid-words button")
        expect(buttons).to_have_count(len(WORDS))
        for word in WORDS:
            whole(buttons.filter(has_text=word).first)
        hand.settle()
        buttons.filter(has_text="Remove").click()
        book.wait_for("model.pose.handles.tolist() == [[6, 0]]")
        book.screenshot(f"numbers-words-{size[0]}")
    finally:
        page.set_viewport_size({"width": 1366, "height": 768})


def whole(button: Locator) -> None:
    """Check that a button's word is not cut off."""
    assert button.evaluate("(one) => one.scrollWidth <= one.clientWidth")
