"""Every compiled program is lowered for CUDA, on a machine without a GPU.

A program is lowered at its call, with the settings of that call. Then it runs as usual.
"""

from __future__ import annotations

import ast
import importlib
import re
import typing
from collections import defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from glid_nb import HarmonicMap, Options, Pose, methods, solve
from glid_nb._jax import CompiledOnUse
from glid_nb._programs import Program, can_keep_for
from glid_nb._runtime import double_precision
from glid_nb.energies import AMIPS, ENERGIES, CustomEnergy, as_energy
from glid_nb.methods.subspace import descent
from glid_nb.minima import batch
from glid_nb.solvers import Result, cholesky, newton, step, subspace
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import Newton, NewtonDescent
from glid_nb.solvers.sensitivity import minimum_of

from ..support.domains import domain

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]

PACKAGE = Path(__file__).resolve().parents[2] / "glid_nb"

MAKERS = {"jit", "solver_jit", "Program", "CompiledOnUse", "pmap", "shard_map", "ffi_call"}
"""Calls that make something compiled."""
NO_PROGRAMS = {
    "glid_nb._features._is_known": "asks XLA for an option",
    "glid_nb._features.solver_jit": "is a maker itself",
    "glid_nb._jax.CompiledOnUse": "is a maker itself",
    "glid_nb._jax.If": "defines a maker where nobody checks types",
    "glid_nb._programs.Program": "is a maker itself",
    "glid_nb._features.lapack_in_place": "lowers for the CPU only, and runs nothing",
    "glid_nb.solvers.cholesky._lapack_factor": "LAPACK's path, within the programs",
    "glid_nb.solvers.cholesky._lapack_solve": "LAPACK's path, within the programs",
}
ON_CUDA = re.compile(r"cusolver_\w+_ffi|cublas_\w+_ffi|cu_\w+|Sharding")
"""Custom calls that JAX's plugin for CUDA brings."""

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
BENT = HANDLES + np.array([[0.4, 0.2], [0.0, 0.3], [0.0, 0.0]])
QUICK = Options(restarts=0, max_iterations=2)
METHODS = {
    "lbfgs": {"initial": "dirichlet"},
    "newton-staged": {},
    "newton-eigen": {},
    "gauss-newton": {},
    "aqp": {},
}
"""Names and settings. Together they use every kind of Hessian."""


def makers(source: str) -> Iterator[tuple[str, ast.Call | ast.expr]]:
    """Name of the top-level statement, and the call or decorator in it that compiles."""
    for statement in ast.parse(source).body:
        target = statement.targets[0] if isinstance(statement, ast.Assign) else statement
        name = getattr(target, "name", None) or getattr(target, "id", type(target).__name__)
        for node in ast.walk(statement):
            called = node.func if isinstance(node, ast.Call) else None
            uses = [called, *(node.args if isinstance(node, ast.Call) else ())]
            uses += getattr(node, "decorator_list", [])
            for use in uses:
                if getattr(use, "attr", getattr(use, "id", None)) in MAKERS:
                    yield name, use


def programs_in_the_code() -> set[str]:
    found = set[str]()
    for path in sorted(PACKAGE.rglob("*.py")):
        module = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
        found |= {f"{module}.{name}" for name, _ in makers(path.read_text(encoding="utf-8"))}
    return found


@pytest.mark.parametrize(
    ("source", "name"),
    [
        ("run = Program(f, donated=2, may_keep=g)", "run"),
        ("_density = jit(lambda x: x)", "_density"),
        ("@solver_jit\ndef f(x): ...", "f"),
        ("@functools.partial(solver_jit, static_argnames='n')\ndef f(x, n): ...", "f"),
        ("def f(x):\n    return jax.jit(g)(x)", "f"),
        ("class A:\n    @jax.jit\n    def f(x): ...", "A"),
    ],
)
def test_a_program_is_found_in_the_code(source: str, name: str) -> None:
    assert {found for found, _ in makers(source)} == {name}


class Lowered:
    """The lowered texts of the programs, by their names in the code."""

    def __init__(self) -> None:
        self.texts: defaultdict[str, dict[Any, str]] = defaultdict(dict)
        self.names = dict[int, str]()
        for name in programs_in_the_code() - NO_PROGRAMS.keys():
            module, _, attribute = name.rpartition(".")
            self.names[id(getattr(importlib.import_module(module), attribute))] = name

    def add(self, program: Any, jitted: Any, arguments: tuple, keywords: dict[str, Any]) -> None:
        leaves, tree = jax.tree.flatten((arguments, sorted(keywords.items())))
        kind = tree, *(np.shape(a) if not isinstance(a, str) else a for a in leaves)
        known = self.texts[self.names.get(id(program), repr(program))]
        if kind not in known:
            traced = jitted.trace(*arguments, **keywords)
            known[kind] = traced.lower(lowering_platforms=("cuda",)).as_text()


@pytest.fixture(scope="module")
def lowered() -> Lowered:
    """One pose with every energy, stiff areas, angles, every method; a batch in lockstep."""
    found = Lowered()
    call, run = CompiledOnUse.__call__, Program.__call__

    def called(self: CompiledOnUse, *arguments: Any, **keywords: Any) -> Any:
        found.add(self, self, arguments, keywords)
        return call(self, *arguments, **keywords)

    def ran(self: Program, *arguments: Any) -> Any:
        jitted = jax.jit(self.function, donate_argnums=self.donated)
        found.add(self, jitted, arguments, {})
        (problem, *rest), known = arguments, found.texts[found.names[id(self)]]
        if len(known) == 1:
            for energy in (*ENERGIES, CUSTOM):
                found.add(self, jitted, (problem._replace(energy=as_energy(energy)), *rest), {})
        return run(self, *arguments)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CompiledOnUse, "__call__", called)
        patch.setattr(Program, "__call__", ran)
        use_every_program()
    return found


CUSTOM = CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2))


def use_every_program() -> None:
    ell, pose = domain("ell"), Pose(HANDLES, BENT)
    stiff = [{"points": [[-1.0, -1.0], [0.0, -1.5]], "radius": 0.5, "strength": 0.7}]
    solve(ell, pose, None, QUICK)
    solve(ell, Pose(HANDLES, BENT, stiffness=stiff), None, QUICK)
    solve(ell, Pose(HANDLES, BENT, angles=[0.3, None, None]), None, QUICK)
    solve(ell, pose, None, Options.paper(restarts=0, max_iterations=2))
    for name, settings in METHODS.items():
        energy = "arap" if name == "gauss-newton" else None
        solve(ell, pose, energy, QUICK, method=methods.by_name(name, **settings))
    inputs = Inputs(domain=ell, pose=pose, energy=as_energy(None), options=QUICK)
    batch.in_lockstep([inputs, inputs])
    evaluate_a_start(inputs)
    differentiate(solve(ell, pose, AMIPS(s=0.8), Options(restarts=0)))


def differentiate(result: Result) -> None:
    """By one number, by many, and with a factor of its own."""
    result.sensitivity(of="s")
    result.sensitivity(0)
    assert minimum_of(result).factor is not None


@double_precision
def evaluate_a_start(inputs: Inputs) -> None:
    """As if the start had no proof."""
    start = NewtonDescent(Newton(), inputs)
    point = subspace.evaluated_at(start.problem, start.coefficients)
    newton.gradient(start.problem, point)


def test_every_program_of_the_code_is_lowered(lowered: Lowered) -> None:
    """A new program must be called in `use_every_program`."""
    assert set(lowered.texts) == programs_in_the_code() - NO_PROGRAMS.keys()
    kinds = lowered.texts["glid_nb.solvers.step.run"]
    assert len(kinds) >= len(ENERGIES) + len(["custom", "stiff areas", "paper"])
    curvatures = typing.get_args(descent.Curvature)
    assert len(lowered.texts["glid_nb.methods.subspace.descent.hessian_at"]) == len(curvatures)


def test_no_program_calls_what_only_a_cpu_has(lowered: Lowered) -> None:
    calls = {
        name: {call for text in texts.values() for call in custom_calls(text)}
        for name, texts in lowered.texts.items()
    }
    for name, some in calls.items():
        assert not [call for call in some if not ON_CUDA.fullmatch(call)], name
    assert "cusolver_potrf_ffi" in calls["glid_nb.solvers.step.run"]
    assert "cusolver_potrf_ffi" in calls["glid_nb.minima.batch.together"]


def custom_calls(text: str) -> set[str]:
    return set(re.findall(r"custom_call @([\w.$]+)", text))


def test_the_same_test_finds_a_cpus_call() -> None:
    shape = jax.ShapeDtypeStruct((3, 3), np.float32)
    text = jax.jit(jnp.linalg.eigh).trace(shape).lower(lowering_platforms=("cpu",)).as_text()
    assert any(not ON_CUDA.fullmatch(call) for call in custom_calls(text))


def test_every_product_is_asked_for_in_full_precision(lowered: Lowered) -> None:
    """Otherwise a GPU would use TF32 for the Hessian in single precision."""
    products = [
        line
        for texts in lowered.texts.values()
        for text in texts.values()
        for line in text.splitlines()
        if "dot_general" in line
    ]
    assert any("f32" in line for line in products)
    assert any("f64" in line for line in products)
    assert [line for line in products if "precision = [HIGHEST, HIGHEST]" not in line] == []


def test_the_donated_factor_is_where_the_new_one_is_written(lowered: Lowered) -> None:
    """Otherwise every call would warn that the donated memory is of no use."""
    for text in lowered.texts["glid_nb.solvers.step.run"].values():
        assert text.count("tf.aliasing_output") == 1
        assert "jax.buffer_donor" not in text


def test_only_the_whitened_basis_is_in_single_precision(lowered: Lowered) -> None:
    """Values, gradients and certificates take matrices in double precision."""
    for name, texts in lowered.texts.items():
        for text in texts.values():
            (main,) = re.findall(r"func.func public @main\((.*?)\) ->", text, re.DOTALL)
            singles = re.findall(r"tensor<([\dx]*)f32>", main)
            of_newton = name in ("glid_nb.solvers.step.run", "glid_nb.minima.batch.together")
            assert len(singles) <= 1, name
            assert not singles or of_newton or name.startswith("glid_nb.methods.subspace"), name


@double_precision
def test_the_factorisation_takes_the_platforms_own_solver() -> None:
    shapes = jax.ShapeDtypeStruct((4, 4), np.float64), jax.ShapeDtypeStruct((4,), np.float64)

    def both(h: Any, b: Any) -> Any:
        return cholesky.solve(cholesky.factorise(h), b)

    traced = jax.jit(both).trace(*shapes)
    calls: Callable[[str], set[str]] = lambda platform: custom_calls(  # noqa: E731
        traced.lower(lowering_platforms=(platform,)).as_text()
    )
    assert calls("cpu") == {"lapack_dpotrf_ffi", "lapack_dtrsm_ffi"}
    assert calls("cuda") == {"cusolver_potrf_ffi"}
    # If a matrix is not definite, the solver looks for NaN. cuSOLVER's `info` is then not 0.
    text = traced.lower(lowering_platforms=("cuda",)).as_text()
    assert re.search(r"dense<0x7FF8000000000000>", text)
    assert re.search(r"stablehlo.compare +EQ", text)


class Device:
    def __init__(self, platform: str) -> None:
        self.platform = platform


@pytest.mark.parametrize(
    ("device", "default", "count", "kept"),
    [
        ("cpu", "cpu", 1, True),
        ("cpu", "cpu", 2, False),
        ("gpu", "gpu", 1, False),
        # Executables are read for the default platform.
        ("cpu", "gpu", 1, False),
    ],
)
def test_programs_are_kept_for_a_cpu_alone(
    monkeypatch: pytest.MonkeyPatch, device: str, default: str, count: int, kept: bool
) -> None:
    monkeypatch.setattr(jax, "default_backend", lambda: default)
    monkeypatch.setattr(jax, "device_count", lambda: count)
    assert can_keep_for(Device(device)) is kept


def test_a_device_may_be_chosen_by_its_platforms_name() -> None:
    ell, pose = domain("ell"), Pose(HANDLES, BENT)
    here = solve(ell, pose, None, QUICK)
    for device in ("cpu", jax.local_devices()[0]):
        with jax.default_device(device):
            there = solve(ell, pose, None, QUICK)
        assert there.energy == here.energy


@pytest.mark.parametrize("precision", ["bfloat16", "BF16_BF16_F32", "tensorfloat32"])
def test_a_callers_precision_of_products_changes_nothing(
    precision: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    ell, pose = domain("ell"), Pose(HANDLES, BENT)
    here = solve(ell, pose, None, QUICK)
    again = Program(step.run.function, step.run.donated, step.run.may_keep)
    monkeypatch.setattr(step, "run", again)
    with jax.default_matmul_precision(precision):
        there = solve(ell, pose, None, QUICK)
        assert jax.config.jax_default_matmul_precision == precision
    assert there.energy == here.energy
    assert isinstance(there.map, HarmonicMap)
    assert isinstance(here.map, HarmonicMap)
    np.testing.assert_array_equal(there.map.phi, here.map.phi)
