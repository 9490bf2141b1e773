"""How time and memory grow with the cage, its holes and the handles.

Run as a script, it measures one size in a separate process, to get the peak memory of that size.
"""

import functools
import json
import resource
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from glid_nb.geometry import Cage, Domain
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options
from studies.processes import in_new_process
from studies.store import Measurement
from studies.study import Plan, Study, Task
from studies.tables import Row
from studies.timing import summary, timed


class Size(NamedTuple):
    """A :func:`flower` with its handles."""

    vertices: int
    holes: int = 0
    handles: int = 4


SERIES = {
    "vertices": tuple(Size(n) for n in (50, 100, 200, 400, 700, 1000)),
    "holes": tuple(Size(40, holes=n) for n in (0, 5, 10, 20, 35, 50)),
    "handles": tuple(Size(100, handles=n) for n in (2, 4, 16, 64, 200, 500)),
}
"""The sizes of each series; only one number grows."""

_SHAPE = ("domain", "contains")
_QUICK = Size(50)
# The size that the exponents refer to, if it is not the series' own.
_AGAINST = {"holes": "unknowns"}
_OPTIONS = Options(restarts=0)
_REPEATS = 3
_BUDGET = 10.0  # seconds of one kind of timing, after which three are enough


def flower(vertices: int, holes: int) -> Domain:
    """A flower of radius about 8 with triangular holes on a grid inside."""
    t = np.linspace(0, 2 * np.pi, vertices, endpoint=False)
    radius = 8 + 1.2 * np.sin(5 * t)
    exterior = radius[:, None] * np.stack([np.cos(t), np.sin(t)], axis=1)
    side = int(np.ceil(np.sqrt(holes)))
    triangle = np.array([[0, 1], [0.87, -0.5], [-0.87, -0.5]])
    spacing = 8.0 / max(side, 1)
    places = [
        ((i - (side - 1) / 2) * spacing, (j - (side - 1) / 2) * spacing)
        for i in range(side)
        for j in range(side)
    ]
    return Domain.from_cage(
        Cage(exterior, [0.25 * spacing * triangle + place for place in places[:holes]])
    )


def ring_of_handles(count: int) -> Pose:
    """Handles spread over a ring inside a :func:`flower`, a tenth of them (at least one) moved."""
    t = np.linspace(0, 2 * np.pi, count, endpoint=False)
    handles = 6.2 * np.stack([np.cos(t), np.sin(t)], axis=1)
    targets = handles.copy()
    targets[::10] += [0.4, 0.2]
    return Pose(handles, targets)


@functools.cache
def _measured(size: Size, repeats: int) -> dict[str, Any]:
    given = {**size._asdict(), "repeats": repeats}
    return {**size._asdict(), **in_new_process("-m", "studies.bench.scaling", given)}


def _tasks(plan: Plan) -> list[Task]:
    def measure(series: str) -> Measurement:
        sizes = (_QUICK,) if plan.quick else SERIES[series]
        rows = [_measured(size, plan.repeats) for size in sizes]
        return {"series": series, "rows": rows}

    of = f"repeats {plan.repeats}, quick {plan.quick}"
    return [Task(name, of, lambda name=name: measure(name)) for name in SERIES]


def measure_here(given: dict[str, Any]) -> dict[str, Any]:
    """Times: ``step`` of one iteration, ``before`` of a call without iterations, ``domain`` of
    checking and offsetting the cage, ``contains`` of testing a million points. ``memory`` in bytes.

    The iterations have no corrections, so that each has the same work: one Hessian.
    """
    domain, pose = flower(given["vertices"], given["holes"]), ring_of_handles(given["handles"])
    first = solve(domain, pose, None, _OPTIONS)  # compiles, and splits panels
    options = replace(_OPTIONS, corrections=0)
    results = [solve(domain, pose, None, options) for _ in range(1 + _REPEATS)][1:]
    nothing, repeats = replace(_OPTIONS, max_iterations=0), given["repeats"]
    points = np.random.default_rng(0).uniform(-9, 9, (1_000_000, 2))
    return {
        "unknowns": first.n_unknowns,
        "panels": first.n_panels,
        "step": summary([entry.time for result in results for entry in result.history]),
        "before": timed(lambda: solve(domain, pose, None, nothing), repeats, 1, _BUDGET),
        "memory": peak_memory(),
        "domain": timed(lambda: flower(given["vertices"], given["holes"]), repeats, 1, _BUDGET),
        "contains": timed(lambda: domain.cage.contains(points), repeats, 1, _BUDGET),
    }


def peak_memory() -> int:
    """The largest memory of this process, bytes."""
    # getrusage includes the parent's memory at the fork; VmHWM of Linux does not.
    status = Path("/proc/self/status")
    lines = status.read_text(encoding="utf-8").splitlines() if status.exists() else []
    own = [int(line.split()[1]) for line in lines if line.startswith("VmHWM")]
    return 1024 * (own[0] if own else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """One table for each series."""
    made: dict[str, list[Row]] = {}
    for data in found:
        series, rows = data["series"], data["rows"]
        x = np.array([row[_AGAINST.get(series, series)] for row in rows])
        y = np.array([row["step"]["median"] for row in rows])
        made[f"scaling-{series}"] = [
            {
                **{name: row[name] for name in (series, "panels", "unknowns")},
                "iteration, ms": 1e3 * row["step"]["median"],
                "exponent": "" if np.isnan(power) else f"{power:.1f}",
                "call, ms": 1e3 * row["before"]["median"],
                "memory, GB": f"{row['memory'] / 1e9:.2f}",
                **{f"{kind}, ms": 1e3 * row[kind]["median"] for kind in _SHAPE if kind in row},
            }
            for row, power in zip(rows, [np.nan, *local_exponents(x, y)], strict=True)
        ]
    return made


def local_exponents(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The exponent of ``y``'s growth from each size to the next.

    NaN next to values that are not positive: noise can make a difference of two times negative.
    """
    y = np.where(y > 0, y, np.nan)
    return np.diff(np.log(y)) / np.diff(np.log(x))


STUDY = Study("scaling", _tasks, tables)

if __name__ == "__main__":
    print(json.dumps(measure_here(json.load(sys.stdin))))
