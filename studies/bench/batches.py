"""Poses per second of ``solve_batch`` against the size of the batch and the number of devices.

As a script it measures one number of devices, which a process chooses when it starts.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any

import jax
import numpy as np

from glid_nb._runtime import enable_compilation_cache
from glid_nb.session import Problem
from glid_nb.solvers import Options, Pose, solve, solve_batch
from studies.bench.solving import bench_cases
from studies.cases import Case
from studies.processes import in_new_process
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row
from studies.timing import rate, timed

SIZES = (1, 4, 16, 64, 256)
OPTIONS = Options(restarts=0)

_REPEATS = 3
_SHAPE = "rex"
_FORCED = (1, 2)  # CPU devices that XLA is made to show; the cores are the same
_SPREAD = 0.05  # standard deviation of what targets are moved by, world units
_MOST_ALONE = 64


def measure(case: Case, plan: Plan) -> Measurement:
    """The case's pose with its targets moved a little at random, in batches and one by one.

    On a CPU with one and with two devices, elsewhere on all there are; ``series`` has one entry
    for each.
    """
    given = {
        "problem": case.problem.to_dict(),
        "sizes": SIZES[:1] if plan.quick else SIZES,
        "repeats": 1 if plan.quick else _REPEATS,
    }
    series = []
    for count in _FORCED if jax.default_backend() == "cpu" else (None,):
        flags = os.environ.get("XLA_FLAGS", "")
        if count is not None:
            flags = f"{flags} --xla_force_host_platform_device_count={count}"
        series.append(in_new_process("-m", "studies.bench.batches", given, XLA_FLAGS=flags))
    return {"series": series}


def measure_here(given: dict[str, Any]) -> dict[str, Any]:
    """Poses per second of ``problem`` on this process's devices."""
    problem, sizes, repeats = Problem.from_dict(given["problem"]), given["sizes"], given["repeats"]
    handles, targets = problem.pose.handles, problem.pose.targets
    moves = np.random.default_rng(0).normal(scale=_SPREAD, size=(max(sizes), *targets.shape))
    poses = targets + moves

    def together(count: int) -> None:
        solve_batch(problem.domain, handles, poses[:count], options=OPTIONS)

    def one_by_one() -> None:
        for row in poses[:_MOST_ALONE]:
            solve(problem.domain, Pose(handles, row), None, OPTIONS)

    rates = [rate(timed(lambda n=n: together(n), repeats), n) for n in sizes]
    return {
        "devices": len(jax.local_devices()),
        "rows": [{"poses": n, "per_second": r} for n, r in zip(sizes, rates, strict=True)],
        "one_by_one": rate(timed(one_by_one, repeats), min(max(sizes), _MOST_ALONE)),
    }


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Poses per second by the size of the batch."""
    rows: list[Row] = []
    for data in found:
        first, *_ = series = data["series"]
        alone = first["one_by_one"]["median"]
        rows.append({"poses": "one by one", _devices(first): f"{alone:.1f}"})
        for i, row in enumerate(first["rows"]):
            rates = {_devices(s): s["rows"][i]["per_second"]["median"] for s in series}
            rows.append({"poses": row["poses"], **{n: f"{r:.1f}" for n, r in rates.items()}})
    return {"batches": rows}


def _devices(series: dict[str, Any]) -> str:
    return f"{series['devices']} device(s)"


def _middle(plan: Plan) -> list[str]:
    """Rex, or else the shape with the middle number of cage vertices."""
    known = bench_cases(plan)
    if _SHAPE in known:
        return [_SHAPE]
    known.sort(key=lambda name: len(plan.case(name).problem.domain.cage.exterior))
    return [known[len(known) // 2]]


STUDY = Study("batches", on_cases(_middle, measure), tables)

if __name__ == "__main__":
    enable_compilation_cache()
    print(json.dumps(measure_here(json.load(sys.stdin))))
