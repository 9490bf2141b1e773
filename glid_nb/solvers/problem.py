"""A deformation problem as data for compiled programs (paper Sections 5 and 6)."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import AnyArray, jnp
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, basis_of, cauchy
from glid_nb.harmonic.basis import Basis
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.solvers.discretisation import Discretisation, Matrices, basis_rows, padded
from glid_nb.solvers.pose import Pose
from glid_nb.solvers.unknowns import Unknowns

if TYPE_CHECKING:
    from jaxtyping import Array, Float

_HANDLE_BUCKET = 8


class Constraints(NamedTuple):
    """Handles and targets, padded to a bucket (paper Section 6.1, Appendix F)."""

    handles: Float[AnyArray, "h 2c"]
    """``C`` at the handles as ``[Re C, -Im C]``."""
    targets: Float[AnyArray, "h 2"]
    weights: Float[AnyArray, " h"]
    """``lambda`` for a handle, 0 for padding."""


class Problem(NamedTuple):
    """What is minimised, over which unknowns; a pytree, padded to buckets."""

    matrices: Matrices
    singularities: Singularities
    unknowns: Unknowns
    constraints: Constraints
    energy: Energy


class Positional(NamedTuple):
    """The positional energy ``1/2 |A y - b|^2`` with weights (20), as (F.5) writes it."""

    matrix: Float[Array, "2h 4c"]
    """First all rows for the real parts, then those for the imaginary."""
    aims: Float[AnyArray, " 2h"]
    weights: Float[Array, " 2h"]

    @classmethod
    def of(cls, constraints: Constraints) -> Positional:
        """The energy of some constraints."""
        c = constraints.handles.shape[1] // 2
        re, minus_im = constraints.handles[:, :c], constraints.handles[:, c:]
        matrix = jnp.block([[re, minus_im, re, minus_im], [-minus_im, re, minus_im, -re]])
        weights = jnp.concatenate([constraints.weights, constraints.weights])
        return cls(matrix, constraints.targets.T.ravel(), weights)

    def residual(self, y: Float[Array, " 4c"]) -> Float[Array, " 2h"]:
        """``A y - b``."""
        return self.matrix @ y - self.aims

    def energy(self, y: Float[Array, " 4c"]) -> Float[Array, ""]:
        """The energy at the coefficients ``y``."""
        return 0.5 * jnp.sum(self.weights * self.residual(y) ** 2)

    def gradient(self, y: Float[Array, " 4c"]) -> Float[Array, " 4c"]:
        """Its gradient."""
        return self.matrix.T @ (self.weights * self.residual(y))


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
def _rows_at(domain: Domain, points: bytes) -> NDArray[Any]:
    """``C`` at complex points, kept for the next targets of the same handles."""
    return basis_rows(cauchy.cauchy_coordinates, np.frombuffer(points, complex), basis_of(domain))


def handle_images(constraints: Constraints, basis: Basis, map: HarmonicMap) -> NDArray[Any]:
    """(h, 2) images of the padded handles."""
    c = basis.n_columns
    rows = constraints.handles[:, :c] - 1j * constraints.handles[:, c:]
    images = rows @ basis.pad(map.phi) + np.conj(rows @ basis.pad(map.psi))
    return np.stack([np.real(images), np.imag(images)], axis=1)


def real_coefficients(basis: Basis, map: HarmonicMap) -> NDArray[Any]:
    """Padded ``[Re phi, Im phi, Re psi, Im psi]`` of a map."""
    phi, psi = basis.pad(map.phi), basis.pad(map.psi)
    return np.concatenate([np.real(phi), np.imag(phi), np.real(psi), np.imag(psi)])


def map_from(discretisation: Discretisation, coefficients: Any) -> HarmonicMap:
    """The map of padded real coefficients ``[Re phi, Im phi, Re psi, Im psi]``."""
    basis = discretisation.basis
    re_phi, im_phi, re_psi, im_psi = np.asarray(coefficients).reshape(4, -1)[:, basis.columns]
    return HarmonicMap(discretisation.domain, re_phi + 1j * im_phi, re_psi + 1j * im_psi)
