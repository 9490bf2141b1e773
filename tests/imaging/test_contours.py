"""Marching squares, beside scikit-image's."""

from __future__ import annotations

import numpy as np
import pytest
from skimage.measure import find_contours

from glid_nb.imaging.contours import closed_contours


def from_least_vertex(loops):
    """The loops in an order that does not depend on where each begins."""
    turned = [np.roll(loop, -np.lexsort(loop.T[::-1])[0], axis=0) for loop in loops]
    return sorted(turned, key=lambda loop: loop[0].tolist())


@pytest.mark.parametrize("size", [3, 5, 12, 60])
@pytest.mark.parametrize("seed", range(5))
def test_noise_with_all_its_corners_and_holes(size: int, seed: int):
    field = np.random.default_rng(seed).random((size, size + seed)).astype(np.float32) - 0.5
    field[[0, -1]] = field[:, [0, -1]] = -0.3
    expected = [loop[:-1] for loop in find_contours(field, 0.0, fully_connected="high")]
    loops = closed_contours(field)
    assert len(loops) == len(expected)
    for one, other in zip(from_least_vertex(loops), from_least_vertex(expected), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-6)


def test_nothing_positive():
    assert closed_contours(np.full((4, 5), -1.0)) == []
