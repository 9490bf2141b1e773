"""The script that measures batches: a process of its own, for it chooses the number of devices.

Reads ``problem``, ``sizes``, ``repeats`` and ``alone`` as a JSON object from its input, and writes
one to its output. What is timed one by one, and beside a hard pose, is left out unless ``alone``.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import jax
import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import enable_compilation_cache
from glid_nb.session import Problem
from glid_nb.solvers import Options, Pose, Result, solve, solve_batch
from studies.benchmarks.timing import Timing, rate, timed

OPTIONS = Options(restarts=0)

_SPREAD = 0.05  # standard deviation of what targets are moved by, world units
_MOST_ALONE = 64
_EASY = 15
# How far beyond its targets the pose is taken to make it hard.
_FACTORS = (1.5, 2.0, 3.0, 4.0)


def measure(given: dict[str, Any]) -> dict[str, Any]:
    """Poses per second of one shape, whose targets are moved a little at random."""
    problem, repeats = Problem.from_dict(given["problem"]), given["repeats"]
    targets = problem.pose.targets
    count = max(*given["sizes"], _EASY)
    moves = np.random.default_rng(0).normal(scale=_SPREAD, size=(count, *targets.shape))
    poses = targets + moves
    rows = [
        {"poses": n, "per_second": rate(_batch(problem, poses[:n], repeats), n)}
        for n in given["sizes"]
    ]
    found: dict[str, Any] = {"devices": len(jax.local_devices()), "rows": rows}
    if given["alone"]:
        some = poses[: min(max(given["sizes"]), _MOST_ALONE)]

        def one_by_one() -> None:
            for row in some:
                _alone(problem, row)

        found["one_by_one"] = rate(timed(one_by_one, repeats), len(some))
        found["hard"] = _beside_a_hard_pose(problem, poses[:_EASY], repeats)
    return found


def _together(problem: Problem, poses: NDArray[np.float64]) -> tuple[Result, ...]:
    return solve_batch(problem.domain, problem.pose.handles, poses, options=OPTIONS)


def _batch(problem: Problem, poses: NDArray[np.float64], repeats: int) -> Timing:
    return timed(lambda: _together(problem, poses), repeats)


def _alone(problem: Problem, targets: NDArray[np.float64]) -> Result:
    return solve(problem.domain, Pose(problem.pose.handles, targets), None, OPTIONS)


def _beside_a_hard_pose(
    problem: Problem, easy: NDArray[np.float64], repeats: int
) -> dict[str, Any]:
    """The same batch without and with one pose that needs more iterations than the others."""
    usual = int(np.median([r.iterations for r in _together(problem, easy)]))
    hard, needed = easy[0], 0
    for factor in _FACTORS:
        tried = problem.pose.handles + factor * (easy[0] - problem.pose.handles)
        iterations = _alone(problem, tried).iterations
        if iterations > needed:
            hard, needed = tried, iterations
        if needed >= 3 * usual:
            break
    mixed = np.concatenate([hard[None], easy])
    first, *others = _together(problem, mixed)
    # A batch goes round by round; this is the hard pose's part of the rounds with easy ones.
    rounds = max(-(-r.iterations // OPTIONS.iterations_per_call) for r in others)
    last = rounds * OPTIONS.iterations_per_call
    shared = sum(e.time for e in first.history if e.iteration <= last)
    return {
        "easy": len(easy),
        "easy_iterations": usual,
        "hard_iterations": needed,
        "without": _batch(problem, easy, repeats),
        "with": _batch(problem, mixed, repeats),
        "alone": timed(lambda: _alone(problem, hard), repeats),
        "easy_done": sum(r.solve_time for r in others) + shared,
    }


if __name__ == "__main__":
    enable_compilation_cache()
    print(json.dumps(measure(json.load(sys.stdin))))
