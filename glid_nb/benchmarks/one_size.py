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

from glid_nb.benchmarks.scaling import STEPS
from glid_nb.benchmarks.shapes import cut_edges, flower, ring_of_handles
from glid_nb.benchmarks.timing import summary, timed
from glid_nb.geometry import triangulate
from glid_nb.solvers import Options, Result, solve

OPTIONS = Options(restarts=0, hessian="projected", corrections=0, max_iterations=STEPS)

_BUDGET = 10.0  # seconds of one kind of timing, after which three are enough


def measure(given: dict[str, Any]) -> dict[str, Any]:
    """``step`` and ``before``: one iteration, and a call that takes none; ``memory`` in bytes.

    ``columns`` of the basis and ``nodes`` of the Hessian are padded, as the work on them is.
    The time of an iteration is the difference between calls with and without ``STEPS``
    iterations, taken in turn, divided by their number.
    """
    domain = flower(given["vertices"], given["holes"])
    if given["pieces"] > 1:
        domain = cut_edges(domain, given["pieces"])
    pose = ring_of_handles(given["handles"])

    def seconds(options: Options) -> float:
        began = time.perf_counter()
        solve(domain, pose, None, options)
        return time.perf_counter() - began

    none = replace(OPTIONS, max_iterations=0)
    result = solve(domain, pose, None, OPTIONS)
    solve(domain, pose, None, none)
    steps, before, began = [], [], time.perf_counter()
    while len(steps) < given["repeats"]:
        if len(steps) >= 3 and time.perf_counter() - began > _BUDGET:
            break
        before.append(seconds(none))
        steps.append((seconds(OPTIONS) - before[-1]) / max(result.iterations, 1))
    memory = peak_memory()
    return {
        "unknowns": result.n_unknowns,
        "panels": result.n_panels,
        "columns": result.discretisation.basis.n_columns,
        "nodes": len(result.discretisation.matrices.hessian_weights),
        "iterations": result.iterations,
        "step": summary(steps),
        "before": summary(before),
        "memory": memory,
        "mesh": [_mesh(result, n, given["repeats"]) for n in given["mesh"]],
    }


def _mesh(result: Result, wanted: int, repeats: int) -> dict[str, Any]:
    cage = result.map.domain.cage
    vertices = triangulate(cage, wanted).vertices
    return {
        "mesh_vertices": len(vertices),
        "triangulate": timed(lambda: triangulate(cage, wanted), repeats, 0, _BUDGET),
        "evaluate": timed(lambda: result.map(vertices), repeats, 1, _BUDGET),
        "memory": peak_memory(),
    }


def peak_memory() -> int:
    """Bytes of memory that this process held at most."""
    # getrusage starts from what the parent process had; Linux counts this one alone in VmHWM.
    status = Path("/proc/self/status")
    lines = status.read_text(encoding="utf-8").splitlines() if status.exists() else []
    own = [int(line.split()[1]) for line in lines if line.startswith("VmHWM")]
    return 1024 * (own[0] if own else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)


if __name__ == "__main__":
    print(json.dumps(measure(json.load(sys.stdin))))
