"""Shift, Ctrl and the numbers beside a pin in a drag, in a real browser."""

from __future__ import annotations

import numpy as np
import pytest

from .conftest import OpenNotebook
from .editor_page import ROOMY_EDITOR, SETUP, Hand

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# Texts that are drawn on the canvas over the picture.
_LISTEN = """() => {
  window.written = new Set();
  const { fillText } = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillText = function (text, ...at) {
    window.written.add(text);
    return fillText.call(this, text, ...at);
  };
}"""


def test_shift_and_ctrl_keep_a_drag_on_axes_and_pixels(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    page.evaluate(_LISTEN)
    for count, place in enumerate([(-6.0, 0.0), (6.0, 0.0)], 1):
        hand.click(place)
        book.wait_for(f"len(model.pose) == {count}")
    hand.settle()
    (x, y), other = hand.targets[1], hand.targets[0]

    def drag(key: str, start: tuple[float, float], end: tuple[float, float], name: str) -> None:
        if key:
            page.keyboard.down(key)
        for i, at in enumerate(hand.places([start, ((start[0] + end[0]) / 2, end[1]), end])):
            page.mouse.move(*at)
            if i == 0:
                page.mouse.down()
        page.locator(".glid-pad[data-idle=true]").first.wait_for()
        book.screenshot(name)
        page.mouse.up()
        if key:
            page.keyboard.up(key)
        book.wait_for("not model.dragged")
        hand.settle()

    # With Shift upwards only; no other pin is selected by that, or moved.
    drag("Shift", (x, y), (x + 0.5, y + 1.5), "drag-shift")
    moved = hand.targets
    assert moved[1][0] == pytest.approx(x, abs=1e-9)
    assert moved[1][1] == pytest.approx(y + 1.5, abs=0.05)
    assert moved[0] == other
    assert book.value("model.selection") == [1]
    written = page.evaluate("() => [...window.written]")
    assert f"x {x:.3f}   y {moved[1][1]:.3f}".replace("-", "−") in written

    # With Ctrl to whole pixels: a unit has 10.
    x, y = moved[1]
    drag("Control", (x, y), (x - 0.7, y - 0.4), "drag-ctrl")
    x, y = np.array(hand.targets[1]) * 10
    assert (x, y) == (pytest.approx(round(x)), pytest.approx(round(y)))
    assert f"pixel {round(x) + 100}, {50 - round(y)}" in page.evaluate("() => [...window.written]")

    # A pull on the shape says where its new pin is.
    drag("", (0.0, 0.0), (0.4, 0.8), "drag-shape")
    book.wait_for("len(model.pose) == 3")
    x, y = hand.targets[2]
    assert f"x {x:.3f}   y {y:.3f}".replace("-", "−") in page.evaluate("() => [...window.written]")
    assert hand.certified()
