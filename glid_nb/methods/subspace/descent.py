"""Methods in the harmonic subspace that choose a direction on the host, one step at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.methods.subspace.problem import SubspaceProblem
from glid_nb.solvers import Iteration, Method, Result, Status, outcome
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.loop import Advance, Descent, Ending, Reached, follow
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.problem import map_from
from glid_nb.solvers.step import LEAST_ENERGY

Array = NDArray[Any]

# A decrease promised by the direction that rounding of the energy can hide.
_ROUNDING = 1e-8
# The same for a first-order direction, which promises far more than a step can hold.
_SMALL_SLOPE = 1e-4
# A first-order method has converged when this many steps together gain next to nothing.
_WINDOW, _GAIN = 50, 1e-9
# A direction longer than this multiple of the coefficients is shortened: the line search works on
# steps between 1e-12 and 2.
_LONGEST = 10.0
# Newton's steps that are shorter, and gain less of the energy, creep: each is dearer than the last,
# for it splits panels next to where the map folds.
_CREEPING = 1e-6
_JAMMED = (
    "No step along the search direction lowers the energy, though its gradient is not zero: the "
    "map is too close to folding for this method; the last certified map is returned."
)
_CREPT = (
    "Steps gain next to nothing any more, though the gradient is not zero: the map is too close to "
    "folding for this method; the last certified map is returned."
)


class Memory:
    """What a method remembers of its earlier steps; nothing here."""

    def forget(self) -> bool:
        """Drop it, after a direction that led nowhere; False if there was nothing to drop."""
        return False


@dataclass(frozen=True)
class View:
    """What a direction may look at."""

    problem: SubspaceProblem
    point: Point
    gradient: Array
    """(4c,) with respect to the unknowns, 0 elsewhere."""
    memory: Any = None
    step: float | None = None
    """Length of the last step."""


@dataclass(frozen=True)
class SubspaceMethod(Method):
    """A method in the harmonic subspace; its maps are certified."""

    family = "harmonic"
    options = (
        "sampling",
        "certificate",
        "p2p_weight",
        "conformal",
        "align",
        "max_iterations",
    )

    def direction(self, view: View) -> Array | Ending:
        """A descent direction (4c,), or the end of the method."""
        raise NotImplementedError

    def remembered(self) -> Memory:
        """What one solve remembers."""
        return Memory()

    def problem(self, inputs: Inputs) -> SubspaceProblem:
        """The problem on the device."""
        return SubspaceProblem(
            inputs.domain,
            inputs.pose,
            inputs.energy,
            inputs.options,
            self.harmonic_start(inputs),
        )

    def run(self, inputs: Inputs) -> Result:
        """Follow the directions by Newton's own line search and certificate."""
        return follow(lambda: DirectedDescent(self, self.problem(inputs)), inputs)

    @property
    def decrement(self) -> float | None:
        """The share of the energy that half of ``-gradient . direction`` falls below at a minimum;
        None for first-order directions, where that is no Newton decrement."""
        return None


@dataclass(frozen=True)
class SecondOrderMethod(SubspaceMethod):
    """A variant of Newton's method; it has converged where ``decrement^2 / 2`` falls below
    ``tolerance`` times the energy."""

    tolerance: float = 1e-10

    @property
    def decrement(self) -> float | None:
        """The tolerance."""
        return self.tolerance


class DirectedDescent(Descent):
    """Follows a method's directions by Newton's own line search and certificate."""

    uses_lapack = True

    def __init__(self, method: SubspaceMethod, problem: SubspaceProblem) -> None:
        self.method: SubspaceMethod = method
        self.subspace, self.memory = problem, method.remembered()
        self.tolerance = method.decrement
        self.point, self.gradient = problem.evaluate(problem.start)
        self.step: float | None = None
        self.sigma2_lower: Array | None = None
        self.chosen: Array | None = None
        self.ending: Ending | None = None
        self.just_split = 0
        self.initial = self._entry(0)

    @property
    def discretisation(self) -> Any:
        """The panels."""
        return self.subspace.discretisation

    def advance(self, before: int, left: int, may_refine: bool) -> Advance:
        """The next certified step, or why there is none."""
        if not left:
            return Advance()
        if self.chosen is None:
            self._choose()
        if self.ending is not None or self._is_minimal():
            return Advance()
        assert self.chosen is not None
        move = self.subspace.advance(self.point, self.gradient, self.chosen, may_refine)
        end = int(move.outcome)
        if end != outcome.RUNNING:
            return Advance(end, refused=np.asarray(move.refused))
        self.point, self.gradient = move.point, np.asarray(move.gradient)
        self.step, self.chosen = float(move.step), None
        panels = len(self.discretisation.panels)
        self.sigma2_lower = np.asarray(move.sigma2_lower)[:panels]
        least = float(self.sigma2_lower.min())
        entry = self._entry(before + 1, self.step, least, self.just_split)
        self.just_split = 0
        return Advance(iterations=[entry])

    def reached(self) -> Reached:
        """After the last step."""
        disc, coefficients = self.discretisation, np.asarray(self.point.coefficients)
        return Reached(
            float(self.point.energy_iso),
            float(self.point.energy_p2p),
            lambda: map_from(disc, coefficients),
            self.sigma2_lower,
        )

    def adapt(self, done: Advance, history: Sequence[Iteration]) -> Ending | None:
        """End where steps gain nothing; try without memory where none lowers the energy."""
        if self.ending is not None:
            return self.ending
        if done.outcome == outcome.NO_DECREASE:
            if self.memory.forget():
                self.chosen = None
                return None
            hidden = _SMALL_SLOPE if self.tolerance is None else _ROUNDING
            hides = self._promised() <= 2 * hidden * self._scale()
            return Ending(Status.STATIONARY) if hides else Ending(Status.BLOCKED, _JAMMED)
        return self._crept(history) if done.iterations else None

    def split(self, refused: Array) -> int:
        """Split panels; the direction stays, the values are computed anew."""
        count = self.subspace.split(refused)
        self.just_split += count
        if count:
            coefficients = np.asarray(self.point.coefficients)
            self.point, self.gradient = self.subspace.evaluate(coefficients)
        return count

    def _choose(self) -> None:
        view = View(self.subspace, self.point, self.gradient, self.memory, self.step)
        chosen = self.subspace.watch.run(self.method.direction, view)
        if isinstance(chosen, Ending):
            self.ending = chosen
            return
        length = np.linalg.norm(chosen) / max(np.linalg.norm(self.point.coefficients), 1e-300)
        self.chosen = chosen if length <= _LONGEST else chosen * (_LONGEST / length)

    def _is_minimal(self) -> bool:
        if self.tolerance is None or self._promised() / 2 > self.tolerance * self._scale():
            return False
        self.ending = Ending(Status.CONVERGED)
        return True

    def _crept(self, history: Sequence[Iteration]) -> Ending | None:
        """The end, where the last steps gain next to nothing."""
        energies = [entry.energy for entry in (self.initial, *history)]
        if self.tolerance is not None:
            gain = (energies[-2] - energies[-1]) / self._scale()
            assert self.step is not None
            creeps = max(self.step, gain) < _CREEPING
            return Ending(Status.BLOCKED, _CREPT) if creeps else None
        recent = energies[-1 - _WINDOW :]
        if len(recent) <= _WINDOW or recent[0] - recent[-1] > _GAIN * abs(recent[-1]):
            return None
        return Ending(
            Status.CONVERGED,
            f"The solver converged: {_WINDOW} iterations together lower the energy by less "
            f"than {_GAIN:g} of it.",
        )

    def _promised(self) -> float:
        assert self.chosen is not None
        return -float(self.gradient @ self.chosen)

    def _scale(self) -> float:
        return max(abs(float(self.point.energy)), LEAST_ENERGY)

    def _entry(
        self,
        number: int,
        step: float | None = None,
        sigma2_lower: float | None = None,
        split: int | None = None,
    ) -> Iteration:
        return Iteration(
            iteration=number,
            energy_iso=float(self.point.energy_iso),
            energy_p2p=float(self.point.energy_p2p),
            time=self.subspace.watch.lap(),
            step=step,
            sigma2_lower=sigma2_lower,
            panels=len(self.discretisation.panels),
            panels_split=split,
        )
