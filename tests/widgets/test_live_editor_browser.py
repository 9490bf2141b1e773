"""The live editor in JupyterLab and in marimo: the page solves, and the kernel gets its maps."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from glid_nb.session.document_file import load_document

from ..support.browser import ARTEFACTS, bring_into_view, marimo_server
from .conftest import OpenNotebook

pytestmark = [pytest.mark.browser, pytest.mark.slow]

LIVE = """
import glid_nb as glid
live = glid.widgets.LiveEditor(glid.samples.image("bar"), height=420)
live
"""
MARIMO = """
import marimo

app = marimo.App()


@app.cell
def _():
    import glid_nb as glid
    import marimo

    live = marimo.ui.anywidget(glid.widgets.LiveEditor(glid.samples.image("bar")))
    live
    return glid, live, marimo


@app.cell
def _(live, marimo):
    live.value  # runs this cell again after each change
    pose = live.widget.pose
    images = (live.widget.map(pose.handles).round(1) + 0.0).tolist()
    marimo.md(f"The page's pins are at {images}.")
    return


@app.cell
def _(glid):
    glid.Editor(glid.samples.image("gecko"), "session.glid")
    return
"""
WAIT_FOR_A_DRAG = """
import threading
moved = threading.Event()
live.observe(lambda _: live.pose.targets[1, 1] > 1 and moved.set(), ["edit"])
in_time = moved.wait(60)
"""
LEFT, RIGHT, UP = (-6.0, 0.0), (6.0, 0.0), (5.5, 2.0)


class LivePage:
    """A live page in a frame of another page, for a hand."""

    def __init__(self, page: Page, number: int = 0) -> None:
        self.page, self._box = page, page.locator("iframe[title='Live picture']").nth(number)
        bring_into_view(self._box)
        self.root = self._box.content_frame.locator("html")
        self._wait_for("ready")

    def _wait_for(self, what: str) -> None:
        self.root.and_(self._box.content_frame.locator(f"[data-{what}=true]")).wait_for(
            state="attached", timeout=60_000
        )

    def place(self, point: tuple[float, float]) -> tuple[float, float]:
        box = self._box.bounding_box()
        assert box is not None
        x, y = self.root.evaluate("(_, at) => window.glidPage.view.toScreen(at)", list(point))
        return box["x"] + x, box["y"] + y

    def pin(self, *points: tuple[float, float]) -> None:
        for point in points:
            self.page.mouse.click(*self.place(point))

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        self.page.mouse.move(*self.place(start))
        self.page.mouse.down()
        self.page.mouse.move(*self.place(end), steps=6)
        self.page.mouse.up()
        self._wait_for("settled")


def pins_in(session: Path) -> int:
    """How many pins the session file has; 0 without a file."""
    return len(load_document(session).poses[0].pose) if session.exists() else 0


def test_a_page_and_its_kernel_tell_each_other_also_during_a_cell(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([LIVE])
    hand = LivePage(book.page)
    hand.pin(LEFT, RIGHT)
    book.wait_for("len(live.pose) == 2")
    # Code that waits for an event, which only a drag on the page sets.
    with book.running(WAIT_FOR_A_DRAG):
        hand.drag(RIGHT, UP)
    assert book.value("in_time")
    reached = "live.map(live.pose.handles).tolist()"
    np.testing.assert_allclose(book.value(reached), [LEFT, UP], atol=0.05)
    assert book.value("live.certificate.certified")
    book.screenshot("live-editor-lab")

    book.value("setattr(live, 'pose', glid.Pose([[-6, 0], [6, 0]], [[-6, 0], [5, -2]]))")
    book.wait_for(f"abs({reached}[1][1] + 2) < 0.01")  # solved by the page


def test_marimo_shows_an_editor_and_gets_its_poses(page: Page, tmp_path: Path) -> None:
    notebook = tmp_path / "notebook.py"
    notebook.write_text(MARIMO, encoding="utf-8")
    with marimo_server(notebook, tmp_path / "marimo.log") as url:
        page.goto(url)
        hand = LivePage(page)
        hand.pin(LEFT, RIGHT)
        page.get_by_text("pins are at [[-6.0, 0.0], [6.0, 0.0]]").wait_for()
        hand.drag(RIGHT, UP)
        page.get_by_text("pins are at [[-6.0, 0.0], [5.5, 2.0]]").wait_for()
        # An editor itself shows its live editor, and saves what the page sends.
        LivePage(page, 1).pin((0.0, 0.0))
        until = time.monotonic() + 60
        while not pins_in(tmp_path / "session.glid"):
            assert time.monotonic() < until
            page.wait_for_timeout(100)  # the file has no event for us
        page.screenshot(path=ARTEFACTS / "live-editor-marimo.png", full_page=True)
