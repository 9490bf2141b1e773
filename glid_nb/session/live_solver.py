"""Solving while somebody drags: the latest target wins, and goes on from the one before."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry.panels import Panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import (
    OURS,
    DeformationMap,
    MeshMap,
    MethodProgress,
    MethodResult,
    Step,
    run_method,
)
from glid_nb.session.edit_state import EditedPose, Solution, continued_history
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.solvers import Iteration, Progress, Result, solve
from glid_nb.solvers.discretisation import discretise

Array = NDArray[Any]

FRAME_INTERVAL = 1 / 40
"""Least number of seconds between two frames of one solve; its last frame always comes."""
# Panels only ever get finer; beyond this multiple of a fresh domain's a solve takes fresh ones.
_MOST_REFINED = 3.0


@dataclass(frozen=True, eq=False)
class Task:
    """What to solve.

    Parameters
    ----------
    pose : EditedPose
        Handles, targets, energy, options, method, and the map to start from.
    chain : int
        Tasks of one chain continue one another's maps; another chain starts at its own.
    single : bool
        Stop after one compiled call, or one iteration of another method.
    """

    pose: EditedPose
    chain: int
    single: bool = False


@dataclass(frozen=True, eq=False)
class Frame:
    """A map on the way to a solution, or the solution."""

    task: Task
    map: HarmonicMap
    """Certified. The task's own while a method works on a mesh."""
    history: tuple[Iteration, ...] | tuple[Step, ...]
    """All iterations of this gesture so far."""
    solution: Solution | None
    """None while the solve goes on."""
    panels: Panels | None = None
    """Of the boundary; None for other methods than ours."""
    sigma2_lower: Array = field(default_factory=lambda: np.empty(0))
    """(p,) certified bound per panel; empty when it is not known."""
    mesh: MeshMap | None = None
    """The map of a method on a mesh, which may fold."""
    starts: tuple[int, ...] = ()
    """Which of the gesture's iterations began a solve, the targets having moved before."""

    @property
    def bound(self) -> float:
        """What is proved of sigma_2 everywhere; NaN when the solver did not say."""
        if len(self.sigma2_lower):
            return float(self.sigma2_lower.min())
        return self.history[-1].sigma2_lower if self.history else math.nan


class LiveSolver:
    """Solves one task after the other, each from what the one before it has reached.

    Parameters
    ----------
    publish : bound method
        Called with every :class:`Frame`. Its object is not kept alive by this.
    failed : bound method
        Called with an exception that a solve raised.
    """

    def __init__(
        self, publish: Callable[[Frame], None], failed: Callable[[Exception], None]
    ) -> None:
        self._publish, self._failed = weakly(publish), weakly(failed)
        self._last: Result | MethodResult | None = None
        self._last_chain: int | None = None
        self._iterations: tuple[Any, ...] = ()
        self._starts: tuple[int, ...] = ()
        self._published = -np.inf

    def solve(self, task: Task, worker: LatestWins[Task]) -> None:
        """Run the task's method, and publish what it comes to.

        A newer task interrupts this between two compiled calls, or two iterations of another
        method than ours. So every task moves the shape, and the last one is solved to its end.
        """
        continued = self._last_chain == task.chain and self._last is not None
        last = self._last if continued else None
        before = self._iterations if continued else ()
        start = before[-1].iteration + 1 if before else 1
        earlier = tuple(i for i in self._starts if before and before[0].iteration <= i < start)
        self._starts = (*earlier, start)
        try:
            if task.pose.method.name == OURS:
                assert not isinstance(last, MethodResult)
                result, frame = self._solve_by_ours(task, worker, last, before)
            else:
                assert not isinstance(last, Result)
                result, frame = self._solve_by_method(task, worker, last, before)
        except Exception as error:  # shown to the user; the next task begins anew
            self._last = None
            self._failed(error)
            return
        self._last, self._last_chain, self._iterations = result, task.chain, frame.history
        self._published = time.monotonic()
        self._publish(frame)

    def _solve_by_ours(
        self,
        task: Task,
        worker: LatestWins[Task],
        last: Result | None,
        before: tuple[Iteration, ...],
    ) -> tuple[Result, Frame]:
        edited = task.pose
        bounds = np.empty(0)
        calls = iterations = 0

        def callback(progress: Progress) -> bool:
            nonlocal bounds, calls, iterations
            calls += 1
            bounds = progress.sigma2_lower
            moved, iterations = len(progress.history) > iterations, len(progress.history)
            # The panels that a call without an iteration has split are kept for the next task.
            if worker.overtaken or (task.single and (moved or calls > 1)):
                return True  # the frame comes with the result
            if moved and self._is_time():
                history = continued_history(before, progress.history)
                panels = progress.discretisation.panels
                self._publish(
                    Frame(task, progress.map, history, None, panels, bounds, starts=self._starts)
                )
            return False

        start = _starting_point(edited, last)
        # The shape is under a hand: it must go on from where it is, without turning as a whole.
        # A single handle takes it along.
        options = replace(edited.options, align=len(edited.pose) == 1, restarts=0)
        domain = edited.map.domain
        result = solve(domain, edited.pose, edited.energy, options, start, callback)
        solution = Solution.of(result, before, self._starts)
        panels = result.discretisation.panels
        bounds = bounds if len(bounds) == len(panels) else np.empty(0)
        history = continued_history(before, result.history)
        return result, Frame(
            task, result.map, history, solution, panels, bounds, starts=self._starts
        )

    def _solve_by_method(
        self,
        task: Task,
        worker: LatestWins[Task],
        last: MethodResult | None,
        before: tuple[Step, ...],
    ) -> tuple[MethodResult, Frame]:
        edited = task.pose

        def callback(progress: MethodProgress) -> bool:
            if worker.cancelled:
                return True
            if len(progress.history) == 1:  # the start: every task takes a step from there
                return False
            if task.single or worker.overtaken:
                return True
            if self._is_time():
                history = continued_history(before, progress.history[1:])
                self._publish(_frame(task, progress.map, history, None))
            return False

        start = edited.map if last is None else last.map
        if isinstance(start, HarmonicMap) and edited.method.takes("conformal"):
            start = _conformal_if_asked(edited, start)
        result = run_method(
            edited.method.name,
            edited.map.domain,
            edited.pose,
            edited.energy,
            align=False,
            start=start,
            triangulation=start.triangulation if isinstance(start, MeshMap) else None,
            callback=callback,
            **edited.method.arguments(edited.options),
        )
        history = continued_history(before, result.history[1:])
        return result, _frame(task, result.map, history, Solution.of_method(result, before))

    def _is_time(self) -> bool:
        """Whether the next frame is due; the time counts from now on if it is."""
        now = time.monotonic()
        due = now - self._published >= FRAME_INTERVAL
        if due:
            self._published = now
        return due


def _frame(
    task: Task, map: DeformationMap, history: tuple[Step, ...], solution: Solution | None
) -> Frame:
    """What a method other than ours has reached; its map of a mesh stands beside the task's."""
    if isinstance(map, MeshMap):
        return Frame(task, task.pose.map, history, solution, mesh=map)
    return Frame(task, map, history, solution)


def _starting_point(edited: EditedPose, last: Result | None) -> HarmonicMap | Result:
    start = _conformal_if_asked(edited, edited.map if last is None else last.map)
    if last is None or start is not last.map:
        return start
    fresh = discretise(start.domain, edited.options.sampling, edited.options.certificate)
    return start if last.n_panels > _MOST_REFINED * len(fresh.panels) else last


def _conformal_if_asked(edited: EditedPose, start: HarmonicMap) -> HarmonicMap:
    """The start, or the one conformal map that is always at hand where it must be conformal."""
    if edited.options.conformal and np.abs(start.psi - start.psi[0]).max() > 0:
        return HarmonicMap.identity(start.domain)
    return start
