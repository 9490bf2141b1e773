"""Poses per second of batches on this process's device.

As a script it prints one line of JSON for each size, smaller sizes first. It stops before a size
for which the time is too short.
"""

import json
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

import glid_nb
from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.energies import as_energy
from glid_nb.minima import batch, solve, solve_batch
from glid_nb.pose import Pose
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import Newton
from studies.bench.batches import SPREAD
from studies.cases import Case, reference_cases
from studies.gpu.solving import OPTIONS, certificate_of, show
from studies.study import Plan

_GROWTH = 4.0  # from one size to the next
_REPEATS = 3
_ALONE = 16  # poses that are solved one by one


def poses_of(case: Case, count: int) -> np.ndarray:
    """(count, h, 2) targets, each moved a little at random."""
    targets = case.problem.pose.targets
    moves = np.random.default_rng(0).normal(scale=SPREAD, size=(count, *targets.shape))
    return targets + moves


def one_by_one(case: Case) -> dict[str, Any]:
    """Seconds to solve some poses one after the other."""
    domain, handles = case.problem.domain, case.problem.pose.handles
    goals = poses_of(case, _ALONE)
    solve(domain, Pose(handles, goals[0]), None, OPTIONS)
    began = time.perf_counter()
    for targets in goals:
        solve(domain, Pose(handles, targets), None, OPTIONS)
    return {"kind": "one by one", "poses": _ALONE, "seconds": time.perf_counter() - began}


def together(case: Case, count: int) -> dict[str, Any]:
    """Seconds of one batch, and the number of its certified maps."""
    domain, handles = case.problem.domain, case.problem.pose.handles
    goals = poses_of(case, count)
    began = time.perf_counter()
    results = solve_batch(domain, [Pose(handles, goal) for goal in goals], options=OPTIONS)
    seconds = time.perf_counter() - began
    return {
        "kind": "batch",
        "poses": count,
        "seconds": seconds,
        "certified": sum(certificate_of(result).certified for result in results),
        "iterations": sum(result.iterations for result in results),
        "energies": [result.energy for result in results[:_ALONE]],
    }


@double_precision
def lockstep(case: Case, count: int, repeats: int) -> dict[str, Any]:
    """Seconds of the first call for ``count`` poses at once, without and with the work of the host
    before and after it."""
    domain, handles = case.problem.domain, case.problem.pose.handles
    given = [
        Inputs(domain=domain, pose=Pose(handles, goal), energy=as_energy(None), options=OPTIONS)
        for goal in poses_of(case, count)
    ]

    def called() -> tuple[float, float, int]:
        began = time.perf_counter()
        chosen = [batch._Pose(Newton(), inputs) for inputs in given]
        with single_blas_thread():
            batch._call(chosen, count)
        whole = time.perf_counter() - began
        return whole, sum(one.seconds for one in chosen), sum(len(one.history) for one in chosen)

    whole, device, iterations = min(called() for _ in range(repeats))
    found = {"kind": "lockstep", "poses": count, "seconds": whole, "device": device}
    return {**found, "iterations": iterations}


def main() -> None:
    """Measure the sizes that standard input names."""
    given = json.load(sys.stdin)
    glid_nb.enable_compilation_cache()
    reference, ends = given["reference"], time.perf_counter() + given["seconds"]
    plan = Plan({} if reference is None else reference_cases(Path(reference)))
    case = plan.case(given["shape"])
    show(one_by_one(case))
    with ThreadPoolExecutor() as pool:  # compiles
        list(pool.map(lambda count: lockstep(case, count, 1), given["lockstep"]))
    for count in given["lockstep"]:
        show(lockstep(case, count, _REPEATS))
    for count in given["sizes"]:
        found = together(case, count)
        show(found)
        if time.perf_counter() + _GROWTH * found["seconds"] > ends:
            break


if __name__ == "__main__":
    main()
