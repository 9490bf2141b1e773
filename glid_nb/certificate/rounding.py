"""How much rounding can change what the certificate computes.

The certificate's inequalities are evaluated in double precision. Each panel's remainder is
enlarged by ``slack_factor(n) * scale * max_j |phi_j|``, a first-order running error bound
(Higham, Accuracy and Stability of Numerical Algorithms, Section 3) for the ``n``-term sums
``f_z = sum_j D_j phi_j`` whose terms have moduli adding up to at most ``scale * max |phi_j|``:
``n`` roundings for the sum, and 64 that cover the computation of ``D_j`` itself, of the control
points and of the Bernstein coefficients.

A solver carries values along, ``f_z + t df_z``, instead of computing them anew. Each step adds the
error of a sum whose coefficients ``t dphi`` have up to twice the largest modulus that was met.
"""

from __future__ import annotations

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
    """The factor for carried values, of the largest modulus met on the way.

    One error for the first sum, two for each step, and two more: a proof from carried values then
    also succeeds with values computed anew.
    """
    return (1 + 2 * CARRIED_STEPS + 2) * slack_factor(n_columns)


def panel_scale(
    start: Complex[Array, " p"], end: Complex[Array, " p"], singularities: Singularities
) -> Float[Array, " p"]:
    """Per panel, a scale of the terms of ``f_z`` and of ``l f_z'`` at its two ends."""
    length = jnp.abs(end - start)
    scales = [rounding_scale(z, singularities) for z in (start, end)]
    return jnp.maximum(*(value + length * slope for value, slope in scales))
