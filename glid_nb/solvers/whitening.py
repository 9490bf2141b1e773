"""Coordinates of the subspace in which the Hessian of an isometric energy is well conditioned.

The derivatives of Cauchy coordinates on the boundary are nearly dependent. The Hessian's condition
number is the square of theirs, too large for single precision. In the coordinates ``x`` with
``phi = T x``, the derivatives ``D T`` are orthonormal along the boundary. Then the Hessian's
condition number is that of ``K``.

``T`` has a row for each column of the basis. Its columns are, in this order: the translation, the
other unknowns, zeros as padding, and one for each logarithm (its scaled coefficient). All columns
but the translation vanish at one point of the boundary. So none of them moves a handle by more than
a length along the boundary. Otherwise the positional energy would dominate the isometric energy.

On a finely divided cage, some large coefficients change the map very little: the derivative is
small, although the coefficients change steeply along the offset cage. Coordinates in these steep
directions need many nodes and gain little. A solve begins without them and later puts back those
that lower the energy (:meth:`~glid_nb.solvers.newton.NewtonDescent.put_back`).
"""

from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple

import numpy as np
import scipy

from glid_nb._jax import AnyArray, Complex, Float, Int, jnp
from glid_nb.harmonic.basis import Basis, column_bucket

# Raises the Gram matrix's diagonal, relative to its mean, in case columns are dependent.
_RIDGE = 1e-13
# Coordinates are scaled so that their slopes along the offset cage have the mean square 1. These
# are limits on the root mean square of their derivatives over the boundary.
# STEEP: coordinates are left out only if some are below this; traced cages have 0.005 and more.
# _LEAST: then all below this are left out. They oscillate about as fast as the panels' nodes.
STEEP, _LEAST = 4.5e-3, 3e-2


class Whitening(NamedTuple):
    """The coordinates of a solve, and the steep ones that are left out."""

    t: Float[np.ndarray, "2 c u"]  # as (Re, Im)
    steep: Complex[np.ndarray, "c k"]
    """Columns left out; they are orthonormal, also to those of ``t``."""

    def with_steep(self, chosen: Int[np.ndarray, " m"], n_hole_columns: int) -> "Whitening":
        """Add some of the steep columns to the coordinates."""
        t = self.t[0] + 1j * self.t[1]
        own, logarithms = np.split(t, [t.shape[1] - n_hole_columns], axis=1)
        kept = own[:, : 1 + np.flatnonzero(own.any(axis=0)).max()]
        whole = _padded(np.hstack([kept, self.steep[:, chosen]]), logarithms)
        return Whitening(whole, np.delete(self.steep, chosen, axis=1))


def whitening(
    rows: Complex[np.ndarray, "s c"],
    weights: Float[np.ndarray, " s"],
    anchor: Complex[np.ndarray, " c"],
    basis: Basis,
    whole: bool = False,
) -> Whitening:
    """Compute ``T``.

    ``rows`` is ``D`` at samples of the boundary, ``weights`` their quadrature weights. ``anchor``
    is ``C`` at the point where all columns but the translation vanish. ``whole`` keeps all
    coordinates, the steep ones too.
    """
    c, scaled = basis.n_columns, np.sqrt(weights)[:, None] * rows
    single_valued = np.flatnonzero(basis.psi_free)
    # The first entry is the exterior's first vertex, which is no unknown of psi either.
    logarithms = np.flatnonzero(basis.phi_free & ~basis.psi_free)[1:]
    columns = scaled[:, single_valued]
    gram = columns.conj().T @ columns
    gram[np.diag_indices_from(gram)] += _RIDGE * np.trace(gram).real / len(gram)
    lower = scipy.linalg.cholesky(gram, lower=True)
    inverse = scipy.linalg.solve_triangular(lower, np.eye(len(gram)), lower=True)
    steep = inverse[:0]
    if not whole:
        inverse, steep = _without_steep(inverse, single_valued, basis)

    own = np.zeros((c, 1 + len(inverse) + len(steep)), dtype=complex)
    own[: basis.n_exterior, 0] = 1
    own[single_valued, 1:] = np.vstack([inverse, steep]).conj().T
    holes = np.zeros((c, basis.n_hole_columns), dtype=complex)
    for j in logarithms:
        along = inverse.conj().T @ (inverse @ (columns.conj().T @ scaled[:, j]))
        rest = np.linalg.norm(scaled[:, j] - columns @ along)
        place = j - c + basis.n_hole_columns
        holes[single_valued, place], holes[j, place] = -along / rest, 1 / rest
    for part in (own[:, 1:], holes):
        part[: basis.n_exterior] -= anchor @ part
    kept, steep_columns = np.split(own, [1 + len(inverse)], axis=1)
    return Whitening(_padded(kept, holes), steep_columns)


def _padded(
    own: Complex[np.ndarray, "c k"], logarithms: Complex[np.ndarray, "c N"]
) -> Float[np.ndarray, "2 c u"]:
    """Columns, zeros as padding, then the logarithms; as (Re, Im)."""
    c, count = len(own), own.shape[1] + logarithms.shape[1]
    t = np.hstack([own, np.zeros((c, column_bucket(count) - count)), logarithms])
    return np.stack([np.real(t), np.imag(t)])


def _without_steep(
    inverse: Complex[np.ndarray, "n n"], chosen: Int[np.ndarray, " n"], basis: Basis
) -> tuple[Complex[np.ndarray, "k n"], Complex[np.ndarray, "m n"]]:
    """Split the chosen columns' coordinates, as conjugate rows, into those kept and the steep."""
    values = np.zeros((basis.n_columns, len(inverse)), dtype=complex)
    values[chosen] = inverse.conj().T
    vertices, _, previous, _ = basis.singularities
    own = basis.columns[basis.columns < len(vertices)]
    edges = np.abs(vertices - vertices[previous])[own]
    rises = (values[own] - values[previous[own]]) / np.sqrt(edges * edges.sum())[:, None]
    if np.linalg.norm(rises) <= 1 / STEEP:
        return inverse, inverse[:0]
    squares, turn = scipy.linalg.eigh(rises.conj().T @ rises)
    if squares[-1] <= STEEP**-2:
        return inverse, inverse[:0]
    rows, first = turn.conj().T @ inverse, np.searchsorted(squares, _LEAST**-2, side="right")
    return rows[:first], rows[first:]


def whitened(
    nodes: Float[AnyArray, "2c s"],
    index: Int[AnyArray, " h"],
    t: Float[AnyArray, "2 c u"],
    dtype: type[np.floating],
) -> Float[np.ndarray, "2u h"]:
    """``D T`` at some nodes, from ``D``; both as ``[Re, -Im]``, transposed."""
    re, minus_im = np.split(np.asarray(nodes)[:, index], 2)
    t_re, t_im = np.asarray(t)
    parts = [t_re.T @ re + t_im.T @ minus_im, t_re.T @ minus_im - t_im.T @ re]
    return np.concatenate(parts).astype(dtype)


def coefficients(x: Float[Array, " 4u"], t: Float[Array, "2 c u"]) -> Float[Array, " 4c"]:
    """``[Re phi, Im phi, Re psi, Im psi]`` from coordinates in the same layout."""
    x = x.reshape(2, 2, -1)
    re, im = x[:, 0], x[:, 1]
    return jnp.stack([re @ t[0].T - im @ t[1].T, re @ t[1].T + im @ t[0].T], axis=1).ravel()


def pulled_back(rows: Float[AnyArray, "*r 4c"], t: Float[Array, "2 c u"]) -> Float[Array, "*r 4u"]:
    """Derivatives with respect to coordinates, from those with respect to coefficients."""
    xp = t.__array_namespace__()
    parts = rows.reshape(-1, 2, t.shape[1])
    re, im = parts[:, 0], parts[:, 1]  # one product for all rows, not one for each
    pulled = xp.stack([re @ t[0] + im @ t[1], im @ t[0] - re @ t[1]], axis=-2)
    return pulled.reshape(*rows.shape[:-1], -1)
