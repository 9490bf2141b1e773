"""Repeated timings."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

Timing = dict[str, float]
"""``median``, ``low`` and ``high`` (the quartiles) and ``least``, seconds; ``runs``."""


def timed(function: Callable[[], Any], repeats: int, warm_up: int = 1) -> Timing:
    """Wall time of repeated calls, the first ones of which are not counted."""
    for _ in range(warm_up):
        function()
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - began)
    return summary(seconds)


def summary(seconds: list[float]) -> Timing:
    """Median and quartiles of several timings."""
    low, median, high = np.quantile(seconds, [0.25, 0.5, 0.75])
    return {
        "median": float(median),
        "low": float(low),
        "high": float(high),
        "least": min(seconds),
        "runs": len(seconds),
    }


def scaled(timing: Timing, factor: float) -> Timing:
    """The timing of a part, a fraction ``factor`` of the whole."""
    return {key: v if key == "runs" else v * factor for key, v in timing.items()}
