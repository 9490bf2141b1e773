"""How time and memory grow with the cage, its holes, the panels, the mesh and the handles."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

VERTICES = (50, 100, 200, 400, 700, 1000)
HOLES = (0, 5, 10, 20, 35, 50)
HANDLES = (1, 4, 16, 64, 200, 500)
MESH = (10_000, 100_000, 1_000_000)

# In a process of its own, so that its peak memory is that of one size.
_ONE_SIZE = """
import json, pathlib, resource, sys, time
import numpy as np
import glid_nb
from glid_nb.benchmarks.shapes import flower, ring_of_handles
vertices, holes, handles, mesh = json.loads(sys.argv[1])
domain = flower(vertices, holes)
pose = ring_of_handles(handles)
options = glid_nb.Options(restarts=0, max_iterations=4)
result = glid_nb.solve(domain, pose, options=options)
times = []
for _ in range(3):
    began = time.perf_counter()
    again = glid_nb.solve(domain, pose, options=options)
    times.append((time.perf_counter() - began) / max(again.iterations, 1))
def peak():
    # getrusage starts from what the parent process had; Linux counts this one alone in VmHWM.
    status = pathlib.Path("/proc/self/status")
    lines = status.read_text().splitlines() if status.exists() else []
    own = [int(line.split()[1]) for line in lines if line.startswith("VmHWM")]
    return 1024 * (own[0] if own else resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
began = time.perf_counter()
moved = result.map(glid_nb.triangulate(domain.cage, mesh).vertices) if mesh else None
print(json.dumps({
    "unknowns": result.n_unknowns, "panels": result.n_panels, "per_iteration": min(times),
    "evaluate": time.perf_counter() - began if mesh else None,
    "mesh_vertices": len(moved) if mesh else None,
    "memory": peak()}))
"""


def measure_scaling(quick: bool) -> dict[str, Any]:
    """One row per size for each of the series ``vertices``, ``holes``, ``handles``, ``mesh``."""
    last = 1 if quick else None
    return {
        "vertices": [_one(n, 0, 4, 0) for n in VERTICES[:last]],
        "holes": [_one(40, n, 4, 0) for n in HOLES[:last]],
        "handles": [_one(100, 0, n, 0) for n in HANDLES[:last]],
        "mesh": [_one(100, 0, 4, n) for n in MESH[:last]],
    }


def _one(vertices: int, holes: int, handles: int, mesh: int) -> dict[str, Any]:
    given = [vertices, holes, handles, mesh]
    run = subprocess.run(
        [sys.executable, "-c", _ONE_SIZE, json.dumps(given)],
        capture_output=True,
        text=True,
        check=True,
    )
    return {
        "vertices": vertices,
        "holes": holes,
        "handles": handles,
        "mesh": mesh,
        **json.loads(run.stdout),
    }
