"""Many poses of one shape at once, spread over all local devices.

The poses are split over the devices and run through :func:`glid_nb.solvers.step.iterations`, on
CPUs one after the other, elsewhere vectorised, in lockstep. After every call those that have ended
leave the batch, and those that need the host, because a panel must be split for one, are set aside,
so that no device works at a pose longer than that takes; they are finished one by one. The caller
gets all results together, with the last.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type
from glid_nb._jax import jax, jnp, lax
from glid_nb._runtime import (
    COMPILER_OPTIONS,
    compilation_clock,
    double_precision,
    single_blas_thread,
)
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Domain
from glid_nb.solvers import outcome, step
from glid_nb.solvers.loop import Ending, followed, result_of
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import (
    SLOW_ITERATIONS,
    Newton,
    NewtonDescent,
    descend,
    ridge_of,
    settings_of,
)
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose, PoseError
from glid_nb.solvers.problem import Problem
from glid_nb.solvers.restarts import improve
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.status import Status

Array = NDArray[Any]

# Poses per device and call; few sizes, for each compiles a program of its own.
_SIZES = (1, 4, 16, 64)
# Bytes that the Hessians of one call may take per device, with what is made on the way to them.
_MOST_BYTES, _COPIES = 1 << 29, 6


@double_precision
def solve_batch(
    domain: Domain,
    handles: ArrayLike,
    targets: ArrayLike,
    energy: Energy | str | None = None,
    options: Options | None = None,
    devices: Sequence[Any] | None = None,
) -> tuple[Result, ...]:
    """Deform one shape into many poses.

    The same as calling :func:`glid_nb.solve` for each row of targets, up to rounding, and faster
    where there are several devices or one wide one. Every result is certified on its own.

    Parameters
    ----------
    domain : Domain
    handles : (h, 2) array_like
        Points of the domain.
    targets : (B, h, 2) array_like
        Where the handles should go in each of B poses.
    energy, options
        As in :func:`glid_nb.solve`.
    devices : sequence of jax.Device, optional
        By default all local ones. On several hosts under ``jax.distributed`` each call uses the
        devices of its own host; give every host its share of the poses.

    Returns
    -------
    tuple of Result
        In the order of the poses.

    Raises
    ------
    TypeError
        When the domain or the options are of the wrong type, or there is no device.
    PoseError
        When a handle lies outside the domain, or the targets have another shape.
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    energy, options = as_energy(energy), Options() if options is None else options
    poses = _poses(handles, targets)
    if not poses:
        return ()
    poses[0].check_inside(domain)
    devices = tuple(jax.local_devices() if devices is None else devices)
    if not devices or not all(isinstance(device, jax.Device) for device in devices):
        raise TypeError(
            f"devices must be one or more of jax.local_devices(), not {list(devices)!r}"
        )
    inputs = [Inputs(domain=domain, pose=p, energy=energy, options=options) for p in poses]
    batch = [_Pose(given) for given in inputs]
    with single_blas_thread():
        compile_time = _run(batch, devices) / len(batch)
    return tuple(pose.result(compile_time) for pose in batch)


def _poses(handles: ArrayLike, targets: ArrayLike) -> list[Pose]:
    try:
        rows = np.asarray(targets)
    except ValueError as error:
        raise PoseError(f"targets are no array of (poses, handles, 2): {error}") from error
    if rows.ndim != 3 and rows.size:
        raise PoseError(f"targets have shape {rows.shape}; expected (poses, handles, 2)")
    poses = []
    for i, row in enumerate(rows):
        try:
            poses.append(Pose(handles, row))
        except PoseError as error:
            raise PoseError(f"pose {i}: {error}") from error
    return poses


class _Pose:
    """How far one pose has come."""

    def __init__(self, inputs: Inputs) -> None:
        self.inputs, self.descent = inputs, NewtonDescent(Newton(), inputs)
        self.history: list[Iteration] = []
        self.ending: Ending | None = None
        """None while it goes on, or where the batch cannot end it."""
        self.time = 0.0

    def take(self, state: step.State, seconds: float, limit: int) -> bool:
        """Note what a call did; True when the pose goes on in the batch."""
        done = self.descent.take(state, len(self.history), seconds)
        self.descent.factor = None  # it has not come back
        self.history += done.iterations
        self.time += seconds
        if done.outcome == outcome.CONVERGED:
            self.ending = Ending(Status.CONVERGED)
        elif len(self.history) >= limit:
            self.ending = Ending(Status.MAX_ITERATIONS)
        goes_on = self.ending is None and done.outcome == outcome.RUNNING
        return goes_on and len(self.history) < SLOW_ITERATIONS

    def result(self, compile_time: float) -> Result:
        """The result, by a loop of its own where the batch could not end it."""
        ending, clock = self.ending, compilation_clock()
        began, compiling = time.perf_counter(), clock.seconds
        if ending is None:
            with single_blas_thread():
                self.history, ending = followed(self.descent, self.inputs, self.history)
        compiling = clock.seconds - compiling
        seconds = self.time + max(time.perf_counter() - began - compiling, 0.0)
        times = compile_time + compiling, seconds
        first = result_of(self.descent, self.inputs, self.history, ending, *times)
        return improve(first, self.inputs, descend)


def _run(poses: list[_Pose], devices: tuple[Any, ...]) -> float:
    """Bring every pose to its end, or to where it needs a loop of its own; seconds of compiling."""
    unknowns = len(poses[0].descent.problem.unknowns.free)
    room = _MOST_BYTES // (_COPIES * 8 * unknowns**2)
    sizes = [n for n in _SIZES if n <= max(room, 1)]
    running, compile_time = poses, 0.0
    while running:
        each = -(-len(running) // len(devices))
        per_device = next((n for n in sizes if n >= each), sizes[-1])
        now = running[: per_device * len(devices)]
        goes_on, compiling = _call(now, per_device, devices)
        running = [*running[len(now) :], *goes_on]
        compile_time += compiling
    return compile_time


def _call(
    chosen: list[_Pose], per_device: int, devices: tuple[Any, ...]
) -> tuple[list[_Pose], float]:
    """One call for the chosen poses; those that go on, and the seconds of compiling."""
    inputs, descent = chosen[0].inputs, chosen[0].descent
    options, limit = inputs.options, descent.method.limit(inputs.options)
    size = per_device * len(devices)
    rows = dealt(len(chosen), len(devices), per_device)
    # What only fills the batch up stays where it is.
    filled, limits = [chosen[0]] * size, np.zeros(size, dtype=int)
    for row, pose in zip(rows, chosen, strict=True):
        filled[row] = pose
        limits[row] = min(options.iterations_per_call, limit - len(pose.history))
    settings = settings_of(
        options,
        iterations=0,
        may_refine=descent.panels.can_refine,
        ridge=ridge_of(inputs.pose),
        reuse=False,
    )
    program, clock = _program(devices), compilation_clock()
    began, compiling = time.perf_counter(), clock.seconds
    targets = [pose.descent.problem.constraints.targets for pose in filled]
    coefficients = [pose.descent.coefficients for pose in filled]
    state = program(
        descent.problem,
        settings,
        jnp.asarray(np.stack(targets)),
        jnp.asarray(np.stack(coefficients)),
        jnp.asarray(limits),
    )
    state = jax.tree.map(np.asarray, state)
    compiling = clock.seconds - compiling
    seconds = max(time.perf_counter() - began - compiling, 0.0) / len(chosen)
    goes_on = [
        pose
        for row, pose in zip(rows, chosen, strict=True)
        if pose.take(jax.tree.map(lambda a, row=row: a[row], state), seconds, limit)
    ]
    return goes_on, compiling


def dealt(count: int, devices: int, per_device: int) -> Array:
    """The rows of ``count`` poses, dealt out to the devices, each of which has ``per_device``."""
    turn = np.arange(count)
    return turn % devices * per_device + turn // devices


@functools.cache
def _program(devices: tuple[Any, ...]) -> Any:
    """The compiled program for poses on these devices; each device loops on its own."""
    mesh = jax.sharding.Mesh(np.array(devices), ("poses",))
    # A CPU gains nothing from lockstep, in which every pose takes every branch; and the thread pool
    # of XLA 0.10 was seen to lose tasks of such programs and to wait for them for ever.
    in_turn = all(device.platform == "cpu" for device in devices)
    each, shared = jax.P("poses"), jax.P()

    def together(
        problem: Problem, settings: step.Settings, targets: Any, coefficients: Any, limits: Any
    ) -> step.State:
        def one(goals: Any, y: Any, limit: Any) -> step.State:
            state = step.iterations(
                problem._replace(constraints=problem.constraints._replace(targets=goals)),
                y,
                jnp.zeros((len(problem.unknowns.free),) * 2),
                settings._replace(iterations=limit),
            )
            # A factor serves one pose at one time; it need not come back.
            return state._replace(factor=jnp.zeros(()))

        if in_turn:
            return lax.map(lambda pose: one(*pose), (targets, coefficients, limits))
        return jax.vmap(one)(targets, coefficients, limits)

    sharded = jax.shard_map(
        together,
        mesh=mesh,
        in_specs=(shared, shared, each, each, each),
        out_specs=each,
        check_vma=False,
    )
    return jax.jit(sharded, compiler_options=COMPILER_OPTIONS)
