"""SLIM and ARAP of libigl, which is an optional package."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from glid_nb.energies import AMIPS, ARAP, Energy, ExponentialSymmetricDirichlet
from glid_nb.methods.mesh.operators import flips
from glid_nb.methods.mesh.setup import MeshMethod, MeshProblem
from glid_nb.solvers import MethodError, Status
from glid_nb.solvers.loop import Ending, Steps

_WINDOW = 5


def slim_energy(energy: Energy) -> tuple[str, float]:
    """libigl's name of an energy, and libigl's energy in ours.

    Raises
    ------
    MethodError
        For AMIPS, ARAP, and the exponential energy with another parameter than libigl's.
    """
    if isinstance(energy, AMIPS):
        # On triangles libigl weights EXP_CONFORMAL by the symmetric Dirichlet energy's gradient, so
        # it does not end at a minimum of that either, and it is not offered under another name.
        raise MethodError(
            "libigl's SLIM has no AMIPS: the closest of its energies, EXP_CONFORMAL, is "
            "exp((sigma_1/sigma_2 + sigma_2/sigma_1)/2), without AMIPS' terms of area and with no "
            "s; use MIPS(), or AMIPS with the method aqp"
        )
    if isinstance(energy, ARAP):
        raise MethodError(
            "libigl's SLIM has ARAP, but that is no barrier: maps creep up to the first flat "
            "triangle, stay there and at last turn it over; use the method arap-mesh, or "
            "SymmetricDirichlet()"
        )
    if isinstance(energy, ExponentialSymmetricDirichlet) and energy.s != 2:
        raise MethodError(
            "libigl's SLIM minimises exp(sigma_1^2 + sigma_1^-2 + sigma_2^2 + sigma_2^-2), which "
            "is exp(s E_iso) with s = 2, and its Python bindings cannot set the factor; got "
            f"s = {energy.s}; use ExponentialSymmetricDirichlet(2), or the method aqp"
        )
    return {
        "iso": ("SYMMETRIC_DIRICHLET", 2.0),
        "exp": ("EXP_SYMMETRIC_DIRICHLET", 1.0),
        "mips": ("CONFORMAL", 1.0),
    }[energy.name]


@dataclass(frozen=True)
class SLIM(MeshMethod):
    """Scalable Locally Injective Mappings on a triangle mesh, soft constraints (libigl).

    Rabinovich et al. 2017. libigl minimises ``sum_t 2 area_t E_t + soft_p sum |f(p_i) - q_i|^2``;
    ``soft_p`` is chosen so that this is a multiple of our energy with the same ``lambda``. A start
    with triangles turned over is left out.
    """

    name = "slim"
    label = "SLIM"
    max_iterations = 300
    energies = ("iso", "exp", "mips")
    package = "igl"

    tolerance: float = 1e-9

    def check_energy(self, energy: Energy) -> None:
        """Where libigl has something close, say what."""
        if energy.name in ("amips", "arap", "exp"):
            slim_energy(energy)
        super().check_energy(energy)

    def steps(self, problem: MeshProblem) -> Steps:
        """libigl's iterations."""
        return _slim(problem, self.tolerance)


@dataclass(frozen=True)
class ARAPLocalGlobal(MeshMethod):
    """As-rigid-as-possible on a triangle mesh, hard constraints; it may fold (libigl).

    Local and global steps (Liu et al. 2008).
    """

    name = "arap-mesh"
    label = "ARAP, local/global"
    energies = ("arap",)
    package = "igl"
    options = ("align", "max_iterations")
    needs_handles = True

    tolerance: float = 1e-9

    def steps(self, problem: MeshProblem) -> Steps:
        """libigl's iterations."""
        return _arap(problem, self.tolerance)


def _slim(problem: MeshProblem, tolerance: float) -> Steps:
    import igl  # noqa: PLC0415

    name, factor = slim_energy(problem.energy)
    mesh = problem.operators.mesh
    flat = np.column_stack([mesh.vertices, np.zeros(len(mesh.vertices))])
    targets = _real(problem.targets)
    w = problem.start
    if flips(*problem.operators.wirtinger(w)):
        w = problem.operators.rest
    data = igl.slim_precompute(
        np.asfortranarray(flat),
        np.asfortranarray(mesh.triangles),
        np.asfortranarray(_real(w)),
        getattr(igl.MappingEnergyType, name),
        problem.handles.astype(np.int32),
        np.asfortranarray(targets),
        problem.p2p_weight * problem.operators.area * factor,
    )
    energies = []
    seconds = 0.0
    while True:
        state = problem.snapshot(w, seconds)
        yield state
        energies.append(state.entry.energy)
        if _stalled(energies, tolerance):
            return _converged(tolerance)
        began = time.perf_counter()
        images = igl.slim_solve(data, 1)
        seconds = time.perf_counter() - began
        w = _complex(images)


def _arap(problem: MeshProblem, tolerance: float) -> Steps:
    import igl  # noqa: PLC0415

    assert isinstance(problem.energy, ARAP)
    mesh = problem.operators.mesh
    data = igl.ARAPData()
    data.max_iter = 1
    vertices = np.ascontiguousarray(mesh.vertices)
    faces = np.ascontiguousarray(mesh.triangles, dtype=np.int64)
    igl.arap_precomputation(vertices, faces, 2, problem.handles.astype(np.int32), data)
    targets = _real(problem.targets)
    images = _real(problem.start)
    energies: list[float] = []
    seconds = 0.0
    while True:
        state = problem.snapshot(_complex(images), seconds)
        yield state
        # The start misses the hard constraints, so its energy does not count.
        if energies or state.entry.energy_p2p == 0:
            energies.append(state.entry.energy_iso)
        else:
            energies.append(np.inf)
        if _stalled(energies, tolerance):
            return _converged(tolerance)
        began = time.perf_counter()
        images = igl.arap_solve(targets, data, np.ascontiguousarray(images))
        seconds = time.perf_counter() - began


def _stalled(energies: list[float], tolerance: float) -> bool:
    recent = energies[-1 - _WINDOW :]
    return len(recent) > _WINDOW and abs(recent[0] - recent[-1]) <= tolerance * abs(recent[-1])


def _converged(tolerance: float) -> Ending:
    return Ending(
        Status.CONVERGED,
        f"The solver converged: {_WINDOW} iterations together change the energy by less than "
        f"{tolerance:g} of it.",
    )


def _real(w: Any) -> Any:
    return np.stack([np.real(w), np.imag(w)], axis=-1)


def _complex(images: Any) -> Any:
    return images[:, 0] + 1j * images[:, 1]
