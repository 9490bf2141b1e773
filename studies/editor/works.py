"""Three works by hand, each from the picture to a GIF, and how long they take a person.

    python -m studies.editor.works OUT [--works walk wave rocket]

A walk cycle; a waving arm that was drawn across the body, cut loose with the knife; a photographed
rocket before its own background, filled in. Run it from the repository's root; it needs the extra
`test` and Chromium. Everything is done in the page, by pointer and keys; the kernel is only asked
where things are and whether it is ready. A person is reckoned with CLICK seconds for a click or a
key and DRAG seconds for a drag or a stroke; waiting is measured. OUT gets WORK.gif and pictures of
the window on the way.
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

from PIL import Image
from playwright.sync_api import Locator, Page

from docs.howto.draw_knife import LINE, SHOULDER, figure
from tests.support.browser import JupyterServer, LabNotebook, launched_chromium, watched_page
from tests.widgets.editor_page import Hand, line
from tests.widgets.test_timeline_browser import PINS, STEPS, Timeline
from tests.widgets.test_tracer_browser import Hand as TracerHand

CLICK, DRAG = 1.0, 2.0
Point = Sequence[float]
EDITOR = """
import os, tempfile
os.environ["GLID_NB_DATA"] = tempfile.mkdtemp()  # no kept work is offered
import glid_nb as glid
picture = {}
editor = glid.Editor(picture)
editor
"""


class Animator:
    """A person at an editor of a picture, with two clocks: acting and waiting."""

    def __init__(
        self, page: Page, server: JupyterServer, picture: str, out: Path, name: str
    ) -> None:
        self.page, self.out, self.name = page, out, name
        self.acting = self.waiting = 0.0
        with self.waited():
            self.book = LabNotebook(page, server, [EDITOR.format(picture)])
            page.locator(".glid-editor").wait_for()
        page.locator(".glid-editor").evaluate("(one) => one.scrollIntoView()")

    @contextlib.contextmanager
    def waited(self) -> Iterator[None]:
        """Wait in the block, on the clock."""
        start = time.monotonic()
        yield
        self.waiting += time.monotonic() - start

    def wait_for(self, condition: str, timeout: float = 90) -> None:
        with self.waited():
            self.book.wait_for(condition, timeout)

    def deform(self) -> None:
        """Take the Deform tab's canvas in hand."""
        with self.waited():
            self.hand = Hand(self.book, canvas="editor.canvas")
            self.timeline = Timeline(self.hand)

    def shot(self, moment: str) -> None:
        self.page.screenshot(path=self.out / f"{self.name}-{moment}.png")

    def press(self, key: str) -> None:
        self.acting += CLICK
        self.page.keyboard.press(key)

    def click(self, on: Locator) -> None:
        self.acting += CLICK
        on.click()

    def button(self, name: str) -> None:
        self.click(self.page.get_by_role("button", name=name).first)

    def pin(self, places: Sequence[Point]) -> None:
        for count, place in enumerate(places, start=1):
            self.acting += CLICK
            self.hand.click(place)
            self.wait_for(f"len(editor.deformation.pose) == {count}")

    def select(self, pin: int) -> None:
        self.acting += CLICK
        self.hand.click(self.book.value(f"editor.deformation.pose.targets[{pin}].tolist()"))
        self.wait_for(f"editor.deformation.selection == ({pin},)")

    def drag(self, pin: int, to: Point, between: float | None = None) -> None:
        """Drag a pin from where it is, or from where the motion shows its place at a time."""
        where = f"editor.deformation.pose.targets[{pin}].tolist()"
        if between is not None:
            shown = f"editor.timeline.animation.at({between})"
            where = f"{shown}(editor.deformation.pose.handles[[{pin}]])[0].tolist()"
        start = self.book.value(where)
        self.acting += DRAG
        self.hand.drag(line(start, to, 12))
        with self.waited():
            self.hand.wait_for_target(pin, to)

    def key(self) -> None:
        """Make a keyframe, and continue with a copy."""
        count = self.book.value("len(editor.poses)")
        self.hand.pad.focus()
        self.press("k")
        self.wait_for(f"len(editor.poses) == {count + 1}")
        with self.waited():
            self.hand.settle()

    def move_key(self, index: int, to: float) -> None:
        """Move a keyframe to another time."""
        self.acting += DRAG
        with self.waited():
            self.timeline.settle()
        self.timeline.hold(index, to)
        self.page.mouse.up()
        self.wait_for(f"abs(editor.deformation.state.timeline.times[{index}] - {to}) < 0.021")

    def at_time(self, time: float) -> None:
        """Put the playhead to a time."""
        self.acting += CLICK
        self.timeline.scrub([time])

    def repeat(self, how: str) -> None:
        self.acting += 2 * CLICK
        self.timeline.root.locator("select").select_option(label=how)

    def play(self) -> None:
        """Look at the motion once it is proved."""
        self.wait_for("all(s.status == 'proved' for s in editor.timeline.animation.spans)")
        self.button("Play")
        self.page.locator(".glid-playhead.glid-seen").wait_for()
        self.shot("playing")
        self.button("Play")  # and pause

    def write_gif(self) -> None:
        """Export the motion with the button of the timeline, through the browser's downloads."""
        self.button("Export the motion")
        with self.waited(), self.page.expect_download(timeout=180_000) as sent:
            self.button("Download")
        sent.value.save_as(self.out / f"{self.name}.gif")
        self.acting += CLICK
        self.shot("exported")

    def __str__(self) -> str:
        total, acting, waiting = self.acting + self.waiting, self.acting, self.waiting
        with Image.open(self.out / f"{self.name}.gif") as gif:
            frames = f"{gif.n_frames} frames of {gif.width} x {gif.height}"  # type: ignore[attr-defined]
        return f"{self.name}: {total:.0f} s, acting {acting:.0f}, waiting {waiting:.0f}; {frames}"


def walk(page: Page, server: JupyterServer, out: Path) -> Animator:
    """Four keyframes of a step, in a loop of a second. The poses between are keyed by dragging."""
    me = Animator(page, server, "glid.samples.image('gingerbread')", out, "walk")
    me.deform()
    me.shot("opened")
    me.pin(PINS)

    def step(limbs: Sequence[Point], between: float | None = None) -> None:
        for pin, place in enumerate(limbs, start=1):
            me.drag(pin, place, between)
            between = None  # the drag has made a keyframe

    step(STEPS[1])
    me.key()
    step(STEPS[3])
    me.move_key(1, 0.5)
    me.at_time(0.25)
    me.shot("between")
    step(STEPS[2], 0.25)
    me.wait_for("len(editor.poses) == 3")
    me.repeat("Loop")
    me.shot("keyed")
    me.play()
    me.write_gif()
    return me


def wave(page: Page, server: JupyterServer, out: Path) -> Animator:
    """An arm that hangs along the body is cut loose, waves, and passes in front of the chest."""
    Image.fromarray(figure()).save(server.notebooks / "figure.png")
    me = Animator(page, server, "glid.read_image('figure.png')", out, "wave")
    me.click(page.get_by_role("tab", name="Trace", exact=True))
    knife = TracerHand(me.book)
    with me.waited():
        knife.settle()
    knife.stage.locator("canvas").focus()
    me.press("k")
    me.acting += DRAG
    knife.drag(*((x, y) for x, y in LINE))
    with me.waited():
        knife.settle()
    me.shot("cut")
    me.click(page.get_by_role("tab", name="Deform", exact=True))
    me.deform()
    wanted = [[330, 345], SHOULDER, [250, 100], [235, 290], [205, 440], [285, 440]]
    to_world = "editor.tracer.tracing_model.frame.to_world({}).tolist()"
    me.pin(me.book.value(to_world.format(wanted)))
    (up, out_there, across) = me.book.value(to_world.format([[430, 80], [440, 200], [222, 285]]))
    me.select(0)
    me.press("PageUp")
    me.drag(0, across)
    me.shot("in-front")
    for place in (out_there, up):
        me.key()
        me.drag(0, place)
    me.repeat("Ping-pong")
    me.shot("keyed")
    me.play()
    me.write_gif()
    return me


def rocket(page: Page, server: JupyterServer, out: Path) -> Animator:
    """A photographed rocket is painted over, dances, and its background is filled in."""
    me = Animator(page, server, "__import__('skimage.data').data.rocket()", out, "rocket")
    me.shot("opened")
    brush = TracerHand(me.book)  # the outline is not clear, so the brush is in the hand
    with me.waited():
        brush.settle()
    strokes = {
        "": [[(322, 142), (322, 270), (322, 395)]],
        "n": [[(295, 120), (297, 390)], [(350, 390), (350, 120)], [(300, 105), (345, 105)]],
    }
    for key, lines in strokes.items():
        if key:
            me.press(key)
        for stroke in lines:
            me.acting += DRAG
            brush.drag(*stroke)
            with me.waited():
                brush.settle()
    me.shot("painted")
    me.click(page.get_by_role("tab", name="Deform", exact=True))
    me.deform()
    to_world = "editor.tracer.tracing_model.frame.to_world({}).tolist()"
    pixels = [[322, 390], [322, 330], [322, 240], [322, 145]]
    me.pin(me.book.value(to_world.format(pixels)))
    left, right, middle = me.book.value(to_world.format([[275, 160], [370, 160], [322, 105]]))
    me.click(page.get_by_role("tab", name="Files", exact=True))
    me.acting += 2 * CLICK
    page.locator(".glid-files select").first.select_option(label="The old picture, filled in")
    me.wait_for("editor.canvas.pane.stage.view[2] > 0.025")  # the whole picture is seen
    me.shot("filled")
    me.drag(3, left)
    for place in (middle, right):
        me.key()
        me.drag(3, place)
    me.repeat("Ping-pong")
    me.shot("keyed")
    me.play()
    me.write_gif()
    return me


WORKS = {"walk": walk, "wave": wave, "rocket": rocket}


def main() -> None:
    """Do the works and print their times."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--works", nargs="+", choices=WORKS, default=list(WORKS))
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, launched_chromium() as browser:
        server = JupyterServer(Path(folder) / "jupyter")
        try:
            for name in chosen.works:
                with watched_page(browser) as page:
                    print(WORKS[name](page, server, chosen.out), flush=True)
        finally:
            server.close()


if __name__ == "__main__":
    main()
