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
from numpy.typing import ArrayLike

from glid_nb._arguments import check_type
from glid_nb._errors import about
from glid_nb._features import solver_jit
from glid_nb._jax import jax, jnp
from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Domain
from glid_nb.minima import search
from glid_nb.pose import Pose, PoseError, Stiffness
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
    handles: ArrayLike,
    targets: ArrayLike,
    energy: Energy | str | None = None,
    options: Options | None = None,
    devices: Sequence[Any] | None = None,
    depths: ArrayLike | None = None,
    angles: ArrayLike | None = None,
    scales: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    stiffness: Any = None,
) -> tuple[Result, ...]:
    """Deform one shape into many poses.

    Equals calling :func:`glid_nb.solve` for each row of targets, up to rounding. It is faster with
    several devices or with one wide device. The results are in the order of the targets, and each
    has its own proof.

    ``handles`` are (h, 2) points of the domain. ``targets`` (B, h, 2) are their desired images in
    each of B poses. Depths, angles, scales and weights, (h,), and the stiffness hold for every
    pose, as in :class:`glid_nb.Pose`. Energy and options are as in :func:`glid_nb.solve`. The
    default devices are all local ones. On several hosts under ``jax.distributed``, each call uses
    the devices of its own host, so give every host its share of the poses.

    Raises a TypeError when the domain or the options have the wrong type, or when the devices are
    not one or more different devices of one platform. Raises a PoseError when a handle lies outside
    the domain, or when the targets have another shape.
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    energy, options = as_energy(energy), Options() if options is None else options
    more: dict[str, Any] = {"depths": depths, "angles": angles, "scales": scales}
    more |= {"weights": weights, "stiffness": Stiffness.of(stiffness)}
    poses = _poses(handles, targets, more)
    if not poses:
        return ()
    poses[0].check_inside(domain)
    devices = _checked_devices(jax.local_devices() if devices is None else devices)
    given = [Inputs(domain=domain, pose=pose, energy=energy, options=options) for pose in poses]
    # A CPU gains nothing from lockstep, because every pose then executes every branch. Also, the
    # thread pool of XLA 0.10 sometimes lost tasks of such programs and waited for them forever.
    # With wanted angles or scales, the poses do not share the rows of the positional energy.
    alone = devices[0].platform == "cpu" or poses[0].turned.any()
    count, free = len(devices), SimpleQueue[Any]()
    groups = [[inputs] for inputs in given] if alone else [given[i::count] for i in range(count)]
    for device in devices:
        free.put(device)

    def solved(group: list[Inputs]) -> list[Result]:
        device = free.get()
        try:
            with jax.default_device(device):
                if not alone:
                    return _in_lockstep(group)
                return [replace(search.run(Newton(), inputs), factor=None) for inputs in group]
        finally:
            free.put(device)

    discretise(domain, options.sampling, options.certificate)  # once for all threads
    pool = ThreadPoolExecutor(count)
    try:
        by_group = list(pool.map(solved, groups))
    finally:
        pool.shutdown(cancel_futures=True)
    return tuple(by_group[i % len(groups)][i // len(groups)] for i in range(len(given)))


@double_precision
def _in_lockstep(group: list[Inputs]) -> list[Result]:
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


def _poses(handles: ArrayLike, targets: ArrayLike, more: dict[str, Any]) -> list[Pose]:
    try:
        rows = np.asarray(targets)
    except ValueError as error:
        raise PoseError(f"targets are not an array of (poses, handles, 2): {error}") from error
    if rows.ndim != 3 and rows.size:
        raise PoseError(f"targets have shape {rows.shape}; expected (poses, handles, 2)")
    poses = []
    for i, row in enumerate(rows):
        with about(f"pose {i}", PoseError):
            poses.append(Pose(handles, row, **more))
    return poses


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
    state = _together(
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
def _together(
    problem: SubspaceProblem, settings: step.Settings, aims: Any, coefficients: Any, limits: Any
) -> step.State:
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
