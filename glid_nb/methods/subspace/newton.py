"""Newton's method of :mod:`glid_nb.solvers`, run like any other method."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from glid_nb._runtime import double_precision
from glid_nb.methods.method import Inputs
from glid_nb.methods.result import MethodProgress, MethodResult, Step
from glid_nb.solvers import Iteration, Options, Progress, Result, Status, solve


@double_precision
def run_newton(inputs: Inputs, **options: Any) -> MethodResult:
    """One solve."""
    settings: dict[str, Any] = {"restarts": 0, **options}
    chosen = Options(
        p2p_weight=inputs.p2p_weight,
        max_iterations=inputs.max_iterations,
        align=inputs.align,
        iterations_per_call=1 if inputs.callback else Options.iterations_per_call,
        **settings,
    )
    arguments = (inputs.domain, inputs.pose, inputs.energy)
    none = replace(chosen, max_iterations=0, restarts=0)
    start_map = inputs.harmonic_start
    still = solve(*arguments, none, start_map)
    start = _start_step(still)

    def report(progress: Progress) -> bool | None:
        assert inputs.callback is not None
        history = (start, *(_step(entry, entry.time) for entry in progress.history))
        return inputs.callback(MethodProgress(inputs.method, history, lambda: progress.map))

    if inputs.callback is None:
        result = solve(*arguments, chosen, start_map)
    elif inputs.callback(MethodProgress(inputs.method, (start,), lambda: still.map)):
        return _result(inputs, still, Status.STOPPED, (start,))
    else:
        result = solve(*arguments, chosen, start_map, report)
    steps = [_step(entry, entry.time) for entry in result.history]
    return _result(inputs, result, result.status, (start, *steps))


def _result(
    inputs: Inputs, result: Result, status: Status, history: tuple[Step, ...]
) -> MethodResult:
    return MethodResult(
        inputs.method,
        result.map,
        status,
        status.message,
        history,
        inputs.pose,
        result.compile_time,
    )


def _start_step(result: Result) -> Step:
    return Step(0, result.energy, result.energy_iso, result.energy_p2p, np.nan, 0.0, None, np.nan)


def _step(entry: Iteration, seconds: float) -> Step:
    return Step(
        entry.iteration,
        entry.energy,
        entry.energy_iso,
        entry.energy_p2p,
        entry.step,
        seconds,
        None,
        entry.sigma2_lower,
    )
