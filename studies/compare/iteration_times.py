"""Milliseconds of one iteration of every method (Table 2)."""

from typing import Any

import numpy as np

from glid_nb.energies import ARAP
from glid_nb.geometry import triangulate
from glid_nb.methods import METHODS, available
from studies.cases import Case
from studies.compare.shapes import all_shapes
from studies.runs import MESH_VERTICES, entries, run
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row

_PAPER = {"sampling": "uniform", "certificate": "lipschitz"}
_RUNS = 3


TIMED: dict[str, dict[str, Any]] = {
    "newton": {"max_iterations": None},
    "newton-paper": {},
    "newton-staged": {},
    "newton-eigen": _PAPER,
    "newton-shift": _PAPER,
    "lbfgs": {**_PAPER, "max_iterations": 40},
    "gradient-descent": {**_PAPER, "max_iterations": 40},
    "slim": {},
    "aqp": {"max_iterations": 40},
    "arap-mesh": {"energy": ARAP()},
}
"""Settings of each method. The default is 12 iterations.

All methods except ours use the paper's samples and certificate, if they use any.

Ours runs to its end, because its iterations differ: close to the minimum they have more steps.
"""


def measure(case: Case, plan: Plan) -> Measurement:
    """Mean seconds of an iteration from the identity: the median of several unwatched runs."""
    mesh = triangulate(case.problem.domain.cage, MESH_VERTICES, points=case.problem.pose.handles)
    known = available()
    seconds: dict[str, float] = {}
    start = unknowns = None
    for method, settings in TIMED.items():
        if method not in known:
            continue
        plan.detail(f"{case.name}: {known[method].label}, one iteration")
        settings = {"max_iterations": 12, "mesh": mesh, **settings}
        # The first run compiles the programs, so it does not count.
        runs = [run(method, case, **settings) for _ in range(1 + _RUNS)][1:]
        steps = [[step.time for step in entries(result)] for result in runs]
        unknowns = runs[0].n_unknowns or unknowns
        if method == "aqp":
            start = float(np.median([times[0] for times in steps]))
        if len(steps[0]) > 1:
            seconds[method] = float(np.median([np.mean(times[1:]) for times in steps]))
    return {"unknowns": unknowns, "seconds": seconds, "aqp_start": start}


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Milliseconds of an iteration by shape and method."""
    titles = {name: method.label for name, method in METHODS.items()}
    rows: list[Row] = []
    for data in found:
        times = {titles[name]: f"{1e3 * value:.1f}" for name, value in data["seconds"].items()}
        start = None if data["aqp_start"] is None else f"{1e3 * data['aqp_start']:.0f}"
        about = {"shape": data["name"], "unknowns": data["unknowns"]}
        rows.append({**about, **times, "AQP's start": start})
    return {"iteration-times": rows}


STUDY = Study("iteration-times", on_cases(all_shapes, measure), tables)
