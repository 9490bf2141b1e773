"""Bounds on the rounding errors of the certificate, and its bounds rounded for text.

The certificate's inequalities are evaluated in double precision. Each panel's remainder is
enlarged by ``slack_factor(n) * scale * max_j |phi_j|``, a first-order running error bound
(Higham, Accuracy and Stability of Numerical Algorithms, Section 3) for the ``n``-term sums
``f_z = sum_j D_j phi_j``, the moduli of whose terms add up to at most ``scale * max |phi_j|``:
``n`` roundings for the sum, and 64 for computing ``D_j``, control points and Bernstein
coefficients.

A solver carries values along, ``f_z + t df_z``, instead of computing them anew. Each step adds the
error of a sum whose coefficients ``t dphi`` have up to twice the largest modulus so far.
"""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from typing import TYPE_CHECKING

from glid_nb._jax import jnp
from glid_nb.harmonic.cauchy import Singularities, rounding_scale

if TYPE_CHECKING:
    from jaxtyping import Array, Complex, Float

UNIT_ROUNDOFF = 2.0**-53

CARRIED_STEPS = 31
"""Most steps through which values are carried before they are computed anew."""


def slack_factor(n_columns: int) -> float:
    """``(n + 64) u``, ``u`` the unit roundoff of double precision, for values computed anew."""
    return (n_columns + 64) * UNIT_ROUNDOFF


def carried_slack_factor(n_columns: int) -> float:
    """The factor for carried values, relative to the largest modulus so far.

    One error for the first sum, two for each step, and two more, so that a proof from carried
    values also succeeds with values computed anew.
    """
    return (1 + 2 * CARRIED_STEPS + 2) * slack_factor(n_columns)


def panel_scale(
    start: Complex[Array, " p"], end: Complex[Array, " p"], singularities: Singularities
) -> Float[Array, " p"]:
    """Per panel, the larger scale of the terms of ``f_z`` and ``l f_z'`` at its two ends."""
    length = jnp.abs(end - start)
    scales = [rounding_scale(z, singularities) for z in (start, end)]
    return jnp.maximum(*(value + length * slope for value, slope in scales))


def rounded_down(value: float, digits: int = 3) -> str:
    """A lower bound as text that is a bound too, with ``digits`` significant digits."""
    return _written(value, digits, ROUND_FLOOR, -math.inf)


def rounded_up(value: float, digits: int = 3) -> str:
    """An upper bound as text, with ``digits`` significant digits and at most so many decimals."""
    return _written(value, digits, ROUND_CEILING, -digits)


def _written(value: float, digits: int, rounding: str, least_exponent: float) -> str:
    if not (value > 0 and math.isfinite(value)):
        return f"{value:.{digits}g}"
    exact = Decimal(float(value))
    exponent = int(max(exact.adjusted() + 1 - digits, least_exponent))
    rounded = exact.quantize(Decimal(1).scaleb(exponent), rounding)
    return f"{float(rounded):.{digits}g}"
