"""Solving for a deformation: the host's side of Newton's method (paper Algorithm 1)."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._arguments import check_type
from glid_nb._jax import jit, jnp
from glid_nb._runtime import compilation_clock, double_precision, single_blas_thread
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.harmonic.basis import Basis
from glid_nb.solvers import newton, outcome
from glid_nb.solvers.align import aligned
from glid_nb.solvers.discretisation import Discretisation, basis_rows, discretise, padded
from glid_nb.solvers.evaluation import Constraints
from glid_nb.solvers.history import entries
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose
from glid_nb.solvers.restarts import improve
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.start import StartError, check_belongs, check_proved
from glid_nb.solvers.status import Status
from glid_nb.solvers.unknowns import canonical, reduced_unknowns

Array = NDArray[Any]

_HANDLE_BUCKET = 8
# Without two handles a rotation costs nothing and the Hessian is singular (Appendix I).
_RIDGE, _LARGEST_RIDGE = 1e-9, 1e-2
_RIDGE_FACTOR = 100.0
# How often panels are split in a row before a shorter step is tried instead, and in all before a
# solve that gets nowhere ends.
_PATIENCE = 3
_MOST_ROUNDS = 40
# When to put the Hessian on all nodes: many iterations, or a short step that gains little.
SLOW_ITERATIONS = 20
_SLOW_STEP, _SLOW_GAIN = 0.5, 0.05
# Steps in a row that together gain less than this fraction of the energy end a solve.
_STALLED, _STALL_GAIN = 4, 1e-10
# A decrease promised by the Newton decrement that rounding of the energy can hide.
_ROUNDING = 1e-8


@dataclass(frozen=True, eq=False)
class Progress:
    """What a callback sees between calls."""

    history: tuple[Iteration, ...]
    """All iterations so far."""
    sigma2_lower: Array
    """(p,) certified bound per panel."""
    discretisation: Discretisation
    _coefficients: Any

    @property
    def map(self) -> HarmonicMap:
        """The certified map of this moment."""
        return map_from(self.discretisation, self._coefficients)


Callback = Callable[[Progress], bool | None]


@double_precision
def solve(
    domain: Domain,
    pose: Pose,
    energy: Energy | str | None = None,
    options: Options | None = None,
    start: HarmonicMap | Result | None = None,
    callback: Callback | None = None,
) -> Result:
    """Deform a domain so that its handles go to their targets with the least distortion.

    Minimises (20) by Newton's method from a certified map. Every step is proved locally
    injective before it is taken, so the result always is: when no certified step lowers the
    energy, the last map is returned with a status that says so.

    Parameters
    ----------
    domain : Domain
    pose : Pose
        Handles, which must lie in the domain, and their targets, which may be anywhere.
    energy : Energy or str, optional
        Isometric energy, or the name of one with its default parameter ("iso", "exp", "amips",
        "mips", "arap"); by default the symmetric Dirichlet energy.
    options : Options, optional
    start : HarmonicMap or Result, optional
        Where to start; by default the identity. Unless ``options.align`` is off, the start is
        first moved rigidly towards the targets. The result of an earlier solve on the same domain
        also passes on its panels.
    callback : callable, optional
        Called with a :class:`Progress` between compiled calls, also after those that took no step
        because panels must be split first; returning ``True`` stops the solve.

    Raises
    ------
    TypeError
        When an argument is of the wrong type; the message names it.
    PoseError
        When a handle lies outside the domain.
    EnergyError
        When the energy's name is unknown, or it is no energy at all.
    StartError
        When the starting map belongs to another domain, is not conformal though the options ask
        for it, or is not proved locally injective.
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    check_type("pose", pose, Pose, "make one with Pose(handles, targets)")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    check_type("start", start, HarmonicMap | Result | None, "an earlier result or its map")
    check_type("callback", callback, Callable | None, "a function of a Progress")
    energy = as_energy(energy)
    options = Options() if options is None else options
    pose.check_inside(domain)
    first = descend(domain, pose, energy, options, start, callback)
    if start is not None:
        return first
    return improve(first, functools.partial(descend, domain), callback)


@double_precision
def descend(
    domain: Domain,
    pose: Pose,
    energy: Energy,
    options: Options,
    start: HarmonicMap | Result | None = None,
    callback: Callback | None = None,
) -> Result:
    """One descent from one map to the local minimum that it leads to."""
    clock = compilation_clock()
    compiling, began = clock.seconds, time.perf_counter()
    loop = _Loop(domain, pose, energy, options, start)
    with single_blas_thread():
        status = loop.run(callback)
    elapsed, compiling = time.perf_counter() - began, clock.seconds - compiling
    return Result(
        map_from(loop.discretisation, loop.coefficients),
        status,
        loop.energy_iso + loop.energy_p2p,
        loop.energy_iso,
        loop.energy_p2p,
        tuple(loop.history),
        pose,
        options,
        energy,
        loop.discretisation,
        compiling,
        max(elapsed - compiling, 0.0),
        start_energy=loop.start_energy,
        factor=loop.factor if status is Status.CONVERGED else None,
    )


class _Loop:
    """The state of one solve on the host."""

    def __init__(
        self,
        domain: Domain,
        pose: Pose,
        energy: Energy,
        options: Options,
        start: HarmonicMap | Result | None,
    ) -> None:
        self.options, self.energy, self.pose = options, energy, pose
        map_, self.discretisation = _starting_point(domain, options, start)
        self.matrices = self.discretisation.matrices
        basis = self.discretisation.basis
        self.unknowns = reduced_unknowns(basis, options.conformal)
        self.constraints = constraints_of(domain, pose, options.p2p_weight)
        self.ridge = ridge_of(pose)
        if options.align:
            map_ = aligned(map_, pose, handle_images(self.constraints, basis, map_)[: len(pose)])
        self.coefficients: Any = real_coefficients(basis, map_)
        self.history: list[Iteration] = []
        self.energy_iso = self.energy_p2p = np.nan
        self.just_split = 0
        self.full_since: int | None = None
        self.start_energy = np.nan
        self.factor: Any
        if isinstance(start, Result) and options.corrections and self._fits(start):
            # The result keeps its own.
            self.factor, self.reuse = jnp.array(start.factor, copy=True), True
        else:
            self.factor, self.reuse = _no_factor(len(self.unknowns.free)), False

    def _fits(self, start: Result) -> bool:
        """Whether the last Hessian of an earlier solve is one of this problem's."""
        mine, theirs = self.options, start.options
        return (
            start.factor is not None
            and start.discretisation is self.discretisation
            and start.energy_measure == self.energy
            and np.array_equal(start.pose.handles, self.pose.handles)
            and (theirs.p2p_weight, theirs.conformal) == (mine.p2p_weight, mine.conformal)
        )

    def run(self, callback: Callback | None) -> Status:
        rounds = total_rounds = 0
        options, clock = self.options, compilation_clock()
        while True:
            began, compiling = time.perf_counter(), clock.seconds
            state = self._call(may_refine=rounds < _PATIENCE)
            end = int(state.outcome)
            taken = int(state.iteration)
            seconds = time.perf_counter() - began - (clock.seconds - compiling)
            if np.isnan(self.start_energy):
                self.start_energy = float(state.start_energy)
            self._record(state, taken, max(seconds, 0.0))
            # After a split the map is still where its Hessian was taken.
            self.reuse = end == outcome.REFUSED and bool(options.corrections)
            if taken:
                rounds = total_rounds = 0
                self._relax_ridge()
                if self._is_slow() and self._has_coarse_hessian():
                    self._take_full_hessian()
                if callback is not None and callback(self._progress(state)):
                    return Status.STOPPED
            if end == outcome.CONVERGED:
                return Status.CONVERGED
            if end == outcome.INDEFINITE:
                # Rounding or the nodes may have made it so.
                if self._take_full_hessian():
                    continue
                if self.options.hessian == "exact":
                    return Status.INDEFINITE
                # Singular to rounding (two handles in one place, say): a larger epsilon helps.
                self.ridge = max(_RIDGE_FACTOR * self.ridge, _RIDGE)
                if self.ridge > _LARGEST_RIDGE:
                    return Status.BLOCKED
                continue
            stalled = end == outcome.NO_DECREASE or (taken and self._has_stalled())
            if stalled and not self._take_full_hessian():
                return self._without_decrease(state)
            if len(self.history) >= self.options.max_iterations:
                return Status.MAX_ITERATIONS
            if end in (outcome.REFUSED, outcome.BLOCKED):
                if not taken and callback is not None and callback(self._progress(state)):
                    return Status.STOPPED
                rounds, total_rounds = rounds + 1, total_rounds + 1
                if end == outcome.BLOCKED:
                    rounds = 0
                if total_rounds > _MOST_ROUNDS:
                    return Status.BLOCKED
                if not self._split(np.asarray(state.refused)):
                    if end == outcome.BLOCKED:
                        return Status.BLOCKED
                    rounds = _PATIENCE  # a shorter step, then

    def _call(self, may_refine: bool) -> newton.State:
        options = self.options
        left = options.max_iterations - len(self.history)
        # With no iterations left, one call still evaluates the energies.
        settings = newton.Settings(
            np.asarray(options.tolerance),
            np.asarray(min(options.iterations_per_call, left)),
            np.asarray(may_refine and self.discretisation.can_refine),
            np.asarray(self.ridge),
            np.asarray(self.reuse),
            np.asarray(options.corrections),
        )
        disc = self.discretisation
        return newton.run(
            self.matrices,
            disc.basis.singularities,
            self.unknowns,
            self.constraints,
            self.energy,
            self.coefficients,
            self.factor,
            settings,
            hessian=options.hessian,
            capacity=capacity_for(options.iterations_per_call),
        )

    def _record(self, state: newton.State, taken: int, seconds: float) -> None:
        self.coefficients, self.factor = state.coefficients, state.factor
        self.energy_iso, self.energy_p2p = float(state.energy_iso), float(state.energy_p2p)
        panels = len(self.discretisation.panels)
        self.history += entries(
            state.records, taken, len(self.history), panels, self.just_split, seconds
        )
        if taken:
            self.just_split = 0

    def _progress(self, state: newton.State) -> Progress:
        bounds = np.asarray(state.sigma2_lower)[: len(self.discretisation.panels)]
        return Progress(tuple(self.history), bounds, self.discretisation, self.coefficients)

    def _take_full_hessian(self) -> bool:
        """From now on the Hessian in double precision on all nodes; False when it is so already."""
        if self.full_since is not None:
            return False
        self.full_since = len(self.history)
        self.matrices = self.discretisation.full_matrices
        return True

    def _has_coarse_hessian(self) -> bool:
        """Whether other nodes may make fewer iterations: not those of K+, which are slow anyway."""
        return self.discretisation.can_refine and self.options.hessian != "projected"

    def _relax_ridge(self) -> None:
        """Lower an epsilon that one place needed: close to the minimum it would make steps short.

        Where a bar is tied into a loop, 1e-9 outweighed the softest direction 200 times.
        """
        relaxed = self.ridge / _RIDGE_FACTOR
        self.ridge = max(relaxed if relaxed >= _RIDGE else 0.0, ridge_of(self.pose))

    def _is_slow(self) -> bool:
        """Whether the Hessian's coarser quadrature seems to cost iterations."""
        *before, last = self.history
        if len(self.history) >= SLOW_ITERATIONS:
            return True
        gained = before[-1].energy - last.energy if before else np.inf
        return last.step < _SLOW_STEP and gained < _SLOW_GAIN * last.energy

    def _has_stalled(self) -> bool:
        """Whether the last steps gained nothing: without a barrier, a map can creep to folding."""
        history = self.history[self.full_since or 0 :]
        recent = [entry.energy for entry in history[-1 - _STALLED :]]
        return len(recent) > _STALLED and recent[0] - recent[-1] <= _STALL_GAIN * abs(recent[-1])

    def _without_decrease(self, state: newton.State) -> Status:
        promised = float(state.decrement) ** 2 / 2
        small = promised <= _ROUNDING * abs(self.energy_iso + self.energy_p2p)
        return Status.STATIONARY if small else Status.BLOCKED

    def _split(self, refused: Array) -> bool:
        """Split the panels that refused a step; False when none can be."""
        wanted = self.discretisation.splittable(refused)
        if not wanted.any():
            return False
        self.discretisation = self.discretisation.refined(wanted)
        self.matrices = self.discretisation.matrices
        if self.full_since is not None:
            self.matrices = self.discretisation.full_matrices
        self.just_split += int(wanted.sum())
        return True


def _starting_point(
    domain: Domain, options: Options, start: HarmonicMap | Result | None
) -> tuple[HarmonicMap, Discretisation]:
    if start is None:
        return HarmonicMap.identity(domain), _discretised(domain, options)
    map_ = start.map if isinstance(start, Result) else start
    check_belongs(map_, domain)
    if options.conformal and np.abs(map_.psi - map_.psi[0]).max() > 0:
        raise StartError(
            "the map to start from is not conformal (psi is not constant); start from a conformal "
            "map or turn the option conformal off"
        )
    if isinstance(start, Result):
        disc = start.discretisation
        same = (disc.sampling, disc.certificate) == (options.sampling, options.certificate)
        return canonical(map_), disc if same else _discretised(domain, options)
    check_proved(map_)
    return canonical(HarmonicMap(domain, map_.phi, map_.psi)), _discretised(domain, options)


def _discretised(domain: Domain, options: Options) -> Discretisation:
    return discretise(domain, options.sampling, options.certificate)


def ridge_of(pose: Pose) -> float:
    """The multiple of its mean that a Hessian's diagonal is raised by from the start."""
    return _RIDGE if len(pose) < 2 else 0.0


def handle_images(constraints: Constraints, basis: Basis, map: HarmonicMap) -> Array:
    """(h, 2) images of the padded handles."""
    c = basis.n_columns
    rows = constraints.handles[:, :c] - 1j * constraints.handles[:, c:]
    images = rows @ basis.pad(map.phi) + np.conj(rows @ basis.pad(map.psi))
    return np.stack([np.real(images), np.imag(images)], axis=1)


def constraints_of(domain: Domain, pose: Pose, weight: float) -> Constraints:
    """The constraints of a pose, padded to a bucket of handles."""
    count = len(pose)
    size = _HANDLE_BUCKET * max(1, -(-count // _HANDLE_BUCKET))
    if not count:
        columns = 2 * basis_of(domain).n_columns
        return Constraints(np.zeros((size, columns)), np.zeros((size, 2)), np.zeros(size))
    points = pose.handles @ np.array([1, 1j])
    return Constraints(
        padded(_rows_at(domain, points.tobytes()), size),
        padded(np.array(pose.targets), size),
        padded(np.full(count, float(weight)), size, 0.0),
    )


@functools.lru_cache(maxsize=32)
def _rows_at(domain: Domain, points: bytes) -> Array:
    """``C`` at complex points, kept for the next targets of the same handles."""
    return basis_rows(cauchy.cauchy_coordinates, np.frombuffer(points, complex), basis_of(domain))


def _zeros(size: int) -> Any:
    return jnp.zeros((size, size))


_no_factor = jit(_zeros, static_argnames="size")
"""What a call without a factor is given: compiled, for JAX's own zeros take four times as long."""


def capacity_for(iterations: int) -> int:
    """Room in a call's history: a power of two, so that few programs are compiled."""
    return 1 << (iterations - 1).bit_length()


def real_coefficients(basis: Basis, map: HarmonicMap) -> Array:
    """Padded ``[Re phi, Im phi, Re psi, Im psi]`` of a map."""
    phi, psi = basis.pad(map.phi), basis.pad(map.psi)
    return np.concatenate([np.real(phi), np.imag(phi), np.real(psi), np.imag(psi)])


def map_from(discretisation: Discretisation, coefficients: Any) -> HarmonicMap:
    """The map of padded real coefficients ``[Re phi, Im phi, Re psi, Im psi]``."""
    basis = discretisation.basis
    re_phi, im_phi, re_psi, im_psi = np.asarray(coefficients).reshape(4, -1)[:, basis.columns]
    return HarmonicMap(discretisation.domain, re_phi + 1j * im_phi, re_psi + 1j * im_psi)
