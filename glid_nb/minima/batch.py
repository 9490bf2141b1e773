"""Solve many poses of one shape at once, spread over all local devices.

A CPU device solves one pose at a time and then takes the next one. Other devices run their share
of the poses vectorised, in lockstep. A pose whose panels must be split needs the host: it leaves
the batch and is finished by itself.
"""

from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from queue import SimpleQueue
from typing import Any

import numpy as np

from glid_nb._arguments import check_type
from glid_nb._errors import about
from glid_nb._features import solver_jit
from glid_nb._jax import jax, jnp
from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Domain
from glid_nb.minima import search
from glid_nb.pose import Pose, PoseError
from glid_nb.solvers import step
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.line_search import RUNNING
from glid_nb.solvers.loop import Advance, Stopwatch, followed
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import SLOW_ITERATIONS, Newton, NewtonDescent
from glid_nb.solvers.options import Options
from glid_nb.solvers.problem import SubspaceProblem
from glid_nb.solvers.result import Result

# Poses per device and call. The list is short because each size compiles its own program.
_SIZES = (1, 4, 16, 64)
# _MOST_BYTES: memory that the Hessians of one call may take per device.
# _COPIES: Hessian-sized arrays that one pose needs, intermediate ones included.
_MOST_BYTES, _COPIES = 1 << 29, 6


@double_precision
def solve_batch(
    domain: Domain,
    poses: Iterable[Pose],
    energy: Energy | str | None = None,
    options: Options | None = None,
    *,
    devices: Sequence[Any] | None = None,
) -> tuple[Result, ...]:
    """Deform one shape into many poses.

    Equals calling :func:`glid_nb.solve` for each pose, up to rounding. It is faster with several
    devices or with one wide device. The results are in the order of the poses, and each has its own
    proof.

    ``[pose.with_targets(one) for one in targets]`` makes the poses from targets (B, h, 2). Energy
    and options are as in :func:`glid_nb.solve`. The default devices are all local ones. On several
    hosts under ``jax.distributed``, each call uses the devices of its own host, so give every host
    its share of the poses.

    Raises a TypeError when the domain, a pose or the options have the wrong type, or when the
    devices are not one or more different devices of one platform. Raises a PoseError when a handle
    lies outside the domain.
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    energy, options = as_energy(energy), Options() if options is None else options
    checked = _checked_poses(domain, poses)
    if not checked:
        return ()
    devices = _checked_devices(jax.local_devices() if devices is None else devices)
    given = [Inputs(domain=domain, pose=pose, energy=energy, options=options) for pose in checked]
    # A CPU gains nothing from lockstep, because every pose then executes every branch. Also, the
    # thread pool of XLA 0.10 sometimes lost tasks of such programs and waited for them forever.
    alone = devices[0].platform == "cpu"
    groups = [[i] for i in range(len(given))] if alone else lockstep_groups(checked, len(devices))
    free = SimpleQueue[Any]()
    for device in devices:
        free.put(device)

    def solved(group: list[int]) -> list[Result]:
        device, members = free.get(), [given[i] for i in group]
        try:
            with jax.default_device(device):
                if len(members) > 1:
                    return in_lockstep(members)
                return [replace(search.run(Newton(), one), factor=None) for one in members]
        finally:
            free.put(device)

    discretise(domain, options.sampling, options.certificate)  # once for all threads
    pool = ThreadPoolExecutor(len(devices))
    try:
        by_group = zip(groups, pool.map(solved, groups), strict=True)
        found = {i: one for group, made in by_group for i, one in zip(group, made, strict=True)}
    finally:
        pool.shutdown(cancel_futures=True)
    return tuple(found[i] for i in range(len(given)))


def lockstep_groups(poses: Sequence[Pose], shares: int) -> list[list[int]]:
    """Indices of poses that may run in lockstep, each group in so many shares.

    These poses differ in targets only, so they share the rows of the positional energy. A pose with
    wanted angles or scales shares no rows and stays alone.
    """
    groups: list[list[int]] = []
    for i, pose in enumerate(poses):
        known = (group for group in groups if poses[group[0]].same_constraints(pose))
        group = None if pose.oriented.any() else next(known, None)
        if group is None:
            groups.append([i])
        else:
            group.append(i)
    return [group[k::shares] for group in groups for k in range(min(shares, len(group)))]


@double_precision
def in_lockstep(group: list[Inputs]) -> list[Result]:
    """The results of poses of one domain, solved together by one program, as on a GPU."""
    batch = [_Pose(Newton(), inputs) for inputs in group]
    with single_blas_thread():
        compile_time = _run(batch) / max(len(batch), 1)
    return [pose.finished(compile_time) for pose in batch]


def _checked_devices(devices: Any) -> tuple[Any, ...]:
    given = tuple(devices) if isinstance(devices, Iterable) else ()
    are = bool(given) and all(isinstance(device, jax.Device) for device in given)
    if not are or len(set(given)) < len(given) or len({one.platform for one in given}) > 1:
        wanted = "one or more of jax.local_devices(), each of them once and all of one platform"
        raise TypeError(f"devices must be {wanted}, not {devices!r:.200}")
    return given


def _checked_poses(domain: Domain, poses: Any) -> list[Pose]:
    check_type("poses", poses, Iterable, "give a list of glid_nb.Pose")
    checked = list(poses)
    for i, pose in enumerate(checked):
        check_type(f"poses[{i}]", pose, Pose, "give a list of glid_nb.Pose(handles, targets)")
        with about(f"pose {i}", PoseError):
            pose.check_inside(domain)
    return checked


class _Pose(NewtonDescent):
    """The descent of one pose, first in the batch, then by itself if need be."""

    seconds = 0.0  # spent in the batch
    done: Advance | None = None  # the outcome of its last call

    @property
    def goes_on(self) -> bool:
        running = self.done is None or self.done.outcome == RUNNING
        return running and self.left > 0 and len(self.history) < SLOW_ITERATIONS

    def finished(self, compile_time: float) -> Result:
        """The result. If the batch could not finish the pose, its own loop does."""
        watch = Stopwatch()
        with single_blas_thread():
            ending = followed(self, self.done)
        times = compile_time + watch.compiling, self.seconds + watch.seconds
        return search.improve(self.result(ending, *times), self.inputs, self.method)


def _run(poses: list[_Pose]) -> float:
    """Run every pose until it converges or needs the host. Returns the seconds of compiling."""
    running, compile_time = poses, 0.0
    while running:
        unknowns = len(running[0].problem.unknowns.free)
        room = max(_MOST_BYTES // (_COPIES * 8 * unknowns**2), 1)
        sizes = [n for n in _SIZES if n <= room]
        size = next((n for n in sizes if n >= len(running)), sizes[-1])
        now = running[:size]
        compile_time += _call(now, size)
        running = [*running[size:], *(pose for pose in now if pose.goes_on)]
    return compile_time


def _call(chosen: list[_Pose], size: int) -> float:
    first, watch = chosen[0], Stopwatch()
    limits = [int(pose.settings().iterations) for pose in chosen]
    # Padding rows get the iteration limit 0.
    filled = [*chosen, *[first] * (size - len(chosen))]
    state = together(
        first.problem,
        first.settings(),
        jnp.asarray(np.stack([pose.problem.positional.aims for pose in filled])),
        jnp.asarray(np.stack([pose.coefficients for pose in filled])),
        jnp.asarray(np.pad(limits, (0, size - len(chosen)))),
    )
    state = jax.tree.map(np.asarray, state)
    compiling, seconds = watch.compiling, watch.seconds / len(chosen)
    for row, pose in enumerate(chosen):
        pose.done = pose.take(jax.tree.map(lambda a, row=row: a[row], state), seconds)
        pose.seconds += seconds
    return compiling


@solver_jit
def together(
    problem: SubspaceProblem, settings: step.Settings, aims: Any, coefficients: Any, limits: Any
) -> step.State:
    """Some iterations of each pose. The poses are the rows of the last three arguments."""

    def one(goals: Any, start: Any, limit: Any) -> step.State:
        state = step.iterations(
            problem._replace(positional=problem.positional._replace(aims=goals)),
            start,
            jnp.zeros((len(problem.unknowns.free),) * 2),
            settings._replace(iterations=limit),
        )
        # No later call reads the factor, so it is not returned.
        return state._replace(factor=jnp.zeros(()))

    return jax.vmap(one)(aims, coefficients, limits)
