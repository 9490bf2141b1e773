"""Processes of this machine: one is killed in the middle."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest

from glid_nb.many import solve_many
from glid_nb.pose import Pose

from ..support.domains import domain

pytestmark = pytest.mark.slow

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
KILL = getattr(signal, "SIGKILL", signal.SIGTERM)


def test_a_killed_process_costs_its_problems_only_once_more(tmp_path: Path) -> None:
    moves = np.random.default_rng(0).normal(scale=0.3, size=(16, *HANDLES.shape))
    problems = [(domain("ell"), Pose(HANDLES, HANDLES + move)) for move in moves]
    problems[10] = domain("ell"), Pose([[50, 0]], [[0, 0]])
    others = multiprocessing.active_children()
    many = solve_many(problems, executor=2, folder=tmp_path)
    found = [next(many)]
    ours = [one for one in multiprocessing.active_children() if one not in others]
    assert len(ours) == 2
    os.kill(ours[0].pid, KILL)
    found += many
    assert sorted(one.index for one in found) == list(range(16))
    assert [one.index for one in found if one.error] == [10]
    for one in found:
        if one.result:
            assert one.result.certificate.certified
            assert one.result.map.domain is domain("ell")
            np.testing.assert_allclose(one.result.map(HANDLES), one.result.pose.targets, atol=1e-3)
    assert len(list(tmp_path.glob("*/*"))) == 15
    left = [one for one in multiprocessing.active_children() if one not in others]
    assert not left


ENDLESS = """
import itertools, multiprocessing, sys
import glid_nb as glid
if __name__ == "__main__":
    domain = glid.Domain.from_cage(glid.Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    problem = domain, glid.Pose([[1, 1], [3, 1]], [[1, 1], [3, 1.2]])
    many = glid.solve_many(itertools.repeat(problem), executor=1)
    next(many)
    print(*(one.pid for one in multiprocessing.active_children()), flush=True)
    sys.stdin.read()
"""


def test_processes_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(ENDLESS, encoding="utf-8")
    pipes: Any = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, str(script)], text=True, **pipes) as parent:
        workers = [psutil.Process(int(pid)) for pid in parent.stdout.readline().split()]
        parent.kill()
    assert len(workers) == 1
    _, alive = psutil.wait_procs(workers, timeout=60)
    assert not alive


UNGUARDED = """
import glid_nb as glid
domain = glid.Domain.from_cage(glid.Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
problem = domain, glid.Pose([[1, 1], [3, 1]], [[1, 1], [3, 1.2]])
print(list(glid.solve_many([problem], executor=1)))
"""


def test_a_script_without_a_guard_is_told_so(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=250, check=False
    )
    assert done.returncode == 1
    assert "ExecutorLostError: the processes end before they answer anything" in done.stderr
    assert "needs `if __name__ == '__main__':`" in done.stderr
