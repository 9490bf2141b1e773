"""Many poses of one shape at once, spread over all local devices.

The poses are split over the devices and run through :func:`glid_nb.solvers.newton.iterations`, on
CPUs one after the other, elsewhere vectorised, in lockstep. After every call those that have ended
leave the batch, and those that need the host, because a panel must be split for one, are set aside,
so that no device works at a pose longer than that takes; they are finished one by one. The caller
gets all results together, with the last.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Sequence
from dataclasses import replace
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
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import newton, outcome
from glid_nb.solvers.align import aligned
from glid_nb.solvers.discretisation import Discretisation, discretise
from glid_nb.solvers.evaluation import Constraints
from glid_nb.solvers.history import entries
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose, PoseError
from glid_nb.solvers.restarts import improve
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.solve import (
    SLOW_ITERATIONS,
    capacity_for,
    constraints_of,
    descend,
    map_from,
    real_coefficients,
    ridge_of,
)
from glid_nb.solvers.status import Status
from glid_nb.solvers.unknowns import reduced_unknowns

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
    batch = _Batch(domain, poses, energy, options, devices)
    with single_blas_thread():
        batch.run()
    return tuple(batch.finished(i) for i in range(len(poses)))


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


class _Batch:
    """The state of all poses on the host."""

    def __init__(
        self,
        domain: Domain,
        poses: list[Pose],
        energy: Energy,
        options: Options,
        devices: tuple[Any, ...],
    ) -> None:
        self.domain, self.poses, self.energy = domain, poses, energy
        self.options, self.devices = options, devices
        self.discretisation: Discretisation = discretise(
            domain, options.sampling, options.certificate
        )
        basis = self.discretisation.basis
        self.constraints = constraints_of(domain, poses[0], options.p2p_weight)
        self.unknowns = reduced_unknowns(basis, options.conformal)
        identity = HarmonicMap.identity(domain)
        images = identity(poses[0].handles) if options.align else None
        starts = [aligned(identity, p, images) if options.align else identity for p in poses]
        self.coefficients = np.stack([real_coefficients(basis, start) for start in starts])
        self.targets = np.zeros((len(poses), *self.constraints.targets.shape))
        for padded, pose in zip(self.targets, poses, strict=True):
            padded[: len(pose)] = pose.targets
        self.status: list[Status | None] = [None] * len(poses)
        self.energies = np.full((len(poses), 2), np.nan)
        self.start_energy = np.full(len(poses), np.nan)
        self.histories: list[list[Iteration]] = [[] for _ in poses]
        self.compile_time, self.time = 0.0, np.zeros(len(poses))

    def run(self) -> None:
        """Bring every pose to its end, or to where it needs a solve of its own."""
        room = _MOST_BYTES // (_COPIES * 8 * len(self.unknowns.free) ** 2)
        sizes = [n for n in _SIZES if n <= max(room, 1)]
        running = list(range(len(self.poses)))
        while running:
            each = -(-len(running) // len(self.devices))
            per_device = next((n for n in sizes if n >= each), sizes[-1])
            now = running[: per_device * len(self.devices)]
            goes_on = self._call(now, per_device * len(self.devices))
            running = [*running[len(now) :], *goes_on]

    def _call(self, chosen: list[int], size: int) -> list[int]:
        """One call for the chosen poses; returns those that go on."""
        options = self.options
        rows = dealt(len(chosen), len(self.devices), size // len(self.devices))
        # What only fills the batch up stays where it is.
        index, limits = np.full(size, chosen[0]), np.zeros(size, dtype=int)
        index[rows] = chosen
        left = [options.max_iterations - len(self.histories[i]) for i in chosen]
        limits[rows] = np.minimum(options.iterations_per_call, left)
        settings = newton.Settings(
            np.asarray(options.tolerance),
            np.asarray(0),
            np.asarray(self.discretisation.can_refine),
            np.asarray(ridge_of(self.poses[0])),
            np.asarray(False),
            np.asarray(options.corrections),
        )
        program = _program(
            self.devices,
            options.hessian,
            capacity_for(options.iterations_per_call),
        )
        clock = compilation_clock()
        began, compiling = time.perf_counter(), clock.seconds
        state = program(
            self.discretisation.matrices,
            self.discretisation.basis.singularities,
            self.unknowns,
            self.constraints,
            self.energy,
            settings,
            jnp.asarray(self.targets[index]),
            jnp.asarray(self.coefficients[index]),
            jnp.asarray(limits),
        )
        state = jax.tree.map(np.asarray, state)
        compiling = clock.seconds - compiling
        seconds = max(time.perf_counter() - began - compiling, 0.0) / len(chosen)
        self.compile_time += compiling
        return [
            i
            for row, i in zip(rows, chosen, strict=True)
            if self._record(i, jax.tree.map(lambda a, row=row: a[row], state), seconds)
        ]

    def _record(self, i: int, state: newton.State, seconds: float) -> bool:
        """Note what a call did for pose ``i``; True when it goes on."""
        history, end, taken = self.histories[i], int(state.outcome), int(state.iteration)
        self.coefficients[i] = state.coefficients
        self.energies[i] = state.energy_iso, state.energy_p2p
        if not history:
            self.start_energy[i] = state.start_energy
        panels = len(self.discretisation.panels)
        history += entries(state.records, taken, len(history), panels, 0, seconds)
        self.time[i] += seconds
        if end == outcome.CONVERGED:
            self.status[i] = Status.CONVERGED
        elif len(history) >= self.options.max_iterations:
            self.status[i] = Status.MAX_ITERATIONS
        return self.status[i] is None and end == outcome.RUNNING and len(history) < SLOW_ITERATIONS

    def finished(self, i: int) -> Result:
        """The result of pose ``i``, by a solve of its own where the batch could not end it."""
        status = self.status[i]
        iso, p2p = (float(part) for part in self.energies[i])
        first = Result(
            map_from(self.discretisation, self.coefficients[i]),
            Status.STOPPED if status is None else status,
            iso + p2p,
            iso,
            p2p,
            tuple(self.histories[i]),
            self.poses[i],
            self.options,
            self.energy,
            self.discretisation,
            self.compile_time / len(self.poses),
            float(self.time[i]),
            start_energy=float(self.start_energy[i]),
        )
        alone = functools.partial(descend, self.domain)
        if status is None:
            done = len(first.history)
            rest = replace(
                self.options, align=False, max_iterations=self.options.max_iterations - done
            )
            last = alone(self.poses[i], self.energy, rest, first)
            later = tuple(replace(e, iteration=e.iteration + done) for e in last.history)
            first = replace(
                last,
                options=self.options,
                history=first.history + later,
                compile_time=first.compile_time + last.compile_time,
                solve_time=first.solve_time + last.solve_time,
                start_energy=first.start_energy,
            )
        return improve(first, alone, None)


def dealt(count: int, devices: int, per_device: int) -> Array:
    """The rows of ``count`` poses, dealt out to the devices, each of which has ``per_device``."""
    turn = np.arange(count)
    return turn % devices * per_device + turn // devices


@functools.cache
def _program(devices: tuple[Any, ...], hessian: Any, capacity: int) -> Any:
    """The compiled program for poses on these devices; each device loops on its own."""
    mesh = jax.sharding.Mesh(np.array(devices), ("poses",))
    # A CPU gains nothing from lockstep, in which every pose takes every branch; and the thread pool
    # of XLA 0.10 was seen to lose tasks of such programs and to wait for them for ever.
    in_turn = all(device.platform == "cpu" for device in devices)
    each, shared = jax.P("poses"), jax.P()

    def together(
        matrices: Any,
        singularities: Any,
        unknowns: Any,
        constraints: Constraints,
        energy: Energy,
        settings: newton.Settings,
        targets: Any,
        coefficients: Any,
        limits: Any,
    ) -> newton.State:
        def one(goals: Any, y: Any, limit: Any) -> newton.State:
            state = newton.iterations(
                matrices,
                singularities,
                unknowns,
                constraints._replace(targets=goals),
                energy,
                y,
                jnp.zeros((len(unknowns.free),) * 2),
                settings._replace(iterations=limit),
                hessian=hessian,
                capacity=capacity,
            )
            # A factor serves one pose at one time; it need not come back.
            return state._replace(factor=jnp.zeros(()))

        if in_turn:
            return lax.map(lambda pose: one(*pose), (targets, coefficients, limits))
        return jax.vmap(one)(targets, coefficients, limits)

    sharded = jax.shard_map(
        together,
        mesh=mesh,
        in_specs=(*[shared] * 6, each, each, each),
        out_specs=each,
        check_vma=False,
    )
    return jax.jit(sharded, compiler_options=COMPILER_OPTIONS)
