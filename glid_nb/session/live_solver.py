"""Solving during a drag: each solve continues the one before, and the latest target wins."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry import MeshMap, Panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.edit_state import EditedPose, Solution, continued_history
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.solvers import DeformationMap, Iteration, Newton, Progress, Result, solve
from glid_nb.solvers.discretisation import Discretisation, discretise

Array = NDArray[Any]

FRAME_INTERVAL = 1 / 40
"""Least number of seconds between two frames of one solve; the last frame is always sent."""
# Panels are only ever split; with more than this multiple of the initial number, start afresh.
_MOST_REFINED = 3.0


@dataclass(frozen=True, eq=False)
class Task:
    """What to solve."""

    pose: EditedPose
    """Handles, targets, energy, options, method, and the map to start from."""
    chain: int
    """A task continues from the map of the task before it only if both are of one chain."""
    single: bool = False
    """Stop after one compiled call, or one iteration of another method."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A map during a solve, or its final one."""

    task: Task
    map: HarmonicMap
    """Certified; for a method on a mesh the task's own."""
    history: tuple[Iteration, ...]
    """All iterations of this gesture so far."""
    solution: Solution | None
    """None while the solve goes on."""
    panels: Panels | None = None
    """Of the boundary; None for a method without panels."""
    sigma2_lower: Array = field(default_factory=lambda: np.empty(0))
    """(p,) certified bound per panel; empty when it is not known."""
    mesh: MeshMap | None = None
    """The map of a method on a mesh, which may fold."""
    starts: tuple[int, ...] = ()
    """Numbers of the gesture's iterations at which the targets had moved."""

    @property
    def bound(self) -> float:
        """The certified lower bound on sigma_2; NaN when the solver has not given one."""
        if len(self.sigma2_lower):
            return float(self.sigma2_lower.min())
        known = self.history[-1].sigma2_lower if self.history else None
        return math.nan if known is None else known


class LiveSolver:
    """Solves one task after the other, each from the map that the one before has reached.

    Parameters
    ----------
    publish : bound method
        Called with every :class:`Frame`; its object is not kept alive.
    failed : bound method
        Called with the exception that a solve raised; likewise.
    """

    def __init__(
        self, publish: Callable[[Frame], None], failed: Callable[[Exception], None]
    ) -> None:
        self._publish, self._failed = weakly(publish), weakly(failed)
        self._last: Result | None = None
        self._last_chain: int | None = None
        self._iterations: tuple[Iteration, ...] = ()
        self._starts: tuple[int, ...] = ()
        self._published = -np.inf
        self._bounds = np.empty(0)

    def solve(self, task: Task, worker: LatestWins[Task]) -> None:
        """Run the task's method and publish its frames.

        A newer task interrupts this between two compiled calls, or two iterations of another
        method. So every task moves the shape, and the last one is solved to its end.
        """
        continued = self._last_chain == task.chain and self._last is not None
        last = self._last if continued else None
        before = self._iterations if continued else ()
        start = before[-1].iteration + 1 if before else 1
        earlier = tuple(i for i in self._starts if before and before[0].iteration <= i < start)
        self._starts = (*earlier, start)
        try:
            result = self._result(task, worker, last, before)
        except Exception as error:  # shown to the user; the next task starts from its own map
            self._last = None
            self._failed(error)
            return
        history = continued_history(before, result.history)
        solution = Solution.of(result, before, self._starts)
        frame = self._frame(task, result.map, history, solution, result.discretisation)
        self._last, self._last_chain, self._iterations = result, task.chain, frame.history
        self._published = time.monotonic()
        self._publish(frame)

    def _result(
        self,
        task: Task,
        worker: LatestWins[Task],
        last: Result | None,
        before: tuple[Iteration, ...],
    ) -> Result:
        edited, method = task.pose, task.pose.method
        calls = iterations = 0
        self._bounds = np.empty(0)

        def callback(progress: Progress) -> bool:
            nonlocal calls, iterations
            if progress.sigma2_lower is None and not progress.history:
                # The report before the first iteration: every task takes at least a step.
                return worker.cancelled
            calls += 1
            self._bounds = np.empty(0) if progress.sigma2_lower is None else progress.sigma2_lower
            moved, iterations = len(progress.history) > iterations, len(progress.history)
            # A first call may only split panels; those are kept for the next task.
            if worker.overtaken or (task.single and (moved or calls > 1)):
                return True  # the frame comes with the result
            now = time.monotonic()
            if moved and now - self._published >= FRAME_INTERVAL:
                self._published = now
                history = continued_history(before, progress.history)
                disc = progress.discretisation
                self._publish(self._frame(task, progress.map, history, None, disc))
            return False

        # During a drag the shape must not turn as a whole; a single handle takes it along.
        align = isinstance(method, Newton) and len(edited.pose) == 1
        options = replace(edited.options, align=align, restarts=0)
        start = _starting_point(edited, last)
        domain = edited.map.domain
        return solve(domain, edited.pose, edited.energy, options, start, callback, method=method)

    def _frame(
        self,
        task: Task,
        map: DeformationMap,
        history: tuple[Iteration, ...],
        solution: Solution | None,
        discretisation: Discretisation | None,
    ) -> Frame:
        panels = None if discretisation is None else discretisation.panels
        bounds = self._bounds
        if panels is None or len(bounds) != len(panels):
            bounds = np.empty(0)
        mesh, certified = (map, task.pose.map) if isinstance(map, MeshMap) else (None, map)
        return Frame(task, certified, history, solution, panels, bounds, mesh, self._starts)


def _starting_point(edited: EditedPose, last: Result | None) -> DeformationMap | Result:
    start = edited.map if last is None else last.map
    if isinstance(start, MeshMap):
        return start
    conformal = edited.options.conformal and "conformal" in edited.method.options
    if conformal and np.abs(start.psi - start.psi[0]).max() > 0:
        # The solver needs a conformal start; the identity is one.
        return HarmonicMap.identity(start.domain)
    if last is None or last.n_panels is None:
        return start
    fresh = discretise(start.domain, edited.options.sampling, edited.options.certificate)
    return start if last.n_panels > _MOST_REFINED * len(fresh.panels) else last
