"""Newton's method on the device: one compiled call runs several iterations (paper Algorithm 1)."""

import functools
from collections import namedtuple
from typing import Any, NamedTuple

from glid_nb._features import lapack_in_place
from glid_nb._jax import AnyArray, Array, Bool, Float, Int, jax, jnp, lax
from glid_nb._programs import Program
from glid_nb.energies import table1
from glid_nb.solvers import cholesky, evaluation, hessian, line_search, whitening
from glid_nb.solvers.evaluation import Coefficients, Line, Number, Point
from glid_nb.solvers.line_search import CONVERGED, INDEFINITE, RUNNING
from glid_nb.solvers.options import MOST_PER_CALL
from glid_nb.solvers.problem import SubspaceProblem, expand, restrict_gradient, restrict_hessian

Factor = Float[Array, "4u 4u"]

# _CONTRACTION: another correction follows only if this one gained less than this share of what the
# step before it gained.
# _CLOSE: corrections begin only after a step that gained less than this share of the energy.
_CONTRACTION, _CLOSE = 0.3, 0.1
LEAST_ENERGY = 1e-6
"""Decreases are compared with the energy or with this, whichever is larger. ARAP's energy is 0 at
rigid motions."""


class Settings(NamedTuple):
    """Numbers that may change without compiling again."""

    tolerance: Float[AnyArray, ""] | float
    iterations: Int[AnyArray, ""] | int
    may_split: Bool[AnyArray, ""] | bool  # whether to return when a panel refuses a step
    ridge: Float[AnyArray, ""] | float  # added to the diagonal, relative to its mean
    reuse: Bool[AnyArray, ""] | bool  # whether to begin with the given factor
    corrections: Int[AnyArray, ""] | int  # most corrections of one iteration
    projects_first: Bool[AnyArray, ""] | bool  # whether to project before the first factorisation
    attempts: Int[AnyArray, ""] | int  # most factorisations of one iteration


Record = namedtuple(
    "Record",
    "energy_distortion energy_p2p step decrement sigma2_lower hessian_modified corrections",
)
"""One iteration after its step, as a row of numbers with the names of ``Iteration``."""


class State(NamedTuple):
    point: Point  # certified after the first step
    start_distortion: Number  # energies before the first iteration of this call
    start_p2p: Number
    iteration: Int[Array, ""]
    outcome: Int[Array, ""]
    decrement: Number
    records: Float[Array, "i r"]  # a Record in each row
    refused: Bool[Array, " p"]  # panels that refused the last preferred step
    sigma2_lower: Float[Array, " p"]  # certified bounds at the point, NaN before the first step
    turning: Float[Array, " p"]  # the proved change of arg f_z along each panel at the point
    factor: Factor  # Cholesky factor of the last Hessian, in whitened coordinates
    corrects: Bool[Array, ""]  # whether the next step is a correction
    gain: Number  # the decrease of the energy by the last step


def iterations(
    problem: SubspaceProblem, coefficients: Coefficients, factor: Factor, settings: Settings
) -> State:
    """Up to ``settings.iterations`` (at most `MOST_PER_CALL`) iterations of Algorithm 1, to be
    compiled.

    An iteration is a step with a new Hessian and, close to the minimum, corrections: steps with the
    same factor but new gradients (Shamanskii's method). One loop makes all steps, so only one body
    is compiled.
    """

    def goes_on(state: State) -> Bool[Array, ""]:
        more = state.corrects | (state.iteration < settings.iterations)
        return (state.outcome == RUNNING) & more

    point = evaluation.evaluated(problem, coefficients)
    real = problem.matrices.real
    start = State(
        point=point,
        start_distortion=point.energy_distortion,
        start_p2p=point.energy_p2p,
        iteration=jnp.array(0),
        outcome=jnp.array(RUNNING),
        decrement=jnp.array(jnp.inf),
        records=jnp.zeros((MOST_PER_CALL, len(Record._fields))),
        refused=jnp.zeros_like(real),
        sigma2_lower=jnp.full(real.shape, jnp.nan),
        turning=jnp.zeros(real.shape),
        factor=factor,
        corrects=jnp.array(False),
        gain=jnp.array(jnp.inf),
    )
    return lax.while_loop(goes_on, functools.partial(_step, problem, settings), start)


class _Trial(NamedTuple):
    """What one pass through lines 4 to 9 of Algorithm 1 finds."""

    factor: Factor
    projected: Bool[Array, ""]  # whether the Hessian was projected (21), (25)
    decrement: Number
    minimal: Bool[Array, ""]  # whether the step predicts no decrease worth taking
    outcome: Int[Array, ""]  # RUNNING if a step was certified
    step: Number
    point: Point  # the one that the step leads to, else the one that was
    sigma2_lower: Float[Array, " p"]
    turning: Float[Array, " p"]
    refused: Bool[Array, " p"]


def _step(problem: SubspaceProblem, settings: Settings, state: State) -> State:
    """One step: the first one of an iteration of Algorithm 1, or a correction."""
    trial = _tried(problem, settings, state)
    first = _after_first_step(problem, settings, state, trial)
    correction = _after_correction(problem, settings, state, trial)

    def chosen(corrected: Array, iterated: Array) -> Array:
        same = corrected is iterated
        return iterated if same else jnp.where(state.corrects, corrected, iterated)

    return jax.tree.map(chosen, correction, first)


def _tried(problem: SubspaceProblem, settings: Settings, state: State) -> _Trial:
    """The body of Algorithm 1's loop, with its line numbers."""
    point = state.point  # line 3: its energy
    factor, projected = _factorised(problem, settings, state)  # lines 5 and 6
    definite = jnp.isfinite(factor[-1, -1])
    line = _newton_line(problem, point, factor)  # lines 4 and 7
    # Lines 9 and 10, before the search: we stop on the decrement that the direction predicts.
    scale = jnp.maximum(jnp.abs(point.energy), LEAST_ENERGY)
    minimal = line.squared_decrement / 2 <= settings.tolerance * scale
    found = line_search.search(problem, point, line)  # lines 14 to 17 and 21 to 23
    found = found._replace(acceptable=found.acceptable & definite & ~minimal)
    once = settings.may_split | state.corrects  # a correction does not try shorter steps
    searched = line_search.backtrack(problem, point, line, found, once)  # lines 18 to 20
    outcome = jnp.where(minimal, CONVERGED, searched.outcome)
    outcome = jnp.where(definite, outcome, INDEFINITE)
    there, sigma2_lower, turning = lax.cond(
        outcome == RUNNING,
        lambda: (searched.point, searched.panel.sigma2_lower, searched.panel.turning),
        lambda: (point, state.sigma2_lower, state.turning),
    )
    decrement = jnp.sqrt(jnp.maximum(line.squared_decrement, 0))
    return _Trial(
        factor=factor,
        projected=projected,
        decrement=decrement,
        minimal=minimal,
        outcome=outcome,
        step=searched.step,
        point=there,
        sigma2_lower=sigma2_lower,
        turning=turning,
        refused=searched.refused,
    )


def _after_first_step(
    problem: SubspaceProblem, settings: Settings, state: State, trial: _Trial
) -> State:
    """The state after the first step of an iteration. Corrections follow close to the minimum."""
    there, stepped, i = trial.point, trial.outcome == RUNNING, state.iteration
    gain = state.point.energy - there.energy
    record = Record(
        energy_distortion=there.energy_distortion,
        energy_p2p=there.energy_p2p,
        step=trial.step,
        decrement=trial.decrement,
        sigma2_lower=_least(problem, trial.sigma2_lower),
        hessian_modified=trial.projected,
        corrections=0,
    )
    return State(
        point=there,
        start_distortion=state.start_distortion,
        start_p2p=state.start_p2p,
        iteration=i + stepped,
        outcome=trial.outcome,
        decrement=trial.decrement,
        records=_written(state.records, i, record, stepped),
        refused=trial.refused,
        sigma2_lower=trial.sigma2_lower,
        turning=trial.turning,
        factor=trial.factor,
        corrects=stepped & (gain < _CLOSE * there.energy) & (settings.corrections > 0),
        gain=gain,
    )


def _after_correction(
    problem: SubspaceProblem, settings: Settings, state: State, trial: _Trial
) -> State:
    """The state after a correction. One that fails ends its iteration only; one behind others that
    predicts no decrease ends the solve."""
    there, stepped, i = trial.point, trial.outcome == RUNNING, state.iteration - 1
    gain = state.point.energy - there.energy
    known = Record(*state.records[i])
    ends = trial.minimal & (known.corrections > 0)
    record = known._replace(
        energy_distortion=there.energy_distortion,
        energy_p2p=there.energy_p2p,
        sigma2_lower=_least(problem, trial.sigma2_lower),
        corrections=known.corrections + 1,
    )
    more = (gain < _CONTRACTION * state.gain) & (record.corrections < settings.corrections)
    return state._replace(
        point=there,
        outcome=jnp.where(ends, CONVERGED, RUNNING),
        decrement=jnp.where(ends, trial.decrement, state.decrement),
        records=_written(state.records, i, record, stepped),
        sigma2_lower=trial.sigma2_lower,
        turning=trial.turning,
        factor=trial.factor,
        corrects=stepped & more,
        gain=gain,
    )


def _least(problem: SubspaceProblem, sigma2_lower: Float[Array, " p"]) -> Number:
    """The least bound on the real panels."""
    return jnp.min(jnp.where(problem.matrices.real, sigma2_lower, jnp.inf))


def _written(records: Array, i: Array, record: Record, stepped: Array) -> Array:
    """The records with row ``i`` replaced if there was a step."""
    return records.at[i].set(jnp.where(stepped, jnp.stack(record), records[i]))


def _factorised(problem: SubspaceProblem, settings: Settings, state: State) -> tuple[Factor, Array]:
    """Cholesky factor of the Hessian (Algorithm 1, line 5), and whether ``K`` was projected.

    The last element of the factor is NaN if the factorisation failed. A correction, or a first step
    that reuses, keeps the given factor. The projection is (21), or (25) if that is enough.

    The attempts form a loop, so that they write into the same memory."""
    matrices, energy = problem.matrices, problem.energy
    first_step = jnp.logical_not(settings.reuse) | (state.iteration > 0)
    wanted = first_step & ~state.corrects
    dtype = matrices.whitened.dtype

    def attempt(carry: tuple) -> tuple:
        _, h, count = carry
        values = state.point.samples.values[:, matrices.hessian_index]
        x, y = evaluation.squares(values)
        local = hessian.local_hessian(energy.differentials(x, y), x, y)
        projected = hessian.positive_part(local)
        weights, f, g = jax.tree.map(
            lambda a: a.astype(dtype), (matrices.hessian_weights, *evaluation.directions(values))
        )

        def assembled(_: Any) -> Factor:
            projects = settings.projects_first | (count > 0)
            pairs = zip(projected, local, strict=True)
            k = hessian.LocalHessian(*(jnp.where(projects, *pair).astype(dtype) for pair in pairs))
            return hessian.assemble(matrices.whitened, weights, f, g, k)

        def project(h: Factor) -> Factor:
            # The indefinite Hessian differs from the projected one in this block only.
            across = (projected.across_f - local.across_f).astype(dtype)
            block = hessian.assemble_across_f(matrices.whitened, weights, f, across)
            return h.at[: block.shape[0], : block.shape[0]].add(block)

        if energy.indefinite_across_f_only:
            h = lax.cond(count == 0, assembled, project, h)
        else:
            h = assembled(h)
        whole = restrict_hessian(h, problem.unknowns, problem.p2p_hessian, settings.ridge)
        return cholesky.factorise(whole), h, count + 1

    def goes_on(carry: tuple) -> Bool[Array, ""]:
        factor, _, count = carry
        again = (count < settings.attempts) & ~jnp.isfinite(factor[-1, -1])
        return wanted & ((count == 0) | again)

    blank = jnp.zeros(state.factor.shape, dtype)
    factor, _, count = lax.while_loop(goes_on, attempt, (state.factor, blank, jnp.array(0)))
    return factor, wanted & ((count == 2) | settings.projects_first)


def _newton_line(problem: SubspaceProblem, point: Point, factor: Factor) -> Line:
    """The line in the direction ``-H^-1 gradient`` (1), computed in whitened coordinates
    (Algorithm 1, line 7)."""
    unknowns, t = problem.unknowns, problem.matrices.whitening
    gradient = evaluation.gradient(problem, point)
    gradient = restrict_gradient(whitening.pulled_back(gradient, t), unknowns)
    step = -cholesky.solve(factor, gradient)
    step = jnp.where(jnp.isfinite(factor[-1, -1]), step, 0)
    direction = whitening.coefficients(expand(step, unknowns), t)
    return evaluation.line_along(problem, direction, jnp.dot(gradient, step))


def _is_ours(problem: SubspaceProblem, *_: Any) -> bool:
    """Whether the compiled program may be kept: for an energy of Table 1, with LAPACK ready."""
    return lapack_in_place() and type(problem.energy).__module__ == table1.__name__


run = Program(iterations, donated=2, may_keep=_is_ours)
""":func:`iterations` compiled, for one pose. It destroys the factor that it is given."""
