"""Our method: Newton's, several iterations a compiled call, on the host (paper Algorithm 1)."""

from __future__ import annotations

import functools
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import jit, jnp
from glid_nb._runtime import compilation_clock, double_precision
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import outcome, step
from glid_nb.solvers.discretisation import Discretisation, discretise
from glid_nb.solvers.loop import Advance, Descent, Ending, Reached, follow
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose
from glid_nb.solvers.problem import (
    Problem,
    constraints_of,
    handle_images,
    map_from,
    real_coefficients,
)
from glid_nb.solvers.restarts import improve
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.start import aligned, check_conformal, check_proved
from glid_nb.solvers.status import Status
from glid_nb.solvers.unknowns import canonical, reduced_unknowns

Array = NDArray[Any]

# Without two handles a rotation costs nothing and the Hessian is singular (Appendix I).
_RIDGE, _LARGEST_RIDGE = 1e-9, 1e-2
_RIDGE_FACTOR = 100.0
# When to put the Hessian on all nodes: many iterations, or a short step that gains little.
SLOW_ITERATIONS = 20
_SLOW_STEP, _SLOW_GAIN = 0.5, 0.05
# Steps in a row that together gain less than this fraction of the energy end a solve.
_STALLED, _STALL_GAIN = 4, 1e-10
# A decrease promised by the Newton decrement that rounding of the energy can hide.
_ROUNDING = 1e-8


@dataclass(frozen=True)
class Newton(Method):
    """Newton's method with the exact Hessian where it is positive definite and the paper's
    projected one elsewhere.

    Ours; its settings are the :class:`~glid_nb.Options`.
    """

    name = "newton"
    label = "Newton, ours"
    family = "harmonic"
    options = tuple(Options.__dataclass_fields__)

    def run(self, inputs: Inputs) -> Result:
        """One descent and, where it ends badly without a start, others."""
        first = descend(inputs, self)
        return first if inputs.start is not None else improve(first, inputs, descend)


@double_precision
def descend(inputs: Inputs, method: Method | None = None) -> Result:
    """One descent from one map to the local minimum that it leads to."""
    method = Newton() if method is None else method
    return follow(lambda: NewtonDescent(method, inputs), inputs)


class NewtonDescent(Descent):
    """Newton's method at work."""

    shows_start = False
    uses_lapack = True

    def __init__(self, method: Method, inputs: Inputs) -> None:
        self.method, self.options, self.pose = method, inputs.options, inputs.pose
        options, domain = inputs.options, inputs.domain
        map_, self.discretisation = _starting_point(method, inputs)
        basis = self.discretisation.basis
        constraints = constraints_of(domain, inputs.pose, options.p2p_weight)
        self.problem = Problem(
            matrices=self.discretisation.matrices,
            singularities=basis.singularities,
            unknowns=reduced_unknowns(basis, options.conformal),
            constraints=constraints,
            energy=inputs.energy,
        )
        if options.align:
            images = handle_images(constraints, basis, map_)[: len(inputs.pose)]
            map_ = aligned(map_, inputs.pose, images)
        self.coefficients: Any = real_coefficients(basis, map_)
        self.ridge = ridge_of(inputs.pose)
        self.just_split = 0
        self.full_since: int | None = None
        self.factor: Any = None
        if isinstance(inputs.start, Result) and self._continues(inputs.start):
            # The result keeps its own.
            self.factor = jnp.array(inputs.start.factor, copy=True)
        self.reuse = self.factor is not None

    def _continues(self, start: Result) -> bool:
        """Whether the last Hessian of an earlier solve is one of this problem's."""
        mine, theirs = self.options, start.options
        return bool(
            mine.corrections
            and start.factor is not None
            and start.discretisation is self.discretisation
            and start.energy_measure == self.problem.energy
            and np.array_equal(start.pose.handles, self.pose.handles)
            and (theirs.p2p_weight, theirs.conformal) == (mine.p2p_weight, mine.conformal)
        )

    def advance(self, before: int, left: int, may_refine: bool) -> Advance:
        """One compiled call; with nothing left it still evaluates the energies."""
        options, clock = self.options, compilation_clock()
        began, compiling = time.perf_counter(), clock.seconds
        if self.factor is None:
            self.factor, self.reuse = _no_factor(len(self.problem.unknowns.free)), False
        state = step.run(
            self.problem,
            self.coefficients,
            self.factor,
            settings_of(
                options,
                iterations=min(options.iterations_per_call, left),
                may_refine=may_refine and self.panels.can_refine,
                ridge=self.ridge,
                reuse=self.reuse,
            ),
        )
        int(state.outcome)  # waits for the device
        seconds = time.perf_counter() - began - (clock.seconds - compiling)
        self.factor = state.factor
        return self.take(state, before, max(seconds, 0.0))

    def take(self, state: step.State, before: int, seconds: float) -> Advance:
        """Go to where a call of so many seconds has come, after ``before`` iterations."""
        self.state, self.coefficients = state, state.point.coefficients
        end, taken = int(state.outcome), int(state.iteration)
        if not hasattr(self, "initial"):
            iso, p2p = float(state.start_iso), float(state.start_p2p)
            self.initial = Iteration(iteration=0, energy_iso=iso, energy_p2p=p2p, time=0.0)
        split, panels = self.just_split, len(self.panels.panels)
        done = _entries(state.records, taken, before, panels, split, seconds)
        if taken:
            self.just_split = 0
        # After a split the map is still where its Hessian was taken.
        self.reuse = end == outcome.REFUSED and bool(self.options.corrections)
        return Advance(end, done, np.asarray(state.refused))

    def reached(self) -> Reached:
        """After the last call."""
        point, disc, coefficients = self.state.point, self.panels, self.coefficients
        bounds = np.asarray(self.state.sigma2_lower)[: len(disc.panels)]
        return Reached(
            float(point.energy_iso),
            float(point.energy_p2p),
            lambda: map_from(disc, coefficients),
            bounds,
            factor=self.factor,
        )

    def adapt(self, done: Advance, history: Sequence[Iteration]) -> Ending | None:
        """Take the full Hessian or another ridge where that may help; else end."""
        if done.outcome == outcome.CONVERGED:
            return Ending(Status.CONVERGED)
        if done.iterations:
            self._relax_ridge()
            if self._has_coarse_hessian() and _is_slow(history):
                self._take_full_hessian(history)
        if done.outcome == outcome.INDEFINITE:
            # Rounding or the nodes may have made it so.
            return None if self._take_full_hessian(history) else self._raise_ridge()
        stalled = done.iterations and _has_stalled(history[self.full_since or 0 :])
        if done.outcome == outcome.NO_DECREASE or stalled:
            return None if self._take_full_hessian(history) else self._without_decrease()
        return None

    def split(self, refused: Array) -> int:
        """Split the panels that refused a step; 0 when none can be."""
        wanted = self.panels.splittable(refused)
        count = int(wanted.sum())
        if count:
            self.discretisation = self.panels.refined(wanted)
            self._take_matrices()
            self.just_split += count
        return count

    @property
    def panels(self) -> Discretisation:
        """The discretisation, which a method in the subspace always has."""
        assert self.discretisation is not None
        return self.discretisation

    def _take_matrices(self) -> None:
        disc, full = self.panels, self.full_since is not None
        self.problem = self.problem._replace(matrices=disc.full_matrices if full else disc.matrices)

    def _take_full_hessian(self, history: Sequence[Iteration]) -> bool:
        """From now on the Hessian in double precision on all nodes; False when it is so already."""
        if self.full_since is not None:
            return False
        self.full_since = len(history)
        self._take_matrices()
        return True

    def _has_coarse_hessian(self) -> bool:
        """Whether other nodes may make fewer iterations: not those of K+, which are slow anyway."""
        return self.panels.can_refine and self.options.hessian != "projected"

    def _relax_ridge(self) -> None:
        """Lower an epsilon that one place needed: close to the minimum it would make steps short.

        Where a bar is tied into a loop, 1e-9 outweighed the softest direction 200 times.
        """
        relaxed = self.ridge / _RIDGE_FACTOR
        self.ridge = max(relaxed if relaxed >= _RIDGE else 0.0, ridge_of(self.pose))

    def _raise_ridge(self) -> Ending | None:
        """A larger epsilon where the Hessian is singular to rounding: two handles in one place."""
        if self.options.hessian == "exact":
            return Ending(Status.INDEFINITE)
        self.ridge = max(_RIDGE_FACTOR * self.ridge, _RIDGE)
        return Ending(Status.BLOCKED) if self.ridge > _LARGEST_RIDGE else None

    def _without_decrease(self) -> Ending:
        promised = float(self.state.decrement) ** 2 / 2
        small = promised <= _ROUNDING * abs(float(self.state.point.energy))
        return Ending(Status.STATIONARY if small else Status.BLOCKED)


def _is_slow(history: Sequence[Iteration]) -> bool:
    """Whether the Hessian's coarser quadrature seems to cost iterations."""
    *before, last = history
    if len(history) >= SLOW_ITERATIONS:
        return True
    gained = before[-1].energy - last.energy if before else np.inf
    assert last.step is not None
    return bool(last.step < _SLOW_STEP and gained < _SLOW_GAIN * last.energy)


def _has_stalled(history: Sequence[Iteration]) -> bool:
    """Whether the last steps gained nothing: without a barrier, a map can creep to folding."""
    recent = [entry.energy for entry in history[-1 - _STALLED :]]
    return len(recent) > _STALLED and recent[0] - recent[-1] <= _STALL_GAIN * abs(recent[-1])


def _starting_point(method: Method, inputs: Inputs) -> tuple[HarmonicMap, Discretisation]:
    """The map to start from, checked, and panels for it."""
    domain, options, start = inputs.domain, inputs.options, inputs.start
    fresh = functools.partial(discretise, domain, options.sampling, options.certificate)
    map_ = method.harmonic_start(inputs)
    if map_ is None:
        return HarmonicMap.identity(domain), fresh()
    if options.conformal:
        check_conformal(map_)
    if isinstance(start, Result):
        disc = start.discretisation
        same = disc is not None and (disc.sampling, disc.certificate) == (
            options.sampling,
            options.certificate,
        )
        return canonical(map_), disc if disc is not None and same else fresh()
    check_proved(map_)
    return canonical(HarmonicMap(domain, map_.phi, map_.psi)), fresh()


def ridge_of(pose: Pose) -> float:
    """The multiple of its mean that a Hessian's diagonal is raised by from the start."""
    return _RIDGE if len(pose) < 2 else 0.0


def settings_of(
    options: Options, *, iterations: int, may_refine: bool, ridge: float, reuse: bool
) -> step.Settings:
    """The numbers of one call."""
    return step.Settings(
        tolerance=np.asarray(options.tolerance),
        iterations=np.asarray(iterations),
        may_refine=np.asarray(may_refine),
        ridge=np.asarray(ridge),
        reuse=np.asarray(reuse),
        corrections=np.asarray(options.corrections),
        projects_first=np.asarray(options.hessian == "projected"),
        attempts=np.asarray(2 if options.hessian == "adaptive" else 1),
    )


def _entries(
    records: step.Record, taken: int, before: int, panels: int, split: int, seconds: float
) -> list[Iteration]:
    """The ``taken`` iterations of one call.

    Parameters
    ----------
    records : Record
        Arrays of at least ``taken`` values.
    taken, before : int
        How many iterations the call made, and how many there were before it.
    panels, split : int
        Panels of the boundary, and how many of them stem from splits just before the call.
    seconds : float
        Of the whole call, compilation left out; shared evenly.
    """
    columns = {k: np.asarray(v)[:taken].tolist() for k, v in records._asdict().items()}
    return [
        Iteration(
            iteration=before + i + 1,
            time=seconds / taken,
            panels=panels,
            panels_split=0 if i else split,
            **{name: values[i] for name, values in columns.items()},
        )
        for i in range(taken)
    ]


def _zeros(size: int) -> Any:
    return jnp.zeros((size, size))


_no_factor = jit(_zeros, static_argnames="size")
"""What a call without a factor is given: compiled, for JAX's own zeros take four times as long."""
