"""Exponents: how fast something grows with a size."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np


def exponent(x: Sequence[float], y: Sequence[float]) -> float:
    """Slope of the straight line through ``log y`` over ``log x``; NaN for fewer than two."""
    if len(x) < 2:
        return float("nan")
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def local_exponents(x: Sequence[float], y: Sequence[float]) -> list[float]:
    """The same between each size and the one before it; one fewer than sizes."""
    pairs = itertools.pairwise(zip(x, y, strict=True))
    return [float(np.log(d / b) / np.log(c / a)) for (a, b), (c, d) in pairs]
