"""Bounds as text, rounded so that the text is a bound too."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal


def rounded_down(value: float, digits: int = 3) -> str:
    """A lower bound with ``digits`` significant digits."""
    return _written(value, digits, ROUND_FLOOR, -math.inf)


def rounded_up(value: float, digits: int = 3) -> str:
    """An upper bound with ``digits`` significant digits, and at most that many decimals."""
    return _written(value, digits, ROUND_CEILING, -digits)


def _written(value: float, digits: int, rounding: str, least_exponent: float) -> str:
    if not (value > 0 and math.isfinite(value)):
        return f"{value:.{digits}g}"
    exact = Decimal(float(value))
    exponent = int(max(exact.adjusted() + 1 - digits, least_exponent))
    rounded = exact.quantize(Decimal(1).scaleb(exponent), rounding)
    return f"{float(rounded):.{digits}g}"
