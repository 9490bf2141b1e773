"""The editor outside JupyterLab: in Notebook and under Voila."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from ..browser import LabNotebook, VoilaPage
from .conftest import OpenNotebook
from .editor_page import EDITOR, SETUP, Hand, line

pytestmark = [pytest.mark.browser, pytest.mark.slow]

INTERFACES = {
    "notebook": functools.partial(LabNotebook, interface="notebook"),
    "voila": VoilaPage,
}


@pytest.mark.parametrize("name", INTERFACES)
def test_a_handle_is_dragged(open_notebook: OpenNotebook, name: str) -> None:
    book = open_notebook([SETUP, EDITOR], INTERFACES[name])
    hand = Hand(book)
    hand.click((-6.0, 0.0))
    book.wait_for("len(model.pose) == 1")
    # A pull on the shape pins the point and takes it along.
    hand.drag(line((6.0, 0.0), (6.5, 2.0), 15))
    book.wait_for("len(model.pose) == 2")
    hand.wait_for_target(1, (6.5, 2.0))
    np.testing.assert_allclose(hand.handles, [(-6.0, 0.0), (6.0, 0.0)], atol=0.1)
    assert hand.certified()
    gap = book.value("float(abs(model.map(model.pose.handles) - model.pose.targets).max())")
    assert gap < 0.01
    # The page shows the map: 10 pixels of the picture are one unit, green and blue count them.
    points = [[-3.0, 1.0], [2.5, -0.5], [5.5, 1.0]]
    for (x, _), image in zip(points, book.value(f"model.map({points}).tolist()"), strict=True):
        wanted = np.array([100 + 10 * x, 155 - 10 * x])
        hand.wait_for_color(image, lambda seen, w=wanted: bool(abs(seen[1:3] - w).max() < 6))
    book.page.locator(".glid-editor").get_by_text("Converged").first.wait_for()
    book.screenshot(f"editor-{name}")
