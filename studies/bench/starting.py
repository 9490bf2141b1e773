"""Cold and warm starts: a first solve in a new process, without and with kept programs."""

import tempfile

from studies.processes import in_new_process
from studies.store import Measurement
from studies.study import Plan, Study, Task
from studies.tables import Row
from studies.timing import summary

PARTS = {
    "import_and_trace": "import and outline of the picture",
    "first_solve": "first solve",
    "compiling": "of it tracing, compiling or loading programs",
    "second_solve": "second solve",
}

_REPEATS = 3
# A script, because importing a module of this package would come before the clock starts.
_FIRST_SOLVE = """
import json, time
began = time.perf_counter()
import glid_nb
glid_nb.enable_compilation_cache()
image = glid_nb.samples.image("gecko")
domain = glid_nb.Domain.from_cage(glid_nb.trace(image).cage)
pose = glid_nb.io.load_pose(glid_nb.samples.pose_path("gecko", "gentle"))
ready = time.perf_counter()
result = glid_nb.solve(domain, pose)
first = time.perf_counter()
glid_nb.solve(domain, pose)
print(json.dumps({
    "import_and_trace": ready - began, "first_solve": first - ready,
    "second_solve": time.perf_counter() - first, "compiling": result.compile_time}))
"""


def measure(repeats: int) -> Measurement:
    """Seconds until the first map of the bundled gecko, each time in a new process.

    ``cold`` starts with an empty folder of compiled programs, ``warm`` with the programs of the
    cold start before it. Each holds a timing for each of :data:`PARTS`.
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


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Seconds of each part, cold and warm."""
    rows: list[Row] = []
    for data in found:
        for kind in ("cold", "warm"):
            cells = {title: f"{data[kind][part]['median']:.2f}" for part, title in PARTS.items()}
            rows.append({"": kind, **cells})
    return {"start": rows}


def _tasks(plan: Plan) -> list[Task]:
    repeats = 1 if plan.quick else _REPEATS
    return [Task("gecko", f"repeats {repeats}", lambda: measure(repeats))]


STUDY = Study("start", _tasks, tables)
