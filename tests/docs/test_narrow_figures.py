"""The pictures of several panels that a phone shows."""

from __future__ import annotations

import io
import json

import numpy as np
from PIL import Image, ImageDraw

from docs.extensions import narrow_figures as narrow
from glid_nb.figures.drawing import PARTS

COLORS = [(200, 0, 0), (0, 200, 0), (0, 0, 200)]


def picture(*boxes: tuple[int, int, int, int]) -> Image.Image:
    """A white picture with parts in colours, one pixel for each CSS pixel."""
    made = Image.new("RGB", (800, 300), "white")
    for (x, y, wide, high), color in zip(boxes, COLORS, strict=False):
        ImageDraw.Draw(made).rectangle((x, y, x + wide - 1, y + high - 1), fill=color)
    made.info[PARTS] = json.dumps(boxes)
    return made


def places(made: Image.Image) -> list[list[int]]:
    """The box of each colour: left, top, right and bottom pixel."""
    pixels = np.asarray(made.convert("RGB"))
    found = []
    for color in COLORS:
        rows, columns = np.nonzero((pixels == color).all(axis=2))
        if len(rows):
            edges = columns.min(), rows.min(), columns.max(), rows.max()
            found.append([int(edge) for edge in edges])
    return found


def test_panels_come_below_each_other_in_the_middle_and_whole() -> None:
    made = narrow.narrow(picture((0, 0, 300, 200), (400, 0, 300, 200)), 800)
    assert made is not None
    first, second = places(made)
    assert second[1] == first[3] + 1
    assert first[0] == second[0] == (made.width - 300) // 2
    assert [first[2] - first[0], first[3] - first[1]] == [299, 199]


def test_small_panels_share_a_row() -> None:
    made = narrow.narrow(picture((0, 0, 150, 100), (200, 0, 150, 100), (400, 0, 300, 100)), 800)
    assert made is not None
    first, second, third = places(made)
    assert first[1] == second[1] < third[1]


def test_a_panel_that_is_wider_than_a_phone_is_drawn_smaller_by_the_page() -> None:
    """No pixel is lost: the page shows the whole picture at the phone's width."""
    made = narrow.narrow(picture((0, 0, 500, 200), (520, 0, 200, 200)), 800)
    assert made is not None
    assert made.width == 500
    assert len(places(made)) == 2


def test_letters_are_legible() -> None:
    tall = [(0, 0, 340, 600), (350, 0, 340, 600), (700, 0, 90, 600)]
    assert narrow.best_scale(tall) >= 0.75


def test_a_picture_of_one_panel_stays_as_it_is() -> None:
    assert narrow.narrow(Image.new("RGB", (800, 300)), 800) is None


def test_a_palette_is_kept() -> None:
    file = io.BytesIO()
    whole = picture((0, 0, 300, 200), (400, 0, 300, 200))
    reduced = whole.quantize(8)
    reduced.info[PARTS] = whole.info[PARTS]
    made = narrow.narrow(reduced, 800)
    assert made is not None
    made.save(file, "png")
    assert made.mode == "P"
    assert made.convert("RGB").getpixel((0, 150)) == (255, 255, 255)
    assert len(places(made)) == 2
