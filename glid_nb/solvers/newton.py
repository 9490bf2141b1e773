"""Our Newton method, the part on the host (paper Algorithm 1).

A compiled call runs several iterations.
"""

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb._jax import jax, jit, jnp
from glid_nb._runtime import double_precision
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import evaluation, hessian, line_search, step
from glid_nb.solvers.discretisation import Matrices
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.loop import Advance, Ending, Stopwatch, follow
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.options import Options
from glid_nb.solvers.problem import SubspaceProblem, map_from, restrict_rows, unknowns_of
from glid_nb.solvers.result import Iteration, Result, Status
from glid_nb.solvers.subspace import SubspaceDescent
from glid_nb.solvers.whitening import pulled_back

# The ridge is a shift of the Hessian's diagonal, relative to the diagonal's mean.
# With fewer than two handles, rotations cost nothing and the Hessian is singular (Appendix I). This
# is the initial shift for such poses, large enough for single precision.
_SINGULAR_RIDGE = 1e-6
# The smallest and the largest shift. The solve ends if the largest is not enough.
_RIDGE, _LARGEST_RIDGE = 1e-9, 1e-2
# The shift grows by this factor after a failed factorisation and shrinks by it after a step.
_RIDGE_FACTOR = 100.0
# A solve with this many iterations is slow; from then on the Hessian uses all nodes.
SLOW_ITERATIONS = 20
# A solve is also slow if a step is shorter than _SLOW_STEP and gains less than _SLOW_GAIN of the
# energy.
_SLOW_STEP, _SLOW_GAIN = 0.5, 0.05
# A solve has stalled if _STALLED steps in a row gain less than _STALL_GAIN of the energy together.
_STALLED, _STALL_GAIN = 4, 1e-10
# If each of these steps is shorter than this, a gain below this share of the energy is a stall.
_CREEPING = 1e-6
# Multiplications for Hessians in one call: some seconds. A callback can stop the solve afterwards.
WORK_PER_CALL = 10**10
# A solve begins without the steep coordinates (see whitening.py) and puts some of them back.
# _GAIN: the coordinates that stay out would together gain less than this share of the energy.
# _ROUGH: the first check is where the decrement predicts a decrease below this share.
# _GROWTH: a coordinate stays out if its coefficients would exceed this many times the shape's size.
_GAIN, _ROUGH, _GROWTH = 1e-7, 4e-3, 1e2
# The rounding of the energy can hide a predicted decrease below this share of the energy.
_ROUNDING = 1e-8


@dataclass(frozen=True)
class Newton(Method):
    """Newton's method, with the exact Hessian where that is positive definite, else the projected.

    This is our method. Its settings are the :class:`~glid_nb.Options`.
    """

    name = "newton"
    label = "Newton, ours"
    family = "harmonic"
    options = tuple(Options.__dataclass_fields__)

    def run(self, inputs: Inputs) -> Result:
        return descend(inputs, self)


@double_precision
def descend(inputs: Inputs, method: Method) -> Result:
    """One descent from one map to a local minimum."""
    return follow(lambda: NewtonDescent(method, inputs))


@dataclass(frozen=True)
class Treatment:
    """How the next compiled call treats the Hessian; :meth:`NewtonDescent.adapt` changes it."""

    ridge: float
    """Added to the diagonal, relative to its mean."""
    least_ridge: float
    """The ridge that stays, where the Hessian is singular by itself."""
    reuse: bool
    """Whether the call begins with the last factor."""
    rough: bool
    """Whether to converge roughly, since steep coordinates may be put back afterwards."""
    full_since: int | None = None
    """The number of iterations after which the Hessian was put on all nodes."""

    def relaxed(self) -> "Treatment":
        """With a smaller ridge: near the minimum a ridge shortens the steps."""
        relaxed = self.ridge / _RIDGE_FACTOR
        return replace(self, ridge=max(relaxed if relaxed >= _RIDGE else 0.0, self.least_ridge))

    def raised(self) -> "Treatment":
        """With more of a ridge."""
        return replace(self, ridge=max(_RIDGE_FACTOR * self.ridge, _RIDGE))


class NewtonDescent(SubspaceDescent):
    """One run of Algorithm 1.

    With fewer than two handles the Hessian is singular (Proposition I.1).
    """

    shows_start = False

    def __init__(self, method: Method, inputs: Inputs) -> None:
        super().__init__(method, inputs, reduced=True)
        self.problem = self.problem._replace(p2p_hessian=_p2p_hessian(self.problem))
        if isinstance(inputs.start, Result) and self._continues(inputs.start):
            # A copy, because a call destroys the factor that it gets.
            self.factor = jnp.array(inputs.start.factor, copy=True)
        self.decrement = np.inf  # of the last step
        singular = len(inputs.pose) < 2
        self.treatment = Treatment(
            ridge=_SINGULAR_RIDGE if singular else 0.0,
            least_ridge=_RIDGE if singular else 0.0,
            reuse=self.factor is not None,
            rough=self.discretisation.whitening.steep.shape[1] > 0,
        )

    def _continues(self, start: Result) -> bool:
        """Whether the last Hessian of an earlier solve belongs to this problem."""
        mine, theirs = self.inputs.options, start.options
        return bool(
            mine.corrections
            and start.factor is not None
            and start.discretisation is self.discretisation
            and start.energy_measure == self.problem.energy
            and start.pose.same_constraints(self.inputs.pose)
            and (theirs.p2p_weight, theirs.conformal) == (mine.p2p_weight, mine.conformal)
        )

    def settings(self, may_split: bool = True) -> step.Settings:
        options = self.inputs.options
        return step.Settings(
            tolerance=max(options.tolerance, _ROUGH * self.treatment.rough),
            iterations=min(options.iterations_per_call, self.left, self._most_at_once()),
            may_split=may_split and self.discretisation.can_split,
            ridge=self.treatment.ridge,
            reuse=self.treatment.reuse,
            corrections=options.corrections,
            projects_first=options.hessian == "projected",
            attempts=2 if options.hessian == "adaptive" else 1,
        )

    def _most_at_once(self) -> int:
        rows, nodes = self.problem.matrices.whitened.shape
        return max(WORK_PER_CALL // (rows**2 * nodes), 1)

    def advance(self, may_split: bool) -> Advance:
        """One compiled call. Without iterations left, it still evaluates the energies."""
        watch = Stopwatch()
        state = step.run(*self.arguments(may_split))
        int(state.outcome)  # waits for the device
        self.factor = state.factor
        return self.take(state, watch.seconds)

    def arguments(self, may_split: bool = True) -> tuple[Any, ...]:
        """The arguments of the next compiled call, which destroys the factor."""
        if self.factor is None:
            self.factor = np.zeros(self.problem.p2p_hessian.shape)
            self.treatment = replace(self.treatment, reuse=False)
        return self.problem, self.coefficients, self.factor, self.settings(may_split)

    def take(self, state: step.State, seconds: float) -> Advance:
        """Read the state after a compiled call that took ``seconds``."""
        self.point = state.point
        self.decrement = float(state.decrement)
        end, taken = int(state.outcome), int(state.iteration)
        panels = self.discretisation.panels
        if taken:
            self.prove(state.sigma2_lower, state.turning)
        if self.initial is None:
            iso, p2p = float(state.start_distortion), float(state.start_p2p)
            self.initial = Iteration(energy_distortion=iso, energy_p2p=p2p)
        for row in np.asarray(state.records)[:taken].tolist():
            known: dict[str, Any] = dict(zip(step.Record._fields, row, strict=True))
            known["hessian_modified"] = bool(known["hessian_modified"])
            known |= {"corrections": int(row[-1]), "panels_split": self.just_split}
            self.record(Iteration(time=seconds / taken, panels=len(panels), **known))
            self.just_split = 0
        refused = np.asarray(state.refused)
        if refused.any():
            refused = refused & evaluation.tightened_by_splitting(self.problem, state.point)
        # After a split the map is unchanged, so its last Hessian is still right.
        reuse = end == line_search.REFUSED and bool(self.inputs.options.corrections)
        self.treatment = replace(self.treatment, reuse=reuse)
        return Advance(end, taken, refused)

    def adapt(self, done: Advance) -> Ending | None:
        """Switch to the full Hessian or another ridge if that may help; else end the solve."""
        if done.outcome == line_search.CONVERGED and self.treatment.rough:
            rough = self.put_back()
            reuse = not rough and bool(self.inputs.options.corrections)
            self.treatment = replace(self.treatment, rough=rough, reuse=reuse)
            return None
        if done.outcome == line_search.CONVERGED:
            now = map_from(self.inputs.domain, self.coefficients)
            goes_on = self.measure_turns(now) or self.put_back()
            return None if goes_on else Ending(Status.CONVERGED)
        if done.iterations:
            self.treatment = self.treatment.relaxed()
            # Finer quadrature does not help the projected Hessian.
            coarse = self.discretisation.can_split and self.inputs.options.hessian != "projected"
            if coarse and _is_slow(self.history):
                self.take_full_hessian()
        if done.outcome == line_search.INDEFINITE:
            # Rounding or the coarse quadrature may be the cause.
            if self.take_full_hessian():
                return None
            # Another cause: with two handles in nearly one place, the Hessian is almost singular.
            if self.inputs.options.hessian == "exact":
                return Ending(Status.INDEFINITE)
            self.treatment = self.treatment.raised()
            return Ending(Status.BLOCKED) if self.treatment.ridge > _LARGEST_RIDGE else None
        stalled = done.iterations and has_stalled(self.history[self.treatment.full_since or 0 :])
        if not (done.outcome == line_search.NO_DECREASE or stalled) or self.take_full_hessian():
            return None
        hidden = _ROUNDING * abs(float(self.evaluated.energy))
        return Ending(Status.STATIONARY if self.decrement**2 / 2 <= hidden else Status.BLOCKED)

    def put_back(self) -> bool:
        """Put back the steep coordinates that would lower the minimum. Returns whether there are
        any."""
        steep = self.discretisation.whitening.steep
        if not steep.shape[1]:
            return False
        point = self.evaluated
        gains = _promised(self.problem, point, steep, self.inputs.options.conformal)
        order = np.argsort(gains)
        least = _GAIN * max(abs(float(point.energy)), step.LEAST_ENERGY)
        chosen = np.sort(order[np.cumsum(gains[order]) > least])
        if not len(chosen):
            return False
        self.discretisation = self.discretisation.with_steep(chosen)
        basis, t = self.discretisation.basis, self.discretisation.whitening.t
        unknowns = unknowns_of(basis, self.inputs.options.conformal, t)
        # Steep coordinates oscillate between the nodes of the coarse quadrature: use all nodes.
        if self.treatment.full_since is None:
            self.treatment = replace(self.treatment, full_since=len(self.history))
        self.problem = self.problem._replace(matrices=self._hessian_matrices(), unknowns=unknowns)
        self.problem = self.problem._replace(p2p_hessian=_p2p_hessian(self.problem))
        self.factor, self.treatment = None, replace(self.treatment, reuse=False)
        return True

    def _hessian_matrices(self) -> Matrices:
        """The panels' matrices, for the full Hessian if the solve has switched to it."""
        full = self.treatment.full_since is not None
        return self.discretisation.full(self.matrices) if full else self.matrices

    def measure_turns(self, map: HarmonicMap) -> bool:
        changes = super().measure_turns(map)
        self.problem = self.problem._replace(p2p_hessian=_p2p_hessian(self.problem))
        return changes

    def split(self, refused: Array) -> int:
        count = super().split(refused)
        if count:
            self.problem = self.problem._replace(matrices=self._hessian_matrices())
        return count

    def take_full_hessian(self) -> bool:
        """Use double precision and all nodes for the Hessian; False if that is already so."""
        if self.treatment.full_since is not None:
            return False
        self.treatment = replace(self.treatment, full_since=len(self.history))
        self.problem = self.problem._replace(matrices=self._hessian_matrices())
        return True


gradient = jit(evaluation.gradient)


def _promised(problem: SubspaceProblem, point: Point, columns: Array, conformal: bool) -> Array:
    """(k,) predicted decreases of the energy along orthonormal steep columns (c, k), each alone.

    The prediction is that of a Newton step. Steep columns oscillate, so their curvature is the mean
    of the curvatures along and across the derivatives. Over the boundary the harmonic mean is
    taken, which is rather too small.
    """
    x, y = evaluation.squares(point.samples.values)
    k = hessian.positive_part(hessian.local_hessian(problem.energy.differentials(x, y), x, y))
    weights = np.asarray(problem.matrices.weights)
    g = np.asarray(gradient(problem, point)).reshape(2, 2, -1)
    slopes = np.abs((g[:, 0] + 1j * g[:, 1]) @ columns.conj()) ** 2
    along = (k.along_ff, k.across_f), (k.along_gg, k.across_g)
    means = [np.asarray(a + b) / 2 for a, b in along]
    curvatures = [
        weights.sum() / (weights[weights > 0] / mean[weights > 0]).sum() for mean in means
    ]
    curvature = np.array(curvatures)[:, None]
    gains, changes = slopes / (2 * curvature), np.sqrt(slopes) / curvature
    if conformal:
        gains, changes = gains[:1], changes[:1]
    # With coefficients much larger than the shape, the map would lose digits to cancellation.
    size = np.abs(problem.matrices.chord).sum(axis=1).max() / 2
    allowed = changes.max(axis=0) * np.abs(columns).max(axis=0) <= _GROWTH * size
    return np.where(allowed, gains.sum(axis=0), 0.0)


class _Quadratic:
    """What the positional energy's Hessian depends on, compared by value: a key of a cache."""

    def __init__(self, problem: SubspaceProblem) -> None:
        positional, self.unknowns = problem.positional, problem.unknowns
        self.matrix, self.weights = positional.matrix, positional.weights
        self.whitening = problem.matrices.whitening

    @property
    def _arrays(self) -> tuple[Any, ...]:
        return self.matrix, self.weights, self.unknowns.free, self.whitening

    def __hash__(self) -> int:
        return hash(tuple(array.shape for array in self._arrays))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Quadratic) and all(
            a is b or (isinstance(a, np.ndarray) and np.array_equal(a, b))
            for a, b in zip(self._arrays, other._arrays, strict=True)
        )


def _p2p_hessian(problem: SubspaceProblem) -> Any:
    """The positional energy's Hessian (F.6), the sum of (F.3), else the identity; on the device."""
    return _hessian_of(_Quadratic(problem))


@functools.lru_cache(maxsize=1)  # a drag asks for the same one at each move
def _hessian_of(quadratic: _Quadratic) -> Any:
    rows = pulled_back(quadratic.matrix, np.asarray(quadratic.whitening))
    rows = restrict_rows(rows, quadratic.unknowns)
    h = rows.T @ (quadratic.weights[:, None] * rows)
    h[np.diag_indices_from(h)] += 1 - quadratic.unknowns.free
    return jax.device_put(h)


def _is_slow(history: Sequence[Iteration]) -> bool:
    *before, last = history
    if len(history) >= SLOW_ITERATIONS:
        return True
    gained = before[-1].energy - last.energy if before else np.inf
    assert last.step is not None
    return bool(last.step < _SLOW_STEP and gained < _SLOW_GAIN * last.energy)


def has_stalled(history: Sequence[Iteration]) -> bool:
    """Whether the last iterations lowered the energy too little to continue."""
    if len(history) <= _STALLED:
        return False
    before, *recent = history[-1 - _STALLED :]
    tiny = all((entry.step or 0.0) < _CREEPING for entry in recent)
    least = (_CREEPING if tiny else _STALL_GAIN) * abs(recent[-1].energy)
    return before.energy - recent[-1].energy <= least
