"""What a new user sees, as screenshots to look at, at three sizes in both themes.

Left out without ``--minutes``. ``$GLID_NB_ARTEFACTS`` names the folder of the screenshots.
"""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

import glid_nb

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import Hand, line
from .test_editors_browser import RESTART
from .test_tracer_browser import Hand as Tracer

pytestmark = [pytest.mark.browser, pytest.mark.long, pytest.mark.timeout(900)]

CELL = """
import os
os.environ["GLID_NB_DATA"] = {data!r}
import skimage.data
import glid_nb as glid
editor = glid.Editor({picture})
editor
"""
PINS = glid_nb.io.load_pose(glid_nb.samples.pose_path("gecko", "gentle")).handles.tolist()


class Walk:
    """A notebook with an editor in a window, with one screenshot after another."""

    def __init__(
        self, opened: OpenNotebook, picture: str, size: tuple[int, int], theme: str, data: Path
    ) -> None:
        window = {"viewport": {"width": size[0], "height": size[1]}, "service_workers": "block"}
        cell = CELL.format(data=str(data), picture=picture)  # no kept work is offered
        self.book = opened([cell], **window)
        self.page, self.name, self.taken = self.book.page, f"{size[0]}-{theme}", itertools.count(1)
        self.book.theme(f"JupyterLab {theme}")
        self.page.locator("#jupyterlab-splash").wait_for(state="detached")

    def shot(self, what: str) -> None:
        top = "document.querySelector('.glid-editor').scrollIntoView({block: 'start'})"
        self.page.evaluate(top)
        self.page.wait_for_load_state("networkidle")
        self.book.screenshot(f"walk-{self.name}-{next(self.taken):02}-{what}".lower())


@pytest.fixture(params=["Light", "Dark"])
def theme(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(params=[(1366, 768), (1920, 1080), (800, 768)], ids=lambda size: str(size[0]))
def size(request: pytest.FixtureRequest) -> tuple[int, int]:
    return request.param


def test_a_cut_out(
    open_notebook: OpenNotebook, tmp_path: Path, size: tuple[int, int], theme: str
) -> None:
    walk = Walk(open_notebook, "glid.samples.image('gecko')", size, theme, tmp_path)
    book, page, shot = walk.book, walk.page, walk.shot

    def files(button: str) -> None:
        page.locator(".glid-files button", has_text=button).click()

    # Pins, the tail in front of the body, the head turned, named and stiff.
    shot("opened")
    hand = Hand(book, canvas="editor.canvas")
    for count, point in enumerate(PINS, 1):
        hand.click(point)
        book.wait_for(f"len(editor.pose) == {count}")
    (x, y), tail = PINS[0], PINS[-1]
    hand.drag(line(tail, [tail[0] + 5, tail[1] + 6], 20))
    page.keyboard.press("PageUp")
    book.wait_for("editor.pose.depths.any()")
    hand.settle()
    shot("tail-in-front")
    hand.click((x, y))
    book.wait_for("editor.deformation.selection == (0,)")
    ring = 42 * book.value("editor.canvas.pane.stage.view[2]")
    turn = ring * np.exp(1j * np.linspace(0.8, 1.4, 9))
    hand.drag([[x + z.real, y + z.imag] for z in turn])
    page.get_by_title("The selected pin's name").fill("head")
    hand.pad.focus()
    book.wait_for("editor.pose.names[0] == 'head' and editor.pose.oriented[0]")
    hand.settle()
    shot("head-turned-and-named")
    page.keyboard.press("b")
    hand.drag(line([x - 0.7, y], [x + 0.7, y], 10))
    book.wait_for("editor.pose.stiffness")
    hand.settle()
    shot("stiff-head")
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Key", exact=True).click()
    book.wait_for("len(editor.poses) == 2")
    raised = [PINS[1][0], PINS[1][1] + 2]
    hand.drag(line(PINS[1], raised, 10))
    hand.wait_for_target(1, raised)

    # Mistakes, and their remedies.
    page.get_by_label("Angle °").fill("much")
    page.keyboard.press("Enter")
    page.get_by_text("is not a number").wait_for()
    shot("mistake")
    hand.click((x, y), button="right")
    shot("menu")
    page.keyboard.press("Escape")
    page.keyboard.press("?")
    shot("help")
    page.keyboard.press("Escape")
    page.get_by_role("tab", name="Proof").click()
    shot("proof")

    # The kernel is restarted. The work comes back, is saved, exported and opened again.
    page.evaluate(RESTART)
    page.locator(".glid-editor.jupyter-widgets-disconnected").wait_for()
    shot("restarted")
    book.run_all()
    page.get_by_role("button", name="Restore it").click()
    book.wait_for(f"len(editor.pose) == {len(PINS)} and editor.pose.names[0] == 'head'")
    shot("brought-back")
    page.get_by_role("tab", name="Files").click()
    page.get_by_placeholder("Name.glid").fill(str(tmp_path / "gecko.glid"))
    files("Save")
    page.get_by_text("Saved").wait_for()
    files("Write here")
    page.get_by_text("Wrote gecko.png").wait_for()
    shot("exported")
    book.value("None", setup="before = editor.canvas")
    files("Open")
    page.get_by_text("Wrote gecko.png").wait_for(state="detached")
    book.wait_for("editor.canvas is not before and editor.pose.names[0] == 'head'")
    Hand(book, canvas="editor.canvas").wait_until_drawn()
    shot("reopened")
    assert (tmp_path / "gecko.png").stat().st_size > 10_000


def test_a_photograph(
    open_notebook: OpenNotebook, tmp_path: Path, size: tuple[int, int], theme: str
) -> None:
    """Its outline is drawn by hand."""
    walk = Walk(open_notebook, "skimage.data.chelsea()", size, theme, tmp_path)
    book, page, shot = walk.book, walk.page, walk.shot
    page.get_by_text("The outline is not clear").wait_for()
    shot("photograph")
    page.get_by_role("button", name="Draw its outline").click()
    tracer = Tracer(book)
    bring_into_view(tracer.stage)
    for corner in ((150, 30), (310, 60), (330, 210), (220, 290), (80, 250), (70, 90)):
        page.mouse.click(*tracer.place(*corner))
    page.keyboard.press("Enter")
    book.wait_for("editor.tracer.cage.n_holes == 0")
    tracer.settle()
    shot("photograph-outlined")
    page.get_by_role("tab", name="Deform").click()
    hand = Hand(book, canvas="editor.canvas")
    hand.click([-5.0, 0.0])
    hand.drag(line([0.0, 0.0], [2.0, 2.0], 10))
    book.wait_for("len(editor.pose) == 2 and editor.pose.targets[1, 1] > 1")
    hand.settle()
    shot("photograph-dragged")
    assert hand.certified()
