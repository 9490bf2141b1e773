"""Every method stops at any iteration: the state it has reached is a whole result."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MeshMap, MethodProgress, MethodResult, methods, run_method
from glid_nb.solvers import Status

from .problems import problem

pytestmark = pytest.mark.slow

ITERATIVE = [name for name, method in methods().items() if method.family != "linear"]
LINEAR = [name for name, method in methods().items() if method.family == "linear"]
WEIGHT = 1e3


def run(name: str, **more: Any) -> MethodResult:
    package = methods()[name].package
    if package:
        pytest.importorskip(package)
    settings = {"p2p_weight": WEIGHT, "n_vertices": 150, "align": False}
    return run_method(name, *problem("ell"), **settings, **more)


def points_of(map: HarmonicMap | MeshMap) -> NDArray[Any]:
    return map.images if isinstance(map, MeshMap) else np.stack([map.phi, map.psi])


def check(result: MethodResult, iterations: int) -> None:
    """The history ends with the map that is returned, and what the method promises of it holds."""
    method = methods()[result.method]
    assert result.message.endswith(".")
    assert result.iterations == iterations
    assert [step.iteration for step in result.history] == list(range(iterations + 1))
    assert np.isfinite([step.energy for step in result.history]).all()
    assert result.energy == pytest.approx(result.energy_iso + result.energy_p2p)
    assert np.isfinite(points_of(result.map)).all()
    miss = result.map(result.pose.handles) - result.pose.targets
    if method.weighted:
        assert result.energy_p2p == pytest.approx(WEIGHT / 2 * (miss**2).sum(), rel=1e-6)
    if method.family == "harmonic":
        assert isinstance(result.map, HarmonicMap)
        assert result.certificate is not None
        assert result.certificate.certified
        assert result.flips is None
    else:
        assert isinstance(result.map, MeshMap)
        assert result.flips == result.map.flipped.sum()


@pytest.mark.parametrize("iterations", [0, 1, 2])
@pytest.mark.parametrize("name", ITERATIVE)
def test_at_its_most_iterations(name: str, iterations: int) -> None:
    result = run(name, max_iterations=iterations)
    assert result.status is Status.MAX_ITERATIONS
    assert result.message == Status.MAX_ITERATIONS.message
    check(result, iterations)
    if not iterations and isinstance(result.map, HarmonicMap):
        handles = result.pose.handles
        np.testing.assert_allclose(result.map(handles), handles, atol=1e-9)


@pytest.mark.parametrize("iterations", [0, 1, 2])
@pytest.mark.parametrize("name", ITERATIVE)
def test_when_the_callback_says_so(name: str, iterations: int) -> None:
    seen: list[MethodProgress] = []

    def stop(progress: MethodProgress) -> bool:
        seen.append(progress)
        return len(progress.history) == iterations + 1

    result = run(name, callback=stop)
    assert result.status is Status.STOPPED
    assert result.message == Status.STOPPED.message
    check(result, iterations)
    last = seen[-1]
    assert last.method == name
    assert len(last.history) == len(result.history)
    assert last.history[-1].energy == pytest.approx(result.energy, rel=1e-12)
    np.testing.assert_array_equal(points_of(last.map), points_of(result.map))
    # It was asked after the start and after every iteration.
    assert {len(progress.history) for progress in seen} == set(range(1, iterations + 2))


@pytest.mark.parametrize("name", LINEAR)
def test_linear_methods_stop_before_their_one_solve(name: str) -> None:
    limited = run(name, max_iterations=0)
    assert limited.status is Status.MAX_ITERATIONS
    check(limited, 0)
    stopped = run(name, callback=lambda _: True)
    assert stopped.status is Status.STOPPED
    np.testing.assert_array_equal(points_of(stopped.map), points_of(limited.map))
    check(run(name, max_iterations=1), 1)
