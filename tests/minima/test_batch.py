"""Many poses at once: the same maps as one by one, on several devices too."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Callable

import jax
import numpy as np
import pytest

from glid_nb._features import enable_x64
from glid_nb.energies import as_energy
from glid_nb.geometry import Domain
from glid_nb.minima import batch, solve, solve_batch
from glid_nb.pose import Pose, PoseError
from glid_nb.solvers import Options, Status
from glid_nb.solvers.method import Inputs

from ..domains import domain
from ..solvers.checks import check_certified

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])


def targets(count: int) -> np.ndarray:
    moves = np.random.default_rng(0).normal(scale=0.6, size=(count, *HANDLES.shape))
    moves[-1] *= 6  # one hard pose among easy ones
    return HANDLES + moves


@pytest.mark.slow
def test_a_batch_is_the_poses_one_by_one() -> None:
    goals = targets(5)
    depths = np.arange(len(HANDLES))
    results = solve_batch(domain("ell"), HANDLES, goals, depths=depths)
    assert len(results) == 5
    for goal, result in zip(goals, results, strict=True):
        alone = solve(domain("ell"), Pose(HANDLES, goal))
        assert result.status.ok
        assert result.energy == pytest.approx(alone.energy, rel=1e-6)
        check_certified(result)
        np.testing.assert_array_equal(result.pose.targets, goal)
        np.testing.assert_array_equal(result.pose.depths, depths)
        numbers = [entry.iteration for entry in result.history]
        assert numbers == list(range(1, len(numbers) + 1))


@pytest.mark.slow
def test_poses_in_lockstep_are_the_poses_one_by_one() -> None:
    """As a GPU runs them."""
    ell, goals = domain("ell"), targets(3)
    given = [
        Inputs(domain=ell, pose=Pose(HANDLES, goal), energy=as_energy(None), options=Options())
        for goal in goals
    ]
    with enable_x64():
        results = batch._in_lockstep(given)
    alone = [solve(ell, Pose(HANDLES, goal)) for goal in goals]
    np.testing.assert_allclose([r.energy for r in results], [r.energy for r in alone], rtol=1e-6)
    for goal, result in zip(goals, results, strict=True):
        check_certified(result)
        np.testing.assert_array_equal(result.pose.targets, goal)


def test_an_empty_batch() -> None:
    for none in (np.zeros((0, 3, 2)), []):
        assert solve_batch(domain("ell"), HANDLES, none) == ()


def test_ragged_targets_are_refused() -> None:
    with pytest.raises(PoseError, match=r"targets are not an array of \(poses, handles, 2\)"):
        solve_batch(domain("ell"), HANDLES, [[[0, 0]], [[0, 0], [1, 1]]])


def test_devices_are_different_jax_devices() -> None:
    one = jax.local_devices()[0]
    for devices in ([], ["cpu"], "cpu", [one, one], one, 1):
        with pytest.raises(TypeError, match=r"devices must be one or more of .* each of them once"):
            solve_batch(domain("ell"), HANDLES, targets(1), devices=devices)


@pytest.mark.slow
def test_the_iteration_limit_holds_for_each_pose() -> None:
    options = Options(max_iterations=2, corrections=0)
    results = solve_batch(domain("ell"), HANDLES, targets(3), options=options)
    assert all(r.status is Status.MAX_ITERATIONS and r.iterations == 2 for r in results)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t[0], r"targets have shape \(3, 2\)"),
        (lambda t: t[:, :2], "pose 0: there are 3 handles but 2 targets"),
        (lambda t: np.where(np.arange(2)[:, None, None] == 1, np.nan, t), r"pose 1: targets\[0\]"),
    ],
)
def test_bad_targets_are_refused(change: Callable[[np.ndarray], np.ndarray], message: str) -> None:
    with pytest.raises(PoseError, match=message):
        solve_batch(domain("ell"), HANDLES, change(targets(2)))


_ON_TWO_DEVICES = """
import json, sys
import numpy as np
import jax
from glid_nb import Cage, Domain, Options, enable_compilation_cache, solve_batch
enable_compilation_cache()
data = json.load(sys.stdin)
assert len(jax.local_devices()) == 2
shape = Domain.from_cage(Cage(data["cage"]))
options = Options(restarts=0)
both = solve_batch(shape, data["handles"], data["targets"], options=options)
one = solve_batch(
    shape, data["handles"], data["targets"], options=options, devices=jax.local_devices()[:1]
)
print(json.dumps([[[r.energy for r in some], [r.certificate.certified for r in some]]
                  for some in (both, one)]))
"""


@pytest.mark.slow
def test_two_devices_find_what_one_finds() -> None:
    given = {
        "cage": domain("ell").cage.exterior.tolist(),
        "handles": HANDLES.tolist(),
        "targets": targets(3)[:2].tolist(),
    }
    run = subprocess.run(
        [sys.executable, "-c", _ON_TWO_DEVICES],
        input=json.dumps(given),
        env={
            **os.environ,
            "XLA_FLAGS": "--xla_force_host_platform_device_count=2",
        },
        capture_output=True,
        text=True,
        check=True,
    )
    (both, certified), (one, _) = json.loads(run.stdout)
    assert certified == [True, True]
    np.testing.assert_allclose(both, one, rtol=1e-9)


_ON_ONE_OF_TWO_HOSTS = """
import json, sys
given = json.load(sys.stdin)
import jax
jax.distributed.initialize(given["coordinator"], num_processes=2, process_id=given["host"])
import glid_nb as glid
glid.enable_compilation_cache()
shape = glid.Domain.from_cage(glid.Cage(given["exterior"], given["holes"]))
share = given["targets"][jax.process_index()::jax.process_count()]
options = glid.Options(restarts=0)
results = glid.solve_batch(shape, given["handles"], share, options=options)
print(json.dumps([
    jax.process_count(),
    len(jax.devices()) - len(jax.local_devices()),
    [result.energy for result in results],
    [result.certificate.certified for result in results],
]))
"""


@pytest.mark.slow
def test_under_jax_distributed_every_host_solves_its_share() -> None:
    shape, goals = Domain.from_cage(domain("ell").cage), targets(4)[:3]
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    hosts = []
    for host in range(2):
        given = {
            "coordinator": f"127.0.0.1:{port}",
            "host": host,
            "exterior": shape.cage.exterior.tolist(),
            "holes": [hole.tolist() for hole in shape.cage.holes],
            "handles": HANDLES.tolist(),
            "targets": goals.tolist(),
        }
        process = subprocess.Popen(
            [sys.executable, "-c", _ON_ONE_OF_TWO_HOSTS],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert process.stdin is not None
        process.stdin.write(json.dumps(given))
        process.stdin.close()
        hosts.append(process)
    shares = []
    for process in hosts:
        assert process.stdout is not None
        with process:
            shares.append(json.loads(process.stdout.read()))
        assert process.returncode == 0
    for host, (count, elsewhere, energies, certified) in enumerate(shares):
        assert (count, elsewhere) == (2, 1)  # they know of one another
        assert certified == [True] * len(goals[host::2])
        poses = [Pose(HANDLES, goal) for goal in goals[host::2]]
        alone = [solve(shape, pose, options=Options(restarts=0)).energy for pose in poses]
        np.testing.assert_allclose(energies, alone, rtol=1e-6)
