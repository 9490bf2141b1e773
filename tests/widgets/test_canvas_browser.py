"""The deformation canvas and the editor in a real browser."""

from __future__ import annotations

import numpy as np
import pytest

from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, center, choose_view, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

THREE = [(-6.0, 0.0), (6.0, 0.0), (0.0, 0.5)]


def test_click_drag_undo_and_redo(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand = Hand(book)
    for point in THREE:
        hand.click(point)
    book.wait_for("len(model.pose) == 3")
    np.testing.assert_allclose(hand.handles, THREE, atol=0.1)
    hand.settle()
    before = hand.targets

    # 60 moves a second, released above the canvas.
    beyond = [5.0, 9.0]
    hand.drag([*line(THREE[1], [7.0, 3.0], 45), *line([7.0, 3.0], beyond, 15)])
    hand.wait_for_target(1, beyond)
    assert hand.certified()
    np.testing.assert_allclose(hand.targets[0], before[0], atol=1e-9)
    gap = book.value("float(abs(model.map(model.pose.handles) - model.pose.targets).max())")
    assert gap < 0.01
    hand.wait_until_drawn()
    book.screenshot("editor-dragged")
    after = hand.targets

    hand.page.keyboard.press("Control+z")
    book.wait_for(f"abs(model.pose.targets - {before}).max() == 0")
    hand.wait_until_drawn()
    hand.page.keyboard.press("Control+Shift+Z")
    book.wait_for(f"abs(model.pose.targets - {after}).max() == 0")
    hand.wait_until_drawn()
    # Escape leaves no trace of a drag.
    steps = book.value("len(model.history.past)")
    hand.page.mouse.move(*hand.place(after[0]))
    hand.page.mouse.down()
    hand.page.mouse.move(*hand.place([-5.0, 2.0]))
    book.wait_for("len(model.dragged) == 1")
    hand.page.keyboard.press("Escape")
    book.wait_for("not model.dragged")
    hand.page.mouse.up()
    assert hand.targets == after
    assert book.value("len(model.history.past)") == steps
    # The right button opens a menu of the shape or of a pin. A click elsewhere only closes it.
    menu = hand.pad.get_by_role("menu")
    hand.click([-3.0, 1.0], button="right")
    book.screenshot("editor-menu-of-the-shape")
    menu.get_by_role("menuitem", name="Add a pin here").click()
    book.wait_for("len(model.pose) == 4 and abs(model.pose.targets[3] - [-3, 1]).max() < 0.1")
    hand.settle()
    hand.click(hand.targets[3], button="right")
    book.wait_for("model.selection == (3,)")
    menu.get_by_role("menuitem", name="Bring forward").click()
    book.wait_for("model.pose.depths.tolist() == [0, 0, 0, 1]")
    hand.settle()
    before = book.value("model.map.phi.real.tolist()")
    hand.click(hand.targets[3], button="right")
    book.screenshot("editor-menu-of-a-pin")
    menu.get_by_role("menuitem", name="Remove, keep the shape").click()
    book.wait_for("len(model.pose) == 3")
    assert book.value("model.map.phi.real.tolist()") == before
    hand.click([-3.0, 5.0], button="right")  # beside the shape
    menu.get_by_role("menuitem", name="Select all pins").wait_for()
    assert not menu.get_by_role("menuitem", name="Add a pin here").count()
    hand.click([-5.0, 1.0])
    menu.wait_for(state="hidden")
    assert book.value("len(model.pose)") == 3
    hand.click(after[2], button="right")
    menu.get_by_role("menuitem", name="Remove", exact=False).first.click()
    book.wait_for("len(model.pose) == 2")
    hand.settle()
    # F fits the view, and the drawing is in the right place.
    view = book.value("list(canvas.pane.stage.view)")
    hand.page.keyboard.press("f")
    book.wait_for(f"list(canvas.pane.stage.view) != {view}")
    hand.wait_until_drawn()
    points = [[-5.0, 0.5], [-2.0, -1.0], [0.5, 0.0], [3.1, 1.0], [5.2, -1.2]]
    for point, image in zip(points, book.value(f"model.map({points}).tolist()"), strict=True):
        seen = hand.color_at(image)
        # 10 pixels of the picture are one unit; green and blue count them.
        wanted = 100 + 10 * point[0]
        assert abs(seen[1] - wanted) < 6, (point, seen)
        assert abs(seen[2] - (255 - wanted)) < 6, (point, seen)


def test_controls_and_overlays(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand = Hand(book)
    for point in THREE:
        hand.click(point)
    book.wait_for("len(model.pose) == 3")
    hand.drag(line(THREE[1], [5.0, 2.5], 10))
    hand.wait_for_target(1, [5.0, 2.5])
    page = book.page
    # One click shows the plots. Each has a name and an explanation, on hover and by its "?".
    page.get_by_role("tab", name="Proof").click()
    assert not page.locator(".glid-plots").is_visible()
    page.get_by_role("button", name="Plots").click()
    for name, place in (("Energy", "Section 6"), ("Steps", "Section 9.2"), ("Time", "Section 10")):
        about = page.get_by_label(f"About the plot: {name}")
        assert place in (about.get_attribute("title") or "")
        about.click()
        page.locator(".glid-guide p", has_text=place).wait_for()
        book.screenshot(f"editor-about-{name}")
        about.click()
        page.locator(".glid-guide p", has_text=place).wait_for(state="hidden")
    page.get_by_role("tab", name="Proof").click()
    # Single steps say what each did.
    page.get_by_title("Pause the solver").click()
    book.value("None", setup="model.drag(1, to=(5.5, 2.0))")
    page.get_by_title("Run the iterations of one frame").click()
    told = page.locator(".glid-solver-panel").get_by_text("panels split").first
    told.wait_for()
    projected = book.value("model.moment.frame.history[-1].hessian_modified")
    words = f"Hessian {'projected' if projected else 'exact'} · step length"
    assert words in told.inner_text()
    book.screenshot("editor-single-step")
    page.get_by_title("Pause the solver").click()
    told.wait_for(state="hidden")
    hand.settle()
    energy = page.locator(".glid-energy select")
    energy.select_option(label="AMIPS")
    book.wait_for("model.state.current.energy.name == 'amips'")
    hand.settle()
    assert hand.certified()
    energy.select_option(label="Symmetric Dirichlet")
    hand.settle()

    # Another method. Its map of a mesh is drawn in place of the certified one.
    before = hand.targets
    method = page.locator(".glid-method select")
    method.select_option(label="Moving least squares · linear")
    book.wait_for("model.moment.comparison is not None and model.moment.solved")
    hand.drag(line(before[1], [-6.5, 0.5], 5))
    hand.wait_for_target(1, [-6.5, 0.5])
    book.wait_for(
        "model.moment.solved and not model.busy and model.moment.comparison.flipped.any()"
    )
    page.locator(".glid-editor").get_by_text("turned over").first.wait_for()
    hand.wait_until_drawn()
    book.screenshot("editor-comparison")
    assert hand.certified()
    page.keyboard.press("Control+z")
    hand.wait_for_target(1, before[1])
    method.select_option(label="Newton, ours")
    book.wait_for("model.moment.comparison is None")
    hand.settle()

    plain = hand.color_at([0.0, -0.5])
    for label in ("Stretch σ₁", "Dilatation k", "Energy density", "Stretch σ₂"):
        choose_view(page, label)
        page.locator(".glid-legend-title", has_text=label).wait_for()
        assert "Colours of the shape" in (
            page.locator(".glid-legend-part").get_attribute("title") or ""
        )
        hand.wait_until_drawn()
    colored = hand.color_at([0.0, -0.5])
    assert max(abs(a - b) for a, b in zip(colored, plain, strict=True)) > 20
    for label in ("Cage", "Offset", "Certificate"):
        choose_view(page, label)
    book.wait_for("canvas.show_panels and canvas.show_cage and 'panels' in canvas.pane.scene.lines")
    page.wait_for_timeout(500)
    book.screenshot("editor-overlays")
    choose_view(page, "Picture")
    page.locator(".glid-legend-title", has_text="Certified σ₂").wait_for()
    hand.wait_until_drawn()
    book.screenshot("editor-certificate")
    book.theme("JupyterLab Dark")
    arrow = method.evaluate("menu => getComputedStyle(menu).backgroundImage")
    assert "e0e0e0" in arrow  # light on dark
    tools = page.locator(".glid-tools")
    pressed, other = (tools.locator(f"[data-tool={name}]") for name in ("select", "stiff"))
    color = "button => getComputedStyle(button).backgroundColor"
    assert pressed.evaluate(color) == "rgb(47, 155, 219)"
    assert other.evaluate(color) != "rgb(47, 155, 219)"
    checks = [
        page.get_by_role("menuitemcheckbox", name=name, include_hidden=True)
        for name in ("Certificate", "Source")
    ]
    assert [one.get_attribute("aria-checked") for one in checks] == ["true", "false"]
    book.screenshot("editor-certificate-dark")
    book.theme("JupyterLab Light")
    choose_view(page, "Picture and grid")
    choose_view(page, "Source")
    book.wait_for("canvas.source is not None")
    pads = page.locator(".glid-pad")
    pads.nth(1).wait_for()
    left, right = (pads.nth(i).bounding_box() for i in (0, 1))
    assert left is not None
    assert right is not None
    assert left["x"] + left["width"] <= right["x"]
    book.screenshot("editor-source")
    choose_view(page, "Source")
    book.wait_for("canvas.source is None")
    # The status line.
    page.locator(".glid-foot").get_by_text("Converged").first.wait_for()


def test_by_keyboard_alone(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand = Hand(book)
    keys, shown = hand.page.keyboard, hand.pad.locator(".glid-help")
    assert hand.pad.get_by_text("Click the shape to pin a point").is_hidden()  # the footer says it
    hand.page.locator(".glid-tools").get_by_role("button", name="Keys and gestures").click()
    shown.get_by_text("Ctrl+Shift+Z").wait_for()
    shown.get_by_text("the shape follows, and never folds").wait_for()
    book.screenshot("editor-help")
    hand.pad.focus()
    keys.press("Shift+?")
    assert not shown.is_visible()
    assert book.value("len(model.pose)") == 0
    keys.press("Enter")  # the cursor appears in the middle
    for _ in range(3):
        keys.press("Shift+ArrowLeft")
    keys.press("Enter")
    book.wait_for("len(model.pose) == 1 and model.selection == (0,)")
    hand.pad.locator(".glid-notice").wait_for(state="hidden")
    hand.page.mouse.move(*hand.place(hand.targets[0]))
    assert "Pin 1: where it should be" in (hand.pad.get_attribute("title") or "")
    x = hand.handles[0][0]
    assert x < -1
    keys.press("Escape")
    keys.press("Enter")
    for _ in range(3):
        keys.press("Shift+ArrowRight")
    keys.press("Enter")
    book.wait_for("len(model.pose) == 2 and model.selection == (1,)")
    before = hand.targets[1]
    keys.press("ArrowUp")
    keys.press("Shift+ArrowRight")
    book.wait_for(
        f"abs(model.pose.targets[1] - [{before[0]} + 0.5, {before[1]} + 0.1]).max() < 1e-9"
    )
    hand.settle()
    assert hand.certified()
    keys.press(",")
    book.wait_for("model.selection == (0,)")
    keys.press("ContextMenu")
    hand.pad.get_by_role("menuitem", name="Copy the pose").wait_for()
    keys.press("Escape")
    assert hand.pad.get_by_role("menu").count() == 0
    keys.press("Shift+F10")
    assert hand.page.evaluate("document.activeElement.firstChild.data") == "Remove"
    keys.press("ArrowUp")
    keys.press("ArrowDown")
    keys.press("Enter")
    book.wait_for("len(model.pose) == 1")
    assert hand.pad.evaluate("pad => pad === document.activeElement")
    keys.press("0")
    book.wait_for("abs(model.pose.targets - model.pose.handles).max() == 0")
    # The notebook did not use the keys itself.
    assert len(book.value("get_ipython().history_manager.input_hist_raw[1:3]")) == 2
    keys.press("Control+z")
    keys.press("Control+z")
    book.wait_for("len(model.pose) == 2")


def test_touch_drags_and_pinches(open_notebook: OpenNotebook) -> None:
    book = open_notebook([SETUP, EDITOR], has_touch=True)
    hand = Hand(book)
    session = book.page.context.new_cdp_session(book.page)

    def touch(kind: str, *points: tuple[float, float]) -> None:
        fingers = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})

    for point in THREE[:2]:
        touch("touchStart", hand.place(point))
        touch("touchEnd")
    book.wait_for("len(model.pose) == 2")
    hand.settle()
    # No pause at the start, which would be a long press.
    first, *others = hand.places(line(THREE[1], [6.5, 2.0], 4))
    touch("touchStart", first)
    for place in others:
        touch("touchMove", place)
    touch("touchEnd")
    hand.wait_for_target(1, [6.5, 2.0])
    assert hand.certified()
    # A long touch opens the menu of the pin, and moves nothing.
    touch("touchStart", hand.place([6.5, 2.0]))
    item = hand.pad.get_by_role("menuitem", name="Bring forward")
    item.wait_for()
    touch("touchEnd")
    touch("touchStart", center(item))
    touch("touchEnd")
    book.wait_for("model.pose.depths.tolist() == [0, 1]")
    unit = book.value("canvas.pane.stage.view[2]")
    count = book.value("len(model.history.past)")
    centre = hand.place([0.0, 0.0])
    for spread in (20, 30, 40, 60, 80):
        ends = ((centre[0] - spread, centre[1]), (centre[0] + spread, centre[1]))
        touch("touchStart" if spread == 20 else "touchMove", *ends)
    touch("touchEnd")
    book.wait_for(f"canvas.pane.stage.view[2] < 0.5 * {unit}")
    assert book.value("len(model.history.past)") == count
    # The wheel zooms about the pointer.
    target = hand.place([1.0, 0.5])
    unit = book.value("canvas.pane.stage.view[2]")
    book.page.mouse.move(*target)
    book.page.mouse.wheel(0, 300)
    book.wait_for(f"canvas.pane.stage.view[2] > 1.2 * {unit}")
    np.testing.assert_allclose(hand.place([1.0, 0.5]), target, atol=0.5)


# The box for the numbers of pins.
NUMBERS = "editor.inspector.children[0].children[-1]"
PREPARED_AS_TOLD = """
import threading
from glid_nb._runtime import stage
from glid_nb.session import live_solver
may_solve, solve = threading.Event(), live_solver.solve

def prepared(*arguments, **named):
    live_solver.solve = solve  # other tests use this kernel
    stage("compile")
    may_solve.wait(60)
    return solve(*arguments, **named)

live_solver.solve = prepared
"""


def test_while_the_solver_is_prepared_nothing_covers_the_picture_and_pins_follow_the_hand(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    bar = page.get_by_role("progressbar", name="Preparing the solver")
    assert not bar.is_visible()
    for point in THREE:
        hand.click(point)
    book.wait_for("len(model.pose) == 3")
    hand.settle()
    book.value("None", setup=f"{PREPARED_AS_TOLD}model.drag(1, to=(6.5, 0.5))")
    bar.wait_for()
    page.wait_for_function("one => one.ariaValueNow === '50'", arg=bar.element_handle())
    page.locator(".glid-foot").get_by_text("Preparing the solver… 50%").wait_for()
    pad, box = hand.pad.bounding_box(), bar.bounding_box()
    assert pad is not None
    assert box is not None
    assert pad["y"] + pad["height"] <= box["y"]  # below the picture
    # The target follows the hand before the kernel has solved anything. The page's own solver may
    # go ahead; what it shows is certified.
    shown = hand.coefficients()
    hand.drag(line((6.5, 0.5), (5.0, 2.0), 10))
    book.wait_for("abs(model.pose.targets[1] - (5, 2)).max() < 0.1 and not model.dragged")
    marked = "list(canvas.pane.stage.marks['targets'][1])"
    np.testing.assert_allclose(book.value(marked), hand.targets[1], atol=1e-4)
    assert not book.value("may_solve.is_set()")
    book.screenshot("editor-preparing")
    book.value("None", setup="may_solve.set()")
    bar.wait_for(state="hidden")
    hand.settle()
    assert hand.certified()
    assert hand.coefficients() != shown


def test_what_is_beside_the_canvas_neither_takes_undo_nor_moves_it(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([SETUP, EDITOR])
    hand, page = Hand(book), book.page
    book.value("None", setup="model.paused = True")
    for point in THREE:
        hand.click(point)
    book.wait_for("len(model.pose) == 3")
    # Undo by keys works wherever in the editor the last click was, except in a text field.
    elsewhere = (
        page.locator(".glid-tools [data-tool=select]"),
        page.get_by_role("tab", name="Proof"),
        page.locator(".glid-solver-panel .widget-label").first,
    )
    for left, place in zip((2, 1, 0), elsewhere, strict=True):
        place.click()
        page.keyboard.press("Control+z")
        book.wait_for(f"len(model.pose) == {left}")
    page.keyboard.press("Control+Shift+Z")
    book.wait_for("len(model.pose) == 1")
    # It also works after a button was disabled and so lost the focus.
    for title, counts, key, left in (
        ("Undo (Ctrl+Z)", (0,), "Control+Shift+Z", 1),
        ("Redo (Ctrl+Shift+Z)", (2, 3), "Control+z", 2),
    ):
        for count in counts:
            page.locator(f".glid-tools button[title='{title}']").click()
            book.wait_for(f"len(model.pose) == {count}")
        page.wait_for_function("document.activeElement.matches('.glid-editor')")
        page.keyboard.press(key)
        book.wait_for(f"len(model.pose) == {left}")
    page.keyboard.press("Control+z")
    book.wait_for("len(model.pose) == 1")
    page.get_by_role("tab", name="Files").click()
    page.get_by_placeholder("Name.glid").click()
    page.keyboard.press("Control+z")
    page.get_by_role("tab", name="Trace").click()
    page.get_by_role("button", name="Whole picture").click()
    book.wait_for("editor.tracer.tracing_model.edited")
    page.get_by_role("tab", name="Trace").click()
    page.keyboard.press("Control+z")
    book.wait_for("not editor.tracer.tracing_model.edited")
    page.get_by_role("tab", name="Deform").click()
    assert book.value("len(model.pose)") == 1

    def places() -> list[object]:
        parts = (".glid-pad", ".glid-side", ".glid-timeline")
        return [page.locator(f".glid-editor {part}").first.bounding_box() for part in parts]

    # A long status and a refusal move nothing, and a notice is beside the colour bar.
    page.get_by_role("tab", name="Pin").click()
    book.value("None", setup="canvas.overlay = 'energy'; stage = canvas.pane.stage")
    page.locator(".glid-legend-bar").wait_for()
    for width, room in ((1366, "> 800"), (800, "< 400")):
        page.set_viewport_size({"width": width, "height": 768})
        book.wait_for(f"canvas.pane.stage.room[0] {room}")
        hand.wait_until_still()
        before = places()
        book.value("None", setup="editor.monitor.line.said.value = 'A long status. ' * 40")
        book.value(
            "None", setup="stage.notice = 'So it is. ' * 9; stage.legend_corner = 'top left'"
        )
        book.value("None", setup=f"bars = {NUMBERS}.children[0]")
        book.value("None", setup="bars.children[0].refusal.value = '<div>Refused. </div>' * 9")
        page.locator(".glid-refusal").get_by_text("Refused.").first.wait_for()
        notice = page.locator(".glid-notice", has_text="So it is.")
        notice.wait_for()
        bar = page.locator(".glid-legend[data-corner='top left']")
        bar.wait_for()
        assert places() == before
        above, below = bar.bounding_box(), notice.bounding_box()
        assert above is not None
        assert below is not None
        assert above["y"] + above["height"] < below["y"]
        book.screenshot(f"editor-long-status-{width}")
        book.value("None", setup="editor.monitor.line.said.value = stage.notice = ''")
