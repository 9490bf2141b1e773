"""One loop for all descent methods in the harmonic subspace; they differ in their direction."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.methods.recording import Ending, Run, Snapshot
from glid_nb.methods.subspace.evaluation import Move, Point
from glid_nb.methods.subspace.problem import SubspaceProblem
from glid_nb.solvers import Status, outcome
from glid_nb.solvers.newton import LEAST_ENERGY

Array = NDArray[Any]

_PATIENCE = 3
_MOST_ROUNDS = 40
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


@dataclass(frozen=True)
class View:
    """What a direction may look at."""

    problem: SubspaceProblem
    point: Point
    gradient: Array
    """(4c,) with respect to the unknowns, 0 elsewhere."""
    step: float
    """Length of the last step, NaN at first."""


class Direction(Protocol):
    """How a method chooses where to go; it may remember what it has seen."""

    second_order: ClassVar[bool]
    """Whether ``-gradient . direction`` is a Newton decrement, whose size tells of convergence."""

    def __call__(self, view: View) -> Array | Ending:
        """A descent direction (4c,), or the end of the method."""
        ...

    def forget(self) -> bool:
        """Drop what was remembered, after a direction that led nowhere; False if nothing was."""
        ...


@double_precision
def _first(problem: SubspaceProblem) -> Point:
    return problem.evaluate(problem.start)


def descend(problem: SubspaceProblem, choose: Direction) -> Run:
    """Follow a method's directions by Newton's own line search and certificate."""
    point = _first(problem)
    seconds, compiling = problem.watch.lap()
    yield _snapshot(problem, point, seconds, compiling)
    energies = [_total(point)]
    step = np.nan
    while True:
        taken = _step(problem, choose, point, step)
        if isinstance(taken, Ending):
            return taken
        point, step = taken.point, float(taken.step)
        seconds, compiling = problem.watch.lap()
        yield _snapshot(
            problem, point, seconds, compiling, step=step, sigma2_lower=float(taken.sigma2_lower)
        )
        energies.append(_total(point))
        gain = energies[-2] - energies[-1]
        if choose.second_order and max(step, gain / _scale(point)) < _CREEPING:
            return Ending(Status.BLOCKED, _CREPT)
        recent = energies[-1 - _WINDOW :]
        stalled = len(recent) > _WINDOW and recent[0] - recent[-1] <= _GAIN * abs(recent[-1])
        if stalled and not choose.second_order:
            return Ending(
                Status.CONVERGED,
                f"The solver converged: {_WINDOW} iterations together lower the energy by less "
                f"than {_GAIN:g} of it.",
            )


@double_precision
def _step(
    problem: SubspaceProblem, choose: Direction, point: Point, last_step: float
) -> Move | Ending:
    """The next certified step, panels split where that needs it, or why there is none."""
    rounds = total_rounds = 0
    with single_blas_thread():
        direction: Array | None = None
        while True:
            if direction is None:
                gradient = np.asarray(point.gradient)
                chosen = _timed(problem, choose, View(problem, point, gradient, last_step))
                if isinstance(chosen, Ending):
                    return chosen
                length = np.linalg.norm(chosen) / max(np.linalg.norm(point.coefficients), 1e-300)
                direction = chosen if length <= _LONGEST else chosen * (_LONGEST / length)
            promised = -float(gradient @ direction)
            scale = _scale(point)
            if choose.second_order and promised / 2 <= problem.options.tolerance * scale:
                return Ending(Status.CONVERGED)
            move = problem.advance(point, direction, rounds < _PATIENCE)
            end = int(move.outcome)
            if end == outcome.RUNNING:
                return move
            if end == outcome.NO_DECREASE:
                if choose.forget():
                    direction = None
                    continue
                hidden = _ROUNDING if choose.second_order else _SMALL_SLOPE
                if promised <= 2 * hidden * scale:
                    return Ending(Status.STATIONARY)
                return Ending(Status.BLOCKED, _JAMMED)
            total_rounds += 1
            rounds = 0 if end == outcome.BLOCKED else rounds + 1
            if total_rounds > _MOST_ROUNDS or not problem.refine(np.asarray(move.refused)):
                return Ending(Status.BLOCKED)
            point = problem.evaluate(np.asarray(point.coefficients))
            gradient = np.asarray(point.gradient)


def _timed(problem: SubspaceProblem, choose: Direction, view: View) -> Array | Ending:
    """The direction, its host work counted; device calls within count themselves."""
    watch = problem.watch
    counted, began = watch.seconds + watch.compile_time, time.perf_counter()
    chosen = choose(view)
    elapsed = time.perf_counter() - began
    watch.seconds += max(elapsed - (watch.seconds + watch.compile_time - counted), 0.0)
    return chosen


def _snapshot(
    problem: SubspaceProblem, point: Point, seconds: float, compiling: float, **more: Any
) -> Snapshot:
    coefficients = np.asarray(point.coefficients)
    return Snapshot(
        float(point.energy_iso),
        float(point.energy_p2p),
        seconds,
        lambda: problem.map_of(coefficients),
        compile_time=compiling,
        **more,
    )


def _scale(point: Point) -> float:
    return max(abs(_total(point)), LEAST_ENERGY)


def _total(point: Point) -> float:
    return float(point.energy_iso) + float(point.energy_p2p)
