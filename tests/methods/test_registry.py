"""The list of methods, and what it refuses."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glid_nb.energies import ARAP, EnergyError, SymmetricDirichlet
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MethodChoice, MethodError, methods, run_method
from glid_nb.solvers import Pose, PoseError, StartError

from ..domains import domain
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
        ({"name": "aqp", "energy": ARAP()}, "cannot minimise the energy 'arap'"),
        ({"name": "slim", "energy": ARAP()}, "ARAP, but that is no barrier: .* arap-mesh"),
        ({"name": "slim", "energy": "amips"}, "no AMIPS: the closest .* is exp.*without AMIPS' te"),
        ({"name": "slim", "energy": "exp"}, "minimises exp.sigma_1.2 .* s = 2, .*; got s = 1.0"),
        ({"name": "lbfgs", "momentum": 2}, "no setting 'momentum'; it has: sampling, certificate"),
        ({"p2p_weight": 0.0}, "p2p_weight must be a positive finite number"),
        ({"p2p_weight": np.nan}, "p2p_weight must be a positive finite number"),
        ({"p2p_weight": True}, "p2p_weight must be a positive finite number"),
        ({"max_iterations": -1}, "max_iterations must be a whole number"),
        ({"n_vertices": 100.5}, "n_vertices must be a whole number"),
        ({"n_vertices": 0}, "n_vertices must be at least 3, got 0"),
        ({"name": "lbfgs", "memory": -1}, "'memory' of .* a whole number of at least 0"),
        ({"name": "aqp", "kappa": -1.0}, "'kappa' of .* a finite number of at least 0"),
        ({"name": "aqp", "kappa": 0.5}, "kappa must be at least 1"),
        ({"name": "aqp", "arap_iterations": 0}, "arap_iterations must be at least 1"),
        ({"name": "newton-shift", "beta": 0}, "beta, .* must be positive"),
        ({"name": "lbfgs", "sampling": np.array(["graded"])}, "'sampling' .* one of graded, uni"),
    ],
)
def test_refusals_name_the_culprit(changes: dict, message: str) -> None:
    shape, pose = problem("ell")
    arguments = {"name": "mls", "domain": shape, "pose": pose, **changes}
    if arguments["name"] == "slim":
        pytest.importorskip("igl")
    with pytest.raises(MethodError, match=message):
        run_method(**arguments)


@pytest.mark.parametrize("name", ["newton", "lbfgs", "slim", "mls"])
@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [
        ("name", ["mls"], r"unknown method \['mls'\]"),
        ("domain", domain("ell").cage, r"domain must be a Domain, not of type Cage; .*from_cage"),
        ("domain", None, "domain must be a Domain, not of type NoneType"),
        ("pose", [[1, 1]], r"pose must be a Pose, not of type list; make one with Pose\(handles"),
        ("align", "no", "align must be True or False, got 'no'"),
        ("align", 1, "align must be True or False, got 1"),
        ("start", 3, "start must be a HarmonicMap, a MeshMap or None, not of type int"),
        ("triangulation", [[0, 1, 2]], "triangulation must be a Triangulation or None, not of ty"),
        ("callback", 3, "callback must be a function or None, not of type int"),
    ],
)
def test_arguments_of_the_wrong_type_are_named(
    name: str, argument: str, value: object, message: str
) -> None:
    shape, pose = problem("ell")
    arguments = {"name": name, "domain": shape, "pose": pose, argument: value}
    with pytest.raises(MethodError, match=message):
        run_method(**arguments)


@pytest.mark.parametrize("name", ["newton", "lbfgs", "aqp"])
def test_a_start_from_another_domain_is_refused(name: str) -> None:
    shape, pose = problem("ell")
    with pytest.raises(StartError, match="belongs to another domain"):
        run_method(name, shape, pose, start=HarmonicMap.identity(domain("ring")))


@pytest.mark.parametrize("name", ["newton", "lbfgs"])
def test_a_start_that_folds_is_refused(name: str) -> None:
    shape, pose = problem("ell")
    identity = HarmonicMap.identity(shape)
    mirrored = HarmonicMap(shape, 0 * identity.phi, identity.phi)
    with pytest.raises(StartError, match="not certified"):
        run_method(name, shape, pose, start=mirrored)


@pytest.mark.parametrize(
    ("name", "settings", "message"),
    [
        (["mls"], {}, "unknown method"),
        ("mls", 3, "settings must be a mapping of names to values, got 3"),
        ("mls", {"alpha": "much"}, "the setting 'alpha' .* must be a finite number"),
    ],
)
def test_a_choice_of_the_wrong_type_is_refused(name: Any, settings: Any, message: str) -> None:
    with pytest.raises(MethodError, match=message):
        MethodChoice(name, settings)


def test_a_handle_outside_is_refused() -> None:
    shape, _ = problem("ell")
    with pytest.raises(PoseError, match="handle 0"):
        run_method("mls", shape, Pose([[2.0, 2.0]], [[0.0, 0.0]]))


def test_a_missing_package_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    found = importlib.util.find_spec

    def without(name: str, *more: object) -> object:
        return None if name in ("igl", "clarabel") else found(name, *more)

    monkeypatch.setattr(importlib.util, "find_spec", without)
    shape, pose = problem("ell")
    needing = [name for name, method in methods().items() if method.package]
    assert needing
    for name in needing:
        with pytest.raises(MethodError, match=r"pip install 'glid-nb\[compare\]'"):
            run_method(name, shape, pose)
        assert name not in methods(available=True)
    assert "newton" in methods(available=True)


def test_a_broken_package_names_the_extra_and_the_cause(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cause = "libgomp.so.1: cannot open shared object file"
    for package in ("igl", "clarabel"):
        (tmp_path / f"{package}.py").write_text(f"raise ImportError({cause!r})")
        monkeypatch.delitem(sys.modules, package, raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    shape, pose = problem("ell")
    for name, method in methods().items():
        if method.package is None:
            continue
        with pytest.raises(MethodError, match=r"pip install .*'glid-nb\[compare\]'") as caught:
            run_method(name, shape, pose)
        assert f"{name!r} needs the package" in str(caught.value)
        assert cause in str(caught.value)
        assert isinstance(caught.value.__cause__, ImportError)


def test_an_energy_may_be_a_name() -> None:
    shape, pose = problem("ell")
    by_name = run_method("newton", shape, pose, "arap", max_iterations=1)
    assert by_name.energy == run_method("newton", shape, pose, ARAP(), max_iterations=1).energy
    with pytest.raises(EnergyError, match="unknown energy 'stiff'"):
        run_method("newton", shape, pose, "stiff")


def test_handles_on_one_line_are_no_cage() -> None:
    shape = Domain.from_cage(Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    handles = [[1, 1], [2, 1], [3, 1]]
    with pytest.raises(MethodError, match="lie on one line"):
        run_method("mean-value", shape, Pose(handles, handles), n_vertices=200)
