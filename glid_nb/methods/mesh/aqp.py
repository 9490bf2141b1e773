"""Accelerated Quadratic Proxy (Kovalsky et al. 2016) with hard constraints."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.methods.mesh.local_global import local_global
from glid_nb.methods.mesh.operators import MeshOperators, Pinned, flips, largest_step
from glid_nb.methods.mesh.projection import Array, project
from glid_nb.methods.mesh.setup import MeshMethod, MeshProblem
from glid_nb.solvers import MethodError, Status
from glid_nb.solvers.loop import Ending, Steps

_ARMIJO = 1e-4
_SAFETY = 0.9
_LEAST_STEP = 1e-14
# A decrease promised by the proxy that rounding of the energy can hide.
_ROUNDING = 1e-8
_WINDOW = 10
_SMOOTHING = 30


@dataclass(frozen=True)
class _State:
    w: Array
    fz: Array
    fzb: Array
    energy: float


@dataclass(frozen=True)
class AQP(MeshMethod):
    """Accelerated Quadratic Proxy on a triangle mesh, hard constraints.

    Kovalsky et al. 2016: steps with the Laplacian in place of the Hessian, from extrapolated
    points. Started from ARAP that is projected onto maps without inverted triangles, as in the
    paper (Section 10). An extrapolated step that does not lower the energy is taken again without
    extrapolation, so the energy decreases throughout.
    """

    name = "aqp"
    label = "AQP"
    max_iterations = 1000
    energies = ("iso", "exp", "amips", "mips", "custom")
    options = ("align", "max_iterations")

    kappa: float = 1000.0
    tolerance: float = 1e-9
    arap_iterations: int = 5

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.kappa < 1:
            raise MethodError(
                f"kappa must be at least 1, at which AQP does not extrapolate; got {self.kappa!r}"
            )
        if self.arap_iterations < 1:
            raise MethodError(
                "arap_iterations must be at least 1: the first brings the handles to their targets"
            )

    def steps(self, problem: MeshProblem) -> Steps:
        """Extrapolated steps while they lower the energy."""
        # Hard constraints: a positional part that is 0 but for rounding would be noise times
        # lambda.
        problem = replace(problem, p2p_weight=1.0)
        operators, energy = problem.operators, problem.energy
        pinned = Pinned(operators, problem.handles)
        theta = (1 - np.sqrt(1 / self.kappa)) / (1 + np.sqrt(1 / self.kappa))
        began = time.perf_counter()
        now = self._started(problem, pinned, theta)
        yield problem.snapshot(now.w, time.perf_counter() - began)
        if not np.isfinite(now.energy):
            left = flips(now.fz, now.fzb)
            return Ending(
                Status.BLOCKED,
                f"No start was found: the projection left {left} triangles turned over or nearly "
                "flat, where the energy is not finite.",
            )
        before, step = now, 1.0
        energies = [now.energy]
        while True:
            began = time.perf_counter()
            found = _iterated(operators, energy, pinned, now, before, step, theta)
            if found is None:
                return _without_decrease(operators, energy, pinned, now)
            before, (now, step) = now, found
            yield problem.snapshot(now.w, time.perf_counter() - began, step)
            energies.append(now.energy)
            recent = energies[-1 - _WINDOW :]
            gain = recent[0] - recent[-1]
            if len(recent) > _WINDOW and gain <= self.tolerance * abs(recent[-1]):
                return Ending(
                    Status.CONVERGED,
                    f"The solver converged: {_WINDOW} iterations together lower the energy by less "
                    f"than {self.tolerance:g} of it.",
                )

    def _started(self, problem: MeshProblem, pinned: Pinned, theta: float) -> _State:
        """ARAP, projected, and smoothed for other energies than the symmetric Dirichlet energy."""
        operators, energy, w = problem.operators, problem.energy, problem.start
        if np.abs(w[problem.handles] - problem.targets).max(initial=0) > 0:
            w = local_global(operators, pinned, w, problem.targets, self.arap_iterations)
            w, _ = project(operators, pinned, w)
        if energy.name != "iso":
            # The projection leaves slender triangles, where an exponential energy overflows.
            w = _smoothed(operators, pinned, w, theta)
        return _state(operators, energy, w)


def _iterated(
    operators: MeshOperators,
    energy: Energy,
    pinned: Pinned,
    now: _State,
    before: _State,
    step: float,
    theta: float,
) -> tuple[_State, float] | None:
    """One accelerated step, or a plain one where that does not lower the energy."""
    ahead = _extrapolated(operators, energy, now, before, theta)
    found = _descended(operators, energy, pinned, ahead, step)
    if found is None or found[0].energy >= now.energy:
        found = _descended(operators, energy, pinned, now, step)
    return None if found is None or found[0].energy >= now.energy else found


def _smoothed(operators: MeshOperators, pinned: Pinned, w: Array, theta: float) -> Array:
    """Some iterations with the symmetric Dirichlet energy."""
    iso = SymmetricDirichlet()
    now = before = _state(operators, iso, w)
    step = 1.0
    for _ in range(_SMOOTHING):
        found = _iterated(operators, iso, pinned, now, before, step, theta)
        if found is None:
            break
        before, (now, step) = now, found
    return now.w


def _without_decrease(
    operators: MeshOperators, energy: Energy, pinned: Pinned, now: _State
) -> Ending:
    gradient = operators.gradient(energy, now.fz, now.fzb)
    promised = float(np.real(np.vdot(gradient, pinned.solve(gradient))))
    if promised <= _ROUNDING * abs(now.energy):
        return Ending(Status.STATIONARY)
    return Ending(
        Status.BLOCKED,
        "No step along the search direction lowers the energy, though its gradient is not zero: "
        "triangles are too close to flat for this method.",
    )


def _state(operators: MeshOperators, energy: Energy, w: Array) -> _State:
    fz, fzb = operators.wirtinger(w)
    return _State(w, fz, fzb, operators.energy(energy, fz, fzb))


def _extrapolated(
    operators: MeshOperators, energy: Energy, now: _State, before: _State, theta: float
) -> _State:
    """The point ahead on the line through the last two, without inverting a triangle."""
    if before is now:
        return now
    dfz, dfzb = now.fz - before.fz, now.fzb - before.fzb
    t = min(theta, 0.5 * largest_step(now.fz, now.fzb, dfz, dfzb))
    fz, fzb = now.fz + t * dfz, now.fzb + t * dfzb
    return _State(now.w + t * (now.w - before.w), fz, fzb, operators.energy(energy, fz, fzb))


def _descended(
    operators: MeshOperators, energy: Energy, pinned: Pinned, start: _State, last: float
) -> tuple[_State, float] | None:
    """One proxy step with backtracking, and its length; ``None`` when none decreases."""
    gradient = operators.gradient(energy, start.fz, start.fzb)
    if not np.isfinite(gradient).all():
        return None
    direction = -pinned.solve(gradient)
    slope = float(np.real(np.vdot(gradient, direction)))
    dfz, dfzb = operators.wirtinger(direction)
    t = min(2 * last, 1.0, _SAFETY * largest_step(start.fz, start.fzb, dfz, dfzb))
    while t > _LEAST_STEP:
        fz, fzb = start.fz + t * dfz, start.fzb + t * dfzb
        value = operators.energy(energy, fz, fzb)
        if value < start.energy + _ARMIJO * t * slope:
            return _State(start.w + t * direction, fz, fzb, value), t
        t /= 2
    return None
