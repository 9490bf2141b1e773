"""Milliseconds of one iteration of every method (Table 2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from glid_nb.compare import methods
from glid_nb.comparisons.cases import Case
from glid_nb.comparisons.runs import MESH_VERTICES, last_of
from glid_nb.comparisons.store import Measurement
from glid_nb.energies import ARAP, Energy
from glid_nb.geometry import triangulate

_PAPER = {"sampling": "uniform", "certificate": "lipschitz"}
_RUNS = 2


class Timed(NamedTuple):
    """A method as it is timed."""

    iterations: int = 12
    settings: Mapping[str, Any] = {}
    energy: Energy | None = None


TIMED = {
    "newton": Timed(),
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
"""All but ours with the paper's samples and certificate, where they have any."""


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Median seconds of an iteration, from the identity, in a second run that nothing watches."""
    mesh = triangulate(case.problem.domain.cage, MESH_VERTICES, points=case.problem.pose.handles)
    known = methods(available=True)
    seconds: dict[str, float] = {}
    start = None
    for method, timed in TIMED.items():
        if method not in known:
            continue
        detail(f"{case.name}: {known[method].title}, one iteration")
        result = last_of(
            _RUNS,
            method,
            case,
            timed.energy,
            max_iterations=timed.iterations,
            triangulation=mesh,
            **timed.settings,
        )
        steps = [step.time for step in result.history]
        if method == "aqp":
            start = steps[0]
        if len(steps) > 1:
            seconds[method] = float(np.median(steps[1:]))
    return {
        "name": case.name,
        "unknowns": case.unknowns,
        "seconds": seconds,
        "aqp_start": start,
        "arrays": {},
    }
