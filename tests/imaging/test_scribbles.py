"""Scribbles: probabilities of a random walker, independent of earlier pictures and strokes."""

from __future__ import annotations

import importlib

import numpy as np
import pytest
from skimage import data
from skimage.segmentation import random_walker

from glid_nb.imaging import Scribbles, TraceOptions, Tracer, read_image
from glid_nb.imaging.foreground import find_foreground
from glid_nb.imaging.scribbles import scaled_picture

STROKES = [[(40.0, 60.0), (120.0, 60.0)]]


@pytest.mark.parametrize("transparent", [False, True])
def test_the_walker_is_that_of_scikit_image_on_premultiplied_colours(transparent: bool):
    image = np.array(read_image(data.coffee())[100:220, 200:360])
    if transparent:
        image[:30, :, 3] = 100
    labels = np.zeros(image.shape[:2], dtype=np.int32)
    labels[[0, -1], :] = labels[:, [0, -1]] = 2
    labels[60, 40:121] = 1
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
    found = find_foreground(image, "scribbles", scribbles=Scribbles(STROKES))
    np.testing.assert_allclose(found.score, np.clip(expected[0], 0, 1), atol=1e-5)


def test_a_large_picture_is_walked_on_at_40_000_pixels():
    height, width = scaled_picture(np.tile(read_image(data.coffee()), (3, 2, 1))).shape[:2]
    assert 39_000 < height * width <= 40_400
    assert abs(height / width - 1) < 0.01


def test_no_contrast_hinders_nowhere():
    # The pixels differ by less than a step of 8 bits, so the walker sees a picture of one colour.
    image = np.full((9, 9, 4), 257 * 100, dtype=np.uint16)
    image[3, 3, 0] += 1
    inner = np.zeros((9, 9), dtype=bool)
    inner[4, 4] = True
    score = find_foreground(image, "scribbles", scribbles=Scribbles(inner)).score
    assert np.isfinite(score).all()
    assert score[4, 4] == 1
    np.testing.assert_allclose(score, score[::-1, ::-1], atol=1e-4)


@pytest.mark.slow
def test_a_picture_is_prepared_once_for_all_scribbles(monkeypatch: pytest.MonkeyPatch):
    prepared = []
    module = importlib.import_module("glid_nb.imaging.trace")  # the function has the same name
    monkeypatch.setattr(
        module, "scaled_picture", lambda image: prepared.append(image) or scaled_picture(image)
    )
    tracer = Tracer(data.coffee())
    tracer.trace()
    assert not prepared
    for x in (250, 300, 350):
        tracer.trace(TraceOptions(scribbles=Scribbles([[(x, 150), (x + 40, 180)]])))
    assert len(prepared) == 1


@pytest.mark.parametrize("seed", range(3))
def test_any_strokes_after_any_others_give_what_they_give_alone(seed: int):
    rng = np.random.default_rng(seed)
    image = rng.integers(0, 255, (60, 80, 4), dtype=np.uint8)
    tracer = Tracer(image)
    foreground = np.zeros((60, 80), dtype=bool)
    background = foreground.copy()
    foreground[30, 25:55] = True
    for _ in range(4):
        row, column = rng.integers(1, 59), rng.integers(1, 60)
        # Strokes are drawn, taken back, and drawn over others.
        for mask in (foreground, background):
            mask[row, column : column + rng.integers(1, 20)] = rng.integers(2)
        options = TraceOptions(scribbles=Scribbles(foreground, background))
        alone = Tracer(image).foreground(options).score
        assert np.abs(tracer.foreground(options).score - alone).max() < 2e-4


@pytest.mark.parametrize("shape", [(1, 300), (300, 1), (1, 8_000)])
def test_a_thin_picture(shape: tuple[int, int]):
    image = np.full((*shape, 4), 255, dtype=np.uint8)
    length = max(shape)
    image.reshape(-1, 4)[length // 3 : 2 * length // 3, :3] = 0
    ends = np.zeros(shape, dtype=bool)
    ends.flat[0] = ends.flat[-1] = True
    middle = np.zeros(shape, dtype=bool)
    middle.flat[length // 2] = True
    found = find_foreground(image, "scribbles", scribbles=Scribbles(middle, ends))
    assert np.mean(found.mask() == (image[..., 0] == 0)) > 0.99
