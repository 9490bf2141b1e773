"""Poses per second of ``solve_batch``, by the size of the batch and the number of devices.

XLA shows a CPU as two devices when the process is started with
``XLA_FLAGS=--xla_force_host_platform_device_count=2``.
"""

import jax
import numpy as np

from glid_nb.minima import solve, solve_batch
from glid_nb.pose import Pose
from glid_nb.solvers import Options
from studies.bench.solving import bench_cases
from studies.cases import Case
from studies.store import Measurement
from studies.study import Plan, Study, Task
from studies.tables import Row
from studies.timing import timed

SIZES = (1, 4, 16, 64, 256)
OPTIONS = Options(restarts=0)

_REPEATS = 3
SPREAD = 0.05
"""Standard deviation of the targets' random moves, world units."""


def measure(case: Case, plan: Plan) -> Measurement:
    """Poses per second with small random moves of the targets: one by one, and in batches."""
    domain, pose = case.problem.domain, case.problem.pose
    sizes, repeats = (SIZES[:1], 1) if plan.quick else (SIZES, _REPEATS)
    moves = np.random.default_rng(0).normal(scale=SPREAD, size=(max(sizes), *pose.targets.shape))
    poses = pose.targets + moves

    def one_by_one(count: int) -> None:
        for targets in poses[:count]:
            solve(domain, Pose(pose.handles, targets), None, OPTIONS)

    def together(count: int) -> None:
        solve_batch(domain, [pose.with_targets(t) for t in poses[:count]], options=OPTIONS)

    alone = min(max(sizes), 64)
    rates = {"one by one": alone / timed(lambda: one_by_one(alone), repeats)["median"]}
    for n in sizes:
        rates[str(n)] = n / timed(lambda n=n: together(n), repeats)["median"]
    return {"name": case.name, "devices": len(jax.local_devices()), "rates": rates}


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Poses per second by the size of the batch."""
    counts = dict.fromkeys(count for data in found for count in data["rates"])
    return {"batches": [_row(count, found) for count in counts]}


def _row(count: str, found: list[Measurement]) -> Row:
    rates = {f"{data['devices']} device(s)": data["rates"].get(count) for data in found}
    return {"poses": count, **rates}


def _tasks(plan: Plan) -> list[Task]:
    """One task: rex, or else the first shape."""
    case = plan.case("rex" if "rex" in plan.references else bench_cases(plan)[0])
    name = f"{case.name}-{len(jax.local_devices())}"
    return [Task(name, f"{case.digest}, quick {plan.quick}", lambda: measure(case, plan))]


STUDY = Study("batches", _tasks, tables)
