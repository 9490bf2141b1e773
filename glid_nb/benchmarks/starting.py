"""Cold and warm starts: a first solve in a new process, without and with compiled programs kept."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from typing import Any

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


def measure_start() -> dict[str, Any]:
    """Seconds until the first map of the bundled gecko, in a process of its own each."""
    with tempfile.TemporaryDirectory() as folder:
        cold, warm = (_in_new_process(folder) for _ in range(2))
    return {"cold": cold, "warm": warm}


def _in_new_process(cache: str) -> dict[str, float]:
    run = subprocess.run(
        [sys.executable, "-c", _FIRST_SOLVE],
        env={**os.environ, "GLID_NB_CACHE": cache},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout)
