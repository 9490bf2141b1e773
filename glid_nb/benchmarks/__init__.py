"""Speed, measured side by side on one machine, and the page that reports it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from glid_nb._files import write_text_atomically
from glid_nb.benchmarks.batches import measure_batches
from glid_nb.benchmarks.drawing import draw
from glid_nb.benchmarks.machine import machine, rates
from glid_nb.benchmarks.page import page
from glid_nb.benchmarks.scaling import measure_scaling
from glid_nb.benchmarks.solving import MODES, measure_drag, measure_solve
from glid_nb.benchmarks.starting import measure_start
from glid_nb.comparisons.cases import Case, reference_cases, sample_case
from glid_nb.comparisons.store import Store
from glid_nb.samples import names

__all__ = ["bench_all"]


def bench_all(
    out: Path,
    reference: Path | None = None,
    *,
    repeats: int = 9,
    quick: bool = False,
    fresh: bool = False,
    detail: Callable[[str], None] = lambda _: None,
) -> Path:
    """Measure, draw and write the page ``out.md`` beside the folder ``out`` of its figures.

    Parameters
    ----------
    out : Path
    reference : Path, optional
        A folder of problems; by default the bundled samples in their gentle poses.
    repeats : int
        Timings of each kind.
    quick : bool
        Small sizes only, to see that everything runs.
    fresh : bool
        Measure everything again; otherwise an interrupted run goes on where it stopped.
    detail : callable
        Told what is being done.

    Returns
    -------
    Path
        The page.
    """
    store = Store(out / "data", fresh)
    cases = _cases(reference)

    def measured(name: str, measure: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        detail(name)
        return store.get(name, measure)

    results: dict[str, Any] = {
        "machine": measured("machine", lambda: {**machine(), "rates": rates()}),
        "solves": [
            measured(f"{case.name}-{mode}", lambda c=case, m=mode: measure_solve(c, m, repeats))
            for case in cases
            for mode in MODES
        ],
        "drags": [
            measured(f"{case.name}-drag", lambda c=case: measure_drag(c, repeats)) for case in cases
        ],
        "start": measured("start", measure_start),
        "scaling": measured("scaling", lambda: measure_scaling(quick)),
        "batches": measured("batches", lambda: measure_batches(_middle(cases), quick)),
    }
    draw(results, out)
    written = out.with_name(out.name + ".md")
    write_text_atomically(written, page(results, out.name))
    return written


def _cases(reference: Path | None) -> list[Case]:
    if reference is not None:
        return list(reference_cases(reference).values())
    return [sample_case(name, "gentle") for name in names()]


def _middle(cases: list[Case]) -> Case:
    """The case called rex, or else the one with the middle number of cage vertices."""
    named = [case for case in cases if case.name == "rex"]
    by_size = sorted(cases, key=lambda case: len(case.problem.domain.cage.exterior))
    return named[0] if named else by_size[len(by_size) // 2]
