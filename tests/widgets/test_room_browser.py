"""The editor uses the window: small, large and full screen."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import NEW_PICTURE, ROOMY_EDITOR, SETUP, Hand, center, choose_view

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EDITOR = """
editor = glid.Editor(picture, n_vertices=300, plots=True)
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
        """The canvas's box, once it fills the room. It is sharp, and the drawing is as large as
        it."""
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

    at_first = settle("(lambda w, h, _: 400 < w < 500)({})")
    pin((-6.0, 0.0))
    page.set_viewport_size({"width": 1920, "height": 1080})
    x, _, width, height = settle("(lambda w, h, _: w > 900)({})")
    assert width > 900
    assert height > 600
    assert x + width < box(plots)[0]  # beside each other
    pin((6.0, 1.0))
    book.screenshot("editor-1920")

    page.set_viewport_size({"width": 800, "height": 768})
    x, y, width, height = settle("(lambda w, h, _: w < 400)({})")
    inside = box(page.locator(".glid-editor"))
    for part in (hand.pad, tools, page.locator(".glid-timeline"), plots):
        left, _, across, _ = box(part)
        assert inside[0] <= left
        assert left + across <= inside[0] + inside[2]
    assert y + height < box(plots)[1]  # one above the other
    pin((0.0, -1.0))
    page.set_viewport_size({"width": 1366, "height": 768})
    assert settle("(lambda w, h, _: 400 < w < 500)({})")[2:] == at_first[2:]

    # The picture alone, by key and by button. Escape brings back the rest.
    for enter in (
        lambda: page.keyboard.press("p"),
        lambda: choose_view(page, "The picture alone", closes=True),
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
    settle("(lambda w, h, _: w > 550)({})")
    pin((-3.0, 1.0))
    page.keyboard.press("p")
    assert settle("(lambda w, h, alone: alone)({})")[2:] == [1366, 768]
    pin((-1.0, 1.0))
    book.screenshot("editor-full-screen-alone")
    page.keyboard.press("Escape")
    page.wait_for_function("!document.fullscreenElement")
    # The picture alone ends first, while the editor still has the whole screen.
    assert settle("(lambda w, h, alone: not alone and w < 500)({})")[2:] == at_first[2:]
    page.mouse.click(*center(tools.get_by_role("button", name="Full screen")))
    page.wait_for_function("!!document.fullscreenElement")
    page.locator(".glid-side").wait_for(state="hidden")
    book.screenshot("editor-full-screen")
    page.keyboard.press("i")
    page.locator(".glid-side").wait_for()
    buttons = [box(button)[1] for button in page.locator(".glid-bars button").all()]
    assert len(set(buttons)) > 1  # buttons stay beside their numbers
    page.evaluate("document.exitFullscreen()")
    settle("(lambda w, h, alone: not alone and w < 500)({})")


def test_plots_are_beside_the_canvas_or_scrolled_to(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, NEW_PICTURE, ROOMY_EDITOR])
    hand, page = Hand(book), book.page
    beside, plots = page.locator(".glid-shell.glid-beside"), page.locator(".glid-plots")
    page.set_viewport_size({"width": 1300, "height": 768})
    page.locator(".glid-editor").evaluate("one => one.scrollIntoView()")
    hand.wait_until_still()
    choose_view(page, "Plots")
    beside.wait_for()
    assert sum(box(plots)[1::2]) < 768
    choose_view(page, "Plots")
    plots.wait_for(state="hidden")
    page.set_viewport_size({"width": 1024, "height": 768})
    page.locator(".glid-editor").evaluate("one => one.scrollIntoView()")
    hand.wait_until_still()
    choose_view(page, "Plots")
    # There is no room beside the canvas: they are below the editor, and seen.
    page.wait_for_function(
        """() => {
          const { top, bottom, height } = document.querySelector('.glid-plots')
            .getBoundingClientRect();
          return height > 100 && top > 0 && bottom <= innerHeight;
        }"""
    )
    assert not beside.count()
    book.screenshot("editor-plots-below")


def test_the_tracer_takes_the_room_that_there_is(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    page = book.page
    page.get_by_role("tab", name="Trace").click()
    stage, panel = page.locator(".glid-stage"), page.locator(".glid-panel")

    def scale() -> float:
        """CSS pixels per pixel of the fitted picture."""
        page.wait_for_function(
            """() => {
              const stage = document.querySelector('.glid-stage[data-viewport]');
              const [scale, left, top] = (stage?.dataset.viewport ?? '').split(' ').map(Number);
              return Math.abs(2 * left + 200 * scale - stage?.clientWidth) < 1
                && Math.min(left, top) < 30;
            }"""
        )
        return float((stage.get_attribute("data-viewport") or "").split()[0])

    scales = {}
    for width, height in ((1366, 768), (800, 768), (1920, 1080), (1366, 768)):
        page.set_viewport_size({"width": width, "height": height})
        page.evaluate("new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go)))")
        now = scale()
        assert scales.setdefault(width, now) == pytest.approx(now)
        below = box(panel)[1] >= sum(box(stage)[1::2])
        assert below == (width == 800)
        assert box(stage)[3] >= {1366: 480, 800: 340, 1920: 800}[width]
        assert box(stage)[2] > 500
        book.screenshot(f"tracer-{width}")
    assert scales[1366] < scales[1920]
    # A view that a hand has chosen stays.
    page.get_by_role("button", name="Zoom in (+)").click()
    zoomed = "document.querySelector('.glid-stage').dataset.viewport.split(' ')[0]"
    page.wait_for_function(f"scale => {zoomed} > 1.1 * scale", arg=scales[1366])
    page.set_viewport_size({"width": 1500, "height": 768})
    page.evaluate("new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go)))")
    assert float(page.evaluate(zoomed)) > 1.1 * scales[1366]


def test_the_hint_hides_no_vertex_of_a_picture_that_fits(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, "glid.widgets.CageTracer(np.rot90(picture).copy())"])
    page = book.page
    stage, hint = page.locator(".glid-stage[data-viewport]"), page.locator(".glid-hint")
    for width, lines in ((1920, 1), (640, 2)):
        page.set_viewport_size({"width": width, "height": 900})
        page.wait_for_function(
            "([hint, lines]) => (hint.offsetHeight > 30) === (lines > 1)",
            arg=[hint.element_handle(), lines],
        )
        page.evaluate("new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(go)))")
        scale, _, top = map(float, (stage.get_attribute("data-viewport") or "").split())
        bring_into_view(stage)
        book.screenshot(f"tracer-hint-{width}")
        assert box(stage)[1] + top + 200 * scale <= box(hint)[1]


def test_nothing_wraps_jumps_or_covers_a_mark(open_notebook: OpenNotebook) -> None:
    """In a narrow window, controls stay on one line, menus at its edge, and marks in view."""
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    hand.click((-6.0, 0.0))
    book.wait_for("len(model.pose) == 1")
    bar, keep = page.locator(".glid-timeline .glid-bar"), page.locator(".glid-keep")
    numbers = page.locator(".glid-bars")
    numbers.get_by_label("Depth").wait_for()
    for width in (1920, 1366, 1024, 800):
        page.set_viewport_size({"width": width, "height": 900})
        # The narrowest has its timeline under the inspector too.
        page.locator(".glid-editor.glid-close" if width == 800 else ".glid-editor").wait_for()
        hand.wait_until_still()
        heights, left = set(), set()
        for time in ("0.00 / 0.00 s", "23.00 / 23.00 s"):
            page.locator(".glid-time").evaluate("(one, text) => { one.textContent = text; }", time)
            heights.add(box(bar)[3])
            left.add(box(keep)[2])
        assert max(heights) < 45  # one line
        assert len(left) == 1
        book.screenshot(f"timeline-bar-{width}")

    # A menu at the right edge is as wide as its rows.
    pad = box(hand.pad)
    heights = set()
    for x in (20, pad[2] - 60):
        page.mouse.click(pad[0] + x, pad[1] + 30, button="right")
        heights |= {box(row)[3] for row in hand.pad.locator(".glid-menu button").all()}
        book.screenshot(f"menu-{x:.0f}")
        page.keyboard.press("Escape")
    assert len(heights) == 1

    # The arrow to a pin beyond the upper right corner lies beside the corner's buttons, which are
    # there when the picture is alone.
    hand.pad.focus()
    page.keyboard.press("p")
    book.wait_for("canvas.pane.stage.room[2] == 1")
    hand.wait_until_still()
    book.value("model.set_pins([0])", setup="model.move_target(0, (40.0, 20.0))")
    hand.settle()
    corner = box(page.locator(".glid-corner").first)
    page.mouse.click(corner[0] - 12, corner[1] + 8)
    book.wait_for("abs(np.array(canvas.pane.stage.view[:2]) - (40.0, 20.0)).max() < 1e-6")

    # A ring's knob below the buttons can still be dragged, and the buttons fade.
    (cx, cy, unit), width, height = book.value(
        "[stage.view, stage.width, stage.height]", "stage = canvas.pane.stage"
    )
    target = (cx + (width / 2 - 21 - 42) * unit, cy + (height / 2 - 21) * unit)
    book.value("None", setup="model.select([0]); model.set_pins([0], angles=0.0, scales=1.0)")
    book.value("None", setup=f"model.move_target(0, {target})")
    page.locator(".glid-corner.glid-through").wait_for()
    pad = box(hand.pad)
    book.screenshot("knob-below-corner")
    page.mouse.move(pad[0] + width - 21, pad[1] + 21)
    page.mouse.down()
    page.mouse.move(pad[0] + width - 42, pad[1] + 21, steps=5)
    page.mouse.up()
    book.wait_for("abs(model.pose.scales[0] - 0.5) < 0.05")
    book.value("None", setup="model.undo(); model.select([])")
    page.locator(".glid-corner:not(.glid-through)").first.wait_for()
    book.value("None", setup="model.select([0])")
    page.keyboard.press("Escape")
    book.wait_for("canvas.pane.stage.room[2] == 0")

    # The largest depth is readable.
    book.value("None", setup="model.set_depths([0], 100.0)")
    depth = page.get_by_label("Depth")
    page.wait_for_function("one => one.value === '100'", arg=depth.element_handle())
    assert depth.evaluate("one => one.scrollWidth <= one.clientWidth")

    # A refusal is at most as wide as the canvas.
    scale = page.get_by_label("Scale")
    scale.fill("-1")
    scale.press("Enter")
    refusal = page.get_by_text("'-1' is out of range")
    refusal.wait_for()
    assert sum(box(refusal)[::2]) <= sum(box(numbers)[::2])
