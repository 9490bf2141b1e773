"""SLIM and ARAP of the optional package libigl."""

from dataclasses import dataclass

import numpy as np

from glid_nb.energies import Energy
from glid_nb.geometry import as_points
from glid_nb.harmonic import as_complex
from glid_nb.methods.mesh.operators import MeshMethod, MeshProblem, flips
from glid_nb.pose import Pose
from glid_nb.solvers import MethodError
from glid_nb.solvers.loop import Steps

# For each of our energies: libigl's name, and libigl's energy divided by ours.
_ENERGIES = {
    "iso": ("SYMMETRIC_DIRICHLET", 2.0),
    "exp": ("EXP_SYMMETRIC_DIRICHLET", 1.0),
    "mips": ("CONFORMAL", 1.0),
}
# We do not offer EXP_CONFORMAL. On triangles libigl weights it by the gradient of the symmetric
# Dirichlet energy, so it does not even end at a minimum of EXP_CONFORMAL.
_REFUSED = {
    "amips": "has no AMIPS: the closest of its energies, EXP_CONFORMAL, is "
    "exp((sigma_1/sigma_2 + sigma_2/sigma_1)/2), without AMIPS' terms of area and with no s; use "
    "MIPS(), or AMIPS with the method aqp",
    "arap": "has ARAP, but it does not prevent flips: maps stop at the first flat triangle, stay "
    "there and at last turn it over; use the method arap-mesh, or SymmetricDirichlet()",
    "exp": "minimises exp(sigma_1^2 + sigma_1^-2 + sigma_2^2 + sigma_2^-2), which is exp(s E_iso) "
    "with s = 2, and its Python bindings cannot set the factor; got s = {s}; use "
    "ExponentialSymmetricDirichlet(2), or the method aqp",
}


@dataclass(frozen=True)
class SLIM(MeshMethod):
    """Scalable Locally Injective Mappings on a triangle mesh, soft constraints (libigl).

    Rabinovich et al. 2017. libigl minimises ``sum_t 2 area_t E_t + soft_p sum |f(p_i) - q_i|^2``.
    ``soft_p`` is chosen so that this is a multiple of our energy with the same ``lambda``. A start
    with flipped triangles is replaced by the identity.
    """

    name = "slim"
    label = "SLIM"
    max_iterations = 300
    energies = ("iso", "exp", "mips")
    package = "igl"
    window = 5

    tolerance: float = 1e-9

    def check(self, energy: Energy, pose: Pose) -> None:
        s = getattr(energy, "s", None)
        if energy.name in _REFUSED and (energy.name, s) != ("exp", 2):
            raise MethodError(f"libigl's SLIM {_REFUSED[energy.name].format(s=s)}")
        super().check(energy, pose)

    def steps(self, problem: MeshProblem) -> Steps:
        import igl  # noqa: PLC0415

        name, factor = _ENERGIES[problem.inputs.energy.name]
        mesh, w = problem.operators.mesh, problem.start
        unit = problem.inputs.domain.cage.unit  # libigl's tolerances are absolute
        flat = np.column_stack([mesh.vertices / unit, np.zeros(len(mesh.vertices))])
        if flips(*problem.operators.wirtinger(w)):
            w = problem.operators.rest
        data = igl.slim_precompute(
            np.asfortranarray(flat),
            np.asfortranarray(mesh.triangles),
            np.asfortranarray(as_points(w / unit)),
            getattr(igl.MappingEnergyType, name),
            problem.handles.astype(np.int32),
            np.asfortranarray(as_points(problem.targets / unit)),
            problem.p2p_weight * problem.operators.area * factor,
        )
        while True:
            yield problem.at(w)
            w = unit * as_complex(igl.slim_solve(data, 1))


@dataclass(frozen=True)
class ARAPLocalGlobal(MeshMethod):
    """As-rigid-as-possible on a triangle mesh, hard constraints; it may fold (libigl; Liu 2008)."""

    name = "arap-mesh"
    label = "ARAP, local/global"
    energies = ("arap",)
    package = "igl"
    window = 5
    options = ("align", "max_iterations")
    needs_handles = True

    tolerance: float = 1e-9

    def steps(self, problem: MeshProblem) -> Steps:
        import igl  # noqa: PLC0415

        mesh = problem.operators.mesh
        data = igl.ARAPData()
        data.max_iter = 1
        vertices = np.ascontiguousarray(mesh.vertices)
        faces = np.ascontiguousarray(mesh.triangles, dtype=np.int64)
        igl.arap_precomputation(vertices, faces, 2, problem.handles.astype(np.int32), data)
        targets, w = as_points(problem.targets), problem.start
        while True:
            yield problem.at(w)
            w = as_complex(igl.arap_solve(targets, data, as_points(w)))
