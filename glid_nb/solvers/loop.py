"""The outer loop on the host, the same for every method: record, report, split panels, stop."""

import math
import time
from collections.abc import Callable, Generator
from contextlib import nullcontext
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb._runtime import compilation_clock, single_blas_thread
from glid_nb.certificate import Certificate
from glid_nb.solvers.discretisation import Discretisation
from glid_nb.solvers.line_search import BLOCKED, REFUSED, RUNNING
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.result import Iteration, Make, Progress, Result, Status

# Rounds of splitting before a shorter step is tried.
_PATIENCE = 3
# Rounds of splitting without a step before the solve ends as blocked.
_MOST_ROUNDS = 40


class Stopwatch:
    """Seconds since it was created; those of compiling are counted apart."""

    def __init__(self) -> None:
        self._clock, self._began = compilation_clock(), time.perf_counter()
        self._compiled = self._clock.seconds

    @property
    def compiling(self) -> float:
        return self._clock.seconds - self._compiled

    @property
    def seconds(self) -> float:
        """All other seconds."""
        return max(time.perf_counter() - self._began - self.compiling, 0.0)


class Ending(NamedTuple):
    status: Status
    detail: str | None = None  # a full sentence, if the status's own sentence says too little


class Advance(NamedTuple):
    outcome: int = RUNNING
    iterations: int = 0
    refused: Array | None = None  # (p,) bool: panels that refused a step and may be split
    ending: Ending | None = None  # set if the method itself ended


class Reached(NamedTuple):
    entry: Iteration  # without its number and its time
    make: Make


class Descent:
    """One run of a method: the interface that the loop uses."""

    initial: Iteration | None = None  # the start; None until the first advance has evaluated it
    shows_start = True  # whether the callback also sees the start
    uses_lapack = False  # several BLAS threads would slow LAPACK down
    discretisation: Discretisation | None = None  # the panels, which may be split
    sigma2_lower: Array | None = None  # (p,) certified; None before the first step
    factor: Any = None  # of the last Hessian, for a solve that continues from here

    def __init__(self, method: Method, inputs: Inputs) -> None:
        self.method, self.inputs = method, inputs
        self.history: list[Iteration] = []

    def advance(self, may_split: bool) -> Advance:
        """Run some iterations, at most those that are left, and extend the history.

        If a panel refuses a step, the outcome is REFUSED with ``may_split``. Without it, shorter
        steps are tried, and the outcome is BLOCKED if none is certified.
        """
        raise NotImplementedError

    def reached(self) -> Reached:
        raise NotImplementedError

    def adapt(self, done: Advance) -> Ending | None:
        """Change settings after an advance, or return how the solve ends."""
        raise NotImplementedError

    def split(self, refused: Array) -> int:
        """Split panels that refused a step. Returns how many were split."""
        raise NotImplementedError

    @property
    def left(self) -> int:
        most = self.inputs.options.max_iterations
        return (self.method.max_iterations if most is None else most) - len(self.history)

    def record(self, entry: Iteration) -> None:
        self.history.append(replace(entry, iteration=len(self.history) + 1))

    def _course(self, entry: Iteration) -> dict[str, Any]:
        course = {"method": self.method, "initial": self.initial, "history": tuple(self.history)}
        energies = {"energy_distortion": entry.energy_distortion, "energy_p2p": entry.energy_p2p}
        return {**course, **energies, "discretisation": self.discretisation}

    def progress(self) -> Progress:
        now = self.reached()
        return Progress(make=now.make, sigma2_lower=self.sigma2_lower, **self._course(now.entry))

    def result(self, ending: Ending, compile_time: float, solve_time: float) -> Result:
        """The result of the solve (Algorithm 1, output and line 10)."""
        now = self.reached()
        made = now.make()
        harmonic = isinstance(made, Certificate)
        if harmonic and ending.status.ok and not math.isfinite(now.entry.energy):
            ending = Ending(Status.BLOCKED)
        return Result(
            map=made.map if harmonic else made,
            status=ending.status,
            detail=ending.detail,
            pose=self.inputs.pose,
            options=self.inputs.options,
            energy_measure=self.inputs.energy,
            compile_time=compile_time,
            solve_time=solve_time,
            factor=self.factor if ending.status is Status.CONVERGED else None,
            step_certificate=made if harmonic else None,
            **self._course(now.entry),
        )

    def stagnation(self) -> Ending | None:
        """CONVERGED if the last ``window`` iterations together hardly changed the energy."""
        window, tolerance = self.method.window, self.method.tolerance
        assert window is not None
        assert self.initial is not None
        energies = [entry.energy for entry in (self.initial, *self.history)][-1 - window :]
        first, last = energies[0], energies[-1]
        if len(energies) <= window or not abs(first - last) <= tolerance * abs(last):
            return None
        change = f"change the energy by less than {tolerance:g} of it"
        detail = f"The solver converged: {window} iterations together {change}."
        return Ending(Status.CONVERGED, detail)


def follow(make: Callable[[], Descent]) -> Result:
    """Run a method until it ends, reaches its iteration limit or the callback returns True."""
    watch = Stopwatch()
    descent = make()
    with single_blas_thread() if descent.uses_lapack else nullcontext():
        ending = followed(descent)
    return descent.result(ending, watch.compiling, watch.seconds)


def followed(descent: Descent, done: Advance | None = None) -> Ending:
    """The loop. ``done`` is an advance that was made before the loop starts."""
    callback, rounds, total_rounds = descent.inputs.callback, 0, 0

    def stopped() -> bool:
        return callback is not None and bool(callback(descent.progress()))

    if descent.shows_start and stopped():
        return Ending(Status.STOPPED)
    while True:
        done = descent.advance(rounds < _PATIENCE) if done is None else done
        refuses = done.outcome in (REFUSED, BLOCKED)
        if done.iterations:
            rounds = total_rounds = 0
        if (done.iterations or refuses) and stopped():
            return Ending(Status.STOPPED)
        ending = descent.adapt(done)
        if ending is not None:
            return ending
        if descent.left <= 0:
            return Ending(Status.MAX_ITERATIONS)
        if refuses:
            blocked = done.outcome == BLOCKED
            rounds, total_rounds = 0 if blocked else rounds + 1, total_rounds + 1
            if total_rounds > _MOST_ROUNDS:
                return Ending(Status.BLOCKED)
            if not descent.split(np.asarray(done.refused)):
                if blocked:
                    return Ending(Status.BLOCKED)
                rounds = _PATIENCE  # nothing can be split: try shorter steps
        done = None


Steps = Generator[Callable[[], Reached], None, Ending]
"""Yields a function that returns the state: at the start and after each step. Returns the end."""


class GeneratedDescent(Descent):
    """A method written as a generator. It stops when the loop does not ask for the next step."""

    def __init__(self, method: Method, inputs: Inputs, steps: Steps) -> None:
        super().__init__(method, inputs)
        self._steps = steps
        self.initial = self._step()

    def _step(self) -> Iteration:
        watch = Stopwatch()
        now, seconds = next(self._steps), watch.seconds
        self._now = now()
        return replace(self._now.entry, time=seconds)

    def advance(self, may_split: bool) -> Advance:  # noqa: ARG002
        if not self.left:
            return Advance()
        try:
            self.record(self._step())
        except StopIteration as stop:
            return Advance(ending=stop.value)
        return Advance(iterations=1)

    def reached(self) -> Reached:
        return self._now

    def adapt(self, done: Advance) -> Ending | None:
        gains = self.method.window is not None and done.iterations
        return self.stagnation() if gains else done.ending
