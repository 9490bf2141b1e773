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
from dataclasses import dataclass, field, replace
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
from glid_nb.solvers import outcome, step
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import (
    SLOW_ITERATIONS,
    Newton,
    descend,
    entries,
    ridge_of,
    settings_of,
    start_of,
    variant_of,
)
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose, PoseError
from glid_nb.solvers.problem import Problem, constraints_of, map_from, real_coefficients
from glid_nb.solvers.restarts import improve
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.start import aligned
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
    return tuple(map(batch.finished, batch.poses, batch.inputs))


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


@dataclass(eq=False)
class _Progress:
    """How far one pose has come."""

    coefficients: Array
    targets: Array
    initial: Iteration | None = None
    energy_iso: float = np.nan
    energy_p2p: float = np.nan
    history: list[Iteration] = field(default_factory=list)
    status: Status | None = None
    """None while it goes on, or where the batch cannot end it."""
    time: float = 0.0


class _Batch:
    """All poses on the host."""

    def __init__(
        self,
        domain: Domain,
        poses: list[Pose],
        energy: Energy,
        options: Options,
        devices: tuple[Any, ...],
    ) -> None:
        self.options, self.devices, self.compile_time = options, devices, 0.0
        self.limit = Newton().limit(options)
        self.inputs = [
            Inputs(domain=domain, pose=pose, energy=energy, options=options) for pose in poses
        ]
        disc = self.discretisation = discretise(domain, options.sampling, options.certificate)
        constraints = constraints_of(domain, poses[0], options.p2p_weight)
        self.problem = Problem(
            matrices=disc.matrices,
            singularities=disc.basis.singularities,
            unknowns=reduced_unknowns(disc.basis, options.conformal),
            constraints=constraints,
            energy=energy,
        )
        identity = HarmonicMap.identity(domain)
        images = identity(poses[0].handles) if options.align else None
        self.poses = []
        for pose in poses:
            start = aligned(identity, pose, images) if options.align else identity
            targets = np.zeros(constraints.targets.shape)
            targets[: len(pose)] = pose.targets
            self.poses.append(_Progress(real_coefficients(disc.basis, start), targets))

    def run(self) -> None:
        """Bring every pose to its end, or to where it needs a solve of its own."""
        room = _MOST_BYTES // (_COPIES * 8 * len(self.problem.unknowns.free) ** 2)
        sizes = [n for n in _SIZES if n <= max(room, 1)]
        running = self.poses
        while running:
            each = -(-len(running) // len(self.devices))
            per_device = next((n for n in sizes if n >= each), sizes[-1])
            now = running[: per_device * len(self.devices)]
            goes_on = self._call(now, per_device * len(self.devices))
            running = [*running[len(now) :], *goes_on]

    def _call(self, chosen: list[_Progress], size: int) -> list[_Progress]:
        """One call for the chosen poses; returns those that go on."""
        options = self.options
        rows = dealt(len(chosen), len(self.devices), size // len(self.devices))
        # What only fills the batch up stays where it is.
        filled, limits = [chosen[0]] * size, np.zeros(size, dtype=int)
        for row, pose in zip(rows, chosen, strict=True):
            filled[row] = pose
            limits[row] = min(options.iterations_per_call, self.limit - len(pose.history))
        settings = settings_of(
            options,
            iterations=0,
            may_refine=self.discretisation.can_refine,
            ridge=ridge_of(self.inputs[0].pose),
            reuse=False,
        )
        program, clock = _program(self.devices, variant_of(options)), compilation_clock()
        began, compiling = time.perf_counter(), clock.seconds
        state = program(
            self.problem,
            settings,
            jnp.asarray(np.stack([pose.targets for pose in filled])),
            jnp.asarray(np.stack([pose.coefficients for pose in filled])),
            jnp.asarray(limits),
        )
        state = jax.tree.map(np.asarray, state)
        compiling = clock.seconds - compiling
        seconds = max(time.perf_counter() - began - compiling, 0.0) / len(chosen)
        self.compile_time += compiling
        return [
            pose
            for row, pose in zip(rows, chosen, strict=True)
            if self._record(pose, jax.tree.map(lambda a, row=row: a[row], state), seconds)
        ]

    def _record(self, pose: _Progress, state: step.State, seconds: float) -> bool:
        """Note what a call did for a pose; True when it goes on."""
        end, taken = int(state.outcome), int(state.iteration)
        pose.coefficients = np.asarray(state.point.coefficients)
        pose.energy_iso, pose.energy_p2p = (
            float(part) for part in (state.point.energy_iso, state.point.energy_p2p)
        )
        if pose.initial is None:
            pose.initial = start_of(state)
        panels = len(self.discretisation.panels)
        pose.history += entries(state.records, taken, len(pose.history), panels, 0, seconds)
        pose.time += seconds
        if end == outcome.CONVERGED:
            pose.status = Status.CONVERGED
        elif len(pose.history) >= self.limit:
            pose.status = Status.MAX_ITERATIONS
        goes_on = pose.status is None and end == outcome.RUNNING
        return goes_on and len(pose.history) < SLOW_ITERATIONS

    def finished(self, pose: _Progress, inputs: Inputs) -> Result:
        """The result of a pose, by a solve of its own where the batch could not end it."""
        assert pose.initial is not None
        first = Result(
            map=map_from(self.discretisation, pose.coefficients),
            status=Status.STOPPED if pose.status is None else pose.status,
            energy_iso=pose.energy_iso,
            energy_p2p=pose.energy_p2p,
            initial=pose.initial,
            history=tuple(pose.history),
            pose=inputs.pose,
            options=inputs.options,
            energy_measure=inputs.energy,
            method=Newton(),
            compile_time=self.compile_time / len(self.poses),
            solve_time=pose.time,
            discretisation=self.discretisation,
        )
        if pose.status is None:
            first = self._continued(first, inputs)
        return improve(first, inputs, descend)

    def _continued(self, first: Result, inputs: Inputs) -> Result:
        """A result of the batch, solved to its end."""
        done = len(first.history)
        rest = replace(inputs.options, align=False, max_iterations=self.limit - done)
        last = descend(replace(inputs, options=rest, start=first))
        later = tuple(replace(e, iteration=e.iteration + done) for e in last.history)
        return replace(
            last,
            options=inputs.options,
            initial=first.initial,
            history=first.history + later,
            compile_time=first.compile_time + last.compile_time,
            solve_time=first.solve_time + last.solve_time,
        )


def dealt(count: int, devices: int, per_device: int) -> Array:
    """The rows of ``count`` poses, dealt out to the devices, each of which has ``per_device``."""
    turn = np.arange(count)
    return turn % devices * per_device + turn // devices


@functools.cache
def _program(devices: tuple[Any, ...], variant: step.Variant) -> Any:
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
                variant=variant,
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
