"""One step of BDHM: a convex program with fixed frames ``f_z / |f_z|``, and its bounds.

The unknowns ``v`` are chosen so that the Hessian of the energy with fixed frames is the identity.
"""

import importlib
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, Self

import numpy as np
import scipy

from glid_nb._arrays import Array
from glid_nb._jax import jax, jnp
from glid_nb._runtime import double_precision
from glid_nb.certificate import Certificate
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.pose import Pose
from glid_nb.solvers.discretisation import complex_basis
from glid_nb.solvers.positional import positional_energy
from glid_nb.solvers.problem import (
    aligned,
    canonical,
    expand,
    map_from,
    real_coefficients,
    unknowns_of,
)

_RATIO = 0.5  # length of the panels of samples, relative to their distance from singularities
# With fewer than two handles, rotations cost nothing. Then this quadratic term is added.
_RIDGE = 1e-6
# The bounds at samples are stricter than the proved bounds by this share of the bound's range.
MARGIN = 0.01
# A sample outside the active set joins when it uses more than this share of the margin.
_SLACK = 0.1
# A sample joins the active set closer to a bound than _JOIN, and leaves it farther than _LEAVE.
# Both are shares of the bound's range.
_JOIN, _LEAVE = 0.10, 0.15


class SampleRows(NamedTuple):
    """``f_z = a v`` and ``conj(f_zbar) = b v`` at samples, both complex."""

    a: Array
    b: Array

    def values(self, v: Array) -> tuple[Array, Array]:
        return self.a @ v, self.b @ v


class BoundedProblem:
    """The energy of a map. With fixed frames it is ``|v|^2 / 2`` plus a linear function."""

    @double_precision
    def __init__(
        self, map: HarmonicMap, pose: Pose, p2p_weight: float, damping: float = 1.0
    ) -> None:
        domain = self.domain = map.domain
        self.pose = pose
        self._basis = basis_of(domain)
        # The holes' psi = conj(phi) are not separate unknowns.
        unknowns = unknowns_of(self._basis, False)
        self._free = np.flatnonzero(unknowns.free)
        changes = jnp.asarray(np.eye(len(unknowns.free))[self._free])
        self._expansion = np.array(jax.vmap(expand, (0, None))(changes, unknowns)).T.copy()
        self.panels = graded_panels(domain, _RATIO)
        self._shares = self.panels.length / self.panels.length.sum()
        self.samples = self.samples_at(self.panels.middle)
        self.positional = positional = positional_energy(map, pose, p2p_weight, damping)
        root = np.sqrt(np.asarray(positional.weights))
        rows = root[:, None] * (np.asarray(positional.matrix) @ self._expansion)
        self._aims = root * np.asarray(positional.aims)
        # R such that R^T R is the energy's matrix. QR does not square the condition number.
        share = np.sqrt(4 * self._shares)[:, None]
        stacked = [share * part(row) for row in self.samples for part in (np.real, np.imag)]
        ridge = np.sqrt(_RIDGE) / domain.cage.unit * np.eye(rows.shape[1])
        stacked += [rows, ridge] if len(pose) < 2 else [rows]
        self._factor = np.asarray(np.linalg.qr(np.concatenate(stacked), mode="r"))
        inverse = scipy.linalg.solve_triangular(self._factor, np.eye(len(self._factor)))
        self._expansion = self._expansion @ inverse
        self.samples = SampleRows(self.samples.a @ inverse, self.samples.b @ inverse)
        self._rows = rows @ inverse

    @double_precision
    def samples_at(self, points: Array) -> SampleRows:
        d = complex_basis(cauchy.first_derivatives, points, self._basis)
        re_phi, im_phi, re_psi, im_psi = np.split(self._expansion, 4)
        return SampleRows(d @ (re_phi + 1j * im_phi), d @ (re_psi + 1j * im_psi))

    def unknowns(self, map: HarmonicMap, align: bool) -> Array:
        map = canonical(aligned(map, self.pose) if align else map)
        return self._factor @ real_coefficients(map)[self._free]

    def map_of(self, v: Array) -> HarmonicMap:
        return map_from(self.domain, self._expansion @ v)

    def energies(self, v: Array) -> tuple[float, float]:
        """The mean ARAP energy along the boundary, and the positional energy."""
        f, g = self.samples.values(v)
        arap = 2 * (np.abs(f) - 1) ** 2 + 2 * np.abs(g) ** 2
        return float(self._shares @ arap), 0.5 * float(((self._rows @ v - self._aims) ** 2).sum())

    def gradient(self, v: Array) -> Array:
        """Gradient of the energy; also of the energy with the frames fixed at ``v``."""
        f, g = self.samples.values(v)
        pull = self.samples.a.conj().T @ (4 * self._shares * (f - f / np.abs(f)))
        pull += self.samples.b.conj().T @ (4 * self._shares * g)
        return np.real(pull) + self._rows.T @ (self._rows @ v - self._aims)


def _bound(default: float, **limits: float) -> Any:
    why = ", because the method starts at an isometry"
    return field(default=default, metadata={**limits, "why": why})


@dataclass(frozen=True)
class DistortionBounds:
    """The bounds ``k(z) <= k``, ``sigma_1(z) <= sigma1`` and ``sigma_2(z) >= sigma2`` (Theorem
    4.2). An isometry must satisfy them strictly."""

    k: float = _bound(0.8, above=0, below=1)
    sigma1: float = _bound(5.0, above=1)
    sigma2: float = _bound(0.3, above=0, below=1)

    def hold(self, certificate: Certificate) -> bool:
        return (
            certificate.certified
            and certificate.k_upper <= self.k
            and certificate.sigma1_upper <= self.sigma1
            and certificate.sigma2_lower >= self.sigma2
        )

    @property
    def narrowest(self) -> float:
        """The smallest of the bounds' ranges, each relative to its bound, at most 1."""
        return min(1.0, (self.sigma1 - 1) / self.sigma1, (1 - self.sigma2) / self.sigma2)

    def used(self, k: Array, sigma1: Array, sigma2: Array) -> Array:
        """(3, n) shares of the way from an isometry to each bound."""
        most, least = self.sigma1 - 1, 1 - self.sigma2
        return np.stack([k / self.k, (sigma1 - 1) / most, (1 - sigma2) / least])


@dataclass(frozen=True, eq=False)
class ActiveSet:
    problem: BoundedProblem
    bounds: DistortionBounds
    samples: SampleRows  # the problem's own in order, then those added after failed proofs
    chosen: Array  # (3, n) bool: the samples where k, sigma_1 and sigma_2 are bounded
    excess: float = 1.0
    """If the current map exceeds the stricter bounds, the next map may exceed them by this share.
    With 1 the current map is always feasible. A smaller share moves the map inwards."""

    def used(self, v: Array) -> Array:
        f, g = (np.abs(part) for part in self.samples.values(v))
        return self.bounds.used(g / np.maximum(f, 1e-300), f + g, f - g)

    def levels(self, v: Array) -> tuple[Array, Array, Array]:
        """The limits of k, sigma_1 and sigma_2 for the next map, at each sample."""
        strict, bounds = 1 - MARGIN, self.bounds
        k, sigma1, sigma2 = strict + self.excess * np.maximum(self.used(v) - strict, 0)
        return k * bounds.k, 1 + sigma1 * (bounds.sigma1 - 1), 1 - sigma2 * (1 - bounds.sigma2)

    def around(self, v: Array) -> Self:
        """Add the local extremes near a bound, and drop samples far from it."""
        used = self.used(v)
        kept = self.chosen & (used > 1 - _LEAVE)
        return replace(self, chosen=kept | (self._peaks(used) & (used > 1 - _JOIN)))

    def and_violated(self, v: Array) -> Self:
        """Add the local extremes beyond a bound; the same object if there are no new ones."""
        used = self.used(v)
        beyond = self._peaks(used) & (used > 1 - (1 - _SLACK) * MARGIN) & ~self.chosen
        return replace(self, chosen=self.chosen | beyond) if beyond.any() else self

    def widened(self, certificate: Certificate) -> Self:
        """Add samples on panels that fail the proof. Only local extremes among them count."""
        panels = certificate.panels
        used = self.bounds.used(panels.k_upper, panels.sigma1_upper, panels.sigma2_lower)
        failed = (used > 1) & _peaks(used)
        at = np.flatnonzero(failed.any(axis=0))
        places = np.concatenate([panels.start[at], panels.end[at], panels.middle[at]])
        parts = zip(self.samples, self.problem.samples_at(places), strict=True)
        chosen = np.concatenate([self.chosen, *[failed[:, at]] * 3], axis=1)
        return replace(self, samples=SampleRows(*map(np.concatenate, parts)), chosen=chosen)

    def _peaks(self, used: Array) -> Array:
        """(3, n) bool: local extremes. Samples added after failed proofs count as extremes."""
        peaks = np.ones(used.shape, dtype=bool)
        own = len(self.problem.samples.a)
        peaks[:, :own] = _peaks(used[:, :own])
        return peaks


def _peaks(used: Array) -> Array:
    return (used >= np.roll(used, 1, axis=1)) & (used >= np.roll(used, -1, axis=1))


class Step(NamedTuple):
    change: Array | None  # to add to the unknowns; None if the program was not solved
    decrease: float  # by weak duality, no feasible point lowers the energy by more
    status: str  # Clarabel's status; "Solved" means solved to the wanted accuracy


def solve_program(gradient: Array, active: ActiveSet, v: Array, gap: float) -> Step:
    """Minimise ``|d|^2 / 2 + gradient^T d`` over ``d`` such that ``v + d`` keeps the bounds.

    With the frame ``r`` of a sample (a unit complex number) the bounds become second-order cones:
    ``|f_zbar| <= k Re(conj(r) f_z)``, ``|f_zbar| <= Re(conj(r) f_z) - sigma2``, and ``|f_z| <= s``,
    ``|f_zbar| <= sigma1 - s`` with one more unknown ``s``. The duality gap is at most ``gap`` or
    1e-8 of the decrease, whichever is larger.
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
    # Each cone has a head and a complex body. Each of these is a matrix for d and a constant.
    cones = [
        (k[i, None] * along[0], k[i] * size[i], samples.b[i], g[i]),
        (along[1], size[m] - sigma2[m], samples.b[m], g[m]),
        (nothing, size[j], samples.a[j], f[j]),
        (nothing, sigma1[j] - size[j], samples.b[j], g[j]),
    ]
    rows = np.concatenate([_triples(head, body) for head, _, body, _ in cones])
    offset = np.concatenate([_triples(head, body) for _, head, _, body in cones])
    # s is measured from its value at the current map. It occurs in heads only.
    of_s = np.kron(np.eye(len(j)), np.array([[1.0], [0.0], [0.0]]))
    without = np.zeros((3 * (len(i) + len(m)), len(j)))
    return _solved(gradient, rows, np.concatenate([without, of_s, -of_s]), offset, gap)


def _triples(head: Array, body: Array) -> Array:
    three = np.stack([head, np.real(body), np.imag(body)], axis=1)
    return three.reshape(3 * len(head), *head.shape[1:])


def _solved(gradient: Array, rows: Array, slack: Array, offset: Array, gap: float) -> Step:
    """Solve the cone program with Clarabel for the part of ``d`` in the span of the rows. The part
    orthogonal to it is minus the gradient."""
    q, r = np.linalg.qr(rows.T)
    seen = q.T @ gradient
    across = gradient - q @ seen
    n, n_slack = len(seen), slack.shape[1]
    clarabel: Any = importlib.import_module("clarabel")  # optional, and without type stubs
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = gap
    # Clarabel's relative gap is relative to at least 1. So this bounds small programs too.
    settings.tol_gap_rel = min(settings.tol_gap_rel, gap)
    # Clarabel's constraint is that b - A x lies in the cones.
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
