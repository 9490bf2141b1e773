"""Repeated timings within one process.

pyperf was tried and not kept: it times each function in processes of its own, twenty by default,
each of which imports JAX and loads compiled programs first, and it cannot take functions in turn.
"""

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
    """:func:`timed_in_turn` of one function."""
    return timed_in_turn({"": function}, repeats, warm_up, budget)[""]


def timed_in_turn(
    functions: Mapping[str, Callable[[], Any]],
    repeats: int,
    warm_up: int = 1,
    budget: float = float("inf"),
) -> dict[str, Timing]:
    """Wall time of each function's calls, one of each after the other again and again.

    A machine that is slow for a while is so for all of them, so their ratios stay. The first calls
    warm up and do not count. After ``budget`` seconds no further turn begins, unless there were
    fewer than :data:`LEAST_REPEATS`.
    """
    seconds: dict[str, list[float]] = {name: [] for name in functions}
    for _ in range(warm_up):
        for function in functions.values():
            function()
    for turn in range(repeats):
        if turn >= LEAST_REPEATS and sum(map(sum, seconds.values())) > budget:
            break
        for name, function in functions.items():
            began = time.perf_counter()
            function()
            seconds[name].append(time.perf_counter() - began)
    return {name: summary(taken) for name, taken in seconds.items()}


def summary(seconds: list[float]) -> Timing:
    """Median and quartiles of several timings."""
    low, median, high = np.quantile(seconds, [0.25, 0.5, 0.75]).tolist()
    quartiles = {"median": median, "low": low, "high": high}
    return {**quartiles, "least": min(seconds), "runs": len(seconds)}
