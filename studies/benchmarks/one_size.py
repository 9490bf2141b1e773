"""The script that measures one size: a process of its own, whose peak memory is that size's.

Reads ``vertices``, ``holes``, ``handles``, ``pieces``, ``mesh`` (display vertices, a list, from the
least) and ``repeats`` as a JSON object from its input, and writes one to its output.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

from glid_nb.geometry import triangulate
from glid_nb.solvers import Options, Pose, Result, Status, solve
from studies.benchmarks.scaling import STEPS
from studies.benchmarks.shapes import cut_edges, flower, ring_of_handles
from studies.benchmarks.timing import summary, timed

OPTIONS = Options(restarts=0)

_FIRST = 4  # iterations of the default settings, to be near a minimum and for their memory

_FURTHER = 0.25  # of the way that the targets went before
_BUDGET = 10.0  # seconds of one kind of timing, after which three are enough


def measure(given: dict[str, Any]) -> dict[str, Any]:
    """``step`` and ``before``: one iteration, and a call that takes none; ``memory`` in bytes.

    After a few iterations of the default settings the targets are moved on. From there
    the exact Hessian is mostly definite, so that an iteration without corrections is equal work;
    ``modified`` counts those in which it was not. Panels that must be split on the way are split
    before; ``split`` of them, which takes ``splitting`` seconds in a solve by the default settings.

    ``columns`` of the basis, ``coordinates`` (those with unknowns) and ``nodes`` of the Hessian are
    padded, as the work on them is.
    The time of an iteration is the difference between calls with and without ``STEPS``
    iterations, taken in turn, divided by their number.
    """
    domain = flower(given["vertices"], given["holes"])
    if given["pieces"] > 1:
        domain = cut_edges(domain, given["pieces"])
    pose = ring_of_handles(given["handles"])
    first = solve(domain, pose, None, replace(OPTIONS, max_iterations=_FIRST))
    moved = Pose(pose.handles, pose.targets + _FURTHER * (pose.targets - pose.handles))
    # As the default settings split: the factor of before serves after it.
    further = replace(OPTIONS, align=False, max_iterations=STEPS)

    def seconds(options: Options, start: Result) -> float:
        began = time.perf_counter()
        solve(domain, moved, None, options, start)
        return time.perf_counter() - began

    some = replace(further, corrections=0)
    none = replace(some, max_iterations=0)
    result, start, split = solve(domain, moved, None, some, first), first, 0
    while result.panels_split:
        split += result.panels_split
        start = replace(start, discretisation=result.discretisation, factor=None)
        result = solve(domain, moved, None, some, start)
    solve(domain, moved, None, none, start)
    # The iteration that finds the minimum reached takes no step, but has a Hessian.
    begun = result.iterations + (result.status is Status.CONVERGED)
    steps, before, began = [], [], time.perf_counter()
    while len(steps) < given["repeats"]:
        if len(steps) >= 3 and time.perf_counter() - began > _BUDGET:
            break
        before.append(seconds(none, start))
        steps.append((seconds(some, start) - before[-1]) / min(max(begun, 1), STEPS))
    memory = peak_memory()
    splitting = seconds(further, first) - seconds(further, start) if split else 0.0
    return {
        "unknowns": result.n_unknowns,
        "panels": result.n_panels,
        "columns": result.discretisation.basis.n_columns,
        "coordinates": len(result.discretisation.basis.unknown_columns),
        "nodes": len(result.discretisation.matrices.hessian_weights),
        "iterations": result.iterations,
        "modified": sum(entry.hessian_modified for entry in result.history),
        "split": split,
        "splitting": max(splitting, 0.0),
        "step": summary(steps),
        "before": summary(before),
        "memory": memory,
        "mesh": _meshes(result, given["mesh"], given["repeats"]),
    }


def _meshes(result: Result, wanted: list[int], repeats: int) -> list[dict[str, Any]]:
    cage, rows = result.map.domain.cage, []
    for i, count in enumerate(wanted):
        made: list[Any] = []
        # One program evaluates all of them: the first warms it up.
        warm_up = 1 if i == 0 else 0

        def make(count: int = count, made: list[Any] = made) -> None:
            made[:] = [triangulate(cage, count).vertices]

        triangulation = timed(make, repeats, warm_up, _BUDGET)
        vertices = made[0]
        evaluation = timed(lambda v=vertices: result.map(v), repeats, warm_up, _BUDGET)
        rows.append(
            {
                "mesh_vertices": len(vertices),
                "triangulate": triangulation,
                "evaluate": evaluation,
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


if __name__ == "__main__":
    print(json.dumps(measure(json.load(sys.stdin))))
