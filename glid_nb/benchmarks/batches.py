"""Poses per second of ``solve_batch`` against the size of the batch."""

from __future__ import annotations

from typing import Any

import jax
import numpy as np

from glid_nb.benchmarks.timing import timed
from glid_nb.comparisons.cases import Case
from glid_nb.solvers import Options, Pose, solve, solve_batch

SIZES = (1, 4, 16, 64, 256)


def measure_batches(case: Case, quick: bool) -> dict[str, Any]:
    """The case's pose with its targets moved a little at random, in batches and one by one."""
    domain, pose = case.problem.domain, case.problem.pose
    options = Options(restarts=0)
    rng = np.random.default_rng(0)
    alone = timed(lambda: solve(domain, pose, None, options), 3)
    rows = []
    for size in SIZES[: 1 if quick else None]:
        moves = rng.normal(scale=0.05, size=(size, *pose.targets.shape))
        targets = pose.targets + moves

        def run(targets: np.ndarray = targets) -> None:
            solve_batch(domain, pose.handles, targets, options=options)

        def one_by_one(targets: np.ndarray = targets) -> None:
            for row in targets[:16]:
                solve(domain, Pose(pose.handles, row), None, options)

        together = timed(run, 1)
        apart = timed(one_by_one, 1)
        rows.append(
            {
                "poses": size,
                "per_second": size / together["median"],
                "one_by_one": min(size, 16) / apart["median"],
            }
        )
    return {
        "name": case.name,
        "devices": len(jax.local_devices()),
        "alone": alone,
        "rows": rows,
    }
