"""Words, numbers and tables as the page writes them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any


def verdict(reproduced: bool, partly: bool = False) -> str:
    """What became of a claim."""
    if reproduced:
        return "**Reproduced.**"
    return "**Partly reproduced.**" if partly else "**Not reproduced.**"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """A table in Markdown."""
    return [
        "| " + " | ".join(head) + " |",
        "|" + " --- |" * len(head),
        *("| " + " | ".join(row) + " |" for row in rows),
    ]


def joined(words: Sequence[str]) -> str:
    """``a, b and c``; ``none`` for no words."""
    if not words:
        return "none"
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def numbers(values: Iterable[float]) -> str:
    """Bounds, two decimals each."""
    return ", ".join(f"{value:.2f}" for value in values)


def spread(values: Sequence[float], digits: int = 1) -> str:
    """``least to most``, or the one value."""
    low, high = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def name_of(case: str) -> str:
    """A shape's name in words: a bundled sample's says its pose."""
    sample, _, kind = case.rpartition("-")
    return f"the bundled {sample}, {kind} pose" if kind in ("gentle", "extreme") else case


def ended(run: dict[str, Any]) -> str:
    """How a run ended, and after how many iterations."""
    words = {
        "converged": "converged after",
        "stationary": "converged after",
        "max_iterations": "not converged after",
        "stopped": "not converged after",
        "blocked": "blocked after",
        "indefinite": "halts after",
    }
    return f"{words[run['status']]} {run['iterations']}"


def briefly(run: dict[str, Any]) -> str:
    """The same for a table's cell: a bare number where it converged, ``+`` where it was stopped."""
    count = f"{run['iterations']:,}"
    how = {"converged": "", "stationary": "", "blocked": "blocked at ", "indefinite": "halts at "}
    return f"{how[run['status']]}{count}" if run["status"] in how else f"{count}+"
