"""A background lies behind the shape in every export that draws a picture."""

from __future__ import annotations

import base64
import io
import re
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb import InputError, Motion, render
from glid_nb.export import animation_bytes, live_page_html, motion_files, page_html, picture_png
from glid_nb.harmonic import HarmonicMap

from ..support.shapes import SIZE, bent, domain, picture

WALL = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
WALL[:, : SIZE[0] // 2] = (250, 200, 10)
WALL[:, SIZE[0] // 2 :] = (10, 60, 250)
SMALL: Any = {"size": 64, "frames_per_second": 3.0}


def opened(data: bytes) -> np.ndarray:
    with Image.open(io.BytesIO(data)) as read:
        return np.asarray(read.convert("RGBA")).astype(int)


def test_without_a_background_a_picture_is_as_before() -> None:
    plain = render(picture(), bent())
    np.testing.assert_array_equal(plain, render(picture(), bent(), background=None))
    assert not plain[2, 2].any()


def test_a_picture_is_drawn_over_another_one_of_the_same_place() -> None:
    plain, drawn = (opened(picture_png(picture(), bent(), background=b)) for b in (None, WALL))
    alpha = plain[..., 3:] / 255
    both = plain[..., :3] * alpha + WALL * (1 - alpha)
    assert np.abs(drawn[..., :3] - both).max() <= 1.5
    assert (drawn[..., 3] == 255).all()


def test_a_picture_is_drawn_over_a_colour() -> None:
    drawn = render(picture(), bent(), view="fit", background=(1, 2, 3))
    assert drawn[0, 0].tolist() == [1, 2, 3, 255]


def test_moved_labels_have_no_background() -> None:
    with pytest.raises(InputError, match="use fill"):
        render(np.ones(SIZE[::-1]), bent(), interpolation="nearest", background=(0, 0, 0))


def test_frames_show_the_rectangle_of_the_background() -> None:
    motion = Motion([HarmonicMap.identity(domain()), bent()])
    for name in ("walk.gif", "walk.apng"):
        first = opened(motion_files(name, picture(), motion, background=WALL, **SMALL)[name])
        assert first.shape[:2] == (44, 64)  # 64 x 42.7, with even sides
        assert (first[..., 3] == 255).all()
        assert np.abs(first[1, 1, :3] - [250, 200, 10]).max() < 12
        assert np.abs(first[-2, -2, :3] - [10, 60, 250]).max() < 12
        assert np.abs(first[22, 29, :3] - WALL[100, 137]).max() < 12  # the hole of the ring
    data = animation_bytes(picture(), [bent()], size=64, format="apng", background=WALL)
    assert np.abs(opened(data)[1, 1, :3] - [250, 200, 10]).max() < 12


def test_pages_have_the_background_behind_their_canvas() -> None:
    pages = (page_html, live_page_html)
    for made in pages:
        assert "main canvas:first-child {" not in made(picture(), bent())
        assert "main canvas:first-child { background: rgb(1 2 3); }" in made(
            picture(), bent(), background=(1, 2, 3)
        )
        page = made(picture(), bent(), background=WALL)
        found = re.search(
            r"main canvas:first-child \{ background: url\(data:image/jpeg;base64,(.*?)\)", page
        )
        assert found is not None
        behind = opened(base64.b64decode(found[1]))
        assert np.abs(behind[..., :3] - WALL)[:, 20:120].max() < 12


def test_the_page_of_a_motion_has_a_ground_of_its_own_instead_of_white() -> None:
    motion = Motion([HarmonicMap.identity(domain()), bent()])
    page = motion_files("walk.html", picture(), motion)["walk.html"].decode()
    assert "main canvas:first-child {" not in page
    page = motion_files("walk.html", picture(), motion, background=WALL)["walk.html"].decode()
    assert "main canvas:first-child { background: url(" in page
