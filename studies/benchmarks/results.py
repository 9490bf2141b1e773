"""All measurements of a run, read back from their folder for the page and the figures."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from studies.benchmarks.measurements import BenchmarkError, Measurement, kept
from studies.benchmarks.scaling import SERIES
from studies.benchmarks.solving import ALIGNED, DEFAULT, MODES, PAPER, same_minimum

RUN, MACHINE, CAGE, START, COMPILATIONS, BATCHES = (
    "run",
    "machine",
    "cage",
    "start",
    "compilations",
    "batches",
)
"""Names of measurements; those of shapes and series are made of their parts."""


def solves_name(case: str) -> str:
    """The name of the measurement of a shape's solves, which has one of each mode."""
    return f"{case}-solves"


def drag_name(case: str) -> str:
    """The name of the measurement of a shape's drag step."""
    return f"{case}-drag"


def series_name(series: str) -> str:
    """The name of the measurement of a series of sizes."""
    return f"scaling-{series}"


@dataclass(frozen=True)
class Results:
    """What there is; what was not measured is None or missing from its list."""

    run: Measurement
    """``cases`` (names), ``reference``, ``repeats``, ``quick``."""
    machine: Measurement
    solves: dict[str, dict[str, Measurement]]
    """By mode, then by shape."""
    cage: Measurement | None
    """A solve in ``default`` mode on the cage that a goal names."""
    drags: list[Measurement]
    start: Measurement | None
    compilations: Measurement | None
    scaling: dict[str, list[dict[str, Any]]]
    """Rows by series."""
    batches: Measurement | None
    elsewhere: list[str]
    """Names of the measurements that were taken on other machines or with other versions."""

    @property
    def pairs(self) -> list[tuple[Measurement, Measurement]]:
        """``paper`` and ``default`` of each shape that has both."""
        paper, default = self.solves[PAPER], self.solves[DEFAULT]
        return [(paper[name], default[name]) for name in paper if name in default]

    @property
    def like_for_like(self) -> list[tuple[Measurement, Measurement]]:
        """The pairs that end at the same minimum."""
        return [(p, d) for p, d in self.pairs if same_minimum(p["energy"], d["energy"])]

    @property
    def aligned(self) -> list[tuple[Measurement, Measurement]]:
        """``paper`` that begins with the rigid motion, and ``default``, where that was measured."""
        both = self.solves[ALIGNED], self.solves[DEFAULT]
        return [(both[0][name], both[1][name]) for name in both[0] if name in both[1]]


def read(folder: Path) -> Results:
    """The measurements in a folder.

    Raises
    ------
    BenchmarkError
        When there are none that are complete, or a file cannot be read; the message names it.
    """
    run, machine = kept(folder, RUN), kept(folder, MACHINE)
    if run is None or machine is None:
        missing = folder / f"{RUN if run is None else MACHINE}.json"
        raise BenchmarkError(
            f"{missing} holds no measurement that names its machine; run `glid-nb bench` without "
            "--render first"
        )
    found: dict[str, Measurement] = {}

    def get(name: str) -> Measurement | None:
        result = kept(folder, name)
        if result is not None:
            found[name] = result
        return result

    cases = run["cases"]
    by_case = {name: s for name in cases if (s := get(solves_name(name))) is not None}
    solves = {mode: {name: s[mode] for name, s in by_case.items() if mode in s} for mode in MODES}
    drags = [d for name in cases if (d := get(drag_name(name))) is not None]
    series = {name: get(series_name(name)) for name in SERIES}
    cage, start, compilations, batches = (
        get(name) for name in (CAGE, START, COMPILATIONS, BATCHES)
    )
    return Results(
        run,
        machine,
        solves,
        cage,
        drags,
        start,
        compilations,
        {name: s["rows"] for name, s in series.items() if s is not None},
        batches,
        [name for name, result in found.items() if result["taken"] != machine["taken"]],
    )
