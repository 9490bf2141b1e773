"""BDHM's iteration: a second-order cone program per step, its result certified within the bounds.

The map is held to the bounds at samples of an active set and proved to keep them everywhere; where
that fails, the step is shortened toward the last map, which kept them.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.certificate import Certificate, certify
from glid_nb.compare.bdhm.bounds import DistortionBounds
from glid_nb.compare.bdhm.program import ActiveSet, Quadratic, Rows, solve_program
from glid_nb.compare.recording import Ending, Run, Snapshot
from glid_nb.geometry import Domain, Panels, graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.solvers import Pose, Status
from glid_nb.solvers.align import aligned
from glid_nb.solvers.discretisation import basis_rows
from glid_nb.solvers.unknowns import canonical, unknowns_of

Array = NDArray[Any]

# Panels this long relative to their distance from the singularities carry the samples.
_RATIO = 0.5
# By how much the sampled bounds are stricter than the proved ones, and how tightly is proved.
_MARGIN, _TIGHTNESS = 0.01, 0.004
# A sample joins the active set within the first share of a bound's range and leaves beyond the
# second.
_JOIN, _LEAVE = 0.10, 0.15
# How often one program is solved again with more samples, and the violation that asks for it.
_ROUNDS, _SLACK = 6, 2e-3
_HALVINGS = 12


class BoundedProblem:
    """Domain and pose as linear functions of the real unknowns."""

    def __init__(self, domain: Domain, pose: Pose, p2p_weight: float) -> None:
        self.domain, self.pose, self.weight = domain, pose, p2p_weight
        self.basis = basis_of(domain)
        self.panels: Panels = graded_panels(domain, _RATIO)
        # A rotation costs nothing while fewer than two handles hold the map.
        self.ridge = 0.0 if len(pose) >= 2 else 1e-6
        self.expansion = self._expansion()
        d = basis_rows(cauchy.first_derivatives, self.panels.middle, self.basis)
        c = (
            basis_rows(cauchy.cauchy_coordinates, pose.handles @ np.array([1, 1j]), self.basis)
            if len(pose)
            else np.zeros((0, d.shape[1]))
        )
        phi, psi = self._split(self.expansion)
        d, c = _complex(d), _complex(c)
        self.shares = self.panels.length / self.panels.length.sum()
        zero = np.zeros(len(d), dtype=complex)
        self.rows = Rows(d @ phi, zero, d @ psi, zero)
        self.handles = c @ phi + (c @ psi).conj()

    def unknowns(self, map: HarmonicMap) -> Array:
        """The unknowns of a map whose redundant coefficients are 0."""
        phi, psi = self.basis.pad(map.phi), self.basis.pad(map.psi)
        full = np.concatenate([part(v) for v in (phi, psi) for part in (np.real, np.imag)])
        return full[self._free]

    def started(self, map: HarmonicMap, align: bool) -> tuple[Array, Certificate]:
        """The unknowns of a map, rigidly moved toward the targets if asked for, and its proof."""
        u = self.unknowns(canonical(aligned(map, self.pose) if align else map))
        return u, certify(self.map_of(u), tightness=_TIGHTNESS)

    def map_of(self, u: Array) -> HarmonicMap:
        """The map with these unknowns."""
        phi, psi = (part[self.basis.columns] for part in self._split(self.expansion @ u))
        return HarmonicMap(self.domain, phi, psi)

    def values(self, u: Array) -> tuple[Array, Array]:
        """``f_z`` and ``conj(f_zbar)`` at the samples."""
        return self.rows.a @ u, self.rows.b @ u

    def energies(self, u: Array) -> tuple[float, float]:
        """ARAP along the boundary, and the positional part."""
        f, g = self.values(u)
        arap = 2 * (np.abs(f) - 1) ** 2 + 2 * np.abs(g) ** 2
        miss = self.handles @ u - self._targets
        return float(self.shares @ arap), self.weight / 2 * float((np.abs(miss) ** 2).sum())

    def quadratic(self, frames: Array) -> Quadratic:
        """The energy with fixed rotations ``frames``."""
        w = 4 * self.shares[:, None]
        h = self.handles
        P = np.real(self.rows.a.conj().T @ (w * self.rows.a))
        P += np.real(self.rows.b.conj().T @ (w * self.rows.b))
        P += self.weight * np.real(h.conj().T @ h) + self.ridge * np.eye(len(P))
        q = -np.real(self.rows.a.conj().T @ (4 * self.shares * frames))
        q -= self.weight * np.real(h.conj().T @ self._targets)
        return Quadratic(P, q)

    @property
    def _targets(self) -> Array:
        return self.pose.targets @ np.array([1, 1j])

    def _expansion(self) -> Array:
        """(4c, u): all coefficients from the unknowns, the holes' ``psi = conj(phi)`` included."""
        unknowns = unknowns_of(self.basis, False)
        self._free = np.flatnonzero(np.asarray(unknowns.free))
        size, n_holes = len(unknowns.free), len(unknowns.holes)
        matrix = np.zeros((size, len(self._free)))
        matrix[self._free, np.arange(len(self._free))] = 1
        c = size // 4
        for j in range(c - n_holes, c):
            matrix[2 * c + j] = matrix[j]
            matrix[3 * c + j] = -matrix[c + j]
        return matrix

    def _split(self, full: Array) -> tuple[Array, Array]:
        re_phi, im_phi, re_psi, im_psi = np.split(full, 4)
        return re_phi + 1j * im_phi, re_psi + 1j * im_psi


def bdhm(
    domain: Domain,
    pose: Pose,
    p2p_weight: float,
    bounds: DistortionBounds,
    align: bool,
    tolerance: float,
    start: HarmonicMap | None = None,
) -> Run:
    """Alternate between frames and cone programs until the energy no longer falls.

    A start that is not proved to keep the bounds gives way to the identity.
    """
    problem = _problem(domain, pose, p2p_weight)
    identity = HarmonicMap.identity(domain)
    u, certificate = problem.started(identity if start is None else start, align)
    if not bounds.hold(certificate):
        u, certificate = problem.started(identity, align)
    strict = bounds.tightened(_MARGIN)
    active = ActiveSet(*(np.empty(0, dtype=int) for _ in range(3)))
    yield _snapshot(problem, u, certificate, 0.0)
    energies = [sum(problem.energies(u))]
    step = 0.0
    while True:
        began = time.perf_counter()
        with single_blas_thread():
            active = _updated(active, *problem.values(u), strict)
            # Far from the minimum a step is cut short anyway, and one program is enough.
            for rounds in (_ROUNDS,) if step > 0.25 else (1, _ROUNDS):
                solution, active, status = _solved(problem, u, active, strict, rounds)
                found = None
                if solution is not None:
                    found = _certified_step(problem, u, solution, bounds)
                if found is not None:
                    break
            if solution is None:
                return Ending(
                    Status.BLOCKED,
                    f"The cone program was not solved ({status}); the last map, which keeps the "
                    "bounds, is returned.",
                )
        if found is None:
            return Ending(
                Status.BLOCKED,
                "No further step could be proved to keep the bounds; the last map, which keeps "
                "them, is returned.",
            )
        u, step, certificate = found
        yield _snapshot(problem, u, certificate, time.perf_counter() - began, step)
        energies.append(sum(problem.energies(u)))
        # The energy may rise while samples join the active set.
        if (
            len(energies) > 3
            and max(energies[-3:]) - min(energies[-3:]) <= tolerance * energies[-1]
        ):
            return Ending(
                Status.CONVERGED,
                f"The solver converged: the energy changes by less than {tolerance:g} of it.",
            )


def _solved(
    problem: BoundedProblem, u: Array, active: ActiveSet, bounds: DistortionBounds, rounds: int
) -> tuple[Array | None, ActiveSet, str]:
    """The cone program at ``u``, solved again with the samples that its solution violates."""
    f, _ = problem.values(u)
    frames = f / np.abs(f)
    quadratic = problem.quadratic(frames)
    while True:
        solution, status = solve_program(quadratic, problem.rows, frames, active, bounds)
        rounds -= 1
        if solution is None or not rounds:
            break
        wider = _updated(active, *problem.values(solution), bounds, violated_only=True)
        if len(wider) == len(active):
            break
        active = wider
    return solution, active, status


@double_precision
def _problem(domain: Domain, pose: Pose, p2p_weight: float) -> BoundedProblem:
    return BoundedProblem(domain, pose, p2p_weight)


def _updated(
    active: ActiveSet, f: Array, g: Array, bounds: DistortionBounds, violated_only: bool = False
) -> ActiveSet:
    """The samples near a bound: local extremes join, and those far off leave.

    With ``violated_only`` only extremes beyond the bound join, and none leave.
    """
    join, leave = (0.0, np.inf) if violated_only else (_JOIN, _LEAVE)
    sigma1, sigma2 = np.abs(f) + np.abs(g), np.abs(f) - np.abs(g)
    k = np.abs(g) / np.maximum(np.abs(f), 1e-300)
    return ActiveSet(
        _joined(active.k, k / bounds.k, join, leave),
        _joined(active.sigma1, (sigma1 - 1) / (bounds.sigma1 - 1), join, leave),
        _joined(active.sigma2, (1 - sigma2) / (1 - bounds.sigma2), join, leave),
    )


def _joined(active: Array, used: Array, join: float, leave: float) -> Array:
    """``used`` is the share of the way from an isometry to the bound at each sample."""
    before, after = np.roll(used, 1), np.roll(used, -1)
    peak = (used >= before) & (used >= after) & (used > 1 + _SLACK - join)
    kept = active[used[active] > 1 - leave]
    return np.union1d(kept, np.flatnonzero(peak)).astype(int)


def _certified_step(
    problem: BoundedProblem, u: Array, target: Array, bounds: DistortionBounds
) -> tuple[Array, float, Certificate] | None:
    """The longest of the steps 1, 1/2, 1/4, ... whose map is proved to keep the bounds."""
    t = 1.0
    for _ in range(_HALVINGS):
        moved = u + t * (target - u)
        certificate = certify(problem.map_of(moved), tightness=_TIGHTNESS)
        if bounds.hold(certificate):
            return moved, t, certificate
        t /= 2
    return None


def _snapshot(
    problem: BoundedProblem,
    u: Array,
    certificate: Certificate,
    seconds: float,
    step: float = np.nan,
) -> Snapshot:
    iso, p2p = problem.energies(u)
    return Snapshot(
        iso,
        p2p,
        seconds,
        lambda: problem.map_of(u),
        step=step,
        sigma2_lower=certificate.sigma2_lower,
        certificate=certificate,
    )


def _complex(rows: Array) -> Array:
    """``D`` from its halves ``[Re D, -Im D]``."""
    half = rows.shape[1] // 2
    return rows[:, :half] - 1j * rows[:, half:]
