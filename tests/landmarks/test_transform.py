"""The protocol of scikit-image's transforms."""

from __future__ import annotations

import numpy as np
import pytest
from skimage.transform import warp

from glid_nb.geometry import Domain, GeometryError
from glid_nb.harmonic import HarmonicMap
from glid_nb.landmarks import HarmonicTransform, LandmarkError

pytestmark = pytest.mark.slow

PICTURE = np.add.outer(np.arange(40.0), 2 * np.arange(60.0)) / 160
SRC = np.array([[5.0, 5], [55, 5], [30, 20], [5, 35], [55, 35]])
DST = SRC + np.array([[0, 0], [0, 0], [3, 2], [0, 0], [0, 0]])


def test_code_for_a_thin_plate_spline_runs_with_another_name() -> None:
    transform = HarmonicTransform.from_estimate(SRC, DST, domain=Domain.rectangle(PICTURE))
    assert transform.residuals(SRC, DST).max() < 0.1
    assert np.allclose(transform.inverse(transform(SRC)), SRC, atol=1e-9)
    assert np.isfinite(transform([[500.0, 0.0]])).all()
    warped = warp(PICTURE, transform.inverse, cval=-1)
    assert warped[22, 33] == pytest.approx(PICTURE[20, 30], abs=0.02)
    assert HarmonicTransform.from_estimate(SRC, DST).residuals(SRC, DST).max() < 0.1


def test_landmarks_of_a_symmetric_pattern_are_met() -> None:
    """Four coefficients can only miss them: the middle is the mean of the corners, moved or not."""
    src = np.array([[100.0, 100], [400, 100], [250, 250], [100, 400], [400, 400]])
    dst = src + np.array([[0, 0], [0, 0], [30, -20], [0, 0], [0, 0]])
    for domain in (Domain.rectangle((512, 512)), None):
        transform = HarmonicTransform.from_estimate(src, dst, domain=domain)
        assert transform.residuals(src, dst).max() < 0.1
    coarse = Domain.rectangle((512, 512), pieces=1)
    assert HarmonicTransform.from_estimate(src, dst, domain=coarse).residuals(src, dst).max() > 20


def test_a_rectangles_pieces_are_about_as_long() -> None:
    for width, height, pieces, count in ((60, 40, 4, 14), (50, 50, 1, 4), (50, 50, 9, 36)):
        outer = Domain.rectangle((width, height), pieces=pieces).offset_cage.exterior
        lengths = np.linalg.norm(np.roll(outer, -1, axis=0) - outer, axis=1)
        assert len(outer) == count
        assert lengths.max() < 1.02 * width / pieces + 1


def test_the_identity_warps_nothing() -> None:
    map = HarmonicMap.identity(Domain.rectangle(PICTURE))
    assert np.allclose(warp(PICTURE, map.inverse), PICTURE, atol=1e-9)
    assert map.inverse.inverse is map


def test_bad_landmarks_are_named() -> None:
    domain = Domain.rectangle((60, 40))
    with pytest.raises(LandmarkError, match=r"swap: src\[:, ::-1\]"):
        HarmonicTransform.from_estimate(SRC[:, ::-1], DST[:, ::-1], domain=domain)
    with pytest.raises(LandmarkError, match=r"src\[1\] at .* lies outside the domain$"):
        HarmonicTransform.from_estimate([[5, 5], [99, 99]], [[5, 5], [9, 9]], domain=domain)
    with pytest.raises(LandmarkError, match="5 landmarks src and 4 dst"):
        HarmonicTransform.from_estimate(SRC, DST[1:])
    with pytest.raises(LandmarkError, match=r"dst\[0\] is"):
        HarmonicTransform.from_estimate([[1, 1]], [[np.inf, 0]])
    with pytest.raises(LandmarkError, match=r"dst\[1\] is masked"):
        HarmonicTransform.from_estimate(SRC[:2], np.ma.masked_equal(DST[:2], 55))
    with pytest.raises(GeometryError, match="channels first"):
        Domain.rectangle(np.zeros((3, 40, 60)))
    with pytest.raises(GeometryError, match=r"give the size shape\[1::-1\]"):
        Domain.rectangle((40, 60, 3))
    with pytest.raises(GeometryError, match="pieces must be a whole number from 1"):
        Domain.rectangle((60, 40), pieces=0)
    with pytest.raises(GeometryError, match="a picture is an array"):
        Domain.rectangle("gecko.png")
    with pytest.raises(GeometryError, match="width must be a whole number"):
        Domain.rectangle((0, 5))
