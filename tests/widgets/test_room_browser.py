"""The editor uses the window that it has: small, large, full screen, for lectures."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator

from .conftest import OpenNotebook
from .editor_page import SETUP, Hand, center

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EDITOR = """
editor = glid.Editor(picture, n_vertices=300)
canvas, model = editor.canvas, editor.deformation
editor
"""

_BOX = """(one) => {
  const { x, y, width, height } = one.getBoundingClientRect();
  return [x, y, width, height];
}"""


def box(of: Locator) -> list[float]:
    return of.evaluate(_BOX)


def test_the_canvas_takes_the_room_that_there_is(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup="model.paused = True")
    plots, tools = page.locator(".glid-plots"), page.locator(".glid-tools")
    stage = "canvas.pane.stage"

    def settle(room: str) -> list[float]:
        """The canvas' box, once it has the room; it is sharp, and what is drawn as large as it."""
        book.wait_for(f"{stage}.room and {room.format(f'*{stage}.room')}")
        hand.wait_until_still()
        hand.page.wait_for_function(
            """() => {
              const pad = document.querySelector('.glid-pad').getBoundingClientRect();
              const drawn = document.querySelector('.glid-pane .jupyter-threejs canvas');
              return drawn.width === Math.round(pad.width * devicePixelRatio)
                && drawn.height === Math.round(pad.height * devicePixelRatio);
            }"""
        )
        return box(hand.pad)

    def pin(point: tuple[float, float]) -> None:
        """A click at a place pins the shape's point there."""
        count = book.value("len(model.pose)")
        hand.click(point)
        near = f"abs(model.pose.handles[-1] - {point}).max() < 0.1"
        book.wait_for(f"len(model.pose) == {count + 1} and {near}")

    at_first = settle("(lambda w, h, _: w > 560)({})")
    pin((-6.0, 0.0))
    page.set_viewport_size({"width": 1920, "height": 1080})
    x, _, width, height = settle("(lambda w, h, _: w > 1000)({})")
    assert width > 1100
    assert height > 600
    assert x + width < box(plots)[0]  # beside each other
    pin((6.0, 1.0))
    book.screenshot("editor-1920")

    page.set_viewport_size({"width": 800, "height": 768})
    x, y, width, height = settle("(lambda w, h, _: w < 600)({})")
    inside = box(page.locator(".glid-editor"))
    for part in (hand.pad, tools, page.locator(".glid-timeline"), plots):
        left, _, across, _ = box(part)
        assert inside[0] <= left
        assert left + across <= inside[0] + inside[2]
    assert y + height < box(plots)[1]  # one above the other
    pin((0.0, -1.0))
    page.set_viewport_size({"width": 1366, "height": 768})
    assert settle("(lambda w, h, _: 600 < w < 1000)({})")[2:] == at_first[2:]

    # The picture alone, by key and by button; Escape brings the rest back.
    for enter in (
        lambda: page.keyboard.press("p"),
        lambda: hand.pad.get_by_role("button", name="The picture alone").click(),
    ):
        hand.pad.focus()
        enter()
        alone = settle("(lambda w, h, alone: alone)({})")
        assert alone[2] > 1100
        for part in (tools, plots, page.get_by_role("tab", name="Trace")):
            assert not part.is_visible()
        book.screenshot("editor-alone")
        page.keyboard.press("Escape")
        assert settle("(lambda w, h, alone: not alone)({})")[2:] == at_first[2:]
        assert tools.is_visible()
    pin((3.0, 0.0))

    # The whole screen, by key and by button.
    hand.pad.focus()
    page.keyboard.press("w")
    page.wait_for_function("document.fullscreenElement?.classList.contains('glid-editor')")
    settle("(lambda w, h, _: w > 650)({})")
    pin((-3.0, 1.0))
    page.keyboard.press("p")
    assert settle("(lambda w, h, alone: alone)({})")[2:] == [1366, 768]
    pin((-1.0, 1.0))
    book.screenshot("editor-full-screen-alone")
    page.keyboard.press("Escape")
    page.wait_for_function("!document.fullscreenElement")
    assert settle("(lambda w, h, alone: not alone)({})")[2:] == at_first[2:]
    page.mouse.click(*center(hand.pad.get_by_role("button", name="Full screen")))
    page.wait_for_function("!!document.fullscreenElement")
    book.screenshot("editor-full-screen")
    page.evaluate("document.exitFullscreen()")
    settle("(lambda w, h, alone: not alone and w < 650)({})")
