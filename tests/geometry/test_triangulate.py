"""Triangulations fill the cage exactly, evenly and without flat triangles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb.geometry import Cage, GeometryError, Triangulation, triangulate

from ..support.cages import SQUARE, box, cages, comb, nasty_cages, regular


def areas(mesh: Triangulation) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def check_fills(cage: Cage, mesh: Triangulation) -> None:
    size = areas(mesh)
    assert (size > 0).all()
    assert size.sum() == pytest.approx(cage.area, rel=1e-9)
    # Positive triangles of the right total area, all with their centres inside, cannot overlap.
    assert cage.contains(mesh.vertices[mesh.triangles].mean(axis=1)).all()
    assert mesh.triangles.dtype == np.int32
    assert np.array_equal(np.unique(mesh.triangles), np.arange(len(mesh.vertices)))
    # Euler: vertices - edges + triangles = 1 - holes, and no edge belongs to three triangles.
    edges = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() <= 2
    assert len(mesh.vertices) - len(unique) + len(mesh.triangles) == 1 - cage.n_holes
    assert np.sum(count == 1) == mesh.n_boundary


def check_border(cage: Cage, mesh: Triangulation) -> None:
    """The loops of the border hold the vertices on the cage, each once, in the cage's order."""
    loops = mesh.border
    assert sorted(np.concatenate(loops).tolist()) == list(range(mesh.n_boundary))
    assert len(loops) == 1 + cage.n_holes
    for loop in loops:
        turned = np.roll(loop, -loop.argmin())
        assert np.array_equal(turned, turned[0] + np.arange(len(turned)))


def check_boundary(cage: Cage, mesh: Triangulation) -> None:
    boundary = mesh.vertices[: mesh.n_boundary]
    starts = np.concatenate(cage.loops)
    where = {tuple(p) for p in boundary}
    assert all(tuple(p) in where for p in starts)
    length = np.concatenate([np.roll(loop, -1, axis=0) - loop for loop in cage.loops])
    direction = length / np.hypot(*length.T)[:, None]
    tolerance = 1e-12 * np.abs(starts).max()
    for p in boundary[:: max(1, len(boundary) // 50)]:
        arm = p - starts
        along = np.sum(arm * direction, axis=1)
        across = np.abs(arm[:, 0] * direction[:, 1] - arm[:, 1] * direction[:, 0])
        on = (along >= -tolerance) & (along <= np.hypot(*length.T) + tolerance)
        assert across[on].min() <= tolerance


@pytest.mark.slow
@pytest.mark.parametrize("n", [3, 100, 5_000])
@pytest.mark.parametrize("name", nasty_cages())
def test_nasty_cages_are_filled(name: str, n: int) -> None:
    cage = nasty_cages()[name]
    check_fills(cage, triangulate(cage, n))


@pytest.mark.slow
@given(cages(), st.sampled_from([50, 700, 3000]))
@settings(max_examples=40)
def test_random_cages_are_filled(cage: Cage, n: int) -> None:
    mesh = triangulate(cage, n)
    check_fills(cage, mesh)
    check_boundary(cage, mesh)
    check_border(cage, mesh)
    if n > 4 * cage.n_vertices:
        assert len(mesh.vertices) == pytest.approx(n, rel=0.15)


@pytest.mark.parametrize("n", [100, 1_000, 30_000])
def test_vertices_are_spread_evenly(n: int) -> None:
    cage = Cage(regular(40, 3.0), [box(-0.5, -0.5, 1), regular(9, 0.4, (1.6, 0.3))])
    mesh = triangulate(cage, n)
    check_boundary(cage, mesh)
    assert len(mesh.vertices) == pytest.approx(n, rel=0.1)
    if n > 100:
        size = areas(mesh)
        spread = size / np.median(size)
        assert spread.min() > 0.2
        assert spread.max() < 3.0
        edges = np.diff(mesh.vertices[mesh.triangles[:, [0, 1, 2, 0]]], axis=1)
        roundness = 4 * np.sqrt(3) * size / np.sum(edges**2, axis=(1, 2))  # 1 if equilateral
        assert roundness.min() > 0.3
        assert np.median(roundness) > 0.95


def test_a_coarse_triangulation_still_has_every_cage_vertex() -> None:
    cage = Cage(comb(20, 0.5))
    mesh = triangulate(cage, 3)
    assert mesh.n_boundary >= cage.n_vertices
    check_boundary(cage, mesh)


def test_a_hundred_thousand_vertices() -> None:
    cage = Cage(comb(5, 0.4), [regular(20, 0.3, (0.5, 2.0))])
    mesh = triangulate(cage, 100_000)
    assert len(mesh.vertices) == pytest.approx(100_000, rel=0.05)
    assert areas(mesh).sum() == pytest.approx(cage.area, rel=1e-9)


@pytest.mark.slow
def test_a_million_vertices() -> None:
    cage = Cage(comb(5, 0.4), [regular(20, 0.3, (0.5, 2.0))])
    mesh = triangulate(cage, 1_000_000)
    assert areas(mesh).min() > 0


def test_a_triangulation_cannot_be_changed() -> None:
    mesh = triangulate(Cage(SQUARE), 10)
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        mesh.triangles[0] = 1


def test_at_least_three_vertices() -> None:
    with pytest.raises(GeometryError, match="at least 3 vertices, not 2"):
        triangulate(Cage(SQUARE), 2)
