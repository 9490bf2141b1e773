"""Methods in the harmonic subspace that choose a direction on the host, one step at a time."""

import functools
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal

import numpy as np

from glid_nb._arrays import Array
from glid_nb._features import solver_jit
from glid_nb._jax import AnyArray, Bool, jnp
from glid_nb._jax import Array as DeviceArray
from glid_nb._runtime import double_precision
from glid_nb.solvers import Inputs, Method, Result, Status, evaluation, line_search
from glid_nb.solvers.evaluation import Coefficients, Point
from glid_nb.solvers.hessian import LocalHessian, assemble, local_hessian, positive_part
from glid_nb.solvers.line_search import NO_DECREASE, RUNNING
from glid_nb.solvers.loop import Advance, Ending, Stopwatch, follow
from glid_nb.solvers.problem import (
    SubspaceProblem,
    expand,
    map_from,
    restrict_gradient,
    restrict_hessian,
)
from glid_nb.solvers.step import LEAST_ENERGY
from glid_nb.solvers.subspace import SubspaceDescent

Curvature = Literal["exact", "projected", "gauss-newton", "dirichlet"]

_ROUNDING = 1e-8  # the rounding of the energy can hide a predicted decrease below this share
# The same for first-order directions, which predict much larger decreases than a step can reach.
_SMALL_SLOPE = 1e-4
# The line search shortens a direction that is longer than this multiple of the coefficients.
_LONGEST = 10.0
# A Newton solve ends when a step is shorter than this and gains a smaller share of the energy.
# Close to a fold, such steps get more and more expensive, because each splits panels.
_CREEPING = 1e-6
_FOLDS = "the map is too close to folding for this method; the last certified map is returned."
_JAMMED = f"No step on the search direction lowers the energy, whose gradient is not zero: {_FOLDS}"
_CREPT = f"Steps hardly lower the energy any more, though the gradient is not zero: {_FOLDS}"


@dataclass(frozen=True)
class SubspaceMethod(Method):
    family = "harmonic"
    window = 50
    tolerance: ClassVar[float] = 1e-9
    options = ("sampling", "certificate", "p2p_weight", "conformal", "align", "max_iterations")

    def direction(self, at: "DirectedDescent") -> Array | Ending:
        """A descent direction (4c,), or the end of the method."""
        raise NotImplementedError

    def forget(self, memory: Any) -> bool:  # noqa: ARG002
        """Clear the method's memory after a direction without decrease. False if it was empty."""
        return False

    def started(self, inputs: Inputs) -> "DirectedDescent":
        return DirectedDescent(self, inputs)

    def run(self, inputs: Inputs) -> Result:
        return follow(lambda: self.started(inputs))


@dataclass(frozen=True)
class SecondOrderMethod(SubspaceMethod):
    """A variant of Newton's method. It converges at ``decrement^2 / 2 < tolerance * energy``."""

    window = None

    tolerance: float = 1e-10


class DirectedDescent(SubspaceDescent):
    """Follows the directions of a method, with the line search and certificate of our Newton
    method."""

    method: SubspaceMethod
    gradient: Array  # (4c,) with respect to the unknowns, 0 elsewhere
    memory: Any = None  # the method's data from earlier steps
    step: float | None = None  # length of the last step
    _chosen: Array | None = None
    _seconds = 0.0

    @double_precision
    def __init__(self, method: SubspaceMethod, inputs: Inputs) -> None:
        super().__init__(method, inputs, reduced=False)
        self._evaluate()
        self.initial, self._seconds = replace(self.reached().entry, time=self._seconds), 0.0

    @property
    def unit(self) -> float:
        """The unit of length of absolute constants."""
        return self.inputs.domain.cage.unit

    @property
    def size(self) -> float:
        """Norm of the coefficients, without the map's translation."""
        return float(np.linalg.norm(self.coefficients - self.problem.anchor))

    @functools.cached_property
    def free(self) -> Array:
        return np.asarray(self.problem.unknowns.free)

    @functools.cached_property
    def p2p_hessian(self) -> Array:
        """(4c, 4c) Hessian of the positional energy, zero for fixed and tied unknowns."""
        matrix, weights = map(jnp.asarray, self.problem.positional[::2])
        h = restrict_hessian(matrix.T @ (weights[:, None] * matrix), self.problem.unknowns)
        # The isometric Hessian already has a diagonal for fixed unknowns.
        return np.asarray(h) - np.diag(1 - self.free)

    def hessian(self, curvature: Curvature) -> Array:
        """(4c, 4c) Hessian of the isometric energy. For fixed and tied unknowns, its diagonal is
        ``unit**-2``."""
        h = np.array(hessian_at(self.problem, self.evaluated, curvature=curvature))
        fixed = np.flatnonzero(self.free == 0)
        h[fixed, fixed] = self.unit**-2
        return h

    def advance(self, may_split: bool) -> Advance:
        """Take the next certified step, or return why there is none."""
        if not self.left:
            return Advance()
        watch = Stopwatch()
        if self._chosen is None and (ending := self._choose()) is not None:
            return Advance(ending=ending)
        may_split_now = may_split and self.discretisation.can_split
        move, gradient = _advance(
            self.problem, self.evaluated, self.gradient, self._chosen, may_split_now
        )
        end = int(move.outcome)
        self._seconds += watch.seconds
        if end != RUNNING:
            return Advance(end, refused=np.asarray(move.refused))
        self.point, self.gradient = move.point, np.asarray(gradient)
        self.step, self._chosen = float(move.step), None
        self.prove(move.panel.sigma2_lower, move.panel.turning)
        self.record(replace(self.reached().entry, time=self._seconds, step=self.step))
        self.just_split, self._seconds = 0, 0.0
        return Advance(iterations=1)

    def adapt(self, done: Advance) -> Ending | None:
        """End if steps gain nothing, unless measuring angles and scales changes the objective."""
        ending = self._adapted(done)
        if ending is None or not ending.status.ok:
            return ending
        if not self.measure_turns(map_from(self.inputs.domain, self.coefficients)):
            return ending
        vars(self).pop("p2p_hessian", None)
        self._chosen = self.memory = None
        self._evaluate()
        return None

    def _adapted(self, done: Advance) -> Ending | None:
        """End if steps gain nothing. If no step lowers the energy, try once without memory."""
        if done.ending is not None:
            return done.ending
        if done.outcome == NO_DECREASE:
            if self.method.forget(self.memory):
                self._chosen = None
                return None
            hidden = _ROUNDING if self.method.window is None else _SMALL_SLOPE
            hides = self._promised() <= 2 * hidden * self._scale()
            return Ending(Status.STATIONARY) if hides else Ending(Status.BLOCKED, _JAMMED)
        if not done.iterations:
            return None
        if self.method.window is not None:
            return self.stagnation()
        before = self.history[-2] if len(self.history) > 1 else self.initial
        assert before is not None
        gain = (before.energy - self.history[-1].energy) / self._scale()
        crept = max(self.step or 0.0, gain) < _CREEPING
        return Ending(Status.BLOCKED, _CREPT) if crept else None

    def split(self, refused: Array) -> int:
        # Keep the direction, and compute the values on the new panels.
        watch = Stopwatch()
        count = super().split(refused)
        self._seconds += watch.seconds
        if count:
            self._evaluate()
        return count

    def _evaluate(self) -> None:
        watch = Stopwatch()
        self.point, gradient = _evaluate(self.problem, self.coefficients)
        self.gradient = np.asarray(gradient)
        self._seconds += watch.seconds

    def _choose(self) -> Ending | None:
        chosen = self.method.direction(self)
        if isinstance(chosen, Ending):
            return chosen
        length = np.linalg.norm(chosen) / max(self.size, 1e-300)
        self._chosen = chosen if length <= _LONGEST else chosen * (_LONGEST / length)
        second_order, least = self.method.window is None, self.method.tolerance * self._scale()
        minimal = second_order and self._promised() / 2 <= least
        return Ending(Status.CONVERGED) if minimal else None

    def _promised(self) -> float:
        assert self._chosen is not None
        return -float(self.gradient @ self._chosen)

    def _scale(self) -> float:
        return max(abs(float(self.evaluated.energy)), LEAST_ENERGY)


@solver_jit
def _evaluate(problem: SubspaceProblem, coefficients: Coefficients) -> tuple[Point, Coefficients]:
    point = evaluation.evaluated(problem, coefficients)
    return point, restrict_gradient(evaluation.gradient(problem, point), problem.unknowns)


@functools.partial(solver_jit, static_argnames="curvature")
def hessian_at(problem: SubspaceProblem, point: Point, *, curvature: Curvature) -> DeviceArray:
    """(4c, 4c) Hessian of the isometric energy with respect to the unknowns (33).

    ``gauss-newton`` is for ARAP, ``2 (|f_z| - 1)^2 + 2 |f_zbar|^2``, and leaves out the second
    derivatives of the residuals. ``dirichlet`` is the Hessian of ``|f_z|^2 + |f_zbar|^2``.
    """
    matrices = problem.matrices
    values = point.samples.values[:, matrices.hessian_index]
    x, y = evaluation.squares(values)
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
    f, g = evaluation.directions(values)
    basis = matrices.nodes[:, matrices.hessian_index]
    h = assemble(basis, matrices.hessian_weights, f, g, local)
    upper = jnp.triu(restrict_hessian(h, problem.unknowns))
    return upper + jnp.triu(upper, 1).T


@solver_jit
def _advance(
    problem: SubspaceProblem,
    point: Point,
    gradient: Coefficients,
    direction: Coefficients,
    may_split: Bool[AnyArray, ""] | bool,
) -> tuple[line_search.Backtracking, Coefficients]:
    slope = jnp.dot(gradient, direction)
    line = evaluation.line_along(problem, expand(direction, problem.unknowns), slope)
    found = line_search.search(problem, point, line)
    end = line_search.backtrack(problem, point, line, found, may_split)
    # Compute the values from the coefficients. Carried values would collect rounding errors over
    # thousands of iterations, more than the certificate allows for.
    after = evaluation.evaluated(problem, point.coefficients + end.step * line.direction)
    gradient = restrict_gradient(evaluation.gradient(problem, after), problem.unknowns)
    return end._replace(point=after), gradient
