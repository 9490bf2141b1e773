"""A shape that overlaps itself, in a real browser: canvas, picture and exported page agree."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Locator

from ..support.browser import bring_into_view
from .conftest import OpenNotebook
from .editor_page import Hand
from .test_timeline_browser import Timeline

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A bar, red at the left and blue at the right, bent beyond a full circle.
_CANVAS = """
import numpy as np
import glid_nb as glid
glid.enable_compilation_cache()
x = np.linspace(-9, 9, 73)
loop = np.concatenate([np.stack([s * x, 0 * x - 0.8 * s], 1) for s in (1, -1)])
domain = glid.Domain.from_cage(glid.Cage(loop))
picture = np.full((200, 400, 4), 255, np.uint8)
picture[:, :200, 1:3] = picture[:, 200:, :2] = 0
canvas = glid.widgets.DeformCanvas(picture, domain, 500, 400, n_vertices=1500)
model = canvas.deformation
canvas
"""
_CURL = """
start, turn = glid.HarmonicMap.identity(domain), 2j * np.pi / 15
phi = np.where(start.phi != 0, (np.exp(turn * start.phi) - 1) / turn, 0)
curled, handles = glid.HarmonicMap(domain, phi, start.psi), [[-8.6, 0], [0, 0], [8.6, 0]]
model.paused = True
model.apply(lambda state: state.changed(pose=glid.Pose(handles, curled(handles)), map=curled))
canvas.fit()
along, across = np.meshgrid(np.linspace(6.6, 8.2, 12), np.linspace(-0.55, 0.55, 5))
places = curled(np.stack([along, across], -1).reshape(-1, 2))

def frame(size):
    from glid_nb.imaging.render import frame_of
    return frame_of(glid.PixelFrame(*picture.shape[1::-1]), model.map, size, "fit")

def in_picture():
    seen = glid.render(picture, model.map, (400, 400), view="fit", pose=model.pose)
    x, y = frame((400, 400)).to_pixel(places).astype(int).T
    return (seen[y, x, 2] > seen[y, x, 0]).tolist()
"""
_COLORS = """(canvas, places) => {
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext('2d');
  pen.drawImage(canvas, 0, 0);
  const at = ([u, v]) => pen.getImageData(u * copy.width, v * copy.height, 1, 1).data;
  return places.map((place) => Array.from(at(place)));
}"""


def in_front(canvas: Locator, shares: Any) -> list[bool]:
    """For places of a canvas, as shares of its size, whether its colour is the right end's."""
    colors = np.array(canvas.evaluate(_COLORS, shares))[:, [0, 2]]
    assert (abs(np.diff(colors.astype(int), axis=1)) > 100).all(), colors
    return (colors[:, 1] > colors[:, 0]).tolist()


def test_canvas_picture_page_and_clicks_agree(open_notebook: OpenNotebook, tmp_path: Path) -> None:
    book = open_notebook([_CANVAS])
    hand = Hand(book)
    book.value("None", _CURL)
    drawn = hand.pane.locator(".jupyter-threejs canvas")

    def seen_on_canvas() -> list[bool]:
        position = "canvas.pane.scene.picture.attributes['position'].array.ravel().tolist()"
        hand.wait_for_attribute("position", book.value(position))
        hand.wait_until_drawn()
        (x, y, unit), places = book.value("[canvas.pane.stage.view, places.tolist()]")
        shares = (np.array(places) - [x, y]) / unit * [1, -1] / [500, 400] + 0.5
        return in_front(drawn, shares.tolist())

    def seen_on_page() -> list[bool]:
        path = tmp_path / "page.html"
        page_html = "glid.export.page_html(picture, model.map, pose=model.pose)"
        path.write_text(book.value(page_html), encoding="utf-8")
        page = hand.page.context.new_page()
        page.goto(path.as_uri())
        page.wait_for_selector("html[data-ready=true]", state="attached")
        canvas = page.locator("canvas")
        width, height = canvas.evaluate("(c) => [c.clientWidth, c.clientHeight]")
        shares = book.value(
            f"(frame(({width}, {height})).to_pixel(places) / [{width}, {height}]).tolist()"
        )
        seen = in_front(canvas, shares)
        page.close()
        return seen

    for right_in_front in (True, False):
        if not right_in_front:
            book.value("None", "model.select([2, 3])")
            hand.page.keyboard.press("PageDown")
            book.wait_for("model.pose.depths.tolist() == [0, 0, -1, -1]")
        expected = [right_in_front] * 60
        assert book.value("in_picture()") == expected
        assert seen_on_canvas() == expected
        assert seen_on_page() == expected
        # A click pins the visible part. A handle on the covered end looks covered.
        count = len(hand.handles)
        hand.click(book.value(f"places[{31 if right_in_front else 5}].tolist()"))
        book.wait_for(f"len(model.pose) == {count + 1}")
        assert (hand.handles[-1][0] > 0) == right_in_front
        covered = book.value("canvas.pane.stage.marks['hidden']")
        assert covered == ([0] if right_in_front else [2, 3])
        book.screenshot(f"order-{'front' if right_in_front else 'back'}")
    hand.page.keyboard.press("Control+z")
    hand.page.keyboard.press("Control+z")
    book.wait_for("not model.pose.depths.any()")
    assert seen_on_canvas() == [True] * 60


_TIMELINE = """
import ipywidgets
from glid_nb.widgets import TimelinePanel
panel = TimelinePanel(canvas)
box = ipywidgets.VBox([canvas, panel])
box
"""
_DEPTHS = """
from dataclasses import replace
from glid_nb.session.document import AS_SEEN

def show(depth):
    pose = glid.Pose(handles, curled(handles), [0, 0, depth])
    seen = dict(pose=pose, map=curled, solution=AS_SEEN)
    model.apply(lambda state: state.with_current(replace(state.current, **seen)))

show(1)
model.save_pose()
show(-1)
canvas.show_panels = True
"""


def test_in_a_motion_the_order_and_the_boundary_are_those_of_its_time(
    open_notebook: OpenNotebook,
) -> None:
    book = open_notebook([_CANVAS.removesuffix("canvas\n") + _TIMELINE])
    hand = Hand(book)
    book.value("None", _CURL + _DEPTHS)
    book.wait_for("[s.status for s in panel.animation.spans] == ['proved']", 60)
    book.page.wait_for_function("() => document.querySelectorAll('.glid-computing').length === 0")
    timeline, drawn = Timeline(hand), hand.pane.locator(".jupyter-threejs canvas")
    legend = hand.pane.locator(".glid-legend-title")

    def seen() -> list[bool]:
        hand.wait_until_drawn()
        (x, y, unit), places = book.value("[canvas.pane.stage.view, places.tolist()]")
        shares = (np.array(places) - [x, y]) / unit * [1, -1] / [500, 400] + 0.5
        return in_front(drawn, shares.tolist())

    assert seen() == [False] * 60
    assert legend.inner_text() == "Certified σ₂ on the boundary"
    for time, right_in_front in ((0.1, True), (0.9, False), (0.2, True)):
        bring_into_view(timeline.root)
        timeline.scrub([time])
        assert timeline.time == pytest.approx(time, abs=0.02)
        hand.page.wait_for_timeout(300)
        assert seen() == [right_in_front] * 60
        assert legend.inner_text() == "σ₂ on the boundary now"
        book.screenshot(f"order-at-{time}")
    hand.page.keyboard.press("Escape")
    hand.page.wait_for_timeout(300)
    assert seen() == [False] * 60
    assert legend.inner_text() == "Certified σ₂ on the boundary"
