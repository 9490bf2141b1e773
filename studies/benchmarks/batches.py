"""Poses per second of ``solve_batch`` against the size of the batch and the number of devices."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import jax

from studies.benchmarks.processes import in_new_process
from studies.comparisons.cases import Case

SIZES = (1, 4, 16, 64, 256)

_SCRIPT = "studies.benchmarks.one_batch"
_REPEATS = 3
# CPU devices that XLA is made to show; the cores are the same.
_FORCED = (1, 2)


def measure_batches(case: Case, quick: bool, detail: Callable[[str], None]) -> dict[str, Any]:
    """The case's pose with its targets moved a little at random, in batches and one by one.

    On a CPU with one and with two devices, elsewhere on all there are; ``series`` has one entry
    for each.
    """
    given = {
        "problem": case.problem.to_dict(),
        "sizes": SIZES[:1] if quick else SIZES,
        "repeats": 1 if quick else _REPEATS,
    }
    counts = _FORCED if jax.default_backend() == "cpu" else (None,)
    series = []
    for i, count in enumerate(counts):
        detail("all devices" if count is None else f"{count} device(s)")
        flags = os.environ.get("XLA_FLAGS", "")
        if count is not None:
            flags = f"{flags} --xla_force_host_platform_device_count={count}"
        series.append(in_new_process("-m", _SCRIPT, {**given, "alone": i == 0}, XLA_FLAGS=flags))
    return {"name": case.name, "series": series}
