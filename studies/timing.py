"""Repeated timings within one process.

We tried pyperf and did not keep it. It times each function in separate processes, twenty by
default. Each process imports JAX and loads compiled programs first. And pyperf cannot alternate
between functions.
"""

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

Timing = dict[str, float]
"""``median``, ``low`` and ``high`` (the quartiles) and ``least``, seconds; ``runs``."""

LEAST_REPEATS = 3
"""Timings that are always taken, even beyond the budget."""


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
    """Wall time of the functions' calls. Each turn calls every function once.

    If the machine is slow for a while, all functions are slow, so their ratios hardly change. The
    first ``warm_up`` turns do not count. After ``budget`` seconds no new turn begins, unless there
    were fewer than :data:`LEAST_REPEATS`.
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
