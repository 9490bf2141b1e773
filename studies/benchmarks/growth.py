"""Exponents: how fast something grows with a size."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np


def exponent(x: Sequence[float], y: Sequence[float]) -> float:
    """Slope of the straight line through ``log y`` over ``log x``; NaN for fewer than two.

    What is not positive, a difference of two timings that noise outweighs, does not count.
    """
    points = np.array([(a, b) for a, b in zip(x, y, strict=True) if a > 0 and b > 0], dtype=float)
    if len(points) < 2:
        return float("nan")
    log_x, log_y = np.log(points).T
    return float(np.polyfit(log_x, log_y, 1)[0])


def local_exponents(x: Sequence[float], y: Sequence[float]) -> list[float]:
    """The same between each size and the one before it; one fewer than sizes."""
    pairs = itertools.pairwise(zip(x, y, strict=True))
    return [exponent((a, c), (b, d)) for (a, b), (c, d) in pairs]
