"""Every method can be stopped at any iteration and then returns a complete result."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import METHODS
from glid_nb.solvers import Progress, Result, Status

from ..support.problems import problem, run_method

pytestmark = pytest.mark.slow

ITERATIVE = [name for name, method in METHODS.items() if method.family != "linear"]
# Newton's compiled loop is visible only after a call.
COMPILED = ("newton", "newton-paper", "newton-unmodified")
LINEAR = [name for name, method in METHODS.items() if method.family == "linear"]
WEIGHT = 1e3


def run(name: str, **more: Any) -> Result:
    method = METHODS[name]
    if method.package:
        pytest.importorskip(method.package)
    settings = {"p2p_weight": WEIGHT, "align": False, "iterations_per_call": 1}
    if "n_vertices" in method.kinds():
        settings["n_vertices"] = 150
    return run_method(name, *problem("ell"), **settings, **more)


def points_of(map: HarmonicMap | MeshMap) -> NDArray[Any]:
    return map.images if isinstance(map, MeshMap) else np.stack([map.phi, map.psi])


def check(result: Result, iterations: int) -> None:
    """The history ends with the returned map, and the map has what the method promises."""
    method = result.method
    assert result.message.endswith(".")
    assert result.iterations == iterations
    assert [step.iteration for step in result.history] == list(range(1, iterations + 1))
    assert np.isfinite([step.energy for step in (result.initial, *result.history)]).all()
    assert result.energy == pytest.approx(result.energy_distortion + result.energy_p2p)
    assert np.isfinite(points_of(result.map)).all()
    miss = result.map(result.pose.handles) - result.pose.targets
    if "p2p_weight" in method.options:
        assert result.energy_p2p == pytest.approx(WEIGHT / 2 * (miss**2).sum(), rel=1e-6)
    if method.family == "harmonic":
        assert isinstance(result.map, HarmonicMap)
        assert result.certificate is not None
        assert result.certificate.certified
        assert result.flips is None
        assert all(step.flips is None for step in result.history)
    else:
        assert isinstance(result.map, MeshMap)
        assert result.flips == result.map.flipped.sum()
        assert (result.history or [result.initial])[-1].flips == result.flips
        assert result.certificate is None


@pytest.mark.parametrize("iterations", [0, 1, 2])
@pytest.mark.parametrize("name", ITERATIVE)
def test_at_its_most_iterations(name: str, iterations: int) -> None:
    result = run(name, max_iterations=iterations)
    assert result.status is Status.MAX_ITERATIONS
    assert result.message.startswith(Status.MAX_ITERATIONS.message)
    check(result, iterations)
    if not iterations and isinstance(result.map, HarmonicMap):
        handles = result.pose.handles
        np.testing.assert_allclose(result.map(handles), handles, atol=1e-9)


@pytest.mark.parametrize(
    ("name", "iterations"),
    [(name, n) for name in ITERATIVE for n in (0, 1, 2) if n or name not in COMPILED],
)
def test_when_the_callback_says_so(name: str, iterations: int) -> None:
    seen: list[Progress] = []

    def stop(progress: Progress) -> bool:
        seen.append(progress)
        return len(progress.history) == iterations

    result = run(name, callback=stop)
    assert result.status is Status.STOPPED
    assert result.message == Status.STOPPED.message
    check(result, iterations)
    last = seen[-1]
    assert last.method.name == name
    assert len(last.history) == len(result.history)
    assert last.energy == pytest.approx(result.energy, rel=1e-12)
    np.testing.assert_array_equal(points_of(last.map), points_of(result.map))
    # The callback was called after the start and after every iteration.
    first = 1 if name in COMPILED else 0
    assert {len(progress.history) for progress in seen} == set(range(first, iterations + 1))
    assert all(progress.initial == result.initial for progress in seen)


@pytest.mark.parametrize("name", LINEAR)
def test_linear_methods_stop_before_their_one_solve(name: str) -> None:
    limited = run(name, max_iterations=0)
    assert limited.status is Status.MAX_ITERATIONS
    check(limited, 0)
    stopped = run(name, callback=lambda _: True)
    assert stopped.status is Status.STOPPED
    np.testing.assert_array_equal(points_of(stopped.map), points_of(limited.map))
    check(run(name, max_iterations=1), 1)
