"""Milliseconds of one iteration of every method (Table 2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from glid_nb.energies import ARAP, Energy
from glid_nb.geometry import triangulate
from glid_nb.methods import methods
from studies.comparisons.cases import Case
from studies.comparisons.runs import MESH_VERTICES, run
from studies.comparisons.store import Measurement

_PAPER = {"sampling": "uniform", "certificate": "lipschitz"}
_RUNS = 3


class Timed(NamedTuple):
    """A method as it is timed."""

    iterations: int | None = 12
    """How many of its iterations; ``None`` for all."""
    settings: Mapping[str, Any] = {}
    energy: Energy | None = None


TIMED = {
    "newton": Timed(None),
    "newton-paper": Timed(),
    "newton-staged": Timed(),
    "newton-eigen": Timed(settings=_PAPER),
    "newton-shift": Timed(settings=_PAPER),
    "lbfgs": Timed(40, _PAPER),
    "gradient-descent": Timed(40, _PAPER),
    "slim": Timed(),
    "aqp": Timed(40),
    "arap-mesh": Timed(energy=ARAP()),
}
"""All but ours with the paper's samples and certificate, where they have any.

Ours runs to its end, for its iterations are not alike: those close to the minimum hold more steps.
"""


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Mean seconds of an iteration from the identity, the median of runs that nothing watches."""
    mesh = triangulate(case.problem.domain.cage, MESH_VERTICES, points=case.problem.pose.handles)
    known = methods(available=True)
    seconds: dict[str, float] = {}
    start, spread = None, None
    for method, timed in TIMED.items():
        if method not in known:
            continue
        detail(f"{case.name}: {known[method].title}, one iteration")
        settings = {**timed.settings, "max_iterations": timed.iterations, "triangulation": mesh}
        # The first run waits for programs that are compiled.
        runs = [run(method, case, timed.energy, **settings) for _ in range(1 + _RUNS)][1:]
        steps = [[step.time for step in result.history] for result in runs]
        if method == "aqp":
            start = float(np.median([times[0] for times in steps]))
        if len(steps[0]) > 1:
            seconds[method] = float(np.median([np.mean(times[1:]) for times in steps]))
        if method == "newton":
            spread = [min(steps[-1][1:]), max(steps[-1][1:])]
    return {
        "name": case.name,
        "unknowns": case.unknowns,
        "seconds": seconds,
        "aqp_start": start,
        "spread": spread,
        "arrays": {},
    }
