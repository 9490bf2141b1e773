"""Forked processes are refused where JAX would hang, and work elsewhere."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        "fork" not in multiprocessing.get_all_start_methods(), reason="no processes are forked here"
    ),
]

# It runs in a process of its own, because a fork of the tests' process would be refused.
SCRIPT = """
import multiprocessing, warnings
import numpy as np
import glid_nb as glid
warnings.simplefilter("ignore")  # JAX and Python warn of forks, too
glid.enable_compilation_cache() if {cached} else None
domain = glid.Domain.from_cage(glid.Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
pose = glid.Pose([[1, 1], [3, 1]], [[1, 1], [3, 1.1]])

def work(what):
    try:
        if what == "solve":
            return glid.solve(domain, pose, options=glid.Options(restarts=0)).status.value
        if what == "batch":
            return len(glid.solve_batch(domain, [pose]))
        if what == "bdhm":
            return glid.solve(domain, pose, "arap", method=glid.methods.BDHM()).status.value
        map = glid.HarmonicMap.identity(domain)
        images = map(np.random.default_rng(0).random((20_000, 2)))
        map.wirtinger(np.random.default_rng(0).random((20_000, 2)))
        return f"{{images.shape}} {{glid.certify(map).certified}}"
    except glid.InputError as error:
        return f"{{type(error).__name__}}: {{error}}"

{before}
with multiprocessing.get_context("fork").Pool(1) as pool:
    for what in {asked}:
        print(pool.map_async(work, [what]).get({seconds})[0], flush=True)
"""


def answers(before: str, asked: list[str], cached: bool = True) -> list[str]:
    script = SCRIPT.format(before=before, asked=asked, cached=cached, seconds=200)
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=240, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.mark.parametrize(
    "before",
    ["glid.solve(domain, pose, options=glid.Options(restarts=0))", "import jax; jax.numpy.ones(3)"],
    ids=["the package", "the user"],
)
def test_a_fork_of_a_process_that_ran_jax_is_refused_at_once(before: str) -> None:
    asked = ["solve", "batch", "bdhm", "map"]
    *refused, allowed = answers(before, asked)
    for answer in refused:
        assert answer.startswith("ForkError: this process was forked from one that had run JAX")
        assert '"spawn") or "forkserver"' in answer
    assert allowed == "(20000, 2) True"


@pytest.mark.parametrize("before", ["", "import jax"])
def test_a_fork_of_a_process_that_never_ran_jax_solves(before: str) -> None:
    # The cache is JAX's setting, so the package asks JAX for it.
    assert answers(before, ["map", "solve"], cached=False) == ["(20000, 2) True", "converged"]
