"""The canvas shows what lies behind the shape, in a real browser."""

from __future__ import annotations

import pytest

from .conftest import OpenNotebook
from .editor_page import Hand

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A red disk before a wall that is yellow at the left and blue at the right.
_EDITOR = """
import numpy as np
import glid_nb as glid
glid.enable_compilation_cache()
y, x = np.mgrid[:200, :300] + 0.5
wall = np.where((x < 150)[..., None], [230, 200, 20], [20, 60, 230])
disk = (np.hypot(x - 150, y - 100) < 60)[..., None]
picture = np.where(disk, [200, 30, 30], wall).astype(np.uint8)
strokes = glid.Scribbles([[[110, 100], [190, 100]]], [[[20, 20], [280, 20], [280, 180], [20, 180]]])
editor = glid.Editor(picture, n_vertices=600, width=560, height=400)
editor.model.tracing.paint("foreground", strokes.foreground[0])
editor.model.tracing.paint("background", strokes.background[0])
editor.model.apply_tracing()
editor.tabs.selected_index = 1
editor.background = "filled"
canvas, model = editor.canvas, editor.deformation
editor
"""


def test_the_old_picture_lies_behind_the_shape(open_notebook: OpenNotebook) -> None:
    book = open_notebook([_EDITOR])
    hand = Hand(book)

    def wait_for(point: list[float], wanted: list[int]) -> None:
        hand.wait_for_color(
            point, lambda color: all(abs(a - b) < 25 for a, b in zip(color, wanted, strict=False))
        )

    wait_for([-5, 3], [230, 200, 20])
    wait_for([5, 3], [20, 60, 230])
    wait_for([0, 0], [200, 30, 30])
    book.screenshot("old-picture-behind")
    book.value("None", "editor.background = (10, 90, 30)")
    wait_for([-5, 3], [10, 90, 30])
    wait_for([0, 0], [200, 30, 30])
