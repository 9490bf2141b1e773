"""What every method in the harmonic subspace computes on the device.

Three programs: the start's values and gradient, the Hessian, and the step along a direction with
Newton's own line search and certificate. The direction itself is the method's affair, on the host.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Literal, NamedTuple

from glid_nb._arrays import AnyArray
from glid_nb._jax import jit, jnp
from glid_nb._runtime import COMPILER_OPTIONS
from glid_nb.certificate import PanelBounds
from glid_nb.energies import Energy
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.solvers import evaluation, line_search
from glid_nb.solvers.discretisation import Matrices
from glid_nb.solvers.evaluation import Constraints, Samples
from glid_nb.solvers.hessian import LocalHessian, assemble, local_hessian, positive_part
from glid_nb.solvers.unknowns import Unknowns, expand, restrict_gradient, restrict_hessian

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Float, Int

Curvature = Literal["exact", "projected", "gauss-newton", "dirichlet"]


class Setting(NamedTuple):
    """The problem on the device."""

    matrices: Matrices
    singularities: Singularities
    unknowns: Unknowns
    constraints: Constraints
    energy: Energy


class Point(NamedTuple):
    """A map, with what is known of it."""

    coefficients: Float[Array, " 4c"]
    samples: Samples
    energy_iso: Float[Array, ""]
    energy_p2p: Float[Array, ""]
    gradient: Float[Array, " 4c"]
    """With respect to the unknowns; 0 for what is fixed or tied."""


class Move(NamedTuple):
    """The outcome of one step."""

    outcome: Int[AnyArray, ""]
    point: Point
    step: Float[AnyArray, ""]
    sigma2_lower: Float[AnyArray, ""]
    refused: Bool[AnyArray, " p"]


@functools.partial(jit, compiler_options=COMPILER_OPTIONS)
def evaluate(setting: Setting, coefficients: Float[Array, " 4c"]) -> Point:
    """Energies and gradient of a map."""
    return _point(setting, coefficients, evaluation.products(setting.matrices, coefficients))


@functools.partial(jit, static_argnames="curvature", compiler_options=COMPILER_OPTIONS)
def hessian(setting: Setting, point: Point, *, curvature: Curvature) -> Float[Array, "4c 4c"]:
    """Hessian of the isometric energy alone with respect to the unknowns (33).

    ``gauss-newton`` is for ARAP, whose density is ``2 (|f_z| - 1)^2 + 2 |f_zbar|^2``, a sum of
    squares: second derivatives of the residuals are left out. ``dirichlet`` is the Hessian of the
    Dirichlet energy ``|f_z|^2 + |f_zbar|^2``.
    """
    matrices = setting.matrices
    nodes = point.samples.nodes[:, matrices.hessian_index]
    x, y = evaluation.squares(nodes)
    if curvature == "gauss-newton":
        zero, four = jnp.zeros_like(x), jnp.full_like(x, 4.0)
        local = LocalHessian(zero, four, four, four, zero)
    elif curvature == "dirichlet":
        two, zero = jnp.full_like(x, 2.0), jnp.zeros_like(x)
        local = LocalHessian(two, two, two, two, zero)
    else:
        local = local_hessian(setting.energy.differentials(x, y), x, y)
        if curvature == "projected":
            local = positive_part(local)
    f, g = evaluation.directions(nodes)
    basis = matrices.nodes[:, matrices.hessian_index]
    h = assemble(basis, matrices.hessian_weights, f, g, local)
    upper = jnp.triu(restrict_hessian(h, setting.unknowns))
    return upper + jnp.triu(upper, 1).T


@functools.partial(jit, compiler_options=COMPILER_OPTIONS)
def advance(
    setting: Setting,
    point: Point,
    direction: Float[Array, " 4c"],
    may_refine: Bool[AnyArray, ""],
) -> Move:
    """The best certified step along ``direction``, a change of the unknowns."""
    matrices, constraints = setting.matrices, setting.constraints
    descent = -jnp.dot(point.gradient, direction)
    direction = expand(direction, setting.unknowns)
    change = evaluation.products(matrices, direction)
    p2p_matrix, row_weights = p2p_rows(constraints)
    found = line_search.search(
        point.samples.nodes,
        change.nodes,
        matrices.weights,
        setting.energy,
        p2p_matrix @ point.coefficients - constraints.targets.T.ravel(),
        p2p_matrix @ direction,
        row_weights,
        point.energy_iso + point.energy_p2p,
        descent,
    )

    def moved(t: Float[Array, ""]) -> tuple[Array, Samples]:
        samples = [a + t * b for a, b in zip(point.samples, change, strict=True)]
        return point.coefficients + t * direction, Samples(*samples)

    def certified(t: Float[Array, ""]) -> PanelBounds:
        y, samples = moved(t)
        both = (evaluation.largest_modulus(at) for at in (point.coefficients, y))
        largest = jnp.maximum(*both)
        singularities = setting.singularities
        return evaluation.bounds(matrices, singularities, y, samples, largest)

    turning = evaluation.turning(matrices, point.samples.nodes)
    outcome, t, panels, refused = line_search.backtrack(
        found, certified, turning, matrices.real, may_refine
    )
    # Values anew from the coefficients: their rounding errors must not add up over thousands of
    # iterations, for which the certificate makes no allowance.
    y, _ = moved(t)
    after = _point(setting, y, evaluation.products(matrices, y))
    least = jnp.min(jnp.where(matrices.real, panels.sigma2_lower, jnp.inf))
    return Move(outcome, after, t, least, refused)


def p2p_rows(
    constraints: Constraints,
) -> tuple[Float[Array, "2h 4c"], Float[Array, " 2h"]]:
    """The matrix of (F.5), rows for the real parts first, and the rows' weights."""
    weights = jnp.concatenate([constraints.weights, constraints.weights])
    return evaluation.constraint_matrix(constraints), weights


def _point(setting: Setting, y: Float[Array, " 4c"], samples: Samples) -> Point:
    matrices = setting.matrices
    p2p_matrix, row_weights = p2p_rows(setting.constraints)
    residual = p2p_matrix @ y - setting.constraints.targets.T.ravel()
    iso = line_search.isometric_energy(samples.nodes, matrices.weights, setting.energy)
    differentials = setting.energy.differentials(*evaluation.squares(samples.nodes))
    gradient = evaluation.energy_gradient(matrices, samples.nodes, differentials)
    gradient = restrict_gradient(
        gradient + p2p_matrix.T @ (row_weights * residual), setting.unknowns
    )
    return Point(y, samples, iso, 0.5 * jnp.sum(row_weights * residual**2), gradient)
