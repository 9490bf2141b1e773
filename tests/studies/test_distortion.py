"""Densities, and their means over one area for maps of different kinds."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.geometry import triangulate
from glid_nb.harmonic import HarmonicMap
from studies.distortion import (
    area_mean,
    densities,
    density_at,
    harmonic_area_mean,
    mesh_area_mean,
)

from ..support.problems import problem, run_method

DOMAIN, POSE = problem("ell")


def test_densities_are_those_of_the_singular_values() -> None:
    mesh = triangulate(DOMAIN.cage, 60)
    matrix = np.array([[1.5, 0.2], [-0.1, 0.8]])
    s1, s2 = np.linalg.svd(matrix, compute_uv=False)
    expected = (s1**2 + s2**2 + s1**-2 + s2**-2) / 2
    found = densities(mesh, mesh.vertices @ matrix.T)
    np.testing.assert_allclose(found, expected)
    assert mesh_area_mean(mesh.vertices @ matrix.T, mesh) == pytest.approx(expected)
    assert np.isinf(densities(mesh, mesh.vertices * [-1, 1])).all()


def test_the_mean_is_by_area() -> None:
    mesh = triangulate(DOMAIN.cage, 60)
    x = mesh.vertices[mesh.triangles, 0]
    loop = np.vstack([DOMAIN.cage.exterior, DOMAIN.cage.exterior[:1]])
    (x0, y0), (x1, y1) = loop[:-1].T, loop[1:].T
    cross = x0 * y1 - x1 * y0
    centroid = ((x0 + x1) * cross).sum() / (3 * cross.sum())
    assert area_mean(x.mean(axis=1), mesh) == pytest.approx(centroid)


@pytest.mark.slow
def test_harmonic_maps_and_their_piecewise_linear_ones_compare() -> None:
    map_ = run_method("newton", DOMAIN, POSE).map
    assert isinstance(map_, HarmonicMap)
    points = np.array([[0.1, 0.2], [-1.0, -1.0]])
    s1, s2 = map_.sigma1(points), map_.sigma2(points)
    np.testing.assert_allclose(
        density_at(map_, points), (s1**2 + s2**2 + s1**-2 + s2**-2) / 2, rtol=1e-9
    )
    mesh = triangulate(DOMAIN.cage, 4_000)
    smooth, linear = harmonic_area_mean(map_, mesh), mesh_area_mean(map_(mesh.vertices), mesh)
    assert smooth > 2.01
    assert smooth == pytest.approx(linear, rel=1e-3)
