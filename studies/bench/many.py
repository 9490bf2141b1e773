"""Poses per second of ``solve_many`` by executor, and what travels per pose.

The poses are those of a drag: small random moves of the targets. Every map is certified again in
the process that called. Starting the processes is timed apart, because it happens once.
"""

import pickle
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb.many import answer, solve_many, worker
from glid_nb.many.folder import Folder
from glid_nb.many.plan import Plan
from glid_nb.minima import solve
from glid_nb.solvers import Options
from studies.bench.batches import SPREAD
from studies.cases import Case
from studies.store import Measurement
from studies.study import Plan as StudyPlan
from studies.study import Study, Task
from studies.tables import Row

POSES = 1000
_QUICK, _PARTS = 6, 50
OPTIONS = Options(restarts=0)


@contextmanager
def _dask() -> Iterator[Executor]:
    from distributed import Client, LocalCluster  # noqa: PLC0415 - only this study needs it

    how: Any = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with LocalCluster(**how) as cluster, Client(cluster, set_as_default=False) as client:
        yield client.get_executor()


EXECUTORS: dict[str, Callable[[], Any]] = {
    "this process": lambda: nullcontext(None),
    "1 process": lambda: nullcontext(1),
    "2 processes": lambda: nullcontext(2),
    "dask, 2 workers": _dask,
}


def measure(case: Case, plan: StudyPlan) -> Measurement:
    """Times by executor, then bytes and times of the parts."""
    domain, pose = case.problem.domain, case.problem.pose
    count = _QUICK if plan.quick else POSES
    moves = np.random.default_rng(0).normal(scale=SPREAD, size=(count, *pose.targets.shape))
    problems = [(domain, pose.with_targets(pose.targets + move)) for move in moves]
    solve(*problems[0], options=OPTIONS)
    began, own = time.perf_counter(), time.process_time()
    for one in problems:
        solve(*one, options=OPTIONS)
    ways = {"solve in a loop": _times(count, 0.0, time.perf_counter() - began, own)}
    for name, made in EXECUTORS.items():
        plan.detail(f"many: {name}")
        ways[name] = _run(problems, made)
    return {"name": case.name, "poses": count, "ways": ways, "parts": _parts(problems, plan)}


def _run(problems: list[Any], made: Callable[[], Any]) -> Measurement:
    began = time.perf_counter()
    with made() as executor:
        many = solve_many(problems, options=OPTIONS, executor=executor)
        first = [next(many)]
        start = time.perf_counter() - began
        own = time.process_time()
        outcomes = first + list(many)
        took = _times(len(problems) - 1, start, time.perf_counter() - began - start, own)
    assert all(one.result for one in outcomes)
    return took


def _times(count: int, start: float, seconds: float, own: float) -> Measurement:
    """``start`` until the first outcome; the rest per pose, and this process's share of it."""
    return {
        "start": start,
        "rate": count / seconds,
        "own": (time.process_time() - own) / count,
    }


def _parts(problems: list[Any], plan: StudyPlan) -> Measurement:
    """Bytes of what travels, and seconds of processor time of the caller's work for a pose."""
    domain, pose = problems[0]
    result = solve(domain, pose, options=OPTIONS)
    shared = Plan(domain, result.energy_measure, OPTIONS, result.method)
    key = shared.problem_key(pose)
    data = answer.of_result(result, key)
    repeats = 3 if plan.quick else _PARTS
    with tempfile.TemporaryDirectory() as name:
        folder = Folder(Path(name))
        seconds = {
            "solve": _cpu(lambda: solve(domain, pose, options=OPTIONS), repeats),
            "write the answer": _cpu(lambda: answer.of_result(result, key), repeats),
            "pack and hash the pose": _cpu(
                lambda: (worker.packed(pose), shared.problem_key(pose)), repeats
            ),
            "read the answer": _cpu(lambda: answer.received(data, shared, pose, False), repeats),
            "read and certify it": _cpu(lambda: answer.received(data, shared, pose, True), repeats),
            "keep a file": _cpu(lambda: folder.write(key, data), repeats),
        }
    return {
        "bytes": {
            "pose": len(worker.packed(pose)),
            "domain and settings, once per worker": len(shared.packed),
            "answer": len(data),
            "whole result, pickled": len(pickle.dumps(result)),
        },
        "seconds": seconds,
    }


def _cpu(function: Callable[[], Any], repeats: int) -> float:
    """Median processor time, which other work on the machine hardly changes."""
    found = []
    for _ in range(repeats):
        began = time.process_time()
        function()
        found.append(time.process_time() - began)
    return float(np.median(found))


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Poses per second by executor; bytes and times of the parts."""
    rows: list[Row] = []
    parts: list[Row] = []
    for data in found:
        for name, took in data["ways"].items():
            times = {"poses per second": took["rate"], "start, s": took["start"]}
            own = {"caller's processor time per pose, ms": 1e3 * took["own"]}
            rows.append({"executor": name, "poses": data["poses"], **times, **own})
        sizes = data["parts"]["bytes"].items()
        parts += [{"part": name, "bytes": size} for name, size in sizes]
        seconds = data["parts"]["seconds"].items()
        parts += [{"part": name, "processor time, ms": 1e3 * value} for name, value in seconds]
    return {"many": rows, "many-parts": parts}


def _tasks(plan: StudyPlan) -> list[Task]:
    """One task: the bundled gecko."""
    case = plan.case("gecko-gentle")
    of = f"{case.digest}, {_QUICK if plan.quick else POSES} poses"
    return [Task(case.name, of, lambda: measure(case, plan))]


STUDY = Study("many", _tasks, tables)
