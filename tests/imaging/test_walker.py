"""The random walker, beside scikit-image's."""

from __future__ import annotations

import numpy as np
import pytest
from skimage import data
from skimage.segmentation import random_walker

from glid_nb.imaging import Scribbles, TraceOptions, Tracer, read_image
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
