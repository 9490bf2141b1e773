"""The random walker, beside scikit-image's."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image
from skimage import data
from skimage.segmentation import random_walker

from glid_nb.imaging import Scribbles, TraceOptions, Tracer, read_image
from glid_nb.imaging.foreground.scribbles import enlarged
from glid_nb.imaging.foreground.walker import BACKGROUND, FOREGROUND, Walker


def labels_for(walker: Walker) -> np.ndarray:
    height, width = walker.shape
    labels = np.zeros((height, width), dtype=np.int32)
    labels[[0, -1], :] = labels[:, [0, -1]] = BACKGROUND
    labels[height // 2, width // 3 : 2 * width // 3] = FOREGROUND
    return labels


@pytest.mark.parametrize("transparent", [False, True])
def test_it_is_that_of_scikit_image(transparent: bool):
    image = np.array(read_image(data.coffee())[100:220, 200:360])
    if transparent:
        image[:30, :, 3] = 100
    walker = Walker.of(image)
    labels = labels_for(walker)
    assert walker.shape == image.shape[:2]
    values = image / 255.0
    values[..., :3] *= values[..., 3:]
    expected = random_walker(
        values if transparent else values[..., :3],
        labels,
        beta=1000.0,
        mode="bf",
        channel_axis=-1,
        return_full_prob=True,
    )
    np.testing.assert_allclose(walker.probability(labels), np.clip(expected[0], 0, 1), atol=1e-5)


def test_a_large_picture_is_walked_on_at_40_000_pixels():
    height, width = Walker.of(np.tile(read_image(data.coffee()), (3, 2, 1))).shape
    assert 39_000 < height * width <= 40_400
    assert abs(height / width - 1) < 0.01


def test_no_contrast_hinders_nowhere():
    walker = Walker.of(np.zeros((9, 9, 4), dtype=np.uint8))
    probability = walker.probability(labels_for(walker))
    assert np.isfinite(probability).all()
    assert probability[4, 4] == 1


def test_nothing_left_to_walk_on():
    walker = Walker.of(np.zeros((4, 4, 4), dtype=np.uint8))
    labels = np.full((4, 4), BACKGROUND)
    labels[1, 1] = FOREGROUND
    np.testing.assert_array_equal(walker.probability(labels), labels == FOREGROUND)


def test_a_picture_is_prepared_once_for_all_scribbles(monkeypatch: pytest.MonkeyPatch):
    prepared = []
    of = Walker.of
    monkeypatch.setattr(Walker, "of", lambda image: prepared.append(image) or of(image))
    tracer = Tracer(data.coffee())
    tracer.trace()
    assert not prepared
    for x in (250, 300, 350):
        tracer.trace(TraceOptions(scribbles=Scribbles([[(x, 150), (x + 40, 180)]])))
    assert len(prepared) == 1


def test_strokes_that_grow_are_followed_by_the_first_factor(monkeypatch: pytest.MonkeyPatch):
    image = read_image(data.coffee())
    walker = Walker.of(image)
    labels = labels_for(walker)
    walker.probability(labels)
    direct = walker._direct
    monkeypatch.setattr(walker, "_direct", lambda *_: pytest.fail("another factor"))
    row, column = walker.shape[0] // 2, walker.shape[1] // 3
    for k in range(1, 6):
        labels[row + k, column : column + 6] = FOREGROUND
        labels[5 + k, 20:24] = BACKGROUND
        exact = Walker(walker.across, walker.down).probability(labels)
        assert np.abs(walker.probability(labels) - exact).max() < 1e-4
    monkeypatch.setattr(walker, "_direct", direct)
    # Without the rim there are more pixels to walk on than the factor knows.
    labels[[0, -1], :] = labels[:, [0, -1]] = 0
    exact = Walker(walker.across, walker.down).probability(labels)
    np.testing.assert_array_equal(walker.probability(labels), exact)


@pytest.mark.parametrize("seed", range(3))
def test_any_strokes_after_any_others_give_what_they_give_alone(seed: int):
    rng = np.random.default_rng(seed)
    walker = Walker.of(rng.integers(0, 255, (60, 80, 4), dtype=np.uint8))
    labels = labels_for(walker)
    for _ in range(12):
        row, column = rng.integers(1, 59), rng.integers(1, 60)
        # Strokes are drawn, taken back, and drawn over others.
        labels[row, column : column + rng.integers(1, 20)] = rng.integers(0, 3)
        exact = Walker(walker.across, walker.down).probability(labels)
        assert np.abs(walker.probability(labels) - exact).max() < 2e-4


@pytest.mark.parametrize("shape", [(190, 300), (187, 214), (1000, 215)])
def test_a_field_is_enlarged_as_pillow_does_it(shape: tuple[int, int]):
    field = np.random.default_rng(0).random((187, 214), dtype=np.float32)
    size = shape[1], shape[0]
    expected = np.asarray(Image.fromarray(field).resize(size, Image.Resampling.BILINEAR))
    np.testing.assert_allclose(enlarged(field, shape), expected, atol=1e-6)


@pytest.mark.parametrize("small", [(1, 1), (1, 5), (5, 1)])
def test_a_thin_field_is_enlarged_too(small: tuple[int, int]):
    field = np.ones(small, dtype=np.float32)
    np.testing.assert_array_equal(enlarged(field, (7, 20)), np.ones((7, 20)))
