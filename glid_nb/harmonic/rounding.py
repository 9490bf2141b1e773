"""Bounds on the rounding errors of values of the basis.

Sums are computed in double precision, of unit roundoff ``u``. `docs/proof.md` derives every
constant (Lemmas 10 to 13).
"""

import math
from typing import Any as Array  # of NumPy or of JAX

from glid_nb._jax import Complex, Float
from glid_nb.harmonic import cauchy
from glid_nb.harmonic.cauchy import Points, Singularities

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


def derivatives(
    z: Points, edges: Complex[Array, "2 n"], singularities: Singularities
) -> tuple[Complex[Array, "2 k"], Complex[Array, "2 k"], Float[Array, "2 k"], Float[Array, "2 k"]]:
    """``f_z`` and ``conj(f_zbar)``, their derivatives, and bounds on the errors of both."""
    first = cauchy.first_by_edges(z, singularities)
    second = cauchy.second_by_edges(z, singularities)
    xp, m = z.__array_namespace__(), singularities.vertices.shape[0]
    size, factor = xp.abs(edges), slack_factor(edges.shape[1])
    of_logarithms = LOGARITHM * UNIT_ROUNDOFF * xp.sum(size[:, :m], axis=1, keepdims=True) / math.pi
    off = factor * (size @ xp.abs(first).T) + of_logarithms
    # Near the cut a computed logarithm may be the wrong one.
    near_cut = xp.any(xp.abs(xp.real(first[:, :m])) > 0.5 - CUT, axis=1)
    off = UPWARD * xp.where(near_cut, xp.inf, off)
    second_off = UPWARD * factor * (size @ xp.abs(second).T)
    return edges @ first.T, edges @ second.T, off, second_off
