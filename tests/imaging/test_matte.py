"""The shape cut out of a photograph: soft edges without the colours of the old background."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from glid_nb import Cage, cut_out, samples, trace
from glid_nb._arrays import Array
from glid_nb.imaging import TraceError
from glid_nb.imaging.matte import filled_loops

SIZE = 220


def photograph(seed: int = 0) -> tuple[Array, Array, Array]:
    """A hairy blob before a wall: the picture (h, w, 3), its true alpha and its true colours."""
    noise = np.random.default_rng(seed)
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5 - SIZE / 2
    angle, away = np.arctan2(y, x), np.hypot(x, y)
    hair = 3 * np.abs(np.sin(25 * angle)) ** 3
    alpha = ((60 + 8 * np.cos(3 * angle) + hair - away) / 2.5 + 0.5).clip(0, 1)
    shape = np.array([150, 90, 40]) + 25 * np.sin(x / 5)[..., None] * [1, 1, 0.5]
    wall = np.array([190, 205, 225]) + 20 * np.cos(y / 40)[..., None]
    picture = alpha[..., None] * shape + (1 - alpha[..., None]) * wall
    picture = picture + noise.normal(0, 1.5, picture.shape)
    return np.rint(picture).clip(0, 255).astype(np.uint8), alpha, shape


def over(rgba: Array, colour: Array) -> Array:
    alpha = rgba[..., 3:] / 255
    return rgba[..., :3] * alpha + colour * (1 - alpha)


@pytest.mark.parametrize("seed", [0, 1])
def test_edges_have_no_halo_of_the_old_background_and_stay_soft(seed: int) -> None:
    picture, alpha, shape = photograph(seed)
    tracing = trace(picture)
    cage = filled_loops(tracing.cage, tracing.frame)
    cut = cut_out(picture, tracing)
    green = np.array([20, 200, 60])
    truth = alpha[..., None] * shape + (1 - alpha[..., None]) * green
    before = np.where(cage[..., None], picture, green)
    edge = cage & (alpha < 1)
    error_before = np.abs(before - truth)[edge].mean()
    error_after = np.abs(over(cut, green) - truth)[edge].mean()
    assert error_before > 60
    assert error_after < 6
    soft = (alpha > 0.2) & (alpha < 0.8)
    assert np.abs(cut[..., 3] / 255 - alpha)[soft].mean() < 0.08
    assert np.abs(cut[..., :3] - shape)[soft].mean() < 12  # the wall is 80 away


def test_the_inside_is_the_picture_and_the_outside_is_empty() -> None:
    picture, alpha, _ = photograph()
    cut = cut_out(picture, trace(picture))
    inside = gaussian_filter(alpha, 3) > 0.9999
    outside = gaussian_filter(alpha, 3) < 0.0001
    np.testing.assert_array_equal(cut[inside], np.insert(picture[inside], 3, 255, axis=1))
    assert not cut[outside].any()
    assert not cut.flags.writeable


def test_the_same_picture_is_cut_out_the_same_way() -> None:
    picture, _, _ = photograph()
    tracing = trace(picture)
    np.testing.assert_array_equal(cut_out(picture, tracing), cut_out(picture, trace(picture)))


def test_a_picture_with_transparency_of_its_own_is_unchanged() -> None:
    picture = samples.image("gingerbread")
    np.testing.assert_array_equal(cut_out(picture, trace(picture)), picture)


def test_a_scaled_solve_is_close_to_the_full_one(monkeypatch: pytest.MonkeyPatch) -> None:
    picture, _, _ = photograph()
    tracing = trace(picture)
    full = cut_out(picture, tracing)
    monkeypatch.setattr("glid_nb.imaging.matte._MOST_UNKNOWNS", 1500)
    scaled = cut_out(picture, tracing)
    edge = (full[..., 3] > 0) & (full[..., 3] < 255)
    assert np.abs(full[..., 3][edge] / 255 - scaled[..., 3][edge] / 255).mean() < 0.1


def test_what_an_edited_cage_has_more_belongs_to_the_shape() -> None:
    picture, _, _ = photograph()
    tracing = trace(picture)
    exterior = tracing.cage.exterior.copy()
    top = int(np.argmax(exterior[:, 1]))
    exterior[top, 1] += 2.0
    cut = cut_out(picture, tracing, Cage(exterior))
    x, y = tracing.frame.to_pixel(exterior[top] - [0, 1.0])
    column = cut[int(y) : SIZE // 2, int(x), 3]
    assert (column > 250).all()  # up to the shape, without a gap
    assert not cut_out(picture, tracing)[int(y), int(x)].any()


def test_a_picture_of_another_size_is_refused() -> None:
    picture, _, _ = photograph()
    with pytest.raises(TraceError, match="200 x 220 pixels, but the tracing is of 220 x 220"):
        cut_out(picture[:, :200], trace(picture))
