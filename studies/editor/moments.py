"""The moments of an hour with the editor, each reached by hand.

A chapter is a generator. It acts through the page alone, by pointer and keys, and yields a name
each time there is something to look at. What the kernel says only tells the hand where to point
and when to go on.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from glid_nb import samples
from glid_nb.io import load_pose
from tests.support.browser import NotebookPage
from tests.widgets.editor_page import Hand, choose_view, line
from tests.widgets.test_tracer_browser import Hand as TracerHand

SAMPLE = "gecko"
CELL = f"""
import os, tempfile
os.environ["GLID_NB_DATA"] = tempfile.mkdtemp()  # no kept work is offered
import glid_nb as glid
glid.enable_compilation_cache()
editor = glid.Editor(glid.samples.image({SAMPLE!r}))
editor
"""
# A red disk and a blue square, which are kept as parts.
ISLANDS = """
import numpy as np
import os, tempfile
os.environ["GLID_NB_DATA"] = tempfile.mkdtemp()  # no kept work is offered
import glid_nb as glid
glid.enable_compilation_cache()
rows, columns = np.mgrid[:160, :240]
picture = np.zeros((160, 240, 4), np.uint8)
picture[np.hypot(columns - 60, rows - 80) < 42] = (220, 40, 40, 255)
picture[50:110, 150:210] = (40, 80, 220, 255)
editor = glid.Editor(picture)
editor
"""
HEAD, HAND, OTHER_HAND, FOOT, OTHER_FOOT, CHEST, HIP, *_, TAIL = load_pose(
    samples.pose_path(SAMPLE, "gentle")
).handles.tolist()
POSES = "len(editor.poses) == {}"
RING = 42  # pixels from a pin to its ring
# Whether the canvas has taken the room of the whole screen.
FILLED = """() => {
  const pad = document.querySelector('.glid-editor .glid-pad').getBoundingClientRect();
  return Math.abs(pad.width - innerWidth) < 20;
}"""


class Chapters:
    """The chapters of an hour with one editor, in their order."""

    def __init__(self, book: NotebookPage) -> None:
        self.book, self.page = book, book.page
        self.hand = Hand(book, canvas="editor.canvas")

    def pins(self) -> Iterator[str]:
        """Pinned, dragged, turned, selected, and the menu of a place."""
        hand, page = self.hand, self.page
        yield "opened"
        hand.click(HEAD)
        self.wait_for_pins(1)
        yield "one-pin"
        for count, point in enumerate((HIP, TAIL), start=2):
            hand.click(point)
            self.wait_for_pins(count)
        hand.settle()
        middle = [TAIL[0] + 3, TAIL[1] + 3]
        places = hand.places(line(TAIL, middle, 12))
        page.mouse.move(*places[0])
        page.mouse.down()
        for place in places[1:]:
            page.mouse.move(*place)
        yield "dragging"
        page.mouse.up()
        hand.wait_for_target(2, middle)
        for pin, at in ((0, HEAD), (1, HIP)):
            hand.click(at)
            self.book.wait_for(f"editor.deformation.selection == ({pin},)")
            self.turn(at, 0.6)
            self.book.wait_for(f"editor.pose.oriented[{pin}]")
            hand.settle()
        yield "two-turned"
        page.keyboard.press("a")
        self.book.wait_for("len(editor.deformation.selection) == 3")
        yield "several-selected"
        hand.click(HEAD, button="right")
        page.get_by_role("menuitem", name="Remove").first.wait_for()
        yield "menu"
        page.keyboard.press("Escape")

    def brush(self) -> Iterator[str]:
        """A stiff area while it is painted, and after."""
        hand, page = self.hand, self.page
        hand.pad.focus()
        page.keyboard.press("b")
        self.book.wait_for("editor.canvas.brush.tool == 'stiff'")
        places = hand.places(line(HEAD, CHEST, 12))
        page.mouse.move(*places[0])
        page.mouse.down()
        for place in places[1:]:
            page.mouse.move(*place)
        yield "stiff-stroke"
        page.mouse.up()
        self.book.wait_for("editor.pose.stiffness")
        hand.settle()
        yield "stiff-area"
        page.keyboard.press("Escape")

    def inspector(self) -> Iterator[str]:
        """Each of its sections, with one pin selected."""
        self.hand.click([TAIL[0] + 3, TAIL[1] + 3])
        for section in ("Motion", "Files", "Proof", "Pin"):
            self.page.get_by_role("tab", name=section, exact=True).click()
            yield f"section-{section.lower()}"

    def views(self) -> Iterator[str]:
        """The menu of views, an overlay with its legend, plots beside the canvas, the keys."""
        page = self.page
        page.locator(".glid-view-button").click()
        yield "view-menu"
        page.keyboard.press("Escape")
        choose_view(page, "Stretch σ₁")
        self.hand.settle()
        yield "overlay"
        choose_view(page, "Plots")
        page.locator(".glid-plots").wait_for()
        self.book.wait_for("editor.monitor.image.format == 'png'")
        yield "plots"
        choose_view(page, "Plots")
        choose_view(page, "Picture")
        self.hand.pad.focus()
        page.keyboard.press("?")
        page.locator(".glid-help:popover-open").wait_for()
        yield "keys"
        page.keyboard.press("Escape")

    def timeline(self) -> Iterator[str]:
        """Three keyframes, an ease, playing, the whole screen."""
        hand, page, root = self.hand, self.page, self.page.locator(".glid-timeline")
        at = [TAIL[0] + 3, TAIL[1] + 3]
        for count, step in ((2, [0.0, -3.0]), (3, [-2.0, 0.0])):
            hand.pad.focus()
            page.keyboard.press("k")
            self.book.wait_for(POSES.format(count))
            hand.settle()
            goal = [at[0] + step[0], at[1] + step[1]]
            hand.drag(line(at, goal, 10))
            hand.wait_for_target(2, goal)
            at = goal
        self.book.wait_for("all(s.status == 'proved' for s in editor.timeline.animation.spans)", 90)
        yield "three-keyframes"
        root.get_by_role("button", name="Easing of the motion").click()
        root.locator(".glid-ease").wait_for()
        yield "ease"
        page.keyboard.press("Escape")
        # There and back: the motion does not end before it was pictured in every look.
        root.get_by_label("Play once, in a loop, or there and back").select_option("ping-pong")
        page.get_by_role("button", name="Play, pause").first.click()
        root.locator(".glid-playhead.glid-seen").wait_for()
        yield "playing"
        page.get_by_role("button", name="Play, pause").first.click()
        root.locator(".glid-ruler").press("End")  # where the edited pose is
        hand.pad.focus()
        page.keyboard.press("w")
        page.wait_for_function("!!document.fullscreenElement")
        page.wait_for_function(FILLED)
        hand.wait_until_still()
        yield "whole-screen"
        page.evaluate("document.exitFullscreen()")
        page.wait_for_function("!document.fullscreenElement")

    def refusals(self) -> Iterator[str]:
        """A number that is none, and a pin where its shape cannot follow."""
        hand, page = self.hand, self.page
        angle = page.get_by_label("Angle °")
        angle.fill("much")
        page.keyboard.press("Enter")
        page.get_by_text("is not a number").first.wait_for()
        yield "not-a-number"
        angle.fill("")
        page.keyboard.press("Enter")
        start = self.book.value("editor.pose.targets[0].tolist()")
        hand.click(start)
        self.book.wait_for("editor.deformation.selection == (0,)")
        hand.drag(line(start, [start[0] + 3, start[1] - 30], 12))
        hand.settle()
        yield "pulled-too-far"
        hand.pad.focus()
        page.keyboard.press("Control+z")
        hand.settle()

    def tracing(self) -> Iterator[str]:
        """The Trace tab, and its knife through the tail."""
        page = self.page
        page.get_by_role("tab", name="Trace", exact=True).click()
        tracer = TracerHand(self.book)  # type: ignore[arg-type]  # any page with a kernel
        tracer.settle()
        yield "trace"
        frame = "editor.tracer.tracing_model.frame.to_pixel({}).tolist()"
        (x, y), *_ = self.book.value(frame.format([HIP]))
        reach = 0.06 * self.book.value("max(editor.tracer.image.shape)")
        tracer.stage.locator("canvas").focus()
        page.keyboard.press("k")
        tracer.root.get_by_role("button", name="Cut with the knife (K)", pressed=True).wait_for()
        page.mouse.move(*tracer.place(x, y - 0.5 * reach))
        page.mouse.down()
        page.mouse.move(*tracer.place(x, y + 0.5 * reach), steps=8)
        yield "knife-line"
        page.mouse.up()
        tracer.settle()
        yield "knife-cut"
        page.get_by_role("tab", name="Deform", exact=True).click()

    def turn(self, at: list[float], angle: float) -> None:
        """Pull the ring of a pin around it."""
        ring = RING * self.book.value("editor.canvas.pane.stage.view[2]")
        way = ring * np.exp(1j * np.linspace(0.8, 0.8 + angle, 9))
        self.hand.drag([[at[0] + z.real, at[1] + z.imag] for z in way])

    def wait_for_pins(self, count: int) -> None:
        self.book.wait_for(f"len(editor.pose) == {count}")


class PartsChapters:
    """Two islands of a picture, kept as parts."""

    def __init__(self, book: NotebookPage) -> None:
        self.book, self.page = book, book.page
        self.hand = Hand(book, canvas="editor.canvas")

    def parts(self) -> Iterator[str]:
        """The question, the list of parts, a pin in each."""
        self.page.get_by_role("tab", name="Trace", exact=True).click()
        keep = self.page.locator(".glid-panel").get_by_role("button", name="Keep all as parts")
        keep.wait_for()
        yield "islands"
        keep.click()
        self.book.wait_for("len(editor.deformation.state.parts) == 2")
        self.page.locator(".glid-parts").wait_for()
        centres = self.book.value(
            "[p.domain.cage.exterior.mean(axis=0).tolist() for p in editor.deformation.state.parts]"
        )
        for part in (1, 0):
            self.hand.click(centres[part])
            self.book.wait_for(f"editor.deformation.state.part == {part}")
            self.hand.settle()
        self.hand.drag(line(centres[0], [centres[0][0] + 3, centres[0][1]], 10))
        self.hand.settle()
        yield "parts"
