"""Cold and warm starts: a first solve in a new process, without and with compiled programs kept."""

from __future__ import annotations

import tempfile
from typing import Any

from studies.benchmarks.processes import in_new_process
from studies.benchmarks.timing import summary

PARTS = ("import_and_trace", "first_solve", "compiling", "second_solve")
"""``compiling`` is a part of ``first_solve``."""

# Not a module of this package, whose import would come before the clock starts.
_FIRST_SOLVE = """
import json, time
began = time.perf_counter()
import glid_nb
glid_nb.enable_compilation_cache()
image = glid_nb.samples.image("gecko")
domain = glid_nb.Domain.from_cage(glid_nb.trace(image).cage)
pose = glid_nb.load_pose(glid_nb.samples.pose_path("gecko", "gentle"))
ready = time.perf_counter()
result = glid_nb.solve(domain, pose)
first = time.perf_counter()
glid_nb.solve(domain, pose)
print(json.dumps({
    "import_and_trace": ready - began, "first_solve": first - ready,
    "second_solve": time.perf_counter() - first, "compiling": result.compile_time}))
"""


def measure_start(repeats: int) -> dict[str, Any]:
    """Seconds until the first map of the bundled gecko; each time a process of its own.

    ``cold`` with an empty folder of compiled programs, ``warm`` with what the cold start before
    left there; each holds a timing for each of :data:`PARTS`.
    """
    runs: dict[str, list[dict[str, float]]] = {"cold": [], "warm": []}
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as folder:
            for found in runs.values():
                found.append(in_new_process("-c", _FIRST_SOLVE, None, GLID_NB_CACHE=folder))
    return {
        name: {part: summary([run[part] for run in found]) for part in PARTS}
        for name, found in runs.items()
    }
