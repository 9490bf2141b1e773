"""Solving while somebody drags: one thread, and the latest target wins."""

from __future__ import annotations

import math
import threading
import time
import weakref
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
    """A thread that solves the task that was submitted last.

    A newer task interrupts the solve between two compiled calls, or two iterations of another
    method than ours; what that solve has reached is where the newer one starts. So every task moves
    the shape, none waits in a queue, and the last one is solved to its end.

    Parameters
    ----------
    publish : callable
        Called in the thread with every :class:`Frame`.
    failed : callable
        Called in the thread with an exception that a solve raised; the thread lives on.
    """

    def __init__(
        self, publish: Callable[[Frame], None], failed: Callable[[Exception], None]
    ) -> None:
        self._worker = _Worker(publish, failed)
        # Also at the end of the process, before the interpreter is torn down under the thread.
        self._finalizer = weakref.finalize(self, self._worker.close)

    def submit(self, task: Task) -> None:
        """Solve this instead of whatever was submitted before; returns at once."""
        self._worker.submit(task)

    def stop(self) -> None:
        """Give up what is being solved and what is waiting; the last frame says so."""
        self._worker.stop()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until there is nothing left to solve; whether that came within ``timeout``."""
        return self._worker.wait(timeout)

    @property
    def busy(self) -> bool:
        """Whether something is being solved, and not given up, or waits to be."""
        return self._worker.busy

    @property
    def paused(self) -> bool:
        """While paused, tasks wait (but those for a single call do not)."""
        return self._worker.paused

    @paused.setter
    def paused(self, value: bool) -> None:
        self._worker.pause(value)

    @property
    def alive(self) -> bool:
        """Whether the thread runs; it starts with the first task."""
        return self._worker.alive

    def close(self) -> None:
        """End the thread; submitting does nothing from then on."""
        self._finalizer()


class _Worker:
    """The thread and what it shares; it does not know the `LiveSolver`, which can be dropped."""

    def __init__(
        self, publish: Callable[[Frame], None], failed: Callable[[Exception], None]
    ) -> None:
        self._publish, self._failed = _weakly(publish), _weakly(failed)
        self._changed = threading.Condition()
        self._pending: Task | None = None
        self._busy = self._paused = self._closed = self._stopping = False
        self._thread: threading.Thread | None = None
        # Only the thread touches these.
        self._last: Result | MethodResult | None = None
        self._last_chain: int | None = None
        self._iterations: tuple[Any, ...] = ()
        self._starts: tuple[int, ...] = ()
        self._published = -np.inf

    @property
    def busy(self) -> bool:
        with self._changed:
            return (self._busy and not self._stopping) or self._is_due()

    @property
    def paused(self) -> bool:
        return self._paused

    @property
    def alive(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def submit(self, task: Task) -> None:
        with self._changed:
            if self._closed:
                return
            self._pending = task
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="live solver", daemon=True)
                self._thread.start()
            self._changed.notify_all()

    def stop(self) -> None:
        with self._changed:
            self._pending, self._stopping = None, self._busy
            self._changed.notify_all()

    def pause(self, value: bool) -> None:
        with self._changed:
            self._paused = value
            self._changed.notify_all()

    def wait(self, timeout: float | None) -> bool:
        with self._changed:
            return self._changed.wait_for(
                lambda: self._closed or not (self._busy or self._is_due()), timeout
            )

    def close(self) -> None:
        with self._changed:
            self._closed, self._pending = True, None
            self._changed.notify_all()
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def _is_due(self) -> bool:
        return self._pending is not None and (not self._paused or self._pending.single)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._is_due())
                if self._closed:
                    return
                task, self._pending = self._pending, None
                self._busy, self._stopping = True, False
            assert task is not None
            try:
                self._solve(task)
            except Exception as error:  # shown to the user; the thread must live on
                self._last = None
                self._failed(error)
            finally:
                with self._changed:
                    self._busy = self._stopping = False
                    self._changed.notify_all()

    def _given_up(self) -> bool:
        with self._changed:
            return self._closed or self._stopping

    def _overtaken(self) -> bool:
        with self._changed:
            return self._closed or self._stopping or self._paused or self._pending is not None

    def _solve(self, task: Task) -> None:
        """Run the task's method, and publish what it comes to."""
        continued = self._last_chain == task.chain and self._last is not None
        last = self._last if continued else None
        before = self._iterations if continued else ()
        start = before[-1].iteration + 1 if before else 1
        earlier = tuple(i for i in self._starts if before and before[0].iteration <= i < start)
        self._starts = (*earlier, start)
        if task.pose.method.name == OURS:
            assert not isinstance(last, MethodResult)
            result, frame = self._solve_by_ours(task, last, before)
        else:
            assert not isinstance(last, Result)
            result, frame = self._solve_by_method(task, last, before)
        self._last, self._last_chain, self._iterations = result, task.chain, frame.history
        self._published = time.monotonic()
        self._publish(frame)

    def _solve_by_ours(
        self, task: Task, last: Result | None, before: tuple[Iteration, ...]
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
            if self._overtaken() or (task.single and (moved or calls > 1)):
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
        self, task: Task, last: MethodResult | None, before: tuple[Step, ...]
    ) -> tuple[MethodResult, Frame]:
        edited = task.pose

        def callback(progress: MethodProgress) -> bool:
            if self._given_up():
                return True
            if len(progress.history) == 1:  # the start: every task takes a step from there
                return False
            if task.single or self._overtaken():
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


def _weakly(callback: Callable[[Any], None]) -> Callable[[Any], None]:
    """The callback; a method without keeping its object alive, doing nothing once that is gone."""
    if not hasattr(callback, "__self__"):
        return callback
    reference = weakref.WeakMethod(callback)  # type: ignore[type-var]

    def call(value: Any) -> None:
        method = reference()
        if method is not None:
            method(value)

    return call
