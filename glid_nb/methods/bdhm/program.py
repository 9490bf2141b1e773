"""One step of BDHM: a convex program with the frames ``f_z / |f_z|`` held fixed, and its bounds."""

from __future__ import annotations

import importlib
import math
import numbers
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse

from glid_nb._arrays import Array
from glid_nb.certificate import Certificate
from glid_nb.methods.bdhm.problem import BoundedProblem, Samples
from glid_nb.solvers import MethodError

# By which share of a bound's range the bounds at samples are stricter than the proved ones.
MARGIN = 0.01
# How much of the margin a sample that is not in the active set may use before it joins.
_SLACK = 0.1
# A sample joins the active set within the first share of a bound's range and leaves beyond the
# second.
_JOIN, _LEAVE = 0.10, 0.15


@dataclass(frozen=True)
class DistortionBounds:
    """``k(z) <= k``, ``sigma_1(z) <= sigma1`` and ``sigma_2(z) >= sigma2`` (Theorem 4.2).

    A MethodError where an isometry does not satisfy them with room to spare.
    """

    k: float = 0.8
    sigma1: float = 5.0
    sigma2: float = 0.3

    def __post_init__(self) -> None:
        ranges = {"k": (0, 1), "sigma1": (1, math.inf), "sigma2": (0, 1)}
        for name, (low, high) in ranges.items():
            value = getattr(self, name)
            if not isinstance(value, numbers.Real) or not low < float(value) < high:
                wanted = f"must lie between {low} and {high}, ends excluded"
                why = f"for the method starts at an isometry; got {value!r}"
                raise MethodError(f"the bound {name} {wanted}, {why}")

    def hold(self, certificate: Certificate) -> bool:
        return (
            certificate.certified
            and certificate.k_upper <= self.k
            and certificate.sigma1_upper <= self.sigma1
            and certificate.sigma2_lower >= self.sigma2
        )

    @property
    def narrowest(self) -> float:
        """The least of the bounds' ranges, each relative to its bound and no more than 1."""
        return min(1.0, (self.sigma1 - 1) / self.sigma1, (1 - self.sigma2) / self.sigma2)

    def used(self, k: Array, sigma1: Array, sigma2: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        most, least = self.sigma1 - 1, 1 - self.sigma2
        return np.stack([k / self.k, (sigma1 - 1) / most, (1 - sigma2) / least])


@dataclass(frozen=True, eq=False)
class ActiveSet:
    """Samples of the boundary, and which of them are held to which bound."""

    problem: BoundedProblem
    bounds: DistortionBounds
    samples: Samples
    """First the problem's own, which follow one another, then those that a failed proof added."""
    chosen: Array
    """(3, n) bool: where k, sigma_1 and sigma_2 are bounded."""
    excess: float = 1.0
    """How much the next map may keep of what this one has beyond the stricter bounds. With 1 the
    map itself is always admitted; with less it is drawn inward."""

    def used(self, v: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        f, g = (np.abs(part) for part in self.samples.values(v))
        return self.bounds.used(g / np.maximum(f, 1e-300), f + g, f - g)

    def levels(self, v: Array) -> tuple[Array, Array, Array]:
        """k, sigma_1 and sigma_2 that the next map may have; no sample gets more than before."""
        strict, bounds = 1 - MARGIN, self.bounds
        k, sigma1, sigma2 = strict + self.excess * np.maximum(self.used(v) - strict, 0)
        return k * bounds.k, 1 + sigma1 * (bounds.sigma1 - 1), 1 - sigma2 * (1 - bounds.sigma2)

    def around(self, v: Array) -> ActiveSet:
        """With the local extremes near a bound, and without samples far from it."""
        used = self.used(v)
        kept = self.chosen & (used > 1 - _LEAVE)
        return replace(self, chosen=kept | (self._peaks(used) & (used > 1 - _JOIN)))

    def and_violated(self, v: Array) -> ActiveSet:
        """With the local extremes beyond a bound; the same object where there are no new ones."""
        used = self.used(v)
        beyond = self._peaks(used) & (used > 1 - (1 - _SLACK) * MARGIN) & ~self.chosen
        return replace(self, chosen=self.chosen | beyond) if beyond.any() else self

    def refined(self, certificate: Certificate) -> ActiveSet:
        """With new samples on the panels, of each run of them the worst, that fail the proof."""
        panels = certificate.panels
        used = self.bounds.used(panels.k_upper, panels.sigma1_upper, panels.sigma2_lower)
        failed = (used > 1) & _peaks(used)
        at = np.flatnonzero(failed.any(axis=0))
        places = np.concatenate([panels.start[at], panels.end[at], panels.middle[at]])
        parts = zip(self.samples, self.problem.samples_at(places), strict=True)
        chosen = np.concatenate([self.chosen, *[failed[:, at]] * 3], axis=1)
        return replace(self, samples=Samples(*map(np.concatenate, parts)), chosen=chosen)

    def _peaks(self, used: Array) -> Array:
        """Local extremes; samples that were added are taken for such."""
        peaks = np.ones(used.shape, dtype=bool)
        own = len(self.problem.samples.a)
        peaks[:, :own] = _peaks(used[:, :own])
        return peaks


def _peaks(used: Array) -> Array:
    return (used >= np.roll(used, 1, axis=1)) & (used >= np.roll(used, -1, axis=1))


class Step(NamedTuple):
    """The solution of a program."""

    change: Array | None
    """What to add to the unknowns; None where the program was not solved."""
    decrease: float
    """No point that the program admits lowers its energy by more: by weak duality."""
    status: str
    """Clarabel's; "Solved" to the accuracy that was asked for."""


def solve_program(gradient: Array, active: ActiveSet, v: Array, gap: float) -> Step:
    """Minimise ``|d|^2 / 2 + gradient^T d`` over ``d`` such that ``v + d`` keeps the bounds.

    With the frame ``r`` of a sample (a unit complex number) the bounds become second-order cones:
    ``|f_zbar| <= k Re(conj(r) f_z)``, ``|f_zbar| <= Re(conj(r) f_z) - sigma2``, and
    ``|f_z| <= s``, ``|f_zbar| <= sigma1 - s`` with one more unknown ``s``. The first two imply the
    true bounds, the third is exact. The duality gap is to be at most ``gap``, or
    1e-8 of the decrease where that is more.
    """
    i, j, m = (np.flatnonzero(row) for row in active.chosen)
    if not len(i) + len(j) + len(m):
        return Step(-gradient, float(gradient @ gradient) / 2, "Solved")
    k, sigma1, sigma2 = active.levels(v)
    samples = active.samples
    f, g = samples.values(v)
    size = np.abs(f)
    along = [np.real(samples.a[at] * (f[at].conj() / size[at])[:, None]) for at in (i, m)]
    nothing = np.zeros((len(j), len(v)))
    # Each cone is a head and a complex body, (of d, constant) each.
    cones = [
        (k[i, None] * along[0], k[i] * size[i], samples.b[i], g[i]),
        (along[1], size[m] - sigma2[m], samples.b[m], g[m]),
        (nothing, size[j], samples.a[j], f[j]),
        (nothing, sigma1[j] - size[j], samples.b[j], g[j]),
    ]
    rows = np.concatenate([_triples(head, body) for head, _, body, _ in cones])
    offset = np.concatenate([_triples(head, body) for _, head, _, body in cones])
    # s is counted from where the map is now, and only heads have it.
    of_s = np.kron(np.eye(len(j)), np.array([[1.0], [0.0], [0.0]]))
    without = np.zeros((3 * (len(i) + len(m)), len(j)))
    return _solved(gradient, rows, np.concatenate([without, of_s, -of_s]), offset, gap)


def _triples(head: Array, body: Array) -> Array:
    """Head, real and imaginary part of each cone, one after the other."""
    three = np.stack([head, np.real(body), np.imag(body)], axis=1)
    return three.reshape(3 * len(head), *head.shape[1:])


def _solved(gradient: Array, rows: Array, slack: Array, offset: Array, gap: float) -> Step:
    """Only what the rows see of ``d`` is left to Clarabel; across them it is minus the gradient."""
    q, r = np.linalg.qr(rows.T)
    seen = q.T @ gradient
    across = gradient - q @ seen
    n, n_slack = len(seen), slack.shape[1]
    clarabel: Any = importlib.import_module("clarabel")  # optional, and without type stubs
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = gap
    # Relative to 1 at least, so that the smaller of the two gaps ends a small program.
    settings.tol_gap_rel = min(settings.tol_gap_rel, gap)
    # Clarabel wants b - A x in the cones.
    solution = clarabel.DefaultSolver(
        scipy.sparse.diags_array(np.repeat([1.0, 0.0], [n, n_slack])).tocsc(),
        np.concatenate([seen, np.zeros(n_slack)]),
        scipy.sparse.csc_matrix(-np.concatenate([r.T, slack], axis=1)),
        offset,
        [clarabel.SecondOrderConeT(3)] * (len(rows) // 3),
        settings,
    ).solve()
    status = str(solution.status)
    solved = status in ("Solved", "AlmostSolved")
    change = q @ np.asarray(solution.x)[:n] - across if solved else None
    return Step(change, float(across @ across) / 2 - float(solution.obj_val_dual), status)
