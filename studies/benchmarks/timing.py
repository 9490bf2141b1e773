"""Repeated timings."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

Timing = dict[str, float]
"""``median``, ``low`` and ``high`` (the quartiles) and ``least``, seconds; ``runs``."""

LEAST_REPEATS = 3
"""Timings that are taken however long one takes."""


def timed(
    function: Callable[[], Any], repeats: int, warm_up: int = 1, budget: float = float("inf")
) -> Timing:
    """Wall time of repeated calls, the first ones of which are not counted.

    After ``budget`` seconds no further call begins, unless there are fewer than
    :data:`LEAST_REPEATS`.
    """
    for _ in range(warm_up):
        function()
    seconds: list[float] = []
    while len(seconds) < repeats:
        if len(seconds) >= LEAST_REPEATS and sum(seconds) > budget:
            break
        began = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - began)
    return summary(seconds)


def timed_in_turn(
    functions: Mapping[str, Callable[[], Any]], repeats: int, warm_up: int = 1
) -> dict[str, Timing]:
    """Wall time of each function's calls, one of each after the other again and again.

    A machine that is slow for a while is so for all of them: their ratios keep.
    """
    seconds: dict[str, list[float]] = {name: [] for name in functions}
    for turn in range(warm_up + repeats):
        for name, function in functions.items():
            began = time.perf_counter()
            function()
            if turn >= warm_up:
                seconds[name].append(time.perf_counter() - began)
    return {name: summary(taken) for name, taken in seconds.items()}


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


def rate(timing: Timing, count: float) -> Timing:
    """So many things a second, where ``count`` of them take the given time."""
    turned = {"low": "high", "high": "low"}
    return {turned.get(key, key): v if key == "runs" else count / v for key, v in timing.items()}
