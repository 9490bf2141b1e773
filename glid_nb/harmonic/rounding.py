"""Bounds on the rounding errors of values of the basis.

Sums are computed in double precision, of unit roundoff ``u``. `docs/proof.md` derives every
constant (Lemmas 10 to 13).
"""

import math
from typing import Any as Array  # of NumPy or of JAX
from typing import NamedTuple

from glid_nb._jax import Bool, Complex, Float
from glid_nb.harmonic import cauchy
from glid_nb.harmonic.cauchy import Matrix, Points, Singularities

Edges = Complex[Array, "r n"]  # as of `cauchy.edge_coefficients`, any number of rows
Derivatives = tuple[
    Complex[Array, "r k"], Complex[Array, "r k"], Float[Array, "r k"], Float[Array, "r k"]
]

UNIT_ROUNDOFF = 2.0**-53

ELEMENTARY = 2.0
"""Largest relative error of the real ``log`` and ``atan2`` of NumPy and XLA, in roundoffs."""
COMPLEX_QUOTIENT = 8.0  # the same for complex division, by the modulus of the error
LOGARITHM = 16.0  # largest error of ``Log(B_{j+1} / B_j)``, in roundoffs of ``1 + |Log|``
CUT = 64 * UNIT_ROUNDOFF
"""Within this of pi, the angle of an edge may be on the wrong side of the logarithm's cut."""
UPWARD = 1 + 2.0**-30
"""A factor larger than the rounding of all sums of positive numbers that make a bound."""
UNDERFLOW = 1e-140
"""Is added to all errors, so that nothing is proved of numbers that underflow."""


def slack_factor(n_columns: int) -> float:
    """For sums of ``n_columns`` terms, relative to the sum of the moduli of all (Lemma 12)."""
    return (3 * n_columns + 128) * UNIT_ROUNDOFF


class DerivativeRows(NamedTuple):
    """What :func:`derivatives` needs of k points; it does not depend on the map."""

    first: Matrix
    """:func:`~glid_nb.harmonic.cauchy.first_by_edges`."""
    second: Matrix
    """:func:`~glid_nb.harmonic.cauchy.second_by_edges`."""
    first_size: Float[Array, "k n"]  # moduli of both
    second_size: Float[Array, "k n"]
    near_cut: Bool[Array, " k"]
    """Where an edge is so close to the logarithm's cut that a computed logarithm may be wrong."""


def derivative_rows(z: Points, singularities: Singularities) -> DerivativeRows:
    """The rows for :func:`derivatives_by` at (k,) complex points."""
    first = cauchy.first_by_edges(z, singularities)
    second = cauchy.second_by_edges(z, singularities)
    xp, m = z.__array_namespace__(), singularities.vertices.shape[0]
    near_cut = xp.any(xp.abs(xp.real(first[:, :m])) > 0.5 - CUT, axis=1)
    return DerivativeRows(first, second, xp.abs(first), xp.abs(second), near_cut)


def derivatives_by(rows: DerivativeRows, edges: Edges, singularities: Singularities) -> Derivatives:
    """:func:`derivatives` at the points of these rows."""
    xp, m = edges.__array_namespace__(), singularities.vertices.shape[0]
    size, factor = xp.abs(edges), slack_factor(edges.shape[1])
    of_logarithms = LOGARITHM * UNIT_ROUNDOFF * xp.sum(size[:, :m], axis=1, keepdims=True) / math.pi
    off = factor * (size @ rows.first_size.T) + of_logarithms
    off = UPWARD * xp.where(rows.near_cut, xp.inf, off)
    second_off = UPWARD * factor * (size @ rows.second_size.T)
    return edges @ rows.first.T, edges @ rows.second.T, off, second_off


def derivatives(z: Points, edges: Edges, singularities: Singularities) -> Derivatives:
    """``f_z`` and ``conj(f_zbar)``, their derivatives, and bounds on the errors of both.

    ``edges`` are the (2, n) :func:`~glid_nb.harmonic.cauchy.edge_coefficients`.
    """
    return derivatives_by(derivative_rows(z, singularities), edges, singularities)
