"""Solve during a drag: each solve continues the previous one, and the latest target wins."""

import functools
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from glid_nb._runtime import stage, watched
from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve
from glid_nb.pose import DeformationMap, Pose
from glid_nb.session.document import NamedPose, Solution
from glid_nb.session.edit_state import Frame, Task
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.solvers import Iteration, Newton, Progress, Result
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.problem import moved

FRAME_INTERVAL = 1 / 40
"""Least number of seconds between two frames of one solve; the last frame is always sent."""
MOST_ITERATIONS = 200  # most iterations of a gesture that are kept; older ones are dropped
# Panels are split but never merged. With more than this multiple of their initial number, a solve
# starts with the initial panels again.
_MOST_REFINED = 3.0
# The finished share of the preparation for a shape at the beginning of each stage.
_PREPARED = {"start": 0.0, "basis": 0.2, "load": 0.6, "trace": 0.3, "lower": 0.4, "compile": 0.5}


class _Cancelled(Exception):  # noqa: N818 - it is no error
    """The task was cancelled while it prepared the solver."""


class LiveSolver:
    """Solves one task after the other. Each starts from the map that the previous one reached.

    It calls ``publish`` with every frame, ``failed`` with the exception of a solve, and
    ``prepared`` with the finished share of the preparation. It does not keep the objects of these
    methods alive.
    """

    def __init__(
        self,
        publish: Callable[[Frame], None],
        failed: Callable[[Exception], None],
        prepared: Callable[[float], None],
    ) -> None:
        self._publish, self._failed, self._prepared = map(weakly, (publish, failed, prepared))
        self._share: float | None = None  # of the preparation; None before the first task
        self._last: Result | None = None
        self._chain: int | None = None
        # The gesture's iterations before this task, and the numbers of its tasks' first iterations.
        self._before: tuple[Iteration, ...] = ()
        self._starts: tuple[int, ...] = ()
        self._published = -np.inf

    def inputs(self, edited: NamedPose) -> Inputs:
        """The problem of this pose, with the start that the next solve would have."""
        last = self._last
        if last is not None and getattr(last.map, "domain", None) is not edited.map.domain:
            last = None
        return Inputs(
            domain=edited.map.domain,
            pose=edited.pose,
            energy=edited.energy,
            options=edited.options,
            start=_starting_point(edited, last),
        )

    def solve(self, task: Task | None, worker: LatestWins[Task | None]) -> None:
        """Run the task's method and publish its frames. A newer task ends it between two calls."""
        if task is None:
            return
        if self._chain != task.chain or self._last is None:
            self._last, self._before, self._starts = None, (), ()
        before = self._before
        start = before[-1].iteration + 1 if before else 1
        earlier = (i for i in self._starts if before and before[0].iteration <= i < start)
        self._starts = (*earlier, start)
        try:
            with watched(functools.partial(self._watch, worker)):
                if self._share is None:
                    stage("start")  # the first task imports JAX
                result = self._result(task, worker)
        except _Cancelled:
            return
        except Exception as error:  # shown to the user; the next task starts from its own map
            self._last = None
            self._failed(error)
            return
        self._tell_prepared(1.0)
        frame = self._frame(task, result)
        solution = Solution(result.status, result.message, frame.history, frame.starts)
        self._last, self._chain, self._before = result, task.chain, frame.history
        self._published = time.monotonic()
        self._publish(replace(frame, solution=solution))

    def _watch(self, worker: LatestWins[Task | None], name: str) -> None:
        """Report the preparation's progress at the beginning of a stage. End a cancelled task."""
        if worker.cancelled:
            raise _Cancelled
        if (share := _PREPARED.get(name)) is not None:
            self._tell_prepared(share)

    def _tell_prepared(self, share: float) -> None:
        if share != self._share:
            self._share = share
            self._prepared(share)

    def _result(self, task: Task, worker: LatestWins[Task | None]) -> Result:
        calls = iterations = 0

        def callback(progress: Progress) -> bool:
            nonlocal calls, iterations
            self._tell_prepared(1.0)
            if progress.sigma2_lower is None and not progress.history:
                # The report before the first iteration. Every task makes at least one step.
                return worker.cancelled
            calls += 1
            moved, iterations = len(progress.history) > iterations, len(progress.history)
            # A first call may only split panels. The next task keeps them.
            if worker.overtaken or (task.single and (moved or calls > 1)):
                return True  # the frame comes with the result
            now = time.monotonic()
            if moved and now - self._published >= FRAME_INTERVAL:
                self._published = now
                self._publish(self._frame(task, progress))
            return False

        return solve_edited(task.pose, callback, self._last)

    def _frame(self, task: Task, now: Progress | Result) -> Frame:
        last = self._before[-1].iteration if self._before else 0
        more = (replace(i, iteration=last + i.iteration) for i in now.history[-MOST_ITERATIONS:])
        history = (*self._before, *more)[-MOST_ITERATIONS:]
        map = now.map
        mesh, certified = (map, task.pose.map) if isinstance(map, MeshMap) else (None, map)
        proved = now.certificate if isinstance(now, Progress) else now.step_certificate
        return Frame(task, certified, history, self._starts, None, proved, mesh)


def solve_edited(
    edited: NamedPose, callback: Callable[[Progress], bool], last: Result | None = None
) -> Result:
    """Solve a pose of the editor, starting from the previous solve's map or from its own map."""
    # During a drag the shape must not turn as a whole. A single handle moves the whole shape.
    align = isinstance(edited.method, Newton) and len(edited.pose) == 1
    options = replace(edited.options, align=align, restarts=0)
    how = edited.energy, options, _starting_point(edited, last), callback
    return solve(edited.map.domain, edited.pose, *how, method=edited.method)


def _carried(last: Result, pose: Pose) -> Result:
    """The last result as a start. If all targets shifted equally after a solve that was blocked or
    stopped, the start is shifted too. Otherwise no step may lower the energy."""
    start, before = last.map, last.pose
    if last.status.ok or isinstance(start, MeshMap) or not pose.same_constraints(before):
        return last
    moves, off = pose.targets - before.targets, 1e-12 * np.abs(pose.targets).max(initial=0)
    if not moves.any() or not np.allclose(moves, moves[0], rtol=1e-6, atol=off):
        return last
    return replace(last, map=moved(start, 1, complex(*moves[0])))


def _starting_point(edited: NamedPose, last: Result | None) -> DeformationMap | Result:
    last = None if last is None else _carried(last, edited.pose)
    start = edited.map if last is None else last.map
    if isinstance(start, MeshMap):
        return start
    conformal = edited.options.conformal and "conformal" in edited.method.options
    if conformal and np.abs(start.psi - start.psi[0]).max() > 0:
        # The solver needs a conformal start, such as the identity.
        return HarmonicMap.identity(start.domain)
    if last is None or last.n_panels is None:
        return start
    fresh = discretise(start.domain, edited.options.sampling, edited.options.certificate)
    return start if last.n_panels > _MOST_REFINED * len(fresh.panels) else last
