"""Newton's method on the device: one compiled call runs several iterations (paper Algorithm 1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from glid_nb._arrays import AnyArray
from glid_nb._jax import jax, jit, jnp, lax
from glid_nb._runtime import COMPILER_OPTIONS
from glid_nb.certificate import PanelBounds, fz_vanishes
from glid_nb.energies import Energy
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.solvers import cholesky, evaluation, line_search, whitening
from glid_nb.solvers.discretisation import Matrices
from glid_nb.solvers.evaluation import Constraints, Samples
from glid_nb.solvers.hessian import (
    LocalHessian,
    assemble,
    assemble_across_f,
    local_hessian,
    positive_part,
)
from glid_nb.solvers.options import HessianKind
from glid_nb.solvers.outcome import CONVERGED, INDEFINITE, RUNNING
from glid_nb.solvers.unknowns import Unknowns, expand, restrict_gradient, restrict_hessian

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Float, Int

# A correction that gains more than this share of what the step before it gained is slow: the
# Hessian has changed, and a new one gains more for its cost.
_CONTRACTION = 0.3
# Far from the minimum, after a step that gains more than this share of the energy, corrections
# creep along the valley that the next Hessian would cross.
_CLOSE = 0.1
LEAST_ENERGY = 1e-6
"""What a decrease is compared with where the energy is less.

Energies are means over the boundary. ARAP's vanish at rigid motions, where nothing is relative to
them; below this one nobody sees a distortion.
"""


class Record(NamedTuple):
    """History of one iteration, the state after its step."""

    energy_iso: Float[AnyArray, ""]
    energy_p2p: Float[AnyArray, ""]
    step: Float[AnyArray, ""]
    decrement: Float[AnyArray, ""]
    sigma2_lower: Float[AnyArray, ""]
    modified: Bool[AnyArray, ""]
    corrections: Int[AnyArray, ""]


class State(NamedTuple):
    """State of the loop."""

    coefficients: Float[Array, " 4c"]
    samples: Samples
    energy_iso: Float[Array, ""]
    energy_p2p: Float[Array, ""]
    start_energy: Float[Array, ""]
    """Total energy before the first iteration of this call."""
    iteration: Int[Array, ""]
    outcome: Int[Array, ""]
    decrement: Float[Array, ""]
    records: Record
    refused: Bool[Array, " p"]
    """Panels that refused the last preferred step and may allow it once they are split."""
    sigma2_lower: Float[Array, " p"]
    """Certified bound per panel at ``coefficients``, once a step was taken."""
    factor: Float[Array, "4u 4u"]
    """Cholesky factor of the last Hessian, in whitened coordinates."""
    largest: Float[Array, ""]
    """Largest modulus of a coefficient in this call, through which ``samples`` were carried."""


class Settings(NamedTuple):
    """Numbers that may change without compiling again."""

    tolerance: Float[AnyArray, ""]
    iterations: Int[AnyArray, ""]
    may_refine: Bool[AnyArray, ""]
    """Whether to return as soon as a panel refuses a step, so that it can be split."""
    ridge: Float[AnyArray, ""]
    """Added to the Hessian's diagonal, relative to its mean (Section 9.1's epsilon)."""
    reuse: Bool[AnyArray, ""]
    """Whether the first iteration takes the factor that it is given instead of a new one."""
    corrections: Int[AnyArray, ""]
    """Most corrections of one iteration."""


def iterations(
    matrices: Matrices,
    singularities: Singularities,
    unknowns: Unknowns,
    constraints: Constraints,
    energy: Energy,
    coefficients: Float[Array, " 4c"],
    factor: Float[Array, "4u 4u"],
    settings: Settings,
    *,
    hessian: HessianKind,
    capacity: int,
) -> State:
    """Up to ``settings.iterations`` (at most ``capacity``) Newton iterations, to be compiled.

    Close to the minimum an iteration goes on with corrections: steps by the same factor from
    gradients of their own (Shamanskii's method), a fraction of the cost of another Hessian.
    """
    t = matrices.whitening
    p2p_matrix = evaluation.constraint_matrix(constraints)
    row_weights = jnp.concatenate([constraints.weights, constraints.weights])
    p2p_rows = whitening.pulled_back(p2p_matrix, t)
    p2p_hessian = p2p_rows.T @ (row_weights[:, None] * p2p_rows)
    p2p_hessian = restrict_hessian(p2p_hessian, unknowns)

    def residual_at(y: Float[Array, " 4c"]) -> Float[Array, " 2h"]:
        return p2p_matrix @ y - constraints.targets.T.ravel()

    def energies(samples: Samples, y: Float[Array, " 4c"]) -> tuple[Array, Array]:
        return (
            line_search.isometric_energy(samples.nodes, matrices.weights, energy),
            0.5 * jnp.sum(row_weights * residual_at(y) ** 2),
        )

    def factorise(
        samples: Samples, given: Float[Array, "4u 4u"], wanted: Bool[Array, ""]
    ) -> tuple[Float[Array, "4u 4u"], Bool[Array, ""]]:
        """Cholesky factor of the Hessian, NaN where that fails, and whether ``K`` was projected.

        ``given`` where no other is wanted. A loop, for its turns write into the same memory.
        """
        nodes = samples.nodes[:, matrices.hessian_index]
        x, yy = evaluation.squares(nodes)
        local = local_hessian(energy.differentials(x, yy), x, yy)
        projected = positive_part(local)
        dtype = matrices.whitened.dtype
        weights, f, g = jax.tree.map(
            lambda a: a.astype(dtype), (matrices.hessian_weights, *evaluation.directions(nodes))
        )

        def assembled(k: LocalHessian) -> Float[Array, "4u 4u"]:
            k = LocalHessian(*(part.astype(dtype) for part in k))
            return assemble(matrices.whitened, weights, f, g, k)

        def factored(h: Float[Array, "4u 4u"]) -> Float[Array, "4u 4u"]:
            whole = restrict_hessian(h, unknowns, p2p_hessian, settings.ridge)
            return cholesky.factorise(whole)

        def project(h: Float[Array, "4u 4u"]) -> Float[Array, "4u 4u"]:
            if not energy.indefinite_across_f_only:
                return assembled(projected)
            # The Hessian that was not definite lacks this block alone.
            across = (projected.across_f - local.across_f).astype(dtype)
            block = assemble_across_f(matrices.whitened, weights, f, across)
            return h.at[: block.shape[0], : block.shape[0]].add(block)

        first = projected if hessian == "projected" else local
        most = 2 if hessian == "adaptive" else 1

        def attempt(carry: tuple) -> tuple:
            _, h, count = carry
            h = lax.cond(count == 0, lambda _: assembled(first), project, h)
            return factored(h), h, count + 1

        def goes_on(carry: tuple) -> Bool[Array, ""]:
            factor, _, count = carry
            again = (count < most) & ~jnp.isfinite(factor[-1, -1])
            return wanted & ((count == 0) | again)

        blank = jnp.zeros(given.shape, dtype)
        factor, _, count = lax.while_loop(goes_on, attempt, (given, blank, jnp.array(0)))
        return factor, wanted & ((count == 2) | (hessian == "projected"))

    def line(samples: Samples, y: Float[Array, " 4c"], total: Array, factor: Array) -> _Line:
        """The line search along the direction that a factor and the gradient give."""
        nodes, residual = samples.nodes, residual_at(y)
        d = energy.differentials(*evaluation.squares(nodes))
        gradient = evaluation.energy_gradient(matrices, nodes, d)
        gradient = gradient + p2p_matrix.T @ (row_weights * residual)
        gradient = restrict_gradient(whitening.pulled_back(gradient, t), unknowns)
        step = -cholesky.solve(factor, gradient)
        step = jnp.where(jnp.isfinite(factor[-1, -1]), step, 0)
        squared_decrement = -jnp.dot(gradient, step)
        direction = whitening.coefficients(expand(step, unknowns), t)
        change = evaluation.products(matrices, direction)
        search = line_search.search(
            nodes,
            change.nodes,
            matrices.weights,
            energy,
            residual,
            p2p_matrix @ direction,
            row_weights,
            total,
            squared_decrement,
        )
        return _Line(direction, change, squared_decrement, search)

    def bounds(samples: Samples, y: Float[Array, " 4c"], largest: Array) -> PanelBounds:
        return evaluation.bounds(matrices, singularities, y, samples, largest)

    def corrected(place: _Place, gain: Array, factor: Array) -> tuple:
        """Go on by corrections while they pay; the place, how many, and whether at the minimum."""

        def correct(carry: tuple) -> tuple:
            place, gain, count, _, _ = carry
            total = place.energy_iso + place.energy_p2p
            found = line(place.samples, place.coefficients, total, factor)
            minimal = found.squared_decrement / 2 <= settings.tolerance * _scale(total)
            step = found.search.steps[found.search.best]
            takes = found.search.acceptable[found.search.best] & ~minimal
            samples, y = _moved(place.samples, place.coefficients, found, step)
            largest = jnp.maximum(place.largest, evaluation.largest_modulus(y))
            there = _Place(y, samples, *energies(samples, y), largest)
            gained = total - (there.energy_iso + there.energy_p2p)
            decrement = jnp.sqrt(jnp.maximum(found.squared_decrement, 0))
            more = takes & (gained < _CONTRACTION * gain) & (count + 1 < settings.corrections)
            return _where(takes, there, place), gained, count + takes, more, (minimal, decrement)

        more = (gain < _CLOSE * (place.energy_iso + place.energy_p2p)) & (settings.corrections > 0)
        nothing = (jnp.array(False), jnp.array(jnp.inf))
        carry = (place, gain, jnp.array(0), more, nothing)
        place, _, count, _, (minimal, decrement) = lax.while_loop(lambda c: c[3], correct, carry)
        return place, count, minimal, decrement

    def keep_going(state: State) -> Bool[Array, ""]:
        return (state.outcome == RUNNING) & (state.iteration < settings.iterations)

    def iterate(state: State) -> State:
        wanted = jnp.logical_not(settings.reuse) | (state.iteration > 0)
        factor, modified = factorise(state.samples, state.factor, wanted)
        total = state.energy_iso + state.energy_p2p
        found = line(state.samples, state.coefficients, total, factor)

        def certified(step: Float[Array, ""]) -> PanelBounds:
            samples, y = _moved(state.samples, state.coefficients, found, step)
            largest = jnp.maximum(state.largest, evaluation.largest_modulus(y))
            return bounds(samples, y, largest)

        turning = evaluation.turning(matrices, state.samples.nodes)
        outcome, step, panel, refused = line_search.backtrack(
            found.search, certified, turning, matrices.real, settings.may_refine
        )
        minimal = found.squared_decrement / 2 <= settings.tolerance * _scale(total)
        outcome = jnp.where(minimal, CONVERGED, outcome)
        outcome = jnp.where(jnp.isfinite(factor[-1, -1]), outcome, INDEFINITE)
        stepped = outcome == RUNNING
        step = jnp.where(stepped, step, 0.0)
        samples, y = _moved(state.samples, state.coefficients, found, step)
        largest = jnp.maximum(state.largest, evaluation.largest_modulus(y))
        place = _Place(y, samples, *energies(samples, y), largest)
        decrement = jnp.sqrt(jnp.maximum(found.squared_decrement, 0))

        def go_on(place: _Place) -> tuple:
            gain = total - (place.energy_iso + place.energy_p2p)
            further, count, minimal, last = corrected(place, gain, factor)
            proof = lax.cond(
                count > 0,
                lambda: bounds(further.samples, further.coefficients, further.largest),
                lambda: panel,
            )
            zeros = fz_vanishes(jnp.where(matrices.real, proof.turning, 0))
            proved = jnp.all(proof.injective | ~matrices.real) & ~zeros & (count > 0)
            return (
                _where(proved, further, place),
                _where(proved, proof, panel),
                jnp.where(proved, count, 0),
                minimal & proved,
                last,
            )

        def stay(place: _Place) -> tuple:
            return place, panel, jnp.array(0), jnp.array(False), decrement

        place, panel, count, minimal, last = lax.cond(stepped, go_on, stay, place)
        outcome = jnp.where(minimal, CONVERGED, outcome)
        least = jnp.min(jnp.where(matrices.real, panel.sigma2_lower, jnp.inf))
        record = Record(place.energy_iso, place.energy_p2p, step, decrement, least, modified, count)
        records = jax.tree.map(
            lambda all_, one: all_.at[state.iteration].set(
                jnp.where(stepped, one, all_[state.iteration])
            ),
            state.records,
            record,
        )
        return State(
            place.coefficients,
            place.samples,
            place.energy_iso,
            place.energy_p2p,
            state.start_energy,
            state.iteration + stepped,
            outcome,
            jnp.where(minimal, last, decrement),
            records,
            refused,
            jnp.where(stepped, panel.sigma2_lower, state.sigma2_lower),
            factor,
            place.largest,
        )

    samples = evaluation.products(matrices, coefficients)
    iso, p2p = energies(samples, coefficients)
    blank = jnp.full(capacity, jnp.nan)
    flags, counts = jnp.zeros(capacity, bool), jnp.zeros(capacity, int)
    start = State(
        coefficients,
        samples,
        iso,
        p2p,
        iso + p2p,
        jnp.array(0),
        jnp.array(RUNNING),
        jnp.array(jnp.inf),
        Record(blank, blank, blank, blank, blank, flags, counts),
        jnp.zeros_like(matrices.real),
        jnp.full(matrices.real.shape, jnp.nan),
        factor,
        evaluation.largest_modulus(coefficients),
    )
    end = lax.while_loop(keep_going, iterate, start)

    def helped() -> Bool[Array, " p"]:
        return end.refused & evaluation.tightened_by_splitting(
            matrices, singularities, end.coefficients, end.largest
        )

    return end._replace(refused=lax.cond(jnp.any(end.refused), helped, lambda: end.refused))


class _Place(NamedTuple):
    """A map and its energies; ``largest`` as in :class:`State`."""

    coefficients: Float[Array, " 4c"]
    samples: Samples
    energy_iso: Float[Array, ""]
    energy_p2p: Float[Array, ""]
    largest: Float[Array, ""]


class _Line(NamedTuple):
    """A direction, what it changes, and what a search along it found."""

    direction: Float[Array, " 4c"]
    change: Samples
    squared_decrement: Float[Array, ""]
    search: line_search.Search


def _moved(
    samples: Samples, y: Float[Array, " 4c"], line: _Line, step: Float[Array, ""]
) -> tuple[Samples, Float[Array, " 4c"]]:
    moved = (a + step * b for a, b in zip(samples, line.change, strict=True))
    return Samples(*moved), y + step * line.direction


def _scale(total: Float[Array, ""]) -> Float[Array, ""]:
    return jnp.maximum(jnp.abs(total), LEAST_ENERGY)


def _where(condition: Bool[Array, ""], one: Any, other: Any) -> Any:
    return jax.tree.map(lambda a, b: jnp.where(condition, a, b), one, other)


run = jit(
    iterations,
    static_argnames=("hessian", "capacity"),
    donate_argnames=("factor",),
    compiler_options=COMPILER_OPTIONS,
)
""":func:`iterations` compiled, for one pose; the factor that it is given is gone afterwards."""
