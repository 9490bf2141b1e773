"""Maps at fixed points, compared with the maps themselves."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.harmonic import FixedPoints, HarmonicMap, fixed_points

from ..support.domains import NAMES, domain, random_map, real
from ..support.reference_map import points_inside


def assert_same(found: tuple[np.ndarray, np.ndarray], map: HarmonicMap, points: np.ndarray) -> None:
    image, derivatives = found
    assert image.dtype == derivatives.dtype == np.float32
    np.testing.assert_allclose(image, map(points), atol=1e-4)
    fz, fzb = map.wirtinger(points)
    expected = np.stack([fz.real, fz.imag, fzb.real, -fzb.imag], axis=1)
    np.testing.assert_allclose(derivatives, expected, atol=1e-4)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("chunk", "kept"), [(1 << 21, 1 << 26), (100, 500), (1, 0)])
def test_images_and_derivatives_are_the_maps(
    name: str, chunk: int, kept: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fixed_points, "CHUNK", chunk)
    monkeypatch.setattr(fixed_points, "MOST_KEPT", kept)
    d = domain(name)
    points = np.concatenate([real(points_inside(d.cage.loops_complex, 40)), *d.cage.loops])
    evaluate = FixedPoints(d, points)
    for map in (HarmonicMap.identity(d), random_map(name, 0.5, 1), random_map(name, 2.0, 2)):
        assert_same(evaluate(map), map, points)


def test_the_costly_part_is_done_once(monkeypatch: pytest.MonkeyPatch) -> None:
    d = domain("ring")
    points = np.concatenate(d.cage.loops)
    evaluate = FixedPoints(d, points)
    evaluate(HarmonicMap.identity(d))
    monkeypatch.setattr(np, "arctan2", lambda *_: pytest.fail("logarithms are computed again"))
    map = random_map("ring", 1.0, 3)
    image, _ = evaluate(map)
    np.testing.assert_allclose(image, map(points), atol=1e-4)
