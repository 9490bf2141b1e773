"""Displacement fields in other programs: what they read is what the map says."""

from __future__ import annotations

from typing import Any

import numpy as np
import SimpleITK
from numpy.typing import NDArray
from skimage import transform

import glid_nb as glid

from ..harmonic.test_inverse import gentle

SIDE = 80
FRAME = glid.PixelFrame(SIDE, SIDE)


def in_itk(field: Any) -> Any:
    """A transform of SimpleITK, as the how-to page makes it."""
    image = SimpleITK.GetImageFromArray(field.values, isVector=True)
    image.SetOrigin([v - 0.5 for v in field.origin])
    image.SetSpacing(field.spacing)
    return SimpleITK.DisplacementFieldTransform(image)


def picture() -> NDArray[np.float64]:
    y, x = np.mgrid[:SIDE, :SIDE]
    return 100 + 50 * np.sin(x / 9) * np.cos(y / 11)


def test_itk_moves_points_as_the_map_and_back() -> None:
    map = gentle("ell")
    rng = np.random.default_rng(2)
    pixels = FRAME.to_pixel(rng.uniform(-2.4, -0.6, (50, 2)))
    for inverse in (False, True):
        field = map.displacement_field(FRAME, (60, 50), inverse=inverse)
        itk = in_itk(field)
        moved = np.array([itk.TransformPoint((p - 0.5).tolist()) for p in pixels]) + 0.5
        places = FRAME.to_world(pixels)
        true = FRAME.to_pixel(map.inverse(places) if inverse else map(places))
        assert np.linalg.norm(moved - true, axis=1).max() <= field.error + 1e-9


def test_itk_resamples_a_picture_as_scikit_image_does() -> None:
    map, image = gentle("ell"), picture()
    field = map.displacement_field(FRAME, inverse=True)
    source = SimpleITK.GetImageFromArray(image)
    seen = SimpleITK.GetArrayFromImage(
        SimpleITK.Resample(source, source, in_itk(field), SimpleITK.sitkLinear)
    )

    def preimages(pixels: NDArray[np.float64]) -> NDArray[np.float64]:
        return FRAME.to_pixel(map.inverse(FRAME.to_world(pixels + 0.5))) - 0.5

    wanted = transform.warp(image, preimages, order=1, preserve_range=True)
    inside = field.known & (wanted > 0)
    assert inside.mean() > 0.05
    assert abs(seen - wanted)[inside].max() < 1.0


def test_a_layer_of_napari_begins_at_the_samples_and_ends_at_their_images() -> None:
    map = gentle("ell")
    field = map.displacement_field(FRAME, (30, 30))
    start, step = field.vectors.transpose(1, 0, 2)
    # In napari a point is (row, column), and the first pixel's centre is (0, 0).
    pixels = start[:, ::-1] + 0.5
    true = FRAME.to_pixel(map(FRAME.to_world(pixels))) - pixels
    np.testing.assert_allclose(step[:, ::-1], true, atol=1e-9)
