"""The knife, by hand: an arm is cut loose and passes in front of the body."""

from __future__ import annotations

import numpy as np
import pytest

from . import editor_page
from .conftest import OpenNotebook
from .test_tracer_browser import Hand

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A blue body of 70 x 150 pixels with a red arm drawn along its side: one blob to any tracer.
FIGURE = """
import numpy as np
import glid_nb as glid
glid.enable_compilation_cache()
picture = np.zeros((200, 200, 4), np.uint8)
picture[25:185, 50:125] = (40, 90, 200, 255)
picture[35:155, 125:152] = (220, 70, 40, 255)
editor = glid.Editor(picture, n_vertices=2000)
tracer, canvas, model = editor.tracer, editor.canvas, editor.deformation
editor
"""
BELOW_THE_ARM, ARMPIT = (130.0, 175.0), (125.0, 62.0)
SHOULDER, HAND, ON_THE_BODY = (138.0, 48.0), (138.0, 145.0), (88.0, 135.0)  # pixels
WORLD = "tracer.tracing_model.frame.to_world({}).tolist()"
N_LOOPS = "len(tracer.tracing_model.loops)"


def red(pixel: list[int]) -> bool:
    return pixel[0] > pixel[2] + 60


def blue(pixel: list[int]) -> bool:
    return pixel[2] > pixel[0] + 60


def test_an_arm_is_cut_loose_and_passes_in_front(open_notebook: OpenNotebook) -> None:
    book = open_notebook([FIGURE])
    page = book.page
    page.get_by_role("tab", name="Trace").click()
    knife = Hand(book)
    vertices = book.value("tracer.cage.n_vertices")

    # By key. Escape discards the line that is being drawn, and the knife stays in the hand.
    page.mouse.move(*knife.place(20, 20))
    knife.stage.locator("canvas").focus()
    page.keyboard.press("k")
    pressed = knife.root.get_by_role("button", name="Cut with the knife (K)", pressed=True)
    pressed.wait_for()
    width = knife.root.get_by_label("Width of the knife (px)")
    width.fill("2.5")
    width.press("Enter")
    book.wait_for("tracer.gestures.knife_width == 2.5")
    book.screenshot("knife-width")
    width.fill("")
    width.press("Enter")
    book.wait_for("tracer.gestures.knife_width is None")
    page.mouse.move(*knife.place(*BELOW_THE_ARM))
    page.mouse.down()
    page.mouse.move(*knife.place(125, 156), steps=4)
    page.mouse.move(*knife.place(*ARMPIT), steps=8)
    book.screenshot("knife-line")
    page.keyboard.press("Escape")
    page.mouse.up()
    knife.settle()
    assert book.value("tracer.tracing_model.edited") is False
    knife.drag(BELOW_THE_ARM, (125, 156), ARMPIT)
    knife.settle()
    assert knife.status.startswith("Cut open along the line · Cage with")
    assert pressed.is_visible()
    assert book.value("tracer.shown['problems']") == []
    assert vertices < book.value("tracer.cage.n_vertices") < vertices + 40
    book.screenshot("knife-cut")

    page.get_by_role("tab", name="Deform").click()
    book.wait_for("model.state.domain.cage.equals(tracer.cage)")
    hand = editor_page.Hand(book)
    shoulder, fist, goal = book.value(WORLD.format([SHOULDER, HAND, ON_THE_BODY]))
    feet, head = book.value(WORLD.format([(85.0, 175.0), (85.0, 35.0)]))
    for count, pin in enumerate((feet, head, shoulder, fist), start=1):
        hand.click(pin)
        book.wait_for(f"len(model.pose) == {count}")
    hand.settle()
    hand.drag(editor_page.line(fist, goal, 20))
    hand.wait_for_target(3, goal)
    assert hand.certified()
    assert book.value(f"len(model.map.inverse([{goal}], all=True))") == 2  # over the body

    # Its depth decides, on the canvas and in pictures.
    beside = [goal[0], goal[1] + 0.7]  # not where the pin is drawn
    render = "glid.render(picture, model.map, pose=model.pose)[{}, {}].tolist()"
    column, row = book.value(f"tracer.tracing_model.frame.to_pixel({beside}).astype(int).tolist()")
    for key, depth, wanted in (("PageUp", 1, red), ("PageDown", -1, blue)):
        hand.pad.focus()
        for _ in range(1 if key == "PageUp" else 2):
            page.keyboard.press(key)
        book.wait_for(f"model.pose.depths.tolist() == [0, 0, 0, {depth}]")
        hand.wait_for_color(beside, wanted)
        assert wanted(book.value(render.format(row, column)))
        book.screenshot(f"knife-arm-{'in-front' if depth > 0 else 'behind'}")
    assert hand.certified()


def test_on_a_phone_a_finger_cuts_and_chooses_the_piece(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([FIGURE], has_touch=True, viewport={"width": 390, "height": 844})
    page = book.page
    page.get_by_role("tab", name="Trace").tap()
    hand = Hand(book)
    sides = "root => [root.getBoundingClientRect().right, root.parentElement.scrollWidth]"
    right, wide = hand.root.evaluate(sides)
    assert right < 390  # all of it can be seen; what the bar has no room for is scrolled to
    assert wide <= right
    whole = book.value("tracer.cage.area")
    hand.button("Cut with the knife (K)").tap()
    session = page.context.new_cdp_session(page)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        at = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

    touch("touchStart", hand.place(125, 15))
    for y in range(20, 196, 5):
        touch("touchMove", hand.place(125, y))
    touch("touchEnd")
    hand.settle()
    pieces = hand.root.get_by_role("group", name="Pieces of the cut")
    pieces.wait_for()
    assert "Cut into 2 pieces: 7" in hand.status
    large = book.value("tracer.cage.area")
    assert 0.7 * whole < large < 0.85 * whole
    book.screenshot("knife-pieces")
    pieces.get_by_role("button", name="Keep another").tap()
    book.wait_for(f"tracer.cage.area < {0.5 * large}")
    hand.settle()
    assert "Cut into 2 pieces: 2" in hand.status
    pieces.get_by_role("button", name="Undo the cut").tap()
    book.wait_for(f"tracer.cage.area == {whole}")
    pieces.wait_for(state="hidden")

    # Two fingers zoom: the line that the first one began is none.
    a, b = hand.place(125, 15), hand.place(125, 100)
    touch("touchStart", a)
    touch("touchMove", hand.place(125, 80))
    touch("touchStart", hand.place(125, 80), b)
    touch("touchMove", a, hand.place(125, 150))
    touch("touchEnd")
    hand.settle()
    np.testing.assert_allclose(book.value("tracer.cage.area"), whole)
    assert book.value(N_LOOPS) == 1
