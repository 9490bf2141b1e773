"""Where the time of an iteration goes: its stages, each run by itself on the solver's matrices."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp

from glid_nb._runtime import COMPILER_OPTIONS, double_precision, single_blas_thread
from glid_nb.energies import SymmetricDirichlet
from glid_nb.solvers import Result, cholesky, evaluation, line_search
from glid_nb.solvers.discretisation import Matrices
from glid_nb.solvers.evaluation import Samples
from glid_nb.solvers.hessian import LocalHessian, assemble, local_hessian, positive_part
from glid_nb.solvers.solve import real_coefficients
from glid_nb.solvers.unknowns import reduced_unknowns, restrict_hessian
from studies.benchmarks.timing import timed

STAGES = ("hessian", "factor", "products", "certificate", "search")
"""Assembly; factor and solves; products for gradient and direction; bounds; the line search."""

_ENERGY = SymmetricDirichlet()
# Enough to make a Hessian without its targets positive definite, whose nullspace is the motions.
_RIDGE = 1e-3
_SMALL, _ABOVE_ALL = 1e-3, 1e30


@double_precision
def measure_stages(result: Result, repeats: int) -> dict[str, float]:
    """Median seconds of each of :data:`STAGES` at a solve's last map, warm.

    The matrices have the padded sizes that the solver runs on.
    """
    disc, options = result.discretisation, result.options
    matrices, unknowns = disc.matrices, reduced_unknowns(disc.basis, options.conformal)
    y = jnp.asarray(real_coefficients(disc.basis, result.map))
    samples = _program(evaluation.products)(matrices, y)
    change = Samples(*(_SMALL * part for part in samples))

    def hessian(matrices: Matrices, samples: Samples) -> Any:
        return _hessian(matrices, samples, options.hessian == "projected")

    def factor(h: Any, b: Any) -> Any:
        return cholesky.solve(cholesky.factorise(h), b)

    def products(matrices: Matrices, samples: Samples, y: Any) -> Any:
        d = _ENERGY.differentials(*evaluation.squares(samples.nodes))
        gradient = evaluation.energy_gradient(matrices, samples.nodes, d)
        return gradient, evaluation.products(matrices, y)

    def certificate(matrices: Matrices, singularities: Any, samples: Samples, y: Any) -> Any:
        largest = evaluation.largest_modulus(y)
        return evaluation.bounds(matrices, singularities, y, samples, largest)

    def search(matrices: Matrices, samples: Samples, change: Samples) -> Any:
        none = jnp.zeros(2)
        above, decrement = jnp.array(_ABOVE_ALL), jnp.array(1.0)
        return line_search.search(
            samples.nodes,
            change.nodes,
            matrices.weights,
            _ENERGY,
            none,
            none,
            none,
            above,
            decrement,
        )

    def restrict(h: Any, unknowns: Any) -> Any:
        return restrict_hessian(h.astype(float), unknowns, ridge=_RIDGE)

    h = _program(restrict)(_program(hessian)(matrices, samples), unknowns)
    stages: dict[str, tuple[Callable[..., Any], tuple[Any, ...]]] = {
        "hessian": (hessian, (matrices, samples)),
        "factor": (factor, (h, jnp.ones(len(h)))),
        "products": (products, (matrices, samples, y)),
        "certificate": (certificate, (matrices, disc.basis.singularities, samples, y)),
        "search": (search, (matrices, samples, change)),
    }
    with single_blas_thread():
        return {name: _seconds(*stage, repeats) for name, stage in stages.items()}


def _hessian(matrices: Matrices, samples: Samples, projected: bool) -> Any:
    nodes = samples.nodes[:, matrices.hessian_index]
    x, y = evaluation.squares(nodes)
    k = local_hessian(_ENERGY.differentials(x, y), x, y)
    k = positive_part(k) if projected else k
    dtype = matrices.whitened.dtype
    weights, f, g, k = jax.tree.map(
        lambda a: a.astype(dtype),
        (matrices.hessian_weights, *evaluation.directions(nodes), tuple(k)),
    )
    return assemble(matrices.whitened, weights, f, g, LocalHessian(*k))


def _program(function: Callable[..., Any]) -> Callable[..., Any]:
    return jax.jit(function, compiler_options=COMPILER_OPTIONS)


def _seconds(function: Callable[..., Any], arguments: tuple[Any, ...], repeats: int) -> float:
    program = _program(function)
    return timed(lambda: jax.block_until_ready(program(*arguments)), repeats)["median"]
