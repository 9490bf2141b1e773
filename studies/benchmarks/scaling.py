"""How time and memory grow with the cage, its holes, the panels, the mesh and the handles."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from studies.benchmarks.processes import in_new_process

_SCRIPT = "studies.benchmarks.one_size"


STEPS = 2
"""Iterations that are timed: of equal work, one Hessian each and no corrections."""


class Size(NamedTuple):
    """One shape of :mod:`studies.benchmarks.shapes`, with its handles."""

    vertices: int
    holes: int = 0
    handles: int = 4
    pieces: int = 1
    """Into which each edge of the cage is cut: more panels for the same basis."""
    mesh: tuple[int, ...] = ()
    """Display vertices."""


SERIES = {
    "vertices": tuple(Size(n) for n in (50, 100, 200, 400, 700, 1000)),
    "holes": tuple(Size(40, holes=n) for n in (0, 5, 10, 20, 35, 50)),
    "panels": tuple(Size(100, pieces=n) for n in (1, 8, 16, 32, 64)),
    "handles": tuple(Size(100, handles=n) for n in (1, 4, 16, 64, 200, 500)),
    "mesh": (Size(100, mesh=(10_000, 100_000, 1_000_000)),),
}
"""What grows in each series, all else being equal."""

_QUICK = Size(50, mesh=(1000,))


def measure_scaling(
    series: str, repeats: int, quick: bool, detail: Callable[[str], None]
) -> dict[str, Any]:
    """The rows of one of :data:`SERIES`, each measured in a process of its own.

    Parameters
    ----------
    series : str
    repeats : int
        Most timings of each kind; slow ones are repeated three times.
    quick : bool
        Only one small size, the same for every series.
    detail : callable
        Told which size is measured.
    """
    rows = []
    for size in (_QUICK,) if quick else SERIES[series]:
        detail(", ".join(f"{n} {name}" for name, n in size._asdict().items() if n))
        row = {**size._asdict(), **_measured(size, repeats)}
        rows += [{**row, **mesh} for mesh in row["mesh"]] if series == "mesh" else [row]
    return {"rows": rows}


@functools.cache
def _measured(size: Size, repeats: int) -> dict[str, Any]:
    return in_new_process("-m", _SCRIPT, {**size._asdict(), "repeats": repeats})
