"""The derivatives of a minimum, against central differences of solves."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glid_nb import samples
from glid_nb.energies import AMIPS, Energy, ExponentialSymmetricDirichlet, SymmetricDirichlet
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import trace
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.session.problem import load_pose
from glid_nb.solvers import Options, Result, SensitivityError

from ..support.domains import domain
from .test_reference_problems import NAMES, problem

pytestmark = pytest.mark.slow

STEP, CLOSE = 1e-4, 1e-6
FREE = np.nan
ELL = Pose([[-2, -2], [2, -2], [-2, 2]], [[-2, -2], [2.4, -1.2], [-1.5, 2.2]], weights=[1, 2, 0.5])
TURNED = replace(ELL, angles=[FREE, 0.9, 0], scales=[1.3, 0.8, FREE])
STIFF = replace(ELL, stiffness=[{"points": [[0, -2]], "radius": 1, "strength": 0.7}])
TWIN = Pose([[-3.3, 0], [0, 0.2], [3.3, 0]], [[-3, 0.5], [0, 0], [3, 1]])
OF_ALL = ("targets", "handles", "weights")
TO_THE_END = Options(tolerance=1e-22)


def polished(result: Result) -> Result:
    """With the steps that the line search cannot see, because they are below its rounding."""
    for _ in range(3):
        re_phi, im_phi, re_psi, im_psi = result.minimum.newton_step()
        map_ = result.map
        assert isinstance(map_, HarmonicMap)
        phi, psi = map_.phi + re_phi + 1j * im_phi, map_.psi + re_psi + 1j * im_psi
        result = replace(result, map=HarmonicMap(map_.domain, phi, psi))
    return result


def solved(domain: Domain, pose: Pose, energy: Energy, start: Result | None = None) -> Result:
    """At the minimum to rounding; free angles are measured again until nothing changes."""
    for _ in range(4 if pose.oriented.any() else 1):
        options = TO_THE_END if start is None else replace(TO_THE_END, align=False)
        start = solve(domain, pose, energy, options, start)
    assert start is not None
    return polished(start)


def differs(result: Result, energy: Energy, of: Any, k: int) -> float:
    """The error of one derivative relative to the largest velocity of the cage's vertices."""
    map_, pose = result.map, result.pose
    assert isinstance(map_, HarmonicMap)
    ends = []
    for step in (STEP, -STEP):
        moved, other = pose, energy
        if of == "s":
            other = replace(energy, s=energy.s + step)  # type: ignore[attr-defined, type-var]
        else:
            numbers = np.array(getattr(pose, of))
            numbers.flat[k] += step
            moved = replace(pose, **{of: numbers})
        ends.append(solved(map_.domain, moved, other, result))
    points = np.concatenate(map_.domain.cage.loops)
    wanted = (ends[0].map(points) - ends[1].map(points)) / (2 * STEP)
    a, b, c, d = result.minimum.changes(of)[k]
    found = HarmonicMap(map_.domain, a + 1j * b, c + 1j * d)(points)
    return float(np.abs(found - wanted).max() / max(np.abs(wanted).max(), 1e-3))


@functools.cache
def case(name: str) -> tuple[Result, Energy]:
    cases: dict[str, tuple[str, Pose, Energy]] = {
        "ell": ("ell", ELL, SymmetricDirichlet()),
        "holes": ("twin", TWIN, SymmetricDirichlet()),
        "turned": ("ell", TURNED, SymmetricDirichlet()),
        "amips": ("ell", ELL, AMIPS(s=0.7)),
        "stiff": ("ell", STIFF, ExponentialSymmetricDirichlet(s=0.5)),
    }
    shape, pose, energy = cases[name]
    return solved(domain(shape), pose, energy), energy


@pytest.mark.parametrize("of", OF_ALL)
@pytest.mark.parametrize("name", ["ell", "holes", "turned", "amips", "stiff"])
def test_a_derivative_is_the_central_difference(name: str, of: str) -> None:
    result, energy = case(name)
    for k in (1, 2):
        assert differs(result, energy, of, k) < CLOSE


@pytest.mark.parametrize("name", ["amips", "stiff"])
def test_so_is_that_by_the_parameter_of_the_energy(name: str) -> None:
    assert differs(*case(name), "s", 0) < CLOSE


@pytest.mark.parametrize(("of", "k"), [("angles", 1), ("angles", 2), ("scales", 0), ("scales", 1)])
def test_so_are_those_by_angles_and_scales(of: str, k: int) -> None:
    assert differs(*case("turned"), of, k) < CLOSE


@pytest.mark.parametrize("name", ["bar", "gecko"])
def test_so_it_is_on_a_traced_sample(name: str) -> None:
    shape = Domain.from_cage(trace(samples.image(name)).cage)
    energy = SymmetricDirichlet()
    result = solved(shape, load_pose(samples.pose_path(name, "gentle")), energy)
    assert differs(result, energy, "targets", 0) < CLOSE
    assert differs(result, energy, "handles", 3) < CLOSE


@pytest.mark.reference
@pytest.mark.parametrize("name", NAMES)
def test_so_it_is_on_a_shape_of_the_paper(reference_folder: Path, name: str) -> None:
    shape, pose, _ = problem(reference_folder, name)
    energy = SymmetricDirichlet()
    result = solved(shape, pose, energy)
    assert differs(result, energy, "targets", 1) < CLOSE
    assert differs(result, energy, "handles", 2) < CLOSE


def test_conjugate_gradients_and_the_factor_agree() -> None:
    result = solve(domain("ell"), ELL)
    assert result.factor is not None
    forces = -result.minimum.gradients("targets")[:2]
    quickly = result.minimum.yielded(forces)
    assert "factor" not in vars(result.minimum)
    exactly = result.minimum.factor and result.minimum.yielded(forces)
    np.testing.assert_allclose(quickly, exactly, atol=1e-7 * np.abs(exactly).max())


def test_a_sensitivity_is_a_field() -> None:
    result = case("turned")[0]
    target, points = result.sensitivity(1), ELL.handles
    assert len(target.fields) == 2
    assert target(points).shape == (3, 2, 2)
    np.testing.assert_allclose(target(points)[1], np.eye(2), atol=1e-3)  # a stiff spring
    np.testing.assert_allclose(target.along([0, 2])(points), 2 * target(points)[..., 1])
    assert (target.speed(points) >= np.linalg.norm(target(points)[..., 0], axis=1)).all()
    assert len(result.sensitivity(0, "scales").fields) == 1
    assert len(case("amips")[0].sensitivity(of="s").fields) == 1


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"handle": 3}, "there is no handle 3"),
        ({"handle": None}, "there is no handle None"),
        ({"handle": 0, "of": "depths"}, "of must be one of"),
        ({"handle": 0, "of": "angles"}, "its angle, which is free"),
        ({"of": "s"}, "has no parameter s"),
    ],
)
def test_what_there_is_not_is_refused(given: Any, told: str) -> None:
    with pytest.raises(SensitivityError, match=told):
        case("turned")[0].sensitivity(**given)


def test_a_direction_has_as_many_numbers_as_fields() -> None:
    with pytest.raises(SensitivityError, match="direction must be 2 numbers"):
        case("turned")[0].sensitivity(0).along(1.0)
    with pytest.raises(SensitivityError, match="direction must be finite"):
        case("turned")[0].sensitivity(0).along([np.nan, 0])


def test_a_map_that_is_no_isolated_minimum_has_no_derivative() -> None:
    ell = domain("ell")
    with pytest.raises(SensitivityError, match="reached no minimum"):
        solve(ell, ELL, options=Options(max_iterations=1, restarts=0)).sensitivity(0)
    with pytest.raises(SensitivityError, match="pin a second handle"):
        solve(ell, ELL.only([0])).sensitivity(0)
    elsewhere = replace(case("ell")[0], map=HarmonicMap.identity(ell))
    with pytest.raises(SensitivityError, match="not at the minimum"):
        elsewhere.sensitivity(0)
