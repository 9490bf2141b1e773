"""The list of methods, and what it refuses."""

from __future__ import annotations

import importlib.util
from types import ModuleType

import numpy as np
import pytest

from glid_nb.compare import MethodError, methods, run_method
from glid_nb.energies import ARAP, EnergyError, SymmetricDirichlet
from glid_nb.geometry import Cage, Domain
from glid_nb.solvers import Pose, PoseError

from .problems import problem


def test_every_method_says_what_it_is() -> None:
    for name, method in methods().items():
        assert method.name == name
        assert method.title
        assert method.summary.endswith(".")
        assert method.family in ("harmonic", "mesh", "linear")
        assert method.max_iterations > 0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"name": "magic"}, "unknown method 'magic'; choose one of newton"),
        ({"name": "gauss-newton", "energy": SymmetricDirichlet()}, "cannot minimise .* 'iso'"),
        ({"name": "slim", "energy": ARAP()}, "cannot minimise the energy 'arap'"),
        ({"name": "lbfgs", "momentum": 2}, "no setting 'momentum'; it has: sampling, certificate"),
        ({"p2p_weight": 0.0}, "p2p_weight must be a positive finite number"),
        ({"p2p_weight": np.nan}, "p2p_weight must be a positive finite number"),
        ({"max_iterations": -1}, "max_iterations must be a whole number"),
        ({"n_vertices": 100.5}, "n_vertices must be a whole number"),
        ({"name": "lbfgs", "memory": -1}, "'memory' of .* a whole number of at least 0"),
        ({"name": "aqp", "kappa": -1.0}, "'kappa' of .* a finite number of at least 0"),
    ],
)
def test_refusals_name_the_culprit(changes: dict, message: str) -> None:
    domain, pose = problem("ell")
    arguments = {"name": "mls", "domain": domain, "pose": pose, **changes}
    if arguments["name"] == "slim":
        pytest.importorskip("igl")
    with pytest.raises(MethodError, match=message):
        run_method(**arguments)


def test_a_handle_outside_is_refused() -> None:
    domain, _ = problem("ell")
    with pytest.raises(PoseError, match="handle 0"):
        run_method("mls", domain, Pose([[2.0, 2.0]], [[0.0, 0.0]]))


def test_a_missing_package_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec

    def without(name: str, *more: object) -> object:
        return None if name in ("igl", "clarabel") else found(name, *more)

    monkeypatch.setattr(importlib.util, "find_spec", without)
    domain, pose = problem("ell")
    needing = [name for name, method in methods().items() if method.package]
    assert needing
    for name in needing:
        with pytest.raises(MethodError, match=r"pip install 'glid-nb\[compare\]'"):
            run_method(name, domain, pose)
        assert name not in methods(available=True)
    assert "newton" in methods(available=True)
    assert isinstance(importlib.util, ModuleType)


def test_an_energy_may_be_a_name() -> None:
    domain, pose = problem("ell")
    by_name = run_method("newton", domain, pose, "arap", max_iterations=1)
    assert by_name.energy == run_method("newton", domain, pose, ARAP(), max_iterations=1).energy
    with pytest.raises(EnergyError, match="unknown energy 'stiff'"):
        run_method("newton", domain, pose, "stiff")


def test_handles_on_one_line_are_no_cage() -> None:
    domain = Domain.from_cage(Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    handles = [[1, 1], [2, 1], [3, 1]]
    with pytest.raises(MethodError, match="lie on one line"):
        run_method("mean-value", domain, Pose(handles, handles), n_vertices=200)
