"""The line search: a batch of candidate steps, then the certificate (paper Section 9.2).

``f_z`` and ``conj(f_zbar)`` are linear in the coefficients, so their values along the search
direction cost no further product (G.11) and many candidate steps are tried at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from glid_nb._arrays import AnyArray
from glid_nb._jax import jnp, lax
from glid_nb.certificate import PanelBounds, fz_vanishes
from glid_nb.energies import Energy
from glid_nb.solvers.outcome import BLOCKED, NO_DECREASE, PENDING, REFUSED, RUNNING

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Float, Int

CANDIDATES = 24
RATIO = 0.8
# A Newton direction may be too short while the Hessian is modified; trying up to twice its length
# costs nothing and saved up to a tenth of the iterations on the reference shapes.
LONGEST_STEP = 2.0
# Sufficient decrease, the constant c of Algorithm 1.
ARMIJO = 1e-4
# Closest that a step may come to the first inversion at a sample. Going further lowers the energy
# more at once, but leaves the next iterations next to the barrier (0.95 took 12 instead of 8
# iterations on one reference shape).
SAFETY = 0.7
LEAST_STEP = 1e-12


class Search(NamedTuple):
    """Candidate steps, longest first, and the total energy at each."""

    steps: Float[Array, " t"]
    energies: Float[Array, " t"]
    acceptable: Bool[Array, " t"]
    """Where the energy decreases sufficiently (Algorithm 1, line 17)."""
    best: Int[Array, ""]
    """The candidate of least energy."""


def isometric_energy(
    nodes: Float[Array, "4 *t s"], weights: Float[Array, " s"], energy: Energy
) -> Float[Array, "*t"]:
    """Equation (31), infinite where a sample is inverted; padding (weight 0) counts nothing."""
    x = nodes[0] ** 2 + nodes[1] ** 2
    y = nodes[2] ** 2 + nodes[3] ** 2
    valid = x > y
    density = energy.density(jnp.where(valid, x, 1.0), jnp.where(valid, y, 0.0))
    density = jnp.where(valid & (density < jnp.inf), density, jnp.inf)
    return jnp.sum(jnp.where(weights > 0, weights * density, 0), axis=-1)


def largest_step(nodes: Float[Array, "4 s"], change: Float[Array, "4 s"]) -> Float[Array, ""]:
    """The step at which the first sample becomes inverted, or infinity, in closed form.

    ``|f + t df|^2 - |g + t dg|^2`` is a quadratic in ``t`` that is positive at 0.
    """
    a = _difference_of_squares(change, change)
    b = 2 * _difference_of_squares(nodes, change)
    c = _difference_of_squares(nodes, nodes)
    discriminant = b * b - 4 * a * c
    denominator = -b + jnp.sqrt(jnp.maximum(discriminant, 0))
    hits = (discriminant >= 0) & (denominator > 0)
    return jnp.min(jnp.where(hits, 2 * c / jnp.where(hits, denominator, 1), jnp.inf))


def _difference_of_squares(a: Float[Array, "4 s"], b: Float[Array, "4 s"]) -> Float[Array, " s"]:
    """``|f|^2 - |g|^2`` as a bilinear form."""
    return a[0] * b[0] + a[1] * b[1] - a[2] * b[2] - a[3] * b[3]


def search(
    nodes: Float[Array, "4 s"],
    change: Float[Array, "4 s"],
    weights: Float[Array, " s"],
    energy: Energy,
    residual: Float[Array, " r"],
    residual_change: Float[Array, " r"],
    residual_weights: Float[Array, " r"],
    total: Float[Array, ""],
    squared_decrement: Float[Array, ""],
) -> Search:
    """Energies along the line in batches of candidates, each batch shorter, until one decreases."""

    def along(t: Float[Array, " t"]) -> Float[Array, " t"]:
        r = residual + t[:, None] * residual_change
        p2p = 0.5 * jnp.sum(residual_weights * r**2, axis=-1)
        moved = nodes[:, None] + t[:, None] * change[:, None]
        return isometric_energy(moved, weights, energy) + p2p

    def acceptable(steps: Array, energies: Array) -> Array:
        return energies < total - ARMIJO * steps * squared_decrement

    def lower(carry: tuple[Array, Array]) -> tuple[Array, Array]:
        steps = carry[0] * RATIO**CANDIDATES
        # The full Newton step is always among the candidates, or convergence would be linear.
        steps = jnp.where((steps > 1) & (steps * RATIO < 1), 1.0, steps)
        return steps, along(steps)

    limit = SAFETY * largest_step(nodes, change)
    top = jnp.minimum(limit, LONGEST_STEP) * RATIO ** jnp.arange(CANDIDATES)
    steps, energies = lax.while_loop(
        lambda carry: ~jnp.any(acceptable(*carry)) & (carry[0][0] > LEAST_STEP),
        lower,
        (top / RATIO**CANDIDATES, jnp.full(CANDIDATES, jnp.inf)),
    )
    energies = jnp.where(jnp.isnan(energies), jnp.inf, energies)
    return Search(steps, energies, acceptable(steps, energies), jnp.argmin(energies))


def backtrack(
    found: Search,
    certified: Callable[[Array], PanelBounds],
    turning: Float[Array, " p"],
    real: Bool[Array, " p"],
    may_refine: Bool[AnyArray, ""],
) -> tuple[Int[Array, ""], Float[Array, ""], PanelBounds, Bool[Array, " p"]]:
    """Go from the best candidate to shorter ones until one is certified, or ask for finer panels.

    ``turning`` is how ``f_z`` turns along each panel of the current map. Returns the outcome, the
    step, the bounds there, and which panels refused the first step.
    """
    decreases = found.acceptable[found.best]
    count = found.steps.shape[0]

    def attempt(carry: tuple[Array, Array, PanelBounds, Array]) -> tuple:
        _, index, _, refused = carry
        bounds = certified(found.steps[index])
        refuses = real & ~bounds.injective
        # Condition (30): zeros of f_z inside show as a sum of turnings that is not 0. The step then
        # jumps over a map with a zero on the boundary; the panels that turned most are where.
        zeros = fz_vanishes(jnp.where(real, bounds.turning, 0))
        turned = jnp.where(real, jnp.abs(bounds.turning - turning), 0)
        jumped = zeros & ~jnp.any(refuses) & (turned >= jnp.max(turned) / 2)
        refuses = refuses | (jumped & real)
        fails = jnp.any(refuses)
        first = index == found.best
        refused = jnp.where(first, refuses, refused)
        shorter = jnp.argmax(found.acceptable & (jnp.arange(count) > index))
        outcome = jnp.where(
            ~fails,
            RUNNING,
            jnp.where(first & may_refine, REFUSED, BLOCKED),
        )
        # argmax gives 0 when there is no shorter acceptable candidate.
        ended = (outcome != BLOCKED) | (shorter == 0)
        return jnp.where(ended, outcome, PENDING), jnp.where(ended, index, shorter), bounds, refused

    blank = jnp.zeros(real.shape)
    start = (
        jnp.where(decreases, PENDING, NO_DECREASE),
        found.best,
        PanelBounds(blank, blank, blank, real, blank),
        jnp.zeros_like(real),
    )
    outcome, index, bounds, refused = lax.while_loop(lambda c: c[0] == PENDING, attempt, start)
    return outcome, found.steps[index], bounds, refused
