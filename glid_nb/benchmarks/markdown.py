"""Tables and numbers of the page, in Markdown."""

from __future__ import annotations

from collections.abc import Sequence

from glid_nb.benchmarks.timing import Timing


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table."""
    return [
        "| " + " | ".join(head) + " |",
        "|" + " --- |" * len(head),
        *("| " + " | ".join(row) + " |" for row in rows),
    ]


def spread(timing: Timing, factor: float = 1.0, digits: int = 1) -> str:
    """Median and quartiles in brackets, of a timing times ``factor``."""
    median, low, high = (f"{factor * timing[k]:.{digits}f}" for k in ("median", "low", "high"))
    return f"{median} ({low} to {high})"


def ms(timing: Timing) -> str:
    """A timing in milliseconds, with quartiles; without digits behind the point from a second."""
    return spread(timing, 1e3, 1 if timing["median"] < 1 else 0)


def listed(items: Sequence[str]) -> str:
    """Words with commas and an *and*."""
    *most, last = items
    return f"{', '.join(most)} and {last}" if most else last
