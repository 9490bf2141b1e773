"""The outer loop on the host, the same for every method: record, show, split panels, stop."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Sequence
from contextlib import nullcontext
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import compilation_clock, single_blas_thread
from glid_nb.certificate import Certificate
from glid_nb.solvers import outcome
from glid_nb.solvers.discretisation import Discretisation
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.result import DeformationMap, Iteration, Progress, Result
from glid_nb.solvers.status import Status

Array = NDArray[Any]

# How often panels are split in a row before a shorter step is tried instead, and in all before a
# solve that gets nowhere ends.
_PATIENCE = 3
_MOST_ROUNDS = 40


class Ending(NamedTuple):
    """How a method ended."""

    status: Status
    detail: str | None = None
    """A full sentence, where that of the status does not say enough."""


class Advance(NamedTuple):
    """What one advance came to."""

    outcome: int = outcome.RUNNING
    iterations: Sequence[Iteration] = ()
    refused: Array | None = None
    """(p,) bool: panels that refused a step and may allow it once they are split."""


class Reached(NamedTuple):
    """Where a method is."""

    energy_iso: float
    energy_p2p: float
    make_map: Callable[[], DeformationMap]
    sigma2_lower: Array | None = None
    """(p,) certified bound per panel."""
    proof: Certificate | None = None
    """Where the method has proved its map itself."""
    factor: Any = None


class Descent:
    """A method at work: what the loop asks of it.

    Attributes
    ----------
    method : Method
    initial : Iteration
        The start; known at the latest after the first advance.
    shows_start : bool
        Whether a callback is shown the start too.
    uses_lapack : bool
        Whether XLA factorises for it, which several BLAS threads would slow down.
    discretisation : Discretisation or None
        The panels, which may be split.
    """

    method: Method
    initial: Iteration
    shows_start = True
    uses_lapack = False
    discretisation: Discretisation | None = None

    def advance(self, before: int, left: int, may_refine: bool) -> Advance:
        """Go on by at most ``left`` iterations, 0 perhaps, after ``before`` that were made.

        With ``may_refine`` it ends with the outcome REFUSED where a panel refuses a step, instead
        of trying a shorter one; without, with BLOCKED where no step is certified.
        """
        raise NotImplementedError

    def reached(self) -> Reached:
        """Where it is now."""
        raise NotImplementedError

    def adapt(self, done: Advance, history: Sequence[Iteration]) -> Ending | None:
        """Change course after what an advance came to, or end."""
        raise NotImplementedError

    def split(self, refused: Array) -> int:
        """Split panels that refused a step; how many were."""
        raise NotImplementedError

    def progress(self, history: Sequence[Iteration]) -> Progress:
        """What a callback sees."""
        now = self.reached()
        return Progress(
            method=self.method,
            history=tuple(history),
            initial=self.initial,
            energy_iso=now.energy_iso,
            energy_p2p=now.energy_p2p,
            make_map=now.make_map,
            sigma2_lower=now.sigma2_lower,
            discretisation=self.discretisation,
        )


def follow(make: Callable[[], Descent], inputs: Inputs) -> Result:
    """Follow a method to its end, to its most iterations or until the callback returns True."""
    clock = compilation_clock()
    compiling, began = clock.seconds, time.perf_counter()
    descent = make()
    with single_blas_thread() if descent.uses_lapack else nullcontext():
        history, ending = followed(descent, inputs, [])
    compiling, elapsed = clock.seconds - compiling, time.perf_counter() - began
    return result_of(descent, inputs, history, ending, compiling, max(elapsed - compiling, 0.0))


def result_of(
    descent: Descent,
    inputs: Inputs,
    history: list[Iteration],
    ending: Ending,
    compile_time: float,
    solve_time: float,
) -> Result:
    """What a method returns."""
    now = descent.reached()
    return Result(
        map=now.make_map(),
        status=ending.status,
        detail=ending.detail,
        energy_iso=now.energy_iso,
        energy_p2p=now.energy_p2p,
        initial=descent.initial,
        history=tuple(history),
        pose=inputs.pose,
        options=inputs.options,
        energy_measure=inputs.energy,
        method=descent.method,
        compile_time=compile_time,
        solve_time=solve_time,
        discretisation=descent.discretisation,
        factor=now.factor if ending.status is Status.CONVERGED else None,
        proof=now.proof,
    )


def followed(
    descent: Descent, inputs: Inputs, history: list[Iteration]
) -> tuple[list[Iteration], Ending]:
    """The loop: all iterations, those made before in ``history`` included, and the end."""
    callback, limit = inputs.callback, descent.method.limit(inputs.options)
    rounds = total_rounds = 0

    def stopped() -> bool:
        return callback is not None and bool(callback(descent.progress(history)))

    if descent.shows_start and stopped():
        return history, Ending(Status.STOPPED)
    while True:
        done = descent.advance(len(history), limit - len(history), rounds < _PATIENCE)
        history += done.iterations
        refuses = done.outcome in (outcome.REFUSED, outcome.BLOCKED)
        if done.iterations:
            rounds = total_rounds = 0
        if (done.iterations or refuses) and stopped():
            return history, Ending(Status.STOPPED)
        ending = descent.adapt(done, history)
        if ending is not None:
            return history, ending
        if len(history) >= limit:
            return history, Ending(Status.MAX_ITERATIONS)
        if refuses:
            assert done.refused is not None
            rounds, total_rounds = rounds + 1, total_rounds + 1
            if done.outcome == outcome.BLOCKED:
                rounds = 0
            if total_rounds > _MOST_ROUNDS:
                return history, Ending(Status.BLOCKED)
            if not descent.split(np.asarray(done.refused)):
                if done.outcome == outcome.BLOCKED:
                    return history, Ending(Status.BLOCKED)
                rounds = _PATIENCE  # a shorter step, then


class Snapshot(NamedTuple):
    """The state after a step of a method that is written as a generator."""

    entry: Iteration
    """Its number is given by the loop."""
    make_map: Callable[[], DeformationMap]
    proof: Certificate | None = None


Steps = Generator[Snapshot, None, Ending]
"""Yields a snapshot for the start and one after each step; returns how the method ended."""


class GeneratedDescent(Descent):
    """A method that is written as a generator: one that is not asked for its next step has stopped.

    Parameters
    ----------
    method : Method
    steps : generator
    """

    def __init__(self, method: Method, steps: Steps) -> None:
        self.method, self._steps = method, steps
        self._now = next(steps)
        self._ending: Ending | None = None
        self.initial = self._now.entry

    def advance(self, before: int, left: int, may_refine: bool) -> Advance:  # noqa: ARG002
        """One step, or the end."""
        if not left:
            return Advance()
        try:
            self._now = next(self._steps)
        except StopIteration as stop:
            self._ending = stop.value
            return Advance()
        return Advance(iterations=[replace(self._now.entry, iteration=before + 1)])

    def reached(self) -> Reached:
        """After the last step."""
        entry = self._now.entry
        return Reached(
            entry.energy_iso, entry.energy_p2p, self._now.make_map, proof=self._now.proof
        )

    def adapt(self, done: Advance, history: Sequence[Iteration]) -> Ending | None:  # noqa: ARG002
        """The generator's end."""
        return self._ending
