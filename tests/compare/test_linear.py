"""Linear baselines: they interpolate, reproduce what they should, and fold."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.compare import MeshMap, methods, run_method
from glid_nb.compare.linear.mean_value import mean_value_coordinates
from glid_nb.compare.linear.moving_least_squares import moving_least_squares
from glid_nb.solvers import Pose, Status

from .problems import problem

LINEAR = [name for name, method in methods().items() if method.family == "linear"]
# A half turn of one limb over the other.
FOLDING = [[2.5, -2.5], [-2.5, 2.5], [-2.0, -2.0]]


@pytest.mark.parametrize("name", LINEAR)
def test_handles_reach_their_targets_and_rest_stays_rest(name: str) -> None:
    if methods()[name].package:
        pytest.importorskip(methods()[name].package)
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
    if methods()[name].package:
        pytest.importorskip(methods()[name].package)
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
