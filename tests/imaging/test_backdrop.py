"""What lies behind the shape: a colour, or the old picture with its hole filled in."""

import numpy as np
import pytest

from glid_nb import InputError, filled_in, samples, trace
from glid_nb.imaging import PixelFrame, TraceError
from glid_nb.imaging.backdrop import check_background, drawn_backdrop, over


def test_a_hole_in_a_slope_of_colours_is_filled_with_the_slope() -> None:
    y, x = np.mgrid[:160, :200] + 0.5
    slope = np.stack([200 - 0.3 * x, 120 + 0.4 * y, np.full(x.shape, 210.0)], axis=-1)
    disc = np.hypot(x - 100, y - 80) < 40
    picture = np.where(disc[..., None], [60, 20, 20], slope).astype(np.uint8)
    tracing = trace(picture, background=(0.68, 0.6, 0.82))
    behind = filled_in(picture, tracing)
    assert behind.shape == (160, 200, 4)
    assert (behind[..., 3] == 255).all()
    assert np.abs(behind[..., :3] - slope)[disc].max() < 9
    far = np.hypot(x - 100, y - 80) > 60
    np.testing.assert_array_equal(behind[far][:, :3], picture[far])


def test_a_large_picture_is_filled_in_a_scaled_one() -> None:
    y, x = np.mgrid[:1200, :1200]
    disc = np.hypot(x - 600, y - 600) < 400
    picture = np.where(disc[..., None], [10, 10, 10], [200, 180, 160]).astype(np.uint8)
    behind = filled_in(picture, trace(picture))
    assert np.abs(behind[..., :3].astype(int) - [200, 180, 160]).max() <= 2


def test_nothing_is_known_behind_a_transparent_picture() -> None:
    picture = samples.image("gingerbread")
    with pytest.raises(TraceError, match="nothing of its background is known"):
        filled_in(picture, trace(picture))


def test_a_picture_lies_at_its_own_place_in_another_frame() -> None:
    picture = np.zeros((20, 40, 3), np.uint8)
    picture[:, 20:] = 200
    frame = PixelFrame(80, 80)  # the same width in the world, twice as high
    behind = drawn_backdrop(check_background(picture), frame)
    assert behind is not None
    assert not behind[:20].any()
    assert behind[40, 10].tolist() == [0, 0, 0, 255]
    assert behind[40, 70].tolist() == [200, 200, 200, 255]


def test_pixels_are_drawn_over_a_colour_or_over_nothing() -> None:
    pixels = np.full((2, 2, 4), (100, 0, 0, 128), np.uint8)
    assert over(pixels, None) is pixels
    behind = drawn_backdrop((0, 0, 200), PixelFrame(2, 2))
    assert over(pixels, behind)[0, 0].tolist() == [50, 0, 100, 255]


@pytest.mark.parametrize("wrong", ["red", (1, 2), (0, 0, 256), (0.5, 0, 0)])
def test_other_backgrounds_are_refused(wrong: object) -> None:
    with pytest.raises(
        InputError, match="must be three whole numbers from 0 to 255, a picture or None"
    ):
        check_background(wrong)
