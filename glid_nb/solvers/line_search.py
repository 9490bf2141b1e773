"""The line search: a batch of candidate steps, then the certificate (paper Section 9.2).

``f_z`` and ``conj(f_zbar)`` are linear in the coefficients. So their values along the search
direction need no further matrix product (G.11), and many candidate steps are tried at once.
"""

from typing import NamedTuple

from glid_nb._jax import AnyArray, Array, Bool, Float, Int, jnp, lax
from glid_nb.certificate import PanelBounds, fz_vanishes
from glid_nb.solvers import evaluation
from glid_nb.solvers.evaluation import Line, Number, Point, Values
from glid_nb.solvers.problem import SubspaceProblem

# The outcomes of a compiled call.
RUNNING, CONVERGED, NO_DECREASE, REFUSED, INDEFINITE, BLOCKED, PENDING = range(7)

CANDIDATES = 24
RATIO = 0.8
# A Newton direction may be too short while the Hessian is modified. Trying up to twice its length
# costs nothing and saved up to a tenth of the iterations on the reference shapes.
LONGEST_STEP = 2.0
ARMIJO = 1e-4  # sufficient decrease, the constant c of Algorithm 1
# The longest step, as a fraction of the step that inverts the first sample. Close to an inversion
# the next steps are short: 0.95 took 12 iterations instead of 8 on one reference shape.
SAFETY = 0.7
LEAST_STEP = 1e-12


class Search(NamedTuple):
    """Candidate steps, longest first."""

    steps: Float[Array, " t"]
    acceptable: Bool[Array, " t"]  # sufficient decrease (Algorithm 1, line 17)
    best: Int[Array, ""]  # index of the acceptable candidate with the least energy


def largest_step(values: Values, change: Values) -> Number:
    """The step at which the first sample becomes inverted, or infinity.

    It is the first zero of ``|f + t df|^2 - |g + t dg|^2``, a quadratic in ``t`` that is positive
    at 0.
    """
    a = _difference_of_squares(change, change)
    b = 2 * _difference_of_squares(values, change)
    c = _difference_of_squares(values, values)
    discriminant = b * b - 4 * a * c
    denominator = -b + jnp.sqrt(jnp.maximum(discriminant, 0))
    hits = (discriminant >= 0) & (denominator > 0)
    return jnp.min(jnp.where(hits, 2 * c / jnp.where(hits, denominator, 1), jnp.inf))


def _difference_of_squares(a: Values, b: Values) -> Float[Array, " s"]:
    """``|f|^2 - |g|^2`` as a bilinear form."""
    return a[0] * b[0] + a[1] * b[1] - a[2] * b[2] - a[3] * b[3]


def search(problem: SubspaceProblem, point: Point, line: Line) -> Search:
    """Evaluate batches of candidate steps along the line until one decreases the energy enough.

    Each batch is shorter than the one before (Algorithm 1, lines 13 to 17 and 21 to 23).
    """
    values, change, positional = point.samples.values, line.change.values, problem.positional
    residual = positional.residual(point.coefficients)
    residual_change = positional.matrix @ line.direction
    total = point.energy

    def along(t: Float[Array, " t"]) -> Float[Array, " t"]:
        r = residual + t[:, None] * residual_change
        p2p = 0.5 * jnp.sum(positional.weights * r**2, axis=-1)
        there = values[:, None] + t[:, None] * change[:, None]
        return evaluation.energy_distortion(there, problem.matrices, problem.energy) + p2p

    def acceptable(steps: Array, energies: Array) -> Array:
        return energies < total - ARMIJO * steps * line.squared_decrement

    def lower(carry: tuple[Array, Array]) -> tuple[Array, Array]:
        steps = carry[0] * RATIO**CANDIDATES
        # The full Newton step must be a candidate. Otherwise convergence would be linear.
        steps = jnp.where((steps > 1) & (steps * RATIO < 1), 1.0, steps)
        return steps, along(steps)

    limit = SAFETY * largest_step(values, change)
    top = jnp.minimum(limit, LONGEST_STEP) * RATIO ** jnp.arange(CANDIDATES)
    steps, energies = lax.while_loop(
        lambda carry: ~jnp.any(acceptable(*carry)) & (carry[0][0] > LEAST_STEP),
        lower,
        (top / RATIO**CANDIDATES, jnp.full(CANDIDATES, jnp.inf)),
    )
    passes = acceptable(steps, energies)  # an energy that is NaN does not pass
    return Search(steps, passes, jnp.argmin(jnp.where(passes, energies, jnp.inf)))


class Backtracking(NamedTuple):
    outcome: Int[Array, ""]  # RUNNING if the step is certified
    step: Number
    point: Point
    panel: PanelBounds  # the bounds at the point
    refused: Bool[Array, " p"]  # panels that refused the first step


def backtrack(
    problem: SubspaceProblem,
    point: Point,
    line: Line,
    found: Search,
    once: Bool[AnyArray, ""] | bool,
) -> Backtracking:
    """Try the best candidate, then shorter ones, until one is certified (Algorithm 1, lines 18 to
    20). With ``once``, try only the best.

    If Condition (30) fails and no panel refuses, the step jumps over a map whose ``f_z`` vanishes
    on the boundary. Then the panels along which ``f_z`` turned most refuse the step.
    """
    real, count = problem.matrices.real, found.steps.shape[0]
    before = evaluation.fz_turning(problem.matrices, point.samples.values)

    def refusing(panel: PanelBounds) -> Bool[Array, " p"]:
        refuses = real & ~panel.injective
        zeros = fz_vanishes(jnp.where(real, panel.turning, 0))
        turned = jnp.where(real, jnp.abs(panel.turning - before), 0)
        jumped = zeros & ~jnp.any(refuses) & (turned >= jnp.max(turned) / 2)
        return refuses | (jumped & real)

    def attempt(carry: tuple) -> tuple:
        _, index, _, _, refused = carry
        there = evaluation.moved(problem, point, line, found.steps[index])
        panel = evaluation.bounds(problem, there)
        refuses = refusing(panel)
        fails = jnp.any(refuses)
        first = index == found.best
        refused = jnp.where(first, refuses, refused)
        shorter = jnp.argmax(found.acceptable & (jnp.arange(count) > index))
        outcome = jnp.where(~fails, RUNNING, jnp.where(first & once, REFUSED, BLOCKED))
        # argmax is 0 if there is no shorter acceptable candidate.
        ended = (outcome != BLOCKED) | (shorter == 0)
        outcome, index = jnp.where(ended, outcome, PENDING), jnp.where(ended, index, shorter)
        return outcome, index, there, panel, refused

    blank = jnp.zeros(real.shape)
    start = (
        jnp.where(found.acceptable[found.best], PENDING, NO_DECREASE),
        found.best,
        point,
        PanelBounds(blank, blank, blank, real, blank),
        jnp.zeros_like(real),
    )
    ended = lax.while_loop(lambda carry: carry[0] == PENDING, attempt, start)
    outcome, index, there, panel, refused = ended
    return Backtracking(outcome, found.steps[index], there, panel, refused)
