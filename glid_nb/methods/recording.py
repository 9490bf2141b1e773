"""Running any method: its history, its callback, its most iterations.

A method is a generator. It yields a :class:`Snapshot` for the start and after each step, and
returns an :class:`Ending`; so a method that is not asked for its next step has stopped, and none
needs code of its own for that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from typing import NamedTuple

from glid_nb.certificate import Certificate
from glid_nb.methods.result import Callback, DeformationMap, MethodProgress, MethodResult, Step
from glid_nb.solvers import Pose, Status


class Snapshot(NamedTuple):
    """The state after a step."""

    energy_iso: float
    energy_p2p: float
    time: float
    """Seconds of the step alone; the method measures them."""
    map: Callable[[], DeformationMap]
    step: float = math.nan
    flips: int | None = None
    sigma2_lower: float = math.nan
    compile_time: float = 0.0
    certificate: Certificate | None = None
    """Where the method has proved its map itself."""


class Ending(NamedTuple):
    """How a method ended of its own accord."""

    status: Status
    message: str | None = None
    """A full sentence, where that of the status does not say enough."""


Run = Generator[Snapshot, None, Ending]


def record(
    method: str, run: Run, pose: Pose, max_iterations: int, callback: Callback | None = None
) -> MethodResult:
    """Run a method to its end, to ``max_iterations`` or until the callback returns ``True``."""
    history: list[Step] = []
    compile_time = 0.0
    last: Snapshot | None = None
    ending: Ending | None = None
    while ending is None:
        try:
            last = next(run)
        except StopIteration as stop:
            ending = stop.value
            break
        compile_time += last.compile_time
        history.append(_step(len(history), last))
        progress = MethodProgress(method, tuple(history), last.map)
        if callback is not None and callback(progress):
            ending = Ending(Status.STOPPED)
        elif len(history) > max_iterations:
            ending = Ending(Status.MAX_ITERATIONS)
    run.close()
    assert last is not None, "a method yields its start before it ends"
    assert ending is not None
    message = ending.message or ending.status.message
    return MethodResult(
        method,
        last.map(),
        ending.status,
        message,
        tuple(history),
        pose,
        compile_time,
        last.certificate,
    )


def _step(iteration: int, state: Snapshot) -> Step:
    return Step(
        iteration,
        state.energy_iso + state.energy_p2p,
        state.energy_iso,
        state.energy_p2p,
        state.step,
        state.time,
        state.flips,
        state.sigma2_lower,
    )
