"""Coordinates of the subspace in which the Hessian of an isometric energy is well conditioned.

The derivatives of Cauchy coordinates on the boundary are nearly dependent, and the Hessian's
condition is the square of theirs, beyond what single precision resolves. In coordinates ``x`` with
``phi = T x``, where the derivatives ``D T`` are orthonormal along the boundary, it is ``K``'s.

``T`` has a row for each column, and columns for the translation, for the other unknowns, zeros for
padding, and last one for each logarithm, its coefficient, scaled. All but the translation vanish at
one point of the boundary, so none moves a handle by more than its length along the boundary: else
the positional energy would swamp the other.

On a finely divided cage some large coefficients make next to no map but rounding errors, for which
the certificate has to allow. Directions in which the derivative is small against the slopes of the
coefficients along the offset cage have no coordinate.
"""

from typing import Any as Array  # of NumPy or of JAX

import numpy as np
import scipy

from glid_nb._jax import AnyArray, Complex, Float, Int, jnp
from glid_nb.harmonic.basis import Basis, column_bucket

# Raises the Gram matrix's diagonal, relative to its mean, should columns be dependent.
_RIDGE = 1e-13
# Derivatives, in the mean square over the boundary, of coordinates whose slopes along the offset
# cage have the mean square 1. Where some are below the first number (traced cages have 0.005 and
# more), those below the second are left out: they oscillate faster than the panels' nodes can tell.
_STEEP, _LEAST = 4.5e-3, 3e-2


def whitening(
    rows: Complex[np.ndarray, "s c"],
    weights: Float[np.ndarray, " s"],
    anchor: Complex[np.ndarray, " c"],
    basis: Basis,
) -> Float[np.ndarray, "2 c u"]:
    """``T`` as (Re, Im), from ``D`` at samples of the boundary (``rows``), their quadrature's
    ``weights``, and ``C`` at the ``anchor`` where all but the translation vanish."""
    c, scaled = basis.n_columns, np.sqrt(weights)[:, None] * rows
    single_valued = np.flatnonzero(basis.psi_free)
    # The exterior's first is no unknown of psi either.
    logarithms = np.flatnonzero(basis.phi_free & ~basis.psi_free)[1:]
    columns = scaled[:, single_valued]
    gram = columns.conj().T @ columns
    gram[np.diag_indices_from(gram)] += _RIDGE * np.trace(gram).real / len(gram)
    lower = scipy.linalg.cholesky(gram, lower=True)
    inverse = scipy.linalg.solve_triangular(lower, np.eye(len(gram)), lower=True)
    inverse = _without_steep(inverse, single_valued, basis)

    kept, n_holes = len(inverse), basis.n_hole_columns
    u = column_bucket(1 + kept + n_holes)
    t = np.zeros((c, u), dtype=complex)
    t[: basis.n_exterior, 0] = 1
    t[single_valued, 1 : 1 + kept] = inverse.conj().T
    for j in logarithms:
        along = inverse.conj().T @ (inverse @ (columns.conj().T @ scaled[:, j]))
        rest = np.linalg.norm(scaled[:, j] - columns @ along)
        t[single_valued, u - c + j], t[j, u - c + j] = -along / rest, 1 / rest
    t[: basis.n_exterior, 1:] -= anchor @ t[:, 1:]
    return np.stack([np.real(t), np.imag(t)])


def _without_steep(
    inverse: Complex[np.ndarray, "n n"], chosen: Int[np.ndarray, " n"], basis: Basis
) -> Complex[np.ndarray, "k n"]:
    """The chosen columns' coordinates, conjugate rows, without those of steep slopes if any is."""
    values = np.zeros((basis.n_columns, len(inverse)), dtype=complex)
    values[chosen] = inverse.conj().T
    vertices, _, previous, _ = basis.singularities
    own = basis.columns[basis.columns < len(vertices)]
    edges = np.abs(vertices - vertices[previous])[own]
    rises = (values[own] - values[previous[own]]) / np.sqrt(edges * edges.sum())[:, None]
    if np.linalg.norm(rises) <= 1 / _STEEP:
        return inverse
    squares, turn = scipy.linalg.eigh(rises.conj().T @ rises)
    if squares[-1] <= _STEEP**-2:
        return inverse
    return turn[:, squares <= _LEAST**-2].conj().T @ inverse


def whitened(
    nodes: Float[AnyArray, "2c s"],
    index: Int[AnyArray, " h"],
    t: Float[AnyArray, "2 c u"],
    dtype: type[np.floating],
) -> Float[np.ndarray, "2u h"]:
    """``D T`` at some nodes from ``D``, both as ``[Re, -Im]``, transposed."""
    re, minus_im = np.split(np.asarray(nodes)[:, index], 2)
    t_re, t_im = np.asarray(t)
    parts = [t_re.T @ re + t_im.T @ minus_im, t_re.T @ minus_im - t_im.T @ re]
    return np.concatenate(parts).astype(dtype)


def coefficients(x: Float[Array, " 4u"], t: Float[Array, "2 c u"]) -> Float[Array, " 4c"]:
    """``[Re phi, Im phi, Re psi, Im psi]`` of coordinates laid out alike."""
    x = x.reshape(2, 2, -1)
    re, im = x[:, 0], x[:, 1]
    return jnp.stack([re @ t[0].T - im @ t[1].T, re @ t[1].T + im @ t[0].T], axis=1).ravel()


def pulled_back(rows: Float[AnyArray, "*r 4c"], t: Float[Array, "2 c u"]) -> Float[Array, "*r 4u"]:
    """Derivatives with respect to coordinates from those with respect to coefficients."""
    xp = t.__array_namespace__()
    parts = rows.reshape(-1, 2, t.shape[1])
    re, im = parts[:, 0], parts[:, 1]  # one product for all rows, not one for each
    pulled = xp.stack([re @ t[0] + im @ t[1], im @ t[0] - re @ t[1]], axis=-2)
    return pulled.reshape(*rows.shape[:-1], -1)
