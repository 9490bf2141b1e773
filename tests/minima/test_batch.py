"""Many poses at once give the same maps as one by one, also on several devices."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from typing import Any

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

from ..support.checks import check_certified
from ..support.domains import domain

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])


def targets(count: int) -> np.ndarray:
    moves = np.random.default_rng(0).normal(scale=0.6, size=(count, *HANDLES.shape))
    moves[-1] *= 6  # one hard pose among easy ones
    return HANDLES + moves


@pytest.mark.slow
def test_a_batch_is_the_poses_one_by_one() -> None:
    goals = targets(5)
    depths = np.arange(len(HANDLES))
    results = solve_batch(domain("ell"), [Pose(HANDLES, goal, depths) for goal in goals])
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
        results = batch.in_lockstep(given)
    alone = [solve(ell, Pose(HANDLES, goal)) for goal in goals]
    np.testing.assert_allclose([r.energy for r in results], [r.energy for r in alone], rtol=1e-6)
    for goal, result in zip(goals, results, strict=True):
        check_certified(result)
        np.testing.assert_array_equal(result.pose.targets, goal)


@pytest.mark.slow
def test_poses_of_a_batch_may_have_different_handles() -> None:
    ell, goals = domain("ell"), targets(2)
    poses = [
        Pose(HANDLES, goals[0]),
        Pose(HANDLES[:2], goals[1, :2]),
        Pose(HANDLES, HANDLES, angles=[0.1, None, None]),
        Pose(HANDLES, goals[1]),
    ]
    assert batch.lockstep_groups(poses, 1) == [[0, 3], [1], [2]]
    assert batch.lockstep_groups([poses[0]] * 5, 2) == [[0, 2, 4], [1, 3]]
    for pose, result in zip(poses, solve_batch(ell, poses), strict=True):
        check_certified(result)
        assert result.pose is pose
        assert result.energy == pytest.approx(solve(ell, pose).energy, rel=1e-6)


def test_an_empty_batch() -> None:
    assert solve_batch(domain("ell"), []) == ()


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (Pose(HANDLES, HANDLES), "poses must be Iterable, not Pose; give a list of glid_nb.Pose"),
        ([HANDLES], r"poses\[0\] must be Pose, not ndarray"),
        (3, "poses must be Iterable, not int"),
    ],
)
def test_what_is_no_list_of_poses_is_refused(poses: Any, message: str) -> None:
    with pytest.raises(TypeError, match=message):
        solve_batch(domain("ell"), poses)


def test_a_pose_outside_is_named() -> None:
    poses = [Pose(HANDLES, HANDLES), Pose([[50, 0]], [[0, 0]])]
    with pytest.raises(PoseError, match=r"pose 1: handle 0 at .* lies outside the domain"):
        solve_batch(domain("ell"), poses)


def test_devices_are_different_jax_devices() -> None:
    one = jax.local_devices()[0]
    for devices in ([], ["cpu"], "cpu", [one, one], one, 1):
        with pytest.raises(TypeError, match=r"devices must be one or more of .* each of them once"):
            solve_batch(domain("ell"), [Pose(HANDLES, HANDLES)], devices=devices)


@pytest.mark.slow
def test_the_iteration_limit_holds_for_each_pose() -> None:
    options = Options(max_iterations=2, corrections=0)
    poses = [Pose(HANDLES, goal) for goal in targets(3)]
    results = solve_batch(domain("ell"), poses, options=options)
    assert all(r.status is Status.MAX_ITERATIONS and r.iterations == 2 for r in results)


_ON_TWO_DEVICES = """
import json, sys
import numpy as np
import jax
from glid_nb import Cage, Domain, Options, Pose, enable_compilation_cache, solve_batch
enable_compilation_cache()
data = json.load(sys.stdin)
assert len(jax.local_devices()) == 2
shape = Domain.from_cage(Cage(data["cage"]))
options = Options(restarts=0)
poses = [Pose(data["handles"], targets) for targets in data["targets"]]
both = solve_batch(shape, poses, options=options)
one = solve_batch(shape, poses, options=options, devices=jax.local_devices()[:1])
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
poses = [glid.Pose(given["handles"], targets) for targets in share]
results = glid.solve_batch(shape, poses, options=options)
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
        assert (count, elsewhere) == (2, 1)  # they know each other
        assert certified == [True] * len(goals[host::2])
        poses = [Pose(HANDLES, goal) for goal in goals[host::2]]
        alone = [solve(shape, pose, options=Options(restarts=0)).energy for pose in poses]
        np.testing.assert_allclose(energies, alone, rtol=1e-6)
