"""Triangulations with wanted vertices."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.geometry import Cage, GeometryError, triangulate

from .test_triangulate import check_fills

CAGE = Cage([[0, 0], [10, 0], [10, 6], [0, 6]], [[[4, 2], [4, 4], [6, 4], [6, 2]]])


def test_points_become_vertices() -> None:
    # Inside, on an edge, on an edge of the hole, at a corner, next to another one, twice.
    points = np.array([[2, 3], [5, 0], [4, 3], [10, 6], [2.001, 3], [2, 3], [8.123, 5.9]])
    for n in (20, 400):
        mesh = triangulate(CAGE, n, points=points)
        gap = np.linalg.norm(mesh.vertices[:, None] - points, axis=2)
        assert (gap.min(axis=0) == 0).all()
        assert (gap[:, [0, 2, 4]] == 0).sum() == 3
        check_fills(CAGE, mesh)
        on_boundary = gap[: mesh.n_boundary].min(axis=0) == 0
        assert on_boundary.tolist() == [False, True, True, True, False, False, False]


def test_without_points_nothing_changes() -> None:
    plain, empty = triangulate(CAGE, 300), triangulate(CAGE, 300, points=[])
    np.testing.assert_array_equal(plain.vertices, empty.vertices)
    np.testing.assert_array_equal(plain.triangles, empty.triangles)


@pytest.mark.parametrize("point", [[5, 3], [11, 1], [-1e-3, 0.5]])
def test_a_point_outside_is_refused(point: list[float]) -> None:
    with pytest.raises(GeometryError, match=r"point 1 at .* does not lie inside the cage"):
        triangulate(CAGE, 100, points=[[1, 1], point])
