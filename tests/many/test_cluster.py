"""dask: two worker processes, one of them killed; then the scheduler is killed."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from glid_nb import HarmonicMap, io
from glid_nb.cli import main
from glid_nb.many import ExecutorLostError, solve_many
from glid_nb.pose import Pose

from ..support.domains import domain

distributed = pytest.importorskip("distributed")

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
KILL = getattr(signal, "SIGKILL", signal.SIGTERM)
PATIENCE = 3  # seconds until a client gives a scheduler up
# The scheduler runs in a process of its own, and its two workers run in others.
CLUSTER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    how = dict(n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1")
    with LocalCluster(**how) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


def problems(count: int, seed: int) -> list[Any]:
    moves = np.random.default_rng(seed).normal(scale=0.3, size=(count, *HANDLES.shape))
    return [(domain("ell"), Pose(HANDLES, HANDLES + move)) for move in moves]


class Cluster(NamedTuple):
    address: str
    process: subprocess.Popen[str]


@pytest.fixture(scope="module")
def cluster() -> Iterator[Cluster]:
    pipes: Any = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([sys.executable, "-c", CLUSTER], text=True, **pipes) as process:
        yield Cluster(process.stdout.readline().strip(), process)
        process.stdin.close()


@pytest.fixture
def client(cluster: Cluster) -> Iterator[Any]:
    with distributed.Client(cluster.address, timeout=PATIENCE, set_as_default=False) as client:
        yield client


def test_a_killed_worker_loses_nothing(client: Any) -> None:
    many = solve_many(problems(16, 0), executor=client.get_executor(), in_flight=4)
    found = [next(many), next(many)]
    workers = client.run(os.getpid)
    assert len(set(workers.values())) == 2
    os.kill(next(iter(workers.values())), KILL)
    found += many
    assert sorted(one.index for one in found) == list(range(16))
    assert all(one.result and one.result.certificate.certified for one in found)


def test_the_command_uses_a_scheduler(
    cluster: Cluster, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [tmp_path / f"{name}.json" for name in ("one", "two")]
    for path, (shape, pose) in zip(paths, problems(2, 1), strict=True):
        io.Problem(shape, pose).save(path)
    words = ["--scheduler", cluster.address, "--out", f"{tmp_path / 'maps'}/"]
    table = tmp_path / "table.csv"
    assert main(["solve", *map(str, paths), *words, "--summary", str(table)]) == 0
    assert capsys.readouterr().out.count("converged") == 2
    for path in paths:
        HarmonicMap.load(tmp_path / "maps" / path.name)
    with table.open(encoding="utf-8", newline="") as file:
        assert [row["certified"] for row in csv.DictReader(file)] == ["True", "True"]


class Counts(Executor):
    solved = 0

    def submit(self, fn: Any, /, *args: Any, **_: Any) -> Future[Any]:
        self.solved += 1
        future = Future[Any]()
        future.set_result(fn(*args))
        return future


def test_a_lost_scheduler_loses_nothing(cluster: Cluster, client: Any, tmp_path: Path) -> None:
    given, found = problems(16, 2), list[Any]()
    many = solve_many(given, executor=client.get_executor(), folder=tmp_path, in_flight=4)

    def run() -> None:
        for one in many:
            found.append(one)
            if len(found) == 2:
                cluster.process.kill()

    with pytest.raises(ExecutorLostError, match="make a new executor and call again"):
        run()
    assert 2 <= len(found) < 16
    counts = Counts()
    again = list(solve_many(given, executor=counts, folder=tmp_path))
    assert all(one.result for one in again)
    assert {one.index for one in again if one.kept} == {one.index for one in found}
    assert counts.solved == 16 - len(found)
