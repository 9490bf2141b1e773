"""Numbers with their units, in figures as on the page."""

from __future__ import annotations


def seconds(value: float) -> str:
    """A time: milliseconds below a second."""
    return f"{value * 1e3:.0f} ms" if value < 1 else f"{value:.1f} s"


def percent(share: float) -> str:
    """A share of 1 with two digits, none of them after the point from 10 on."""
    value = 100 * share
    if 0 < value < 0.005:
        return "<0.01%"
    digits = 0 if value >= 9.95 else 1 if value >= 0.995 else 2
    return f"{value:.{digits}f}%"
