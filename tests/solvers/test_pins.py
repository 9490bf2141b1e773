"""Handles with an angle, a scale and a weight."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb import methods
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve, solve_batch
from glid_nb.pose import Pose, PoseError
from glid_nb.solvers import MethodError, Options, Result

from ..support.checks import check_certified
from ..support.domains import domain

pytestmark = pytest.mark.slow

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0], [-0.5, -0.5]])
CASES = {
    "an angle": ({"angles": [None, None, 0.6, None]}, 2),
    "a scale": ({"scales": [None, None, 1.3, None]}, 2),
    "a scale that the shape turns away from": ({"scales": [None, None, 0.5, None]}, 2),
    "both": ({"angles": [None, None, -0.4, None], "scales": [None, None, 0.8, None]}, 2),
    "over a right angle away": ({"angles": [None, -2.2, None, None]}, 1),
}


def held(result: Result, pose: Pose, handle: int, tolerance: float = 1e-3) -> None:
    fz = result.map.wirtinger(pose.handles)[0][handle]
    if not np.isnan(pose.angles[handle]):
        assert abs(np.angle(fz * np.exp(-1j * pose.angles[handle]))) < tolerance
    if not np.isnan(pose.scales[handle]):
        assert abs(abs(fz) - pose.scales[handle]) < tolerance


@pytest.mark.parametrize("case", CASES)
def test_newton_holds(case: str) -> None:
    more, handle = CASES[case]
    pose = Pose(HANDLES, HANDLES + np.array([0.2, 0.1]), **more)
    result = solve(domain("ell"), pose, options=Options(restarts=0))
    assert result.status.ok
    check_certified(result)
    held(result, pose, handle)
    np.testing.assert_allclose(result.map(HANDLES), pose.targets, atol=1e-2)


def test_a_solve_that_goes_on_follows_a_turning_handle() -> None:
    result: Result | HarmonicMap | None = None
    for angle in (0.2, 0.4, 0.6):
        pose = Pose(HANDLES, HANDLES, angles=[None, None, angle, None])
        result = solve(domain("ell"), pose, start=result, options=Options(restarts=0))
        held(result, pose, 2)


@pytest.mark.parametrize("method", [methods.LBFGS(), methods.NewtonEigen(), methods.BDHM()])
def test_other_methods_of_the_subspace_hold_them_too(method: methods.Method) -> None:
    pose = Pose(HANDLES, HANDLES, angles=[None, None, 0.3, None], scales=[None, 0.7, None, None])
    result = solve(domain("ell"), pose, method=method)
    check_certified(result)
    held(result, pose, 1)
    held(result, pose, 2)


def test_a_batch_holds_what_one_solve_holds() -> None:
    angles = [None, None, 0.3, None]
    pose = Pose(HANDLES, HANDLES, angles=angles)
    (result,) = solve_batch(domain("ell"), [pose])
    held(result, pose, 2)


def test_a_light_handle_gives_way() -> None:
    targets = HANDLES + np.array([[0, 0], [0, 0], [0, 0], [0.8, 0.8]])
    options = Options(p2p_weight=1e5 * domain("ell").cage.unit ** 2, restarts=0)
    off = []
    for weight in (1e-4, 1.0):
        pose = Pose(HANDLES, targets, weights=[1, 1, 1, weight])
        result = solve(domain("ell"), pose, options=options)
        off.append(np.linalg.norm(result.map(HANDLES[3:]) - targets[3:]))
    assert off[1] < 1e-2 < off[0]


def test_methods_on_meshes_refuse_by_name() -> None:
    pose = Pose(HANDLES, HANDLES, scales=[None, 2.0, None, None])
    with pytest.raises(MethodError, match=r"'mls' cannot hold .* handle 1"):
        solve(domain("ell"), pose, method=methods.MovingLeastSquares())


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"angles": [0.1]}, "angles must be 4 numbers .* or null where free"),
        ({"scales": [0, 1, 1, 1]}, "scales must be 4 numbers from 0.01 to 100"),
        ({"weights": [None, 1, 1, 1]}, "weights must be 4 numbers from 1e-06"),
        ({"angles": ["a", 1, 1, 1]}, "angles must be"),
    ],
)
def test_a_wrong_value_is_named(more: dict[str, list], message: str) -> None:
    with pytest.raises(PoseError, match=message):
        Pose(HANDLES, HANDLES, **more)


def test_poses_read_back() -> None:
    pose = Pose(HANDLES, HANDLES, angles=[None, 1, None, None], weights=[1, 2, 1, 1])
    data = pose.to_dict()
    assert data["angles"] == [None, 1.0, None, None]
    assert "scales" not in data
    again = Pose.from_dict(data)
    assert again.same_constraints(pose)
    assert pose.only([1]).angles.tolist() == [1.0]
