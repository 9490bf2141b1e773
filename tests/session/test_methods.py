"""Other methods in the deformation editor: certified ones move the map, others are a comparison."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from glid_nb.certificate import certify
from glid_nb.energies import AMIPS, ARAP, SymmetricDirichlet
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import METHODS
from glid_nb.session import live_solver
from glid_nb.session.deformation import Deformation
from glid_nb.solvers import MethodError, Status

from ..support.domains import domain

pytestmark = pytest.mark.slow  # most of the time is compiling

TIMEOUT = 120.0
HARMONIC = [name for name, method in METHODS.items() if method.family == "harmonic"]
ON_MESHES = [name for name, method in METHODS.items() if method.family != "harmonic"]


@pytest.fixture
def ring() -> Iterator[Deformation]:
    """Three solved handles on a ring."""
    with Deformation(domain("ring")) as deformation:
        deformation.add_handles([(2, 0), (-2, 0), (0, 2)])
        assert deformation.solve(TIMEOUT)
        yield deformation


def choose(model: Deformation, name: str) -> None:
    """A method with an energy that it can minimise."""
    if importlib.util.find_spec(METHODS[name].package or "numpy") is None:
        pytest.skip("its package is not installed")
    if "arap" in (METHODS[name].energies or ()):
        model.set_energy(ARAP())
    on_a_mesh = METHODS[name].family != "harmonic"
    model.set_method(name, **({"n_vertices": 1500} if on_a_mesh else {}))


@pytest.mark.parametrize("name", HARMONIC)
def test_a_method_in_the_subspace_moves_the_certified_map(ring: Deformation, name: str) -> None:
    frames: list[HarmonicMap] = []
    ring.observe(lambda what: frames.append(ring.map) if what == "frame" else None)
    choose(ring, name)
    ring.drag(0, to=(2.4, 0.3))
    assert ring.solve(TIMEOUT)
    assert ring.moment.comparison is None
    assert ring.moment.shown is ring.map
    assert ring.moment.solved, ring.status.text
    solution = ring.moment.solution
    assert solution is not None
    assert 1 <= len(solution.history) <= live_solver.MOST_ITERATIONS
    assert np.diff([step.iteration for step in solution.history]).tolist() == [1] * (
        len(solution.history) - 1
    )
    if solution.status.ok:
        np.testing.assert_allclose(ring.map([[2, 0]]), [[2.4, 0.3]], atol=0.02)
    for map_ in frames[:: max(1, len(frames) // 10)]:
        assert certify(map_).certified


@pytest.mark.parametrize("name", ON_MESHES)
def test_a_method_on_a_mesh_stands_beside_the_certified_map(ring: Deformation, name: str) -> None:
    choose(ring, name)
    certified = ring.map
    ring.drag(0, to=(2.4, 0.3))
    assert ring.solve(TIMEOUT)
    assert ring.moment.solved, ring.status.text
    mesh = ring.moment.comparison
    assert isinstance(mesh, MeshMap)
    assert ring.moment.shown is mesh
    assert ring.map is certified
    np.testing.assert_allclose(mesh([[2, 0]]), [[2.4, 0.3]], atol=0.02)
    assert "certified" in ring.status.text
    assert ring.status.level != "good"
    # The pointer finds what is shown.
    found = ring.find((2.4, 0.3))
    assert found is not None
    np.testing.assert_allclose(found, [2, 0], atol=0.02)
    ring.set_method("newton")
    assert ring.moment.comparison is None
    assert ring.solve(TIMEOUT)
    np.testing.assert_allclose(ring.map([[2, 0]]), [[2.4, 0.3]], atol=1e-3)


def test_turned_over_triangles_are_said_in_words(ring: Deformation) -> None:
    ring.set_method("mls")
    ring.drag(0, to=(-6, 0))
    assert ring.solve(TIMEOUT)
    mesh = ring.moment.comparison
    assert mesh is not None
    count = int(mesh.flipped.sum())
    assert count > 1
    assert f"not certified: {count} triangles are turned over" in ring.status.text
    assert certify(ring.map).certified


def test_undo_solves_a_mesh_again(ring: Deformation) -> None:
    ring.set_method("mls")
    assert ring.solve(TIMEOUT)
    before = ring.state
    ring.drag(0, to=(3, 0))
    assert ring.solve(TIMEOUT)
    ring.undo()
    assert ring.state is before
    assert ring.solve(TIMEOUT)
    assert ring.state is before
    mesh = ring.moment.comparison
    assert mesh is not None
    np.testing.assert_allclose(mesh([[2, 0]]), [[2, 0]], atol=1e-6)
    ring.undo()
    assert ring.moment.comparison is None
    assert ring.state.current.method.name == "newton"


def test_a_newer_target_interrupts_between_iterations(ring: Deformation) -> None:
    ring.set_method("gradient-descent")
    ring.begin_drag([0])
    for x in np.linspace(2, 3, 10):
        ring.drag_to([(x, 0.1)])
    ring.end_drag()
    ring.set_method("newton")
    assert ring.solve(TIMEOUT)
    np.testing.assert_allclose(ring.map([[2, 0]]), [[3, 0.1]], atol=1e-3)


def test_a_step_is_one_iteration(ring: Deformation) -> None:
    ring.paused = True
    ring.set_method("lbfgs")
    ring.drag(0, to=(3, 1))
    ring.step()
    assert ring.solve(TIMEOUT)
    solution = ring.moment.solution
    assert solution is not None
    assert solution.status is Status.STOPPED
    assert len(solution.history) == 1


def test_a_method_refuses_what_it_cannot_do(ring: Deformation) -> None:
    state = ring.state
    for refused in (
        lambda: ring.set_method("gauss-newton"),  # not the symmetric Dirichlet energy
        lambda: ring.set_method("alchemy"),
        lambda: ring.set_method("lbfgs", memory=2.5),
        lambda: ring.set_method("lbfgs", sampling="uniform"),  # an option
        lambda: ring.set_method("mls", kind="affine"),
    ):
        with pytest.raises(MethodError):
            refused()
        assert ring.state is state
    ring.set_energy(ARAP())
    ring.set_method("gauss-newton")
    with pytest.raises(MethodError, match="cannot minimise"):
        ring.set_energy(AMIPS(1.0))
    assert ring.state.current.energy == ARAP()


def test_a_missing_package_names_the_extra(
    ring: Deformation, monkeypatch: pytest.MonkeyPatch
) -> None:
    state, found = ring.state, importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "igl" else found(name)
    )
    with pytest.raises(MethodError, match=r"pip install 'glid-nb\[compare\]'"):
        ring.set_method("slim")
    assert ring.state is state


def test_too_few_handles_are_said_in_words(ring: Deformation) -> None:
    ring.set_method("mean-value")
    assert ring.solve(TIMEOUT)
    assert ring.moment.comparison is not None
    ring.remove_handles(0)
    assert ring.solve(TIMEOUT)
    assert "need at least 3" in ring.status.text
    assert ring.moment.comparison is None
    assert not ring.moment.solved


@pytest.mark.parametrize("name", METHODS)
def test_without_handles_nothing_breaks(name: str) -> None:
    if importlib.util.find_spec(METHODS[name].package or "numpy") is None:
        pytest.skip("its package is not installed")
    energy = ARAP() if "arap" in (METHODS[name].energies or ()) else SymmetricDirichlet()
    with Deformation(domain("ring"), energy=energy) as model:
        model.set_method(name)
        assert model.solve(TIMEOUT)
        assert model.status.level in ("idle", "blocked"), model.status.text


def test_a_call_without_an_iteration_is_no_frame(
    ring: Deformation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The solver may call back after refused steps, before anything has moved."""
    real: Any = live_solver.solve
    calls = []

    def refusing(*problem: Any, **method: Any) -> object:
        callback = problem[-1]

        def twice(progress: Any) -> bool:
            calls.append(progress)
            return bool(callback(progress) or callback(progress))

        return real(*problem[:5], twice, **method)

    frames: list[int] = []

    def count(what: str) -> None:
        if what == "frame" and ring.moment.frame is not None and ring.moment.frame.solution is None:
            frames.append(len(ring.moment.frame.history))

    ring.observe(count)
    monkeypatch.setattr(live_solver, "FRAME_INTERVAL", 0.0)
    monkeypatch.setattr(live_solver, "solve", refusing)
    ring.drag(0, to=(3, 1))
    assert ring.solve(TIMEOUT)
    assert calls
    assert len(frames) == len(set(frames))
