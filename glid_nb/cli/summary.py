"""What is printed at the end: one screen for people, one JSON object for programs."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from glid_nb._bounds import rounded_down, rounded_up

_LONG = ("history", "options", "versions", "machine")


def as_json(report: Mapping[str, Any], files: Iterable[Path], **extra: Any) -> str:
    """The report without its long parts, and where the files are, as one JSON object."""
    short = {key: value for key, value in report.items() if key not in _LONG}
    return json.dumps({**extra, **short, "files": {path.name: str(path) for path in files}})


def as_text(
    report: Mapping[str, Any], files: Iterable[Path], rows: Iterable[tuple[str, str]] = ()
) -> str:
    """The report on one screen.

    Parameters
    ----------
    report : mapping
        As built by ``build_report``.
    files : iterable of Path
        What was written.
    rows : iterable of (name, text)
        Rows to put first.
    """
    table = [*rows, *_rows(report), *_written(files)]
    width = max(len(name) for name, _ in table)
    lines, previous = [], ""
    for name, text in table:
        lines.append(f"{name if name != previous else '':<{width}}  {text}".rstrip())
        previous = name
    return "\n".join(lines)


def _written(files: Iterable[Path]) -> list[tuple[str, str]]:
    """A row for every folder."""
    folders: dict[Path, list[str]] = {}
    for path in files:
        folders.setdefault(path.parent, []).append(path.name)
    rows = [("written", f"{folder}: {', '.join(names)}") for folder, names in folders.items()]
    return rows or [("written", "nothing; name files with --out and --report")]


def _rows(report: Mapping[str, Any]) -> list[tuple[str, str]]:
    energy = report["energy"] if report["s"] is None else f"{report['energy']}, s = {report['s']:g}"
    winding = f"{report['winding']}"
    if any(report["windings"]):
        winding += f"  (loops: {', '.join(f'{w:+d}' if w else '0' for w in report['windings'])})"
    injective = {
        "yes": "locally and globally",
        "no": "locally only",
        "undecided": "locally; globally undecided",
    }[report["globally_injective"]]
    if report["crossing"] is not None:
        x, y = report["crossing"]
        injective += f"; the boundary's image crosses itself at ({x:.3g}, {y:.3g})"
    split = f", {report['panels_split']} split" if report["panels_split"] else ""
    if report["proof_panels"] != report["panels"]:
        split += f"; {report['proof_panels']} in the final proof"
    return [
        ("status", report["message"]),
        ("unknowns", f"{report['n_unknowns']}"),
        ("panels", f"{report['panels']}{split}"),
        ("iterations", f"{report['iterations']}"),
        (
            "energy",
            f"{_number(report['E'])}  ({energy}: {_number(report['E_iso'])}, "
            f"targets: {_number(report['E_p2p'])})",
        ),
        ("certified", "yes" if report["certified"] else "no"),
        ("sigma_2", f">= {_bound(report['sigma2_lower'], rounded_down)}"),
        ("sigma_1", f"<= {_bound(report['sigma1_upper'], rounded_up)}"),
        ("k", f"<= {_bound(report['k_upper'], rounded_up)}"),
        ("winding number", winding),
        ("injective", injective if report["certified"] else "not proved"),
        (
            "times",
            f"compile {report['compile_time']:.2f} s, solve {report['solve_time']:.3f} s, "
            f"certify {report['certify_time']:.3f} s",
        ),
    ]


def _bound(value: float | None, rounded: Callable[[float, int], str]) -> str:
    return "unbounded" if value is None else rounded(value, 6)


def _number(value: float | None) -> str:
    return "unbounded" if value is None else f"{value:.6g}"
