"""Timings as the page writes them."""

from __future__ import annotations

from studies.benchmarks.timing import Timing


def spread(timing: Timing, factor: float = 1.0, digits: int = 1) -> str:
    """Median and quartiles in brackets, of a timing times ``factor``."""
    median, low, high = (f"{factor * timing[k]:.{digits}f}" for k in ("median", "low", "high"))
    return f"{median} ({low} to {high})"


def ms(timing: Timing) -> str:
    """A timing in milliseconds, with quartiles; without digits behind the point from a second."""
    return spread(timing, 1e3, 1 if timing["median"] < 1 else 0)
