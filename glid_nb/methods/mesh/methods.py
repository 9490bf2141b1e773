"""The methods of this family."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from glid_nb.energies import Energy
from glid_nb.methods.mesh import aqp as aqp_
from glid_nb.methods.mesh import libigl
from glid_nb.methods.mesh.setup import MeshProblem
from glid_nb.methods.method import Inputs, Method, MethodError
from glid_nb.methods.recording import Run, record
from glid_nb.methods.result import MethodResult


def _record(inputs: Inputs, run: Run) -> MethodResult:
    return record(inputs.method, run, inputs.pose, inputs.max_iterations, inputs.callback)


def slim(inputs: Inputs, tolerance: float = 1e-9) -> MethodResult:
    return _record(inputs, libigl.slim(MeshProblem.of(inputs), tolerance))


def arap(inputs: Inputs, tolerance: float = 1e-9) -> MethodResult:
    inputs.need_handles()
    return _record(inputs, libigl.arap(MeshProblem.of(inputs), tolerance))


def aqp(
    inputs: Inputs, kappa: float = 1000.0, tolerance: float = 1e-9, arap_iterations: int = 5
) -> MethodResult:
    problem = MeshProblem.of(inputs)
    # Hard constraints: a positional part that is 0 but for rounding would be noise times lambda.
    problem = replace(problem, p2p_weight=1.0)
    return _record(inputs, aqp_.aqp(problem, kappa, tolerance, arap_iterations))


def _check_aqp(_: Energy, settings: Mapping[str, Any]) -> None:
    kappa = settings["kappa"]
    if kappa < 1:
        raise MethodError(
            f"kappa must be at least 1, at which AQP does not extrapolate; got {kappa!r}"
        )
    if settings["arap_iterations"] < 1:
        raise MethodError(
            "arap_iterations must be at least 1: the first brings the handles to their targets"
        )


def _check_slim(energy: Energy, _: Mapping[str, Any]) -> None:
    if energy.name in ("amips", "arap", "exp"):  # libigl has something close, so say what
        libigl.slim_energy(energy)


METHODS = (
    Method(
        "slim",
        "SLIM",
        "mesh",
        "Scalable Locally Injective Mappings on a triangle mesh, soft constraints (libigl).",
        slim,
        max_iterations=300,
        energies=("iso", "exp", "mips"),
        package="igl",
        restrict=_check_slim,
    ),
    Method(
        "aqp",
        "AQP",
        "mesh",
        "Accelerated Quadratic Proxy on a triangle mesh, hard constraints.",
        aqp,
        max_iterations=1000,
        energies=("iso", "exp", "amips", "mips", "custom"),
        weighted=False,
        restrict=_check_aqp,
    ),
    Method(
        "arap-mesh",
        "ARAP, local/global",
        "mesh",
        "As-rigid-as-possible on a triangle mesh, hard constraints; it may fold (libigl).",
        arap,
        energies=("arap",),
        package="igl",
        weighted=False,
    ),
)
