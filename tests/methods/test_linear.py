"""Linear baselines: they interpolate, reproduce simple maps, and fold."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glid_nb.geometry import MeshMap, graded_panels, triangulate
from glid_nb.harmonic import as_complex
from glid_nb.methods import METHODS
from glid_nb.methods.linear import (
    cauchy_point_to_point,
    mean_value_coordinates,
    moving_least_squares,
)
from glid_nb.pose import Pose
from glid_nb.solvers import Status

from ..support.domains import real
from ..support.problems import problem, run_method

pytestmark = pytest.mark.slow  # most of the time is compiling

Array = NDArray[Any]

LINEAR = [name for name, method in METHODS.items() if method.family == "linear"]
# A half turn of one limb over the other.
FOLDING = [[2.5, -2.5], [-2.5, 2.5], [-2.0, -2.0]]


@pytest.mark.parametrize("name", LINEAR)
def test_handles_reach_their_targets_and_rest_stays_rest(name: str) -> None:
    if METHODS[name].package:
        pytest.importorskip(METHODS[name].package)
    domain, pose = problem("ring")
    result = run_method(name, domain, pose, n_vertices=400)
    assert result.status is Status.CONVERGED
    assert result.iterations == 1
    np.testing.assert_allclose(result.map(pose.handles), pose.targets, atol=1e-3)
    still = run_method(name, domain, Pose(pose.handles, pose.handles), n_vertices=400)
    assert isinstance(still.map, MeshMap)
    np.testing.assert_allclose(still.map.images, still.map.triangulation.vertices, atol=1e-6)
    assert still.flips == 0
    assert "no triangle" in still.message


@pytest.mark.parametrize("name", LINEAR)
def test_they_fold_and_say_how_much(name: str) -> None:
    if METHODS[name].package:
        pytest.importorskip(METHODS[name].package)
    domain, pose = problem("ell")
    result = run_method(name, domain, pose.with_targets(FOLDING), n_vertices=600)
    assert result.flips
    assert isinstance(result.map, MeshMap)
    assert result.map.flipped.sum() == result.flips
    assert f"{result.flips} triangles are turned over" in result.message


def test_moving_least_squares_reproduces_motions() -> None:
    rng = np.random.default_rng(0)
    z, handles = (rng.normal(size=(n, 2)) @ np.array([1, 1j]) for n in (40, 4))
    turn, shift = np.exp(0.7j), 2 - 1j
    np.testing.assert_allclose(
        moving_least_squares(z, handles, turn * handles + shift), turn * z + shift, atol=1e-12
    )
    similar = moving_least_squares(z, handles, 3 * turn * handles, "similarity")
    np.testing.assert_allclose(similar, 3 * turn * z, atol=1e-12)


def test_mean_value_coordinates_reproduce_linear_functions() -> None:
    polygon = np.array([0, 4, 4 + 3j, 2 + 1j, 3j])
    rng = np.random.default_rng(1)
    z = rng.uniform(-2, 6, 60) + 1j * rng.uniform(-2, 5, 60)
    z = np.concatenate([z, polygon, [2, 4 + 1.5j]])
    w = mean_value_coordinates(z, polygon)
    np.testing.assert_allclose(w.sum(axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(w @ polygon, z, atol=1e-9)


def test_cauchy_coordinates_reproduce_similarities() -> None:
    turn, shift = 1.3 * np.exp(0.5j), 2 - 1j
    for name in ("ell", "ring"):
        shape, pose = problem(name)
        targets = real(turn * as_complex(pose.handles) + shift)
        weight = 1e5 * shape.cage.unit**2
        map = cauchy_point_to_point(shape, pose.with_targets(targets), weight)
        points = triangulate(shape.cage, 200).vertices
        np.testing.assert_allclose(as_complex(map(points)), turn * as_complex(points) + shift, 1e-8)
        assert not map.psi.any()


@pytest.mark.parametrize("weight", [1.0, 1e5])
def test_cauchy_coordinates_solve_a_least_squares_problem_by_quadrature(weight: float) -> None:
    """The same problem with Cauchy's integral by Gauss and Legendre and a dense solver."""
    shape, pose = problem("ell")
    panels = graded_panels(shape)
    share = np.sqrt(panels.length / panels.length.sum())
    stiff = np.sqrt(weight / 2)
    loop = shape.offset_cage.loops_complex[0]
    rows = [
        shape.cage.unit * share[:, None] * hats_by_quadrature(loop, panels.middle, 2),
        stiff * hats_by_quadrature(loop, as_complex(pose.handles), 0),
    ]
    right = np.concatenate([np.zeros(len(share)), stiff * as_complex(pose.targets)])
    solution, _, rank, _ = np.linalg.lstsq(np.concatenate(rows), right)
    assert rank == len(loop)
    mesh = triangulate(shape.cage, 200)
    inside = mesh.vertices[mesh.n_boundary :]
    expected = hats_by_quadrature(loop, as_complex(inside), 0) @ solution
    map = cauchy_point_to_point(shape, pose, weight)
    np.testing.assert_allclose(as_complex(map(inside)), expected, atol=1e-7)
    # It is not a rigid motion, so the weight matters.
    assert np.abs(expected - as_complex(inside)).max() > 1


def hats_by_quadrature(loop: Array, z: Array, order: int) -> Array:
    """(k, n) derivatives at z of Cauchy's integral of a closed polygon's hat functions."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    t = (nodes + 1) / 2
    result = np.zeros((len(z), len(loop)), dtype=complex)
    for j, a in enumerate(loop):
        after = (j + 1) % len(loop)
        edge = loop[after] - a
        kernel = weights / 2 * edge / (a + edge * t - z[:, None]) ** (order + 1)
        result[:, j] += kernel @ (1 - t)
        result[:, after] += kernel @ t
    return math.factorial(order) / (2j * np.pi) * result
