"""What every method in the harmonic subspace computes on the device, in three programs.

Values and gradient at a map, the Hessian, and the step along a direction with Newton's own line
search and certificate.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Literal, NamedTuple

from glid_nb._jax import AnyArray, jit, jnp
from glid_nb._runtime import COMPILER_OPTIONS
from glid_nb.certificate import PanelBounds
from glid_nb.solvers import evaluation, line_search
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.hessian import LocalHessian, assemble, local_hessian, positive_part
from glid_nb.solvers.problem import Problem
from glid_nb.solvers.unknowns import expand, restrict_gradient, restrict_hessian

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Float, Int

Curvature = Literal["exact", "projected", "gauss-newton", "dirichlet"]


class Move(NamedTuple):
    """The outcome of one step."""

    outcome: Int[AnyArray, ""]
    point: Point
    gradient: Float[Array, " 4c"]
    step: Float[AnyArray, ""]
    bounds: PanelBounds
    """The certificate there."""
    refused: Bool[AnyArray, " p"]


@functools.partial(jit, compiler_options=COMPILER_OPTIONS)
def evaluate(
    problem: Problem, coefficients: Float[Array, " 4c"]
) -> tuple[Point, Float[Array, " 4c"]]:
    """A map's energies, and their gradient with respect to the unknowns, 0 elsewhere."""
    point = evaluation.evaluated(problem, coefficients)
    return point, restrict_gradient(evaluation.gradient(problem, point), problem.unknowns)


@functools.partial(jit, static_argnames="curvature", compiler_options=COMPILER_OPTIONS)
def hessian(problem: Problem, point: Point, *, curvature: Curvature) -> Float[Array, "4c 4c"]:
    """Hessian of the isometric energy alone with respect to the unknowns (33).

    ``gauss-newton`` is for ARAP, whose density is ``2 (|f_z| - 1)^2 + 2 |f_zbar|^2``, a sum of
    squares: second derivatives of the residuals are left out. ``dirichlet`` is the Hessian of the
    Dirichlet energy ``|f_z|^2 + |f_zbar|^2``.
    """
    matrices = problem.matrices
    nodes = point.samples.nodes[:, matrices.hessian_index]
    x, y = evaluation.squares(nodes)
    if curvature == "gauss-newton":
        zero, four = jnp.zeros_like(x), jnp.full_like(x, 4.0)
        local = LocalHessian(zero, four, four, four, zero)
    elif curvature == "dirichlet":
        two, zero = jnp.full_like(x, 2.0), jnp.zeros_like(x)
        local = LocalHessian(two, two, two, two, zero)
    else:
        local = local_hessian(problem.energy.differentials(x, y), x, y)
        if curvature == "projected":
            local = positive_part(local)
    f, g = evaluation.directions(nodes)
    basis = matrices.nodes[:, matrices.hessian_index]
    h = assemble(basis, matrices.hessian_weights, f, g, local)
    upper = jnp.triu(restrict_hessian(h, problem.unknowns))
    return upper + jnp.triu(upper, 1).T


@functools.partial(jit, compiler_options=COMPILER_OPTIONS)
def advance(
    problem: Problem,
    point: Point,
    gradient: Float[Array, " 4c"],
    direction: Float[Array, " 4c"],
    may_refine: Bool[AnyArray, ""] | bool,
) -> Move:
    """The best certified step along ``direction``, a change of the unknowns."""
    slope = jnp.dot(gradient, direction)
    line = evaluation.line_along(problem, expand(direction, problem.unknowns), slope)
    found = line_search.search(problem, point, line)
    end = line_search.backtrack(problem, point, line, found, may_refine)
    # Values anew from the coefficients: their rounding errors must not add up over thousands of
    # iterations, for which the certificate makes no allowance.
    y = point.coefficients + end.step * line.direction
    after = evaluation.evaluated(problem, y)
    gradient = restrict_gradient(evaluation.gradient(problem, after), problem.unknowns)
    return Move(end.outcome, after, gradient, end.step, end.panel, end.refused)
