"""Accelerated Quadratic Proxy (Kovalsky et al. 2016) with hard constraints."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb.energies import Energy, SymmetricDirichlet
from glid_nb.methods.mesh.operators import MeshMethod, MeshOperators, MeshProblem, Pinned, flips
from glid_nb.solvers import Status
from glid_nb.solvers.loop import Ending, Steps

_ARMIJO = 1e-4
_SAFETY = 0.9
_LEAST_STEP = 1e-14
# The rounding of the energy can hide a decrease below this share, as predicted by the proxy.
_ROUNDING = 1e-8
_SMOOTHING = 30
_MOST_PROJECTIONS = 500
# The projection bounds the little dilatation by BOUND and stops when it is below ENOUGH.
BOUND, ENOUGH = 0.9, 0.95


class _State(NamedTuple):
    w: Array
    fz: Array
    fzb: Array
    energy: float


@dataclass(frozen=True)
class AQP(MeshMethod):
    """Accelerated Quadratic Proxy on a triangle mesh, hard constraints.

    Kovalsky et al. 2016: steps from extrapolated points, with the Laplacian instead of the Hessian.
    The start is an ARAP map, projected onto maps without inverted triangles, as in the paper
    (Section 10). If an extrapolated step does not lower the energy, the step is repeated without
    extrapolation. So the energy always decreases.
    """

    name = "aqp"
    label = "AQP"
    max_iterations = 1000
    window = 10
    energies = ("iso", "exp", "amips", "mips", "custom")
    options = ("align", "max_iterations")

    kappa: float = field(
        default=1000.0, metadata={"least": 1, "why": ", at which AQP does not extrapolate"}
    )
    tolerance: float = 1e-9
    arap_iterations: int = field(
        default=5,
        metadata={"least": 1, "why": ", because the first brings the shape to the targets"},
    )

    def steps(self, problem: MeshProblem) -> Steps:
        # With hard constraints, the positional energy is rounding noise. A weight of 1 keeps it
        # small.
        problem = replace(problem, p2p_weight=1.0 / problem.inputs.domain.cage.unit**2)
        theta = (1 - np.sqrt(1 / self.kappa)) / (1 + np.sqrt(1 / self.kappa))
        pinned = Pinned(problem.operators, problem.handles)
        proxy = _Proxy(problem.operators, pinned, problem.inputs.energy, theta)
        now = start = self._started(problem, proxy)
        yield problem.at(start.w)
        if not np.isfinite(start.energy):
            left = flips(start.fz, start.fzb)
            what = f"the projection left {left} triangles turned over or nearly flat"
            why = f"No start was found: {what}, where the energy is not finite."
            return Ending(Status.BLOCKED, why)
        for now, step in proxy.path(start):
            yield problem.at(now.w, step)
        return proxy.without_decrease(now)

    def _started(self, problem: MeshProblem, proxy: "_Proxy") -> _State:
        operators, w = problem.operators, problem.start
        if np.abs(w[problem.handles] - problem.targets).max(initial=0) > 0:
            for _ in range(self.arap_iterations):  # local and global steps (Liu et al. 2008)
                rotation = _unit(operators.wirtinger(w)[0])
                pull = 2 * operators.adjoint(rotation, 0 * rotation)
                w = proxy.pinned.solve(pull, problem.targets)
            w, _ = project(operators, proxy.pinned, w)
        if problem.inputs.energy.name != "iso":
            # The projection leaves slender triangles, in which an exponential energy overflows.
            smoothing = replace(proxy, energy=SymmetricDirichlet())
            for now, _ in itertools.islice(smoothing.path(smoothing.state(w)), _SMOOTHING):
                w = now.w
        return proxy.state(w)


@dataclass(frozen=True)
class _Proxy:
    operators: MeshOperators
    pinned: Pinned
    energy: Energy
    theta: float  # how far ahead to extrapolate

    def state(self, w: Array) -> _State:
        fz, fzb = self.operators.wirtinger(w)
        return _State(w, fz, fzb, self.operators.energy(self.energy, fz, fzb))

    def path(self, now: _State) -> Iterator[tuple[_State, float]]:
        before, step = now, 1.0
        while True:
            found = self._descended(self._extrapolated(now, before), step)
            if found is None or found[0].energy >= now.energy:
                found = self._descended(now, step)  # without acceleration
            if found is None or found[0].energy >= now.energy:
                return
            before, (now, step) = now, found
            yield found

    def without_decrease(self, now: _State) -> Ending:
        gradient = self.operators.gradient(self.energy, now.fz, now.fzb)
        promised = float(np.real(np.vdot(gradient, self.pinned.solve(gradient))))
        if promised <= _ROUNDING * abs(now.energy):
            return Ending(Status.STATIONARY)
        stuck = "No step lowers the energy, though its gradient is not zero"
        return Ending(Status.BLOCKED, f"{stuck}: triangles are too close to flat for this method.")

    def _extrapolated(self, now: _State, before: _State) -> _State:
        if before is now:
            return now
        dfz, dfzb = now.fz - before.fz, now.fzb - before.fzb
        t = min(self.theta, 0.5 * largest_step(now.fz, now.fzb, dfz, dfzb))
        fz, fzb = now.fz + t * dfz, now.fzb + t * dfzb
        value = self.operators.energy(self.energy, fz, fzb)
        return _State(now.w + t * (now.w - before.w), fz, fzb, value)

    def _descended(self, start: _State, last: float) -> tuple[_State, float] | None:
        """One step with backtracking, and its length; None if no step lowers the energy."""
        gradient = self.operators.gradient(self.energy, start.fz, start.fzb)
        if not np.isfinite(gradient).all():
            return None
        direction = -self.pinned.solve(gradient)
        slope = float(np.real(np.vdot(gradient, direction)))
        dfz, dfzb = self.operators.wirtinger(direction)
        t = min(2 * last, 1.0, _SAFETY * largest_step(start.fz, start.fzb, dfz, dfzb))
        while t > _LEAST_STEP:
            fz, fzb = start.fz + t * dfz, start.fzb + t * dfzb
            value = self.operators.energy(self.energy, fz, fzb)
            if value < start.energy + _ARMIJO * t * slope:
                return _State(start.w + t * direction, fz, fzb, value), t
            t /= 2
        return None


def largest_step(fz: Array, fzb: Array, dfz: Array, dfzb: Array) -> float:
    """The step at which the first triangle becomes flat, or infinity (Smith & Schaefer 2015)."""
    a = np.abs(dfz) ** 2 - np.abs(dfzb) ** 2
    b = 2 * np.real(np.conj(fz) * dfz - np.conj(fzb) * dfzb)
    c = np.abs(fz) ** 2 - np.abs(fzb) ** 2
    discriminant = b * b - 4 * a * c
    denominator = -b + np.sqrt(np.maximum(discriminant, 0))
    hits = (discriminant >= 0) & (denominator > 0)
    return float(np.min(2 * c[hits] / denominator[hits], initial=np.inf))


def project(operators: MeshOperators, pinned: Pinned, w: Array) -> tuple[Array, int]:
    """Project ``w`` onto maps of bounded distortion (Kovalsky et al. 2015), with the same held
    vertices. Returns the map and the number of iterations.

    Each iteration moves to the closest map on a hyperplane that separates the current map from
    these maps. Some triangles may stay flipped.
    """
    for iteration in range(_MOST_PROJECTIONS):
        fz, fzb = operators.wirtinger(w)
        if (np.abs(fzb) < ENOUGH * np.abs(fz)).all():
            return w, iteration
        pz, pzb = closest(fz, fzb, BOUND)
        nz, nzb = fz - pz, fzb - pzb
        gap = float(operators.weights @ (np.abs(nz) ** 2 + np.abs(nzb) ** 2))
        normal = operators.adjoint(nz, nzb)
        direction = pinned.solve(normal)
        slope = float(np.real(np.vdot(normal, direction)))
        if not slope > 0:
            return w, iteration
        w = w - (gap / slope) * direction
    return w, _MOST_PROJECTIONS


def closest(fz: Array, fzb: Array, bound: float) -> tuple[Array, Array]:
    """The closest differentials with ``|f_zbar| <= bound |f_z|``."""
    a, b = np.abs(fz), np.abs(fzb)
    t = (a + bound * b) / (1 + bound**2)
    outside = b > bound * a
    pzb = bound * t * fzb / np.where(b > 0, b, 1)
    return np.where(outside, t * _unit(fz), fz), np.where(outside, pzb, fzb)


def _unit(z: Array) -> Array:
    size = np.abs(z)
    return np.where(size > 0, z / np.where(size > 0, size, 1), 1)
