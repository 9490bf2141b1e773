"""Transparent texels have the colours of the visible texels beside them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from glid_nb.imaging.bleed import bled


def disc(size: int, radius: float, colour: tuple[int, int, int] = (0, 0, 0)) -> NDArray[np.uint8]:
    """An anti-aliased disc of one colour on transparent white."""
    y, x = np.mgrid[:size, :size] + 0.5 - size / 2
    alpha = np.clip(radius - np.hypot(x, y) + 0.5, 0, 1)
    pixels = np.dstack([np.full((size, size, 3), 255.0), 255 * alpha])
    pixels[alpha > 0, :3] = colour
    return np.rint(pixels).astype(np.uint8)


@pytest.mark.parametrize("size", [64, 63, 200, 7])
def test_a_disc_of_one_colour_has_it_everywhere(size: int) -> None:
    image = disc(size, size / 4, (10, 90, 200))
    result = bled(image)
    np.testing.assert_array_equal(result[..., 3], image[..., 3])
    assert (result[..., :3] == (10, 90, 200)).all()


def test_what_is_seen_stays_and_the_picture_itself() -> None:
    image = disc(50, 15)
    image[..., :3] = np.random.default_rng(0).integers(0, 256, (50, 50, 3))
    before = image.copy()
    result = bled(image)
    np.testing.assert_array_equal(image, before)
    seen = image[..., 3] > 0
    np.testing.assert_array_equal(result[seen], image[seen])


def test_the_rim_takes_its_own_colour() -> None:
    """Each half bleeds to its own side."""
    image = disc(80, 25, (200, 0, 0))
    image[:, 40:, :3][image[:, 40:, 3] > 0] = (0, 0, 200)
    result = bled(image)
    assert (result[38, 12] == (200, 0, 0, 0)).all()
    assert (result[38, 67] == (0, 0, 200, 0)).all()
    assert (result[..., 1] == 0).all()


def test_block_means_hold_no_foreign_colour() -> None:
    """As mipmaps with straight alpha are made."""
    result = bled(disc(128, 30, (0, 0, 0)))
    for n in (2, 4, 8, 16, 32, 64, 128):
        assert not result[..., :3].reshape(128 // n, n, 128 // n, n, 3).mean(axis=(1, 3)).any()


@pytest.mark.parametrize("alpha", [0, 255])
def test_without_an_edge_nothing_changes(alpha: int) -> None:
    image = np.full((5, 9, 4), (1, 2, 3, alpha), np.uint8)
    np.testing.assert_array_equal(bled(image), image)


@pytest.mark.parametrize("place", [(0, 0), (8, 4), (4, 8)])
def test_one_pixel_colours_all(place: tuple[int, int]) -> None:
    image = np.zeros((9, 9, 4), np.uint8)
    image[place] = 50, 60, 70, 255
    assert (bled(image)[..., :3] == (50, 60, 70)).all()
