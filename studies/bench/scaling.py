"""How time and memory grow with the cage, its holes, the panels, the mesh and the handles.

As a script it measures one size: a process of its own, whose peak memory is that size's.
"""

from __future__ import annotations

import functools
import json
import resource
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from glid_nb.figures.style import BLUE, GREY, SMALL
from glid_nb.geometry import triangulate
from glid_nb.solvers import Options, Pose, Result, Status, solve
from studies import figures
from studies.bench.shapes import cut_edges, flower, ring_of_handles
from studies.processes import in_new_process
from studies.store import Measurement
from studies.study import Plan, Study, Task
from studies.tables import Row, digits
from studies.timing import summary, timed, timed_in_turn


class Size(NamedTuple):
    """One shape of :mod:`studies.bench.shapes`, with its handles."""

    vertices: int
    holes: int = 0
    handles: int = 4
    pieces: int = 1
    """Into which each edge of the cage is cut: more panels for the same basis."""
    mesh: tuple[int, ...] = ()
    """Display vertices, from the least."""


SERIES = {
    "vertices": tuple(Size(n) for n in (50, 100, 200, 400, 700, 1000)),
    "holes": tuple(Size(40, holes=n) for n in (0, 5, 10, 20, 35, 50)),
    "panels": tuple(Size(100, pieces=n) for n in (1, 8, 16, 32, 64)),
    "handles": tuple(Size(100, handles=n) for n in (1, 4, 16, 64, 200, 500)),
    "mesh": (Size(100, mesh=(10_000, 100_000, 1_000_000)),),
}
"""What grows in each series, all else being equal."""

_QUICK = Size(50, mesh=(1000,))
# What an iteration's time is drawn against, and the power of the fastest growing part of the work.
_AGAINST = {
    "vertices": ("vertices", 3),
    "holes": ("unknowns", 3),
    "panels": ("panels", 1),
    "handles": ("handles", 0),
}
_OPTIONS = Options(restarts=0)
_STEPS = 2  # iterations that are timed: of equal work, one Hessian each and no corrections
_FIRST = 4  # iterations of the default settings, to be near a minimum and for their memory
_FURTHER = 0.25  # of the way that the targets went before
_BUDGET = 10.0  # seconds of one kind of timing, after which three are enough


@functools.cache
def _measured(size: Size, repeats: int) -> dict[str, Any]:
    given = {**size._asdict(), "repeats": repeats}
    return {**size._asdict(), **in_new_process("-m", "studies.bench.scaling", given)}


def _tasks(plan: Plan) -> list[Task]:
    def measure(series: str) -> Measurement:
        sizes = (_QUICK,) if plan.quick else SERIES[series]
        rows = [_measured(size, plan.repeats) for size in sizes]
        if series == "mesh":
            rows = [{**row, **mesh} for row in rows for mesh in row["mesh"]]
        return {"series": series, "rows": rows}

    of = f"repeats {plan.repeats}, quick {plan.quick}"
    return [Task(name, of, lambda name=name: measure(name)) for name in SERIES]


def measure_here(given: dict[str, Any]) -> dict[str, Any]:
    """``step`` and ``before``: one iteration, and a call that takes none; ``memory`` in bytes.

    After a few iterations of the default settings the targets are moved on. From there the exact
    Hessian is mostly definite, so that an iteration without corrections is equal work. Panels that
    must be split on the way are split before. The time of an iteration is the difference between
    calls with and without two iterations, taken in turn, divided by their number.
    """
    domain = flower(given["vertices"], given["holes"])
    if given["pieces"] > 1:
        domain = cut_edges(domain, given["pieces"])
    pose = ring_of_handles(given["handles"])
    first = solve(domain, pose, None, replace(_OPTIONS, max_iterations=_FIRST))
    moved = Pose(pose.handles, pose.targets + _FURTHER * (pose.targets - pose.handles))
    some = replace(_OPTIONS, align=False, corrections=0, max_iterations=_STEPS)
    none = replace(some, max_iterations=0)
    result, start = solve(domain, moved, None, some, first), first
    while result.panels_split:
        start = replace(start, discretisation=result.discretisation, factor=None)
        result = solve(domain, moved, None, some, start)
    calls = timed_in_turn(
        {
            "some": lambda: solve(domain, moved, None, some, start),
            "none": lambda: solve(domain, moved, None, none, start),
        },
        given["repeats"],
        budget=_BUDGET,
    )
    # The iteration that finds the minimum reached takes no step, but has a Hessian.
    begun = result.iterations + (result.status is Status.CONVERGED)
    count = min(max(begun, 1), _STEPS)
    return {
        "unknowns": result.n_unknowns,
        "panels": result.n_panels,
        "step": summary([(calls["some"]["median"] - calls["none"]["median"]) / count]),
        "before": calls["none"],
        "memory": peak_memory(),
        "mesh": _meshes(result, given["mesh"], given["repeats"]),
    }


def _meshes(result: Result, wanted: list[int], repeats: int) -> list[dict[str, Any]]:
    cage, rows = result.map.domain.cage, []
    for count in wanted:
        # One program evaluates all of them: the first warms it up.
        timing = {"repeats": repeats, "warm_up": 0 if rows else 1, "budget": _BUDGET}
        vertices = triangulate(cage, count).vertices
        rows.append(
            {
                "mesh_vertices": len(vertices),
                "triangulate": timed(lambda count=count: triangulate(cage, count), **timing),
                "evaluate": timed(lambda v=vertices: result.map(v), **timing),
                "memory": peak_memory(),
            }
        )
    return rows


def peak_memory() -> int:
    """Bytes of memory that this process held at most."""
    # getrusage starts from what the parent process had; Linux counts this one alone in VmHWM.
    status = Path("/proc/self/status")
    lines = status.read_text(encoding="utf-8").splitlines() if status.exists() else []
    own = [int(line.split()[1]) for line in lines if line.startswith("VmHWM")]
    return 1024 * (own[0] if own else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """One table for each series."""
    made: dict[str, list[Row]] = {}
    for data in found:
        series = data["series"]
        if series == "mesh":
            made["scaling-mesh"] = [_mesh_row(row) for row in data["rows"]]
            continue
        x = _AGAINST[series][0]
        powers = local_exponents(*(np.array(v) for v in _values(data["rows"], x)))
        made[f"scaling-{series}"] = [
            {
                **{name: row[name] for name in (series, "panels", "unknowns")},
                "iteration, ms": 1e3 * row["step"]["median"],
                "exponent": "" if np.isnan(power) else f"{power:.1f}",
                "call, ms": 1e3 * row["before"]["median"],
                "memory, GB": f"{row['memory'] / 1e9:.2f}",
            }
            for row, power in zip(data["rows"], [np.nan, *powers], strict=True)
        ]
    return made


def _mesh_row(row: dict[str, Any]) -> Row:
    return {
        "display vertices": f"{row['mesh_vertices']:,}",
        "triangulate, ms": digits(1e3 * row["triangulate"]["median"]),
        "evaluate the map, ms": digits(1e3 * row["evaluate"]["median"]),
        "memory, GB": f"{row['memory'] / 1e9:.2f}",
    }


def _values(rows: list[dict[str, Any]], x: str) -> tuple[list[float], list[float]]:
    return [row[x] for row in rows], [1e3 * row["step"]["median"] for row in rows]


def local_exponents(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The power by which ``y`` grows from each size to the next.

    NaN beside what is not positive, a difference of two timings that noise outweighs.
    """
    y = np.where(y > 0, y, np.nan)
    return np.diff(np.log(y)) / np.diff(np.log(x))


def draw(found: list[Measurement], folder: Path) -> None:
    """An iteration's time against sizes, on logarithmic axes."""
    rows = {data["series"]: data["rows"] for data in found}
    figure = figures.figure(12.0, 3.0)
    for axes, (series, (x, power)) in zip(figure.subplots(1, 4), _AGAINST.items(), strict=True):
        figures.label_axes(axes, x, "ms per iteration", f"more {series}")
        if series in rows:
            _curve(axes, *_values(rows[series], x), power)
    figures.save(figure, folder / "scaling.png")


def _curve(axes: Axes, x: list[float], y: list[float], power: int) -> None:
    """The measured values, and a dashed line of the expected power that ends at the last one."""
    axes.loglog(x, y, "o-", color=BLUE, ms=4, lw=1.2)
    axes.margins(0.08)
    # A decade at least, so that noise does not look like growth.
    limits = min(axes.get_ylim()[0], max(y) / 10), axes.get_ylim()[1]
    ends = np.geomspace(x[0], x[-1], 2)
    line = y[-1] * (ends / x[-1]) ** power
    axes.plot(ends, line, "--", color=GREY, lw=0.9, zorder=0, label=f"slope {power}")
    axes.set_ylim(limits)
    axes.legend(fontsize=SMALL, frameon=False, loc="upper left")
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, limits)):
        axis.set_major_locator(LogLocator(10, (1.0, 2.0, 5.0) if high / low < 300 else (1.0,)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
        axis.set_minor_formatter(NullFormatter())


STUDY = Study("scaling", _tasks, tables, draw)

if __name__ == "__main__":
    print(json.dumps(measure_here(json.load(sys.stdin))))
