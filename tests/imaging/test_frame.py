"""Pixels to world coordinates and back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from glid_nb.imaging import PixelFrame, TraceError

sides = st.integers(1, 8000)
coordinates = st.floats(-1e4, 1e4)


def test_corners_and_centre_of_a_wide_picture():
    frame = PixelFrame(width=200, height=100)
    corners = [[0, 0], [200, 0], [0, 100], [200, 100]]
    assert frame.to_world(corners).tolist() == [[-10, 5], [10, 5], [-10, -5], [10, -5]]
    assert frame.to_world([100, 50]).tolist() == [0, 0]
    assert frame.bounds == (-10, -5, 10, 5)
    assert frame.units_per_pixel == 0.1


def test_the_longer_side_of_a_high_picture_is_20_units():
    frame = PixelFrame(width=30, height=120)
    low, high = frame.to_world([[0, 120], [30, 0]])
    np.testing.assert_allclose(high - low, [5, 20], rtol=1e-14)


def test_the_centre_of_a_pixel():
    # Row 0, column 1 of a 2 x 2 picture: the upper right one.
    assert PixelFrame(2, 2).to_world([1.5, 0.5]).tolist() == [5, 5]


@pytest.mark.slow
@given(sides, sides, st.lists(st.tuples(coordinates, coordinates), max_size=5))
def test_there_and_back(width, height, points):
    frame = PixelFrame(width, height)
    pixels = np.array(points, dtype=float).reshape(-1, 2)
    scale = 1e-12 * (1e4 + max(width, height))
    np.testing.assert_allclose(frame.to_pixel(frame.to_world(pixels)), pixels, atol=scale)
    world = pixels * frame.units_per_pixel
    back = frame.to_world(frame.to_pixel(world))
    np.testing.assert_allclose(back, world, atol=scale * frame.units_per_pixel)


@given(sides, sides)
def test_y_points_up_and_lengths_scale_alike(width, height):
    frame = PixelFrame(width, height)
    origin, right, down = frame.to_world([[3, 4], [4, 4], [3, 5]])
    unit = frame.units_per_pixel
    np.testing.assert_allclose(right - origin, [unit, 0], atol=1e-11)
    np.testing.assert_allclose(down - origin, [0, -unit], atol=1e-11)


def test_any_leading_shape():
    frame = PixelFrame(40, 30)
    points = np.arange(24.0).reshape(3, 4, 2)
    assert frame.to_world(points).shape == (3, 4, 2)
    np.testing.assert_array_equal(frame.to_world(points)[1, 2], frame.to_world(points[1, 2]))
    assert frame.to_pixel(np.zeros((0, 2))).shape == (0, 2)


def test_index_at():
    frame = PixelFrame(40, 30)
    assert frame.index_at((0, 0)) == (0, 0)
    assert frame.index_at((39.9, 29.9)) == (29, 39)
    for outside in [(-0.1, 3), (40, 3), (3, 30), (np.nan, 3)]:
        with pytest.raises(TraceError, match=r"picked: the pixel .* outside the image of 40 x 30"):
            frame.index_at(outside, "picked")


@pytest.mark.parametrize("width", [0, -3, 2.5, True, "3", None])
def test_a_wrong_width(width):
    with pytest.raises(TraceError, match="width must be a whole number of at least 1 pixels, not"):
        PixelFrame(width, 10)


def test_a_wrong_height():
    with pytest.raises(TraceError, match="height must be"):
        PixelFrame(10, 0)


def test_numpy_sizes_are_accepted_and_equal():
    frame = PixelFrame(*np.array([7, 5]))
    assert frame == PixelFrame(7, 5)
    assert type(frame.width) is int


@pytest.mark.parametrize("points", [[1.0, 2.0, 3.0], [[1.0]], 5.0])
def test_points_of_a_wrong_shape(points):
    with pytest.raises(TraceError, match=r"shape \(\.\.\., 2\)"):
        PixelFrame(10, 10).to_world(points)
    with pytest.raises(TraceError, match=r"shape \(\.\.\., 2\)"):
        PixelFrame(10, 10).to_pixel(points)
