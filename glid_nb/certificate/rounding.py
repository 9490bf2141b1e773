"""Bounds on the rounding errors of the certificate, and its bounds rounded for text.

The certificate's inequalities are computed in double precision, of unit roundoff ``u``. A bound on
their error is added to each panel's remainder. `docs/proof.md` derives every constant (Lemmas 4, 10
to 15).
"""

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from typing import Any as Array  # of NumPy or of JAX

from glid_nb._jax import Complex, Float
from glid_nb.harmonic import cauchy
from glid_nb.harmonic.cauchy import Points, Singularities
from glid_nb.harmonic.rounding import (  # noqa: F401  (of the basis; used under this name, too)
    COMPLEX_QUOTIENT,
    CUT,
    ELEMENTARY,
    LOGARITHM,
    UNDERFLOW,
    UNIT_ROUNDOFF,
    UPWARD,
    derivatives,
    derivatives_by,
    slack_factor,
)

BERNSTEIN = 16 * UNIT_ROUNDOFF
"""Error of a Bernstein coefficient of ``|p|^2``, relative to the largest ``|p|^2``."""
BESIDE = 64 * UNIT_ROUNDOFF
"""How far the end of a panel may lie beside its edge, relative to the largest coordinate."""

CARRIED_STEPS = 31  # most steps for which values are carried along, then they are recomputed


def carried_slack_factor(n_columns: int) -> float:
    """The factor for carried values, relative to the largest coefficients so far (Lemma 15)."""
    return (1 + 2 * CARRIED_STEPS + 6) * slack_factor(n_columns)


def allowance(slack: Float[Array, "*k p"], probe: Float[Array, ""]) -> Float[Array, "*k p"]:
    """Errors plus `UNDERFLOW`; infinite under fast math (Lemmas 13 and 14).

    ``probe``, any positive number that the compiler does not know, detects fast math.
    """
    xp, small = slack.__array_namespace__(), probe * 2.0**-60
    total = probe + small
    second = total - probe
    # This computes the sum's error exactly, unless operations are reassociated.
    exact = (probe - (total - second)) + (small - second) == small
    return xp.where(exact, slack + UNDERFLOW, xp.inf)


def panel_scale(
    start: Complex[Array, " p"], end: Complex[Array, " p"], singularities: Singularities
) -> Float[Array, " p"]:
    """Per panel, the larger scale of the terms of ``f_z`` and ``l f_z'`` at its two ends.

    Times :func:`slack_factor` and the largest coefficient, it bounds the error of both together.
    """
    xp = start.__array_namespace__()
    length = xp.abs(end - start)
    scales = [term_scale(z, singularities) for z in (start, end)]
    return UPWARD * xp.maximum(*(value + length * slope for value, slope in scales))


def term_scale(
    z: Points, singularities: Singularities
) -> tuple[Float[Array, " k"], Float[Array, " k"]]:
    """Sums of the moduli of all terms of ``D(z)``, with the logarithms' errors, and of ``D'(z)``.

    They are infinite where a computed logarithm may be of the wrong branch.
    """
    xp, (vertices, following, preceding, rho) = z.__array_namespace__(), singularities
    b, to_hole = xp.abs(vertices - z[:, None]), xp.abs(z[:, None] - rho)
    edge, chord = (xp.abs(vertices[following] - vertices[i]) for i in (slice(None), preceding))
    log_over_edge = cauchy.log_over_edge(vertices - z[:, None], singularities)
    absolute = LOGARITHM * UNIT_ROUNDOFF / slack_factor(len(vertices) + len(rho))
    first = xp.sum(xp.abs(log_over_edge) + absolute / edge, axis=1) / math.pi
    second = xp.sum(chord / (b[:, preceding] * b * b[:, following]), axis=1) / (2 * math.pi)
    angle = xp.abs(xp.imag(log_over_edge * (vertices[following] - vertices)))
    first = xp.where(xp.any(angle > math.pi * (1 - 2 * CUT), axis=1), xp.inf, first)
    return first + xp.sum(1 / to_hole, axis=1), second + xp.sum(1 / to_hole**2, axis=1)


def rounded_down(value: float, digits: int = 3) -> str:
    """A lower bound as text, rounded down to ``digits`` significant digits."""
    exact = Context(digits, ROUND_FLOOR).create_decimal_from_float(float(value))
    return f"{float(exact):.{digits}g}"


def rounded_up(value: float, digits: int = 3) -> str:
    """An upper bound as text, rounded up to ``digits`` significant digits and decimals at most."""
    exact = Context(digits, ROUND_CEILING).create_decimal_from_float(float(value))
    if exact.is_finite() and exact.adjusted() < 0:
        exact = exact.quantize(Decimal(1).scaleb(-digits), ROUND_CEILING)
    return f"{float(exact):.{digits}g}"
