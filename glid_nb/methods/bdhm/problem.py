"""Domain and pose as linear functions of unknowns that make the energy with fixed frames round."""

from typing import NamedTuple

import numpy as np
import scipy

from glid_nb._arrays import Array
from glid_nb._jax import jax, jnp
from glid_nb._runtime import double_precision
from glid_nb.certificate import Certificate, certify
from glid_nb.geometry import Domain, graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.solvers import Pose
from glid_nb.solvers.discretisation import complex_basis
from glid_nb.solvers.problem import map_from, positional_energy, real_coefficients
from glid_nb.solvers.subspace import aligned
from glid_nb.solvers.unknowns import canonical, expand, unknowns_of

_RATIO = 0.5  # panels this long relative to their distance from the singularities carry the samples
# What a step costs, beside the energy, while fewer than two handles hold the map's rotation.
_RIDGE = 1e-6


class Samples(NamedTuple):
    """``f_z = a v`` and ``conj(f_zbar) = b v`` at samples, both complex."""

    a: Array
    b: Array

    def values(self, v: Array) -> tuple[Array, Array]:
        return self.a @ v, self.b @ v


class BoundedProblem:
    """The energy of a map; with frames held fixed it is ``|v|^2 / 2`` plus something linear."""

    @double_precision
    def __init__(
        self,
        domain: Domain,
        pose: Pose,
        p2p_weight: float,
        map: HarmonicMap | None = None,
        damping: float = 1.0,
    ) -> None:
        self.domain, self.pose = domain, pose
        self._basis = basis_of(domain)
        # The holes' psi = conj(phi) are no unknowns of their own.
        unknowns = unknowns_of(self._basis, False)
        self._free = np.flatnonzero(unknowns.free)
        changes = jnp.asarray(np.eye(len(unknowns.free))[self._free])
        self._expansion = np.array(jax.vmap(expand, (0, None))(changes, unknowns)).T.copy()
        self._panels = graded_panels(domain, _RATIO)
        self._shares = self._panels.length / self._panels.length.sum()
        self.samples = self.samples_at(self._panels.middle)
        self.positional = positional = positional_energy(domain, pose, p2p_weight, map, damping)
        root = np.sqrt(np.asarray(positional.weights))
        rows = root[:, None] * (np.asarray(positional.matrix) @ self._expansion)
        self._aims = root * np.asarray(positional.aims)
        self._factor = self._triangular(rows)
        inverse = scipy.linalg.solve_triangular(self._factor, np.eye(len(self._factor)))
        self._expansion = self._expansion @ inverse
        self.samples = Samples(self.samples.a @ inverse, self.samples.b @ inverse)
        self._rows = rows @ inverse

    @double_precision
    def samples_at(self, points: Array) -> Samples:
        d = complex_basis(cauchy.first_derivatives, points, self._basis)
        phi, psi = _split(self._expansion)
        return Samples(d @ phi, d @ psi)

    def unknowns(self, map: HarmonicMap, align: bool) -> Array:
        """The unknowns of a map, rigidly moved toward the targets if asked for."""
        map = canonical(aligned(map, self.pose) if align else map)
        return self._factor @ real_coefficients(self._basis, map)[self._free]

    def map_of(self, v: Array) -> HarmonicMap:
        return map_from(self.domain, self._expansion @ v)

    def certified(self, v: Array, tightness: float) -> Certificate:
        return certify(self.map_of(v), panels=self._panels, tightness=tightness)

    def energies(self, v: Array) -> tuple[float, float]:
        """ARAP along the boundary, and the positional part."""
        f, g = self.samples.values(v)
        arap = 2 * (np.abs(f) - 1) ** 2 + 2 * np.abs(g) ** 2
        return float(self._shares @ arap), 0.5 * float(((self._rows @ v - self._aims) ** 2).sum())

    def gradient(self, v: Array) -> Array:
        """Of the energy, and of the energy with the frames at ``v`` held fixed."""
        f, g = self.samples.values(v)
        pull = self.samples.a.conj().T @ (4 * self._shares * (f - f / np.abs(f)))
        pull += self.samples.b.conj().T @ (4 * self._shares * g)
        return np.real(pull) + self._rows.T @ (self._rows @ v - self._aims)

    def _triangular(self, positional: Array) -> Array:
        """``R`` with ``R^T R`` the energy's matrix, without squaring its condition."""
        root = np.sqrt(4 * self._shares)[:, None]
        rows = [root * self.samples.a, root * self.samples.b]
        stacked = [*(part for row in rows for part in (row.real, row.imag)), positional]
        if len(self.pose) < 2:
            stacked.append(np.sqrt(_RIDGE) * np.eye(positional.shape[1]))
        return np.asarray(np.linalg.qr(np.concatenate(stacked), mode="r"))


def _split(full: Array) -> tuple[Array, Array]:
    re_phi, im_phi, re_psi, im_psi = np.split(full, 4)
    return re_phi + 1j * im_phi, re_psi + 1j * im_psi
