"""The time of each stage of an iteration, run separately (paper Figure 9)."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp

from glid_nb._features import solver_jit
from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import Result, cholesky, evaluation, line_search
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.hessian import LocalHessian, assemble, local_hessian, positive_part
from glid_nb.solvers.positional import positional_energy
from glid_nb.solvers.problem import (
    SubspaceProblem,
    real_coefficients,
    restrict_hessian,
    unknowns_of,
)
from studies.timing import timed

STAGES = ("gradient", "hessian", "factor", "search", "certificate")

# A Hessian without targets is singular for rigid motions; this makes it positive definite.
_RIDGE = 1e-3
_SMALL = 1e-3


@double_precision
def measure_stages(result: Result, repeats: int) -> dict[str, float]:
    """Median seconds of each of :data:`STAGES` at a solve's last map, warm.

    The matrices are padded as in the solver.
    """
    disc, options = result.discretisation, result.options
    assert disc is not None
    assert isinstance(result.map, HarmonicMap)
    positional = positional_energy(result.map, result.pose, options.p2p_weight)
    unknowns = unknowns_of(disc.basis, options.conformal, disc.matrices.whitening)
    singularities = disc.basis.singularities
    energy = result.energy_measure
    problem = SubspaceProblem(disc.matrices, singularities, unknowns, positional, energy)
    y = jnp.asarray(real_coefficients(result.map))

    def gradient(problem: SubspaceProblem, y: Any) -> Any:
        return evaluation.gradient(problem, evaluation.evaluated(problem, y))

    def hessian(problem: SubspaceProblem, point: Point) -> Any:
        return _hessian(problem, point, options.hessian == "projected")

    def factor(h: Any, b: Any) -> Any:
        return cholesky.solve(cholesky.factorise(h), b)

    point = solver_jit(evaluation.evaluated)(problem, y)
    line = solver_jit(evaluation.line_along)(problem, -_SMALL * y, jnp.array(-1.0))
    h = solver_jit(hessian)(problem, point).astype(float)
    h = solver_jit(lambda h, unknowns: restrict_hessian(h, unknowns, ridge=_RIDGE))(h, unknowns)
    stages: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
        "gradient": (gradient, (problem, y)),
        "hessian": (hessian, (problem, point)),
        "factor": (factor, (h, jnp.ones(len(h)))),
        "search": (line_search.search, (problem, point, line)),
        "certificate": (evaluation.bounds, (problem, point)),
    }
    with single_blas_thread():
        return {name: _seconds(*stage, repeats) for name, stage in stages.items()}


def _hessian(problem: SubspaceProblem, point: Point, projected: bool) -> Any:
    matrices = problem.matrices
    values = point.samples.values[:, matrices.hessian_index]
    x, y = evaluation.squares(values)
    k = local_hessian(problem.energy.differentials(x, y), x, y)
    given = (matrices.hessian_weights, *evaluation.directions(values))
    local = tuple(positive_part(k) if projected else k)
    dtype = matrices.whitened.dtype
    given, local = jax.tree.map(lambda a: a.astype(dtype), (given, local))
    return assemble(matrices.whitened, *given, LocalHessian(*local))


def _seconds(function: Callable[..., Any], arguments: tuple[Any, ...], repeats: int) -> float:
    program = solver_jit(function)
    return timed(lambda: jax.block_until_ready(program(*arguments)), repeats)["median"]
