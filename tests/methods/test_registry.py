"""The list of methods, and what it refuses."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glid_nb import methods
from glid_nb.energies import ARAP, EnergyError, SymmetricDirichlet
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import METHODS, available, by_name
from glid_nb.minima import solve
from glid_nb.pose import Pose, PoseError
from glid_nb.solvers import MethodError, OptionError, Options, StartError

from ..support.domains import domain
from ..support.problems import problem, run_method


def test_every_method_says_what_it_is() -> None:
    for name, method in METHODS.items():
        assert method.name == name
        assert method.label
        assert method.summary.endswith(".")
        assert method.family in ("harmonic", "mesh", "linear")
        assert method.max_iterations > 0
        assert method().certified == (method.family == "harmonic")
        assert set(method.options) <= {*Options.__dataclass_fields__}


def test_a_method_is_a_value() -> None:
    lbfgs = methods.LBFGS(memory=7)
    assert lbfgs == by_name("lbfgs", memory=7) != methods.LBFGS()
    assert hash(lbfgs) == hash(methods.LBFGS(memory=7))
    assert lbfgs.settings == {"memory": 7}
    assert lbfgs.defaults() == {"memory": 5, "initial": "identity"}
    for name, method in METHODS.items():
        assert by_name(name, **method().settings) == method()


@pytest.mark.parametrize(
    ("name", "settings", "message"),
    [
        ("magic", {}, "unknown method 'magic'; choose one of newton"),
        ("lbgfs", {}, "did you mean 'lbfgs'"),
        (["mls"], {}, r"unknown method \['mls'\]"),
        ("lbfgs", {"momentum": 2}, "no setting 'momentum'; it has: memory, initial"),
        ("mls", {"alpha": "much"}, "the setting 'alpha' .* must be a finite number"),
        ("mls", {"n_vertices": 100.5}, "n_vertices' .* must be a whole number"),
        ("mls", {"n_vertices": 0}, "'n_vertices' of .* a whole number of at least 3, got 0"),
        ("lbfgs", {"memory": -1}, "'memory' of .* a whole number of at least 0"),
        ("lbfgs", {"initial": np.array(["identity"])}, "'initial' .* one of identity, dirichlet"),
        ("aqp", {"kappa": -1.0}, "'kappa' of .* a finite number at least 1, at which"),
        ("aqp", {"kappa": 0.5}, "'kappa' of .* a finite number at least 1"),
        ("aqp", {"arap_iterations": 0}, "'arap_iterations' of .* 1, because the first brings"),
        ("newton-shift", {"beta": 0}, "'beta' of .* greater than 0, because it is the least shift"),
        ("harmonic-weights", {"power": 4}, "'power' .* must be one of 1, 2, 3"),
    ],
)
def test_bad_settings_are_refused_by_name(name: Any, settings: dict, message: str) -> None:
    with pytest.raises(MethodError, match=message):
        by_name(name, **settings)


@pytest.mark.parametrize(
    ("name", "energy", "message"),
    [
        ("gauss-newton", SymmetricDirichlet(), "cannot minimise .* 'iso'"),
        ("aqp", ARAP(), "cannot minimise the energy 'arap'"),
        ("slim", ARAP(), "ARAP, but it does not prevent flips: .* arap-mesh"),
        ("slim", "amips", "no AMIPS: the closest .* is exp.*without AMIPS' te"),
        ("slim", "exp", "minimises exp.sigma_1.2 .* s = 2, .*; got s = 1.0"),
    ],
)
def test_energies_that_do_not_go_are_refused(name: str, energy: Any, message: str) -> None:
    if name == "slim":
        pytest.importorskip("igl")
    with pytest.raises(MethodError, match=message):
        run_method(name, *problem("ell"), energy)


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("p2p_weight", 0.0),
        ("p2p_weight", np.nan),
        ("p2p_weight", True),
        ("max_iterations", -1),
        ("align", "no"),
        ("align", 1),
    ],
)
def test_options_out_of_range_are_refused_by_name(option: str, value: Any) -> None:
    with pytest.raises(OptionError, match=option):
        Options(**{option: value})


@pytest.mark.parametrize("name", ["newton", "lbfgs", "slim", "mls"])
@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [
        ("domain", domain("ell").cage, r"domain must be Domain, not Cage; .*from_cage"),
        ("domain", None, "domain must be Domain, not NoneType"),
        ("pose", [[1, 1]], r"pose must be Pose, not list; make one with Pose\(handles"),
        ("start", 3, "start must be HarmonicMap, MeshMap, Result or None, not int"),
        ("callback", 3, "callback must be Callable or None, not int"),
    ],
)
def test_arguments_of_the_wrong_type_are_named(
    name: str, argument: str, value: object, message: str
) -> None:
    shape, pose = problem("ell")
    arguments = {"domain": shape, "pose": pose, "method": METHODS[name](), argument: value}
    with pytest.raises(TypeError, match=message):
        solve(**arguments)


def test_a_method_is_not_its_name() -> None:
    with pytest.raises(TypeError, match="method must be Method or None, not str; one of glid_nb"):
        solve(*problem("ell"), method="lbfgs")  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["newton", "lbfgs", "aqp"])
def test_a_start_from_another_domain_is_refused(name: str) -> None:
    shape, pose = problem("ell")
    with pytest.raises(StartError, match="has another domain"):
        run_method(name, shape, pose, start=HarmonicMap.identity(domain("ring")))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["newton", "lbfgs", "bdhm"])
def test_a_start_that_folds_is_refused(name: str) -> None:
    if METHODS[name].package:
        pytest.importorskip(METHODS[name].package)
    shape, pose = problem("ell")
    identity = HarmonicMap.identity(shape)
    mirrored = HarmonicMap(shape, 0 * identity.phi, identity.phi)
    with pytest.raises(StartError, match="not certified"):
        run_method(name, shape, pose, start=mirrored)


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
    needing = [name for name, method in METHODS.items() if method.package]
    assert needing
    for name in needing:
        with pytest.raises(MethodError, match=r"pip install 'glid-nb\[compare\]'"):
            run_method(name, shape, pose)
        assert name not in available()
    assert "newton" in available()


def test_a_broken_package_names_the_extra_and_the_cause(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    cause = "libgomp.so.1: cannot open shared object file"
    for package in ("igl", "clarabel"):
        (tmp_path / f"{package}.py").write_text(f"raise ImportError({cause!r})")
        monkeypatch.delitem(sys.modules, package, raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    shape, pose = problem("ell")
    for name, method in METHODS.items():
        if method.package is None:
            continue
        with pytest.raises(MethodError, match=r"pip install .*'glid-nb\[compare\]'") as caught:
            run_method(name, shape, pose)
        assert f"{name!r} needs the package" in str(caught.value)
        assert cause in str(caught.value)
        assert isinstance(caught.value.__cause__, ImportError)


@pytest.mark.slow
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
