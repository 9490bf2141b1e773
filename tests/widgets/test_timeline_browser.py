"""A walk cycle made by hand on the timeline, in a real browser."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
import pytest
from playwright.sync_api import FloatRect, Locator
from skimage.io import imread

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

EDITOR = """
import numpy as np
import glid_nb as glid
glid.enable_compilation_cache()
editor = glid.Editor(glid.samples.image("gingerbread"), n_vertices=1500)
canvas, model = editor.canvas, editor.deformation
editor
"""
# Filled at the end by a canvas whose maps the kernel evaluates.
BOX = """
import ipywidgets
box = ipywidgets.VBox(layout={"width": "420px"})
box
"""
OTHER = """
from glid_nb.widgets import TimelinePanel
given = {"width": 400, "height": 300, "n_vertices": 400, "evaluated_in": "kernel"}
other = glid.widgets.DeformCanvas(canvas.image, model, **given)
panel = TimelinePanel(other)
box.children = [other, panel]
"""
PINS = ([0.0, 5.0], [-5.5, 2.0], [5.5, 2.0], [-2.4, -6.5], [2.4, -6.5])
# Of the hands and the feet, at each of the five poses.
STEPS = (
    ([-5.5, 2.0], [5.5, 2.0], [-2.4, -6.5], [2.4, -6.5]),
    ([-5.0, 4.0], [5.0, -0.5], [-1.2, -6.0], [3.6, -6.0]),
    ([-5.5, 2.0], [5.5, 2.0], [-2.0, -6.8], [2.0, -6.8]),
    ([-5.0, -0.5], [5.0, 4.0], [-3.6, -6.0], [1.2, -6.0]),
    ([-5.5, 2.4], [5.5, 1.6], [-2.5, -6.5], [2.3, -6.7]),
)
COUNT_DRAWINGS = """() => {
  window.drawings = 0;
  const draw = WebGL2RenderingContext.prototype.drawElements;
  window.restoreDrawing = () => { WebGL2RenderingContext.prototype.drawElements = draw; };
  WebGL2RenderingContext.prototype.drawElements = function (...a) {
    window.drawings += 1;
    return draw.apply(this, a);
  };
}"""
# Whether keyframes lie below a pointer in their middles.
GRABBED = """(keys) => keys.map((key) => {
  const { x, y, width, height } = key.getBoundingClientRect();
  return document.elementFromPoint(x + width / 2, y + height / 2) === key;
})"""
WIDE_ENOUGH = """(menu) => {
  const wide = menu.offsetWidth;
  menu.style.width = 'max-content';
  const wanted = menu.offsetWidth;
  menu.style.width = '';
  return wide >= wanted;
}"""


class Timeline:
    """What a hand can do on the timeline."""

    def __init__(self, hand: Hand, number: int = 0) -> None:
        self.hand, self.book, self.page = hand, hand.book, hand.page
        self.root = self.page.locator(".glid-timeline").nth(number)
        self.track = self.root.locator(".glid-track")
        self.keys = self.root.locator(".glid-key:not(.glid-return)")

    def button(self, title: str) -> None:
        self.root.locator(f'button[title^="{title}"]').click()

    def settle(self) -> None:
        """Wait until everything between the poses is proved, and the page knows."""
        self.hand.settle()
        proved = "all(s.status == 'proved' for s in editor.timeline.animation.spans)"
        told = (
            "([(one.status, one.reason) for one in editor.timeline.animation.spans], model.status,"
            " model.settled(), [pose.unsolved for pose in model.state.poses])"
        )
        self.book.wait_for(f"{proved} and len(editor.timeline.animation.spans) > 0", 60, told)
        spans = self.book.value("len(editor.timeline.animation.spans)")
        done = "n => document.querySelectorAll('.glid-computing').length === 0 && n > 0"
        self.page.wait_for_function(done, arg=spans)

    @property
    def time(self) -> float:
        return float(self.track.get_attribute("data-time") or "nan")

    @property
    def times(self) -> list[float]:
        return self.book.value("list(model.state.timeline.times)")

    @staticmethod
    def box(part: Locator) -> FloatRect:
        """The place of a part in the window, after it is scrolled into view."""
        bring_into_view(part)
        box = part.bounding_box()
        assert box is not None
        return box

    def x(self, time: float) -> float:
        box = self.box(self.track)
        span = float(self.track.get_attribute("data-span") or "nan")
        return box["x"] + 34 + time / span * (box["width"] - 68)

    def scrub(self, times: Sequence[float]) -> None:
        box = self.box(self.track)
        self.page.mouse.move(self.x(times[0]), box["y"] + 8)
        self.page.mouse.down()
        for time in times:
            self.page.mouse.move(self.x(time), box["y"] + 8)
        self.page.mouse.up()

    def hold(self, index: int, *times: float) -> None:
        """Press on a keyframe and move it to one time after the other."""
        places = [self.x(time) for time in times]
        box = self.box(self.keys.nth(index))
        self.page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 20)
        self.page.mouse.down()
        for place in places:
            self.page.mouse.move(place, box["y"] + 20, steps=5)

    def longest_gap(self) -> int:
        """The longest run of empty pixels on the strip between its first and last piece."""
        strip = self.root.locator(".glid-strip").screenshot()
        row = imread(io.BytesIO(strip))[-3].astype(int)
        return int(np.diff(np.flatnonzero(row[:, 2] - row[:, 0] > 60)).max()) - 1

    def assert_shows_the_motion(self) -> None:
        """The shader has the coefficients of ``motion(t)`` to float32."""
        wanted = self.book.value(
            "canvas.pane.scene.shader_map.coefficients(editor.motion(t))[0].ravel().tolist()",
            f"t = {self.time!r}",
        )
        np.testing.assert_allclose(self.hand.coefficients(), wanted, atol=3e-6, rtol=3e-7)


def test_a_walk_cycle_made_by_hand(open_notebook: OpenNotebook) -> None:
    book = open_notebook([EDITOR, BOX])
    hand = Hand(book)
    timeline, page = Timeline(hand), book.page
    for i, pin in enumerate(PINS):
        hand.click(pin)
        book.wait_for(f"len(model.pose) == {i + 1}")
    for i, step in enumerate(STEPS):
        if i:
            timeline.button("Key this pose")
            book.wait_for(f"len(editor.poses) == {i + 1} and model.state.active == {i}")
        for pin, target in enumerate(step, 1):
            start = hand.targets[pin]
            if start != target:
                hand.drag(line(start, target, 6))
                hand.wait_for_target(pin, target)
    timeline.settle()
    assert timeline.times == [0, 1, 2, 3, 4]
    assert timeline.keys.count() == 5
    book.screenshot("timeline-five-poses")

    # A keyframe moves in time, but not past another. Its easing and the repetition change.
    timeline.hold(1, 1.2, 1.4)
    head = timeline.box(timeline.root.locator(".glid-playhead"))  # shows where it would land
    assert abs(head["x"] + head["width"] / 2 - timeline.x(1.4)) < 5
    page.mouse.up()
    book.wait_for("abs(model.state.timeline.times[1] - 1.4) < 0.03")
    # Escape drops a drag. A keyframe dropped on another stays beside it, so both are visible.
    moved = timeline.times
    timeline.hold(1, 2.6)
    timeline.root.locator(".glid-timeline-note", has_text="to 2.60 s").wait_for()
    page.keyboard.press("Escape")
    page.mouse.up()
    assert timeline.times == moved
    timeline.hold(1, 2.6, 3)
    page.mouse.up()
    book.wait_for(f"model.state.timeline.times[1] == {moved[2]}")
    page.mouse.move(0, 0)
    assert 0.02 < min(np.diff(timeline.times)) < 0.2
    timeline.root.locator(f".glid-key:nth-child(2)[title*='at {moved[2]:.2f} s']").wait_for()
    assert all(timeline.keys.evaluate_all(GRABBED))
    page.keyboard.press("Control+z")
    book.wait_for(f"list(model.state.timeline.times) == {moved}")
    assert timeline.root.locator("select").evaluate_all(f"(all) => all.every({WIDE_ENOUGH})")
    page.get_by_role("tab", name="Motion").click()
    page.get_by_title("How the motion leaves it").select_option(label="Ease in, out")
    timeline.root.locator("select").nth(0).select_option("loop")
    book.wait_for("model.state.timeline.repeat == 'loop' and len(editor.motion.times) == 6")
    assert book.value("model.state.timeline.easing[model.state.active]") == "in-out"
    timeline.settle()

    # Scrubbing shows the motion at that time, without a message to the kernel.
    state = book.value("id(model.state)")
    timeline.scrub([0.3, 0.9, 2.63])
    assert timeline.time == pytest.approx(2.63, abs=0.02)
    timeline.assert_shows_the_motion()
    book.screenshot("timeline-scrubbed")
    for key in ("ArrowRight", "ArrowRight", "ArrowLeft"):
        before = timeline.time
        page.keyboard.press(key)
        assert abs(timeline.time - before) == pytest.approx(1 / 25)
    timeline.assert_shows_the_motion()
    assert book.value("id(model.state)") == state

    # It plays in a loop, without the kernel, and stops at the current time.
    page.evaluate(COUNT_DRAWINGS)
    page.keyboard.press("Space")
    page.wait_for_function("() => window.drawings > 10")
    page.keyboard.press("Space")
    page.evaluate("() => window.restoreDrawing()")
    timeline.assert_shows_the_motion()
    assert book.value("id(model.state)") == state

    # A click on the canvas leaves the motion where it is and pins nothing. Escape goes back to the
    # edited pose.
    before = timeline.time
    hand.click([0.0, 0.0])
    timeline.assert_shows_the_motion()
    assert timeline.time == before
    assert len(hand.handles) == 5
    page.keyboard.press("Escape")
    hand.wait_until_drawn()
    # A map between poses is kept as a pose, and undo takes it back.
    timeline.scrub([0.5])
    timeline.button("Key this pose")
    book.wait_for("len(editor.poses) == 6 and model.state.active == 1")
    page.keyboard.press("Control+z")
    book.wait_for("len(editor.poses) == 5")

    # A recorded drag becomes keyframes, in one step for undo.
    timeline.settle()
    timeline.root.locator(".glid-ruler").focus()
    page.keyboard.press("End")
    book.wait_for("model.state.active == 4")
    timeline.button("Record")
    start = hand.targets[1]
    path = [[start[0] + np.sin(s / 4), start[1] + 0.15 * s] for s in range(20)]
    hand.drag(path, pause=50)
    book.wait_for("not editor.timeline.animation.recording")
    recorded = book.value("len(editor.poses)")
    # How many there are depends on the moments of the moves: in bursts, more are needed.
    assert 6 < recorded < 5 + len(path)
    assert all(time == round(time, 2) for time in timeline.times)
    timeline.settle()
    book.screenshot("timeline-recorded")
    # On a busy machine moves come in bursts, and close keyframes need more room.
    wide = max(280, 10 * timeline.times[-1] / min(np.diff(timeline.times)))
    timeline.root.evaluate(f"root => {{ root.style.width = '{wide}px'; }}")
    assert timeline.keys.evaluate_all(GRABBED).count(False) == 0
    timeline.root.evaluate("root => { root.style.width = '150px'; }")
    assert timeline.longest_gap() <= 3  # the playhead, and a line between two pieces
    timeline.root.evaluate("root => { root.style.width = ''; }")
    page.keyboard.press("Control+z")
    book.wait_for("len(editor.poses) == 5")
    assert hand.targets[1] == start

    # Delete removes the pose that is selected.
    timeline.keys.nth(2).click()
    book.wait_for("model.state.active == 2")
    page.keyboard.press("Delete")
    book.wait_for("len(editor.poses) == 4")
    page.keyboard.press("Control+z")
    book.wait_for("len(editor.poses) == 5")
    timeline.settle()
    assert book.value("editor.motion.certificate.certified")

    # If the kernel evaluates, it draws the frames, and the timeline says so.
    book.value("None", setup=OTHER)
    second = Timeline(hand, 1)
    note = second.root.locator(".glid-timeline-note", has_text="Played by the kernel")
    note.wait_for()
    second.root.evaluate("root => { root.style.width = '390px'; }")
    # All in one call, because the note also reports what is proved meanwhile.
    longer = "note.append(' A longer reason.'.repeat(9))"
    fits = "note.clientHeight >= note.scrollHeight && note.clientHeight > 50"
    assert note.evaluate(f"note => {{ {longer}; return {fits}; }}")
    second.root.evaluate("root => { root.style.width = ''; }")
    book.wait_for("panel.animation.wait(0.1)", 60)
    page.wait_for_function("() => document.querySelectorAll('.glid-computing').length === 0")
    bring_into_view(second.root)
    second.scrub([0.4, 1.1])
    near = "abs(other.pane.scene.map.phi - panel.animation.at(t).phi).max() < 1e-12"
    assert second.time == pytest.approx(1.1, abs=0.02)
    book.wait_for(near.replace("(t)", f"({second.time!r})"))
    page.keyboard.press("Space")
    page.wait_for_function("track => track.dataset.time > 1.2", arg=second.track.element_handle())
    page.keyboard.press("Space")
    book.wait_for(near.replace("(t)", f"({second.time!r})"))
    page.keyboard.press("Escape")
    book.wait_for("other.pane.scene.map is model.map")


def test_moving_a_pin_at_a_later_time_makes_a_keyframe_there(open_notebook: OpenNotebook) -> None:
    book = open_notebook([EDITOR, BOX])
    hand = Hand(book)
    timeline, page = Timeline(hand), book.page
    for pin in PINS:
        hand.click(pin)
    book.wait_for(f"len(model.pose) == {len(PINS)}")
    hand.settle()
    start = hand.targets[-1]

    def drag_at(time: float, end: list[float]) -> None:
        count = book.value("len(editor.poses)")
        timeline.scrub([time])
        assert timeline.time == pytest.approx(time, abs=0.02)
        label = timeline.root.locator(".glid-playhead").get_attribute("data-label")
        assert float(label or "nan") == pytest.approx(time, abs=0.02)
        hand.drag(line(hand.targets[-1], end, 8))
        book.wait_for(f"len(editor.poses) == {count + 1}")
        hand.wait_for_target(len(PINS) - 1, end)

    drag_at(0.8, [start[0] - 0.5, start[1] + 0.5])
    timeline.settle()
    drag_at(1.5, [start[0], start[1] - 0.5])
    timeline.settle()
    np.testing.assert_allclose(timeline.times, [0, 0.8, 1.5], atol=0.03)
    np.testing.assert_allclose(book.value("model.state.poses[0].pose.targets[-1].tolist()"), start)
    book.screenshot("timeline-autokey")

    # K makes a keyframe of what is shown, from the canvas too.
    timeline.scrub([0.4])
    hand.pad.focus()
    page.keyboard.press("k")
    book.wait_for("len(editor.poses) == 4")
    np.testing.assert_allclose(timeline.times, [0, 0.4, 0.8, 1.5], atol=0.03)
