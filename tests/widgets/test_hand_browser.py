"""What a hand may expect of the canvas wherever the editor is: in a real browser."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser

from ..support.browser import (
    GPU_RASTER_FLAGS,
    JupyterServer,
    LabNotebook,
    bring_into_view,
    chromium,
    watched_page,
)
from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, center, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

_KEY = """(pad, key) => {
  pad.focus();
  pad.dispatchEvent(new KeyboardEvent('keydown', {bubbles: true, cancelable: true, ...key}));
}"""
_UNNAMED = r"""(editor) => [...editor.querySelectorAll('button, select, input, img, [role=slider]')]
  .filter((one) => one.checkVisibility() && one.getAttribute('alt') !== '')
  .filter((one) => {
    const labels = [...(one.labels ?? [])].map((label) => label.textContent).join('');
    const text = one.matches('button') ? one.textContent : '';
    const names = [one.ariaLabel, one.alt, labels, text, one.getAttribute('aria-labelledby')];
    return !names.some((name) => /[\p{L}\p{N}]/u.test(name ?? ''));
  }).map((one) => one.outerHTML.slice(0, 200))"""
_CYAN = (0, 213, 224)


def pin_seen(hand: Hand, point: tuple[float, float]) -> bool:
    """Whether the screen shows the disk of a pin at a point of the world."""
    x, y = hand.place(point)
    clip: Any = {"x": x - 10, "y": y - 10, "width": 20, "height": 20}
    pixels = np.asarray(Image.open(io.BytesIO(hand.page.screenshot(clip=clip))).convert("RGB"))
    return bool((abs(pixels.astype(int) - _CYAN).max(axis=2) < 12).any())


def wait_until_seen(hand: Hand, point: tuple[float, float], seen: bool) -> None:
    for _ in range(20):
        if pin_seen(hand, point) == seen:
            return
        hand.page.evaluate("() => new Promise((go) => requestAnimationFrame(go))")
    raise AssertionError(f"a pin at {point} is {'not ' * seen}shown")


def pins_come_and_go(hand: Hand) -> None:
    book = hand.book
    hand.click((-6, 0))
    book.wait_for("len(model.pose) == 1")
    hand.settle()
    hand.page.mouse.move(*hand.place((0, 5)))
    wait_until_seen(hand, (-6, 0), True)
    hand.page.keyboard.press("Delete")
    book.wait_for("len(model.pose) == 0")
    hand.settle()
    wait_until_seen(hand, (-6, 0), False)


def test_the_last_pin_leaves_the_screen_where_the_gpu_draws_the_page(
    browser: Browser, jupyter: JupyterServer
) -> None:
    """A frame that only cleared the canvas was not shown."""
    gpu = browser.browser_type.launch(executable_path=chromium(), args=list(GPU_RASTER_FLAGS))
    with watched_page(gpu) as page:
        book = LabNotebook(page, jupyter, [SETUP, EDITOR])
        pins_come_and_go(Hand(book))
        book.screenshot("hand-gpu-raster")
        book.shut_down()
    gpu.close()


def test_a_hand_finds_what_it_expects(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    root = page.locator(".glid-editor")

    # The wheel over a canvas without the focus scrolls the page.
    def unit() -> float:
        return book.value("canvas.pane.stage.view[2]")

    before = unit()
    page.mouse.move(*hand.place((0, 3.5)))
    page.mouse.wheel(0, 60)
    hand.wait_until_still()
    pins_come_and_go(hand)  # without GPU raster; this also focuses the canvas
    assert unit() == before
    page.mouse.wheel(0, 60)
    book.wait_for(f"canvas.pane.stage.view[2] > {before}")
    hand.pad.press("f")
    book.wait_for(f"abs(canvas.pane.stage.view[2] - {before}) < 1e-6")

    # Keys of a Cyrillic keyboard.
    assert book.value("len(model.pose)") == 0
    hand.pad.evaluate(_KEY, {"key": "я", "code": "KeyZ", "ctrlKey": True})
    book.wait_for("len(model.pose) == 1")
    hand.pad.evaluate(_KEY, {"key": "Я", "code": "KeyZ", "ctrlKey": True, "shiftKey": True})
    book.wait_for("len(model.pose) == 0")

    # Below a CSS zoom, and a transform, a click lands where it should.
    for style in ("zoom: 1.25", "transform: scale(0.8); transform-origin: 0 0"):
        root.evaluate("(one, style) => { one.style.cssText += style; }", style)
        bring_into_view(hand.pad)
        hand.wait_until_still()
        box = hand.pad.bounding_box()
        assert box is not None
        view, width = book.value("[list(canvas.pane.stage.view), canvas.pane.stage.width]")
        scale = box["width"] / width
        x, y = center(hand.pad)
        wanted = (-0.3, 0.2)
        across, up = ((w - v) / view[2] * scale for w, v in zip(wanted, view, strict=False))
        page.mouse.click(x + across, y - up)
        book.wait_for("len(model.pose) == 1")
        np.testing.assert_allclose(hand.handles, [wanted], atol=0.06)
        page.keyboard.press("Control+z")
        book.wait_for("len(model.pose) == 0")
        root.evaluate("one => { one.style.zoom = ''; one.style.transform = ''; }")
        hand.wait_until_still()

    # Without pins the shape is at rest. Alt turns a pin.
    hand.click((-6, 0))
    book.wait_for("len(model.pose) == 1")
    hand.settle()
    page.keyboard.down("Alt")
    for i, place in enumerate(hand.places([(-6, 0), (-5, 0), (-5.2, 0.6)])):
        page.mouse.move(*place)
        if i == 0:
            page.mouse.down()
        # A move that waits for an answer would be replaced by the next one.
        page.locator(".glid-pad[data-idle=true]").first.wait_for()
    page.mouse.up()
    page.keyboard.up("Alt")
    book.wait_for("0.4 < model.pose.angles[0] < 0.9")
    hand.settle()
    assert book.value("float(abs(model.map([[6, 0]]) - [6, 0]).max())") > 2
    page.keyboard.press("Delete")
    book.wait_for("len(model.pose) == 0")
    hand.settle()
    assert book.value("float(abs(model.map([[6, 0]]) - [6, 0]).max())") < 1e-9

    # Every control has a name.
    page.locator(".glid-tools button").first.wait_for()
    for tab in ("Motion", "Files", "Proof", "Pin"):
        page.get_by_role("tab", name=tab, exact=True).click()
        unnamed = root.evaluate(_UNNAMED)
        assert unnamed == [], "\n".join(unnamed)
    page.get_by_role("button", name="Undo (Ctrl+Z)").first.wait_for()
    book.screenshot("hand")


def test_a_drag_between_keyframes_is_kept(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    timeline = page.locator(".glid-timeline")
    for point in ((-6, 0), (6, 0)):
        hand.click(point)
    book.wait_for("len(model.pose) == 2")
    hand.settle()
    book.value("None", setup="editor.timeline.animation.keep(0)")
    hand.settle()
    hand.drag(line((6, 0), (6, 2), 8))
    hand.wait_for_target(1, (6, 2))
    book.wait_for("[s.status for s in editor.timeline.animation.spans] == ['proved']", 60)

    # Scrub to the middle, then drag the shape as it is seen there.
    book.value("None", setup="model.go_to_pose(0)")
    bring_into_view(timeline)
    hand.wait_until_still()
    keys = timeline.locator(".glid-key")
    first, last = (center(keys.nth(i)) for i in (0, 1))
    ruler = timeline.locator(".glid-ruler").bounding_box()
    assert ruler is not None
    page.mouse.click((first[0] + last[0]) / 2, ruler["y"] + ruler["height"] / 2)
    page.wait_for_function("document.querySelector('.glid-track').dataset.time > 0.3")
    time = float(timeline.locator(".glid-track").get_attribute("data-time") or 0)
    # A click, and a drag beside the shape, leave the time as it is.
    hand.click((0, 5))
    hand.drag(line((0, 5), (2, 5.5), 4))
    hand.click((0, 5), button="right")
    page.locator(".glid-pad[data-idle=true]").wait_for()
    assert hand.pad.locator(".glid-menu").count() == 0
    assert timeline.locator(".glid-track").get_attribute("data-time") == str(time)
    assert timeline.locator(".glid-playhead.glid-seen").count() == 1
    start = book.value(f"editor.timeline.animation.at({time})([[6, 0]])[0].tolist()")
    end = [start[0] - 1.5, start[1] + 1.0]
    hand.drag(line(start, end, 8))
    book.wait_for("len(editor.poses) == 3 and model.state.active == 1")
    hand.wait_for_target(1, end)
    hand.wait_until_drawn()
    np.testing.assert_allclose(hand.targets[0], [-6, 0], atol=0.3)
    book.screenshot("hand-between-keyframes")

    # After "Once" the pose that is shown is the one that is edited.
    book.wait_for("[s.status for s in editor.timeline.animation.spans] == ['proved'] * 2", 60)
    timeline.locator(".glid-ruler").focus()
    page.keyboard.press("Home")
    page.locator(".glid-timeline[data-active='0/3']").wait_for()
    hand.wait_until_drawn()
    timeline.locator(".glid-ruler").focus()
    page.keyboard.press("Space")
    book.wait_for("model.state.active == 2")
    hand.wait_until_drawn()


def test_each_view_of_an_editor_fits_its_own_room(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR.replace(", width=560, height=400", "")])
    hand, page = Hand(book), book.page
    book.wait_for("len(canvas.pane.stage.room) == 3")
    hand.wait_until_still()
    page.evaluate(
        """() => {
          const {shell, commands} = window.jupyterapp;
          const book = shell.currentWidget;
          book.content.activeCellIndex = 1;
          return commands.execute('notebook:create-output-view')
            .then(() => shell.activateById(book.id));
        }"""
    )
    second = Hand(book, pad=1)
    # The new view has no prompt beside it, so it has more room and decides; the first one shrinks.
    page.wait_for_function("document.querySelectorAll('.glid-deform')[0].style.zoom < 1")

    def check(one: Hand) -> None:
        bring_into_view(one.pad)
        one.wait_until_still()
        stage = one.pad.locator("xpath=ancestor::*[contains(@class, 'glid-deform')]")
        inner, outer = one.pad.bounding_box(), stage.bounding_box()
        assert inner is not None
        assert outer is not None
        assert inner["x"] + inner["width"] <= outer["x"] + outer["width"] + 1

    check(second)
    check(hand)
    book.screenshot("hand-two-views")
    room = book.value("canvas.pane.stage.room")
    page.mouse.click(*center(hand.pad))  # the view that a hand uses decides
    book.wait_for(f"canvas.pane.stage.room[0] < {room[0]} and len(model.pose) == 1")
    np.testing.assert_allclose(hand.handles, [[0, 0]], atol=0.3)
    check(hand)
    check(second)
