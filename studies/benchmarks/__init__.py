"""Speed, measured side by side on one machine, and the page that reports it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from glid_nb._files import write_text_atomically
from glid_nb.samples import names
from glid_nb.session import Problem
from studies.benchmarks import goals, results
from studies.benchmarks.batches import measure_batches
from studies.benchmarks.compilations import count_compilations
from studies.benchmarks.drawing import draw
from studies.benchmarks.machine import machine, rates
from studies.benchmarks.measurements import BenchmarkError, Measurements
from studies.benchmarks.page import page
from studies.benchmarks.scaling import SERIES, measure_scaling
from studies.benchmarks.shapes import flower, ring_of_handles
from studies.benchmarks.solving import DEFAULT, measure_drag, measure_solves
from studies.benchmarks.starting import measure_start
from studies.comparisons.cases import Case, reference_cases, sample_case

__all__ = ["PARTS", "BenchmarkError", "bench_all", "render"]

PARTS = ("solves", "drags", "start", "compilations", "scaling", "batches")

_STARTS = 3  # processes of each kind
_CAGE_HANDLES = 16


def bench_all(
    out: Path,
    reference: Path | None = None,
    *,
    only: Sequence[str] | None = None,
    repeats: int = 9,
    quick: bool = False,
    fresh: bool = False,
    detail: Callable[[str], None] = lambda _: None,
) -> Path:
    """Measure, draw and write the page ``out.md`` beside the folder ``out`` of its figures.

    Measurements are kept in ``out/data``. What is there already, from this machine with these
    versions and settings, is not measured again.

    Parameters
    ----------
    out : Path
    reference : Path, optional
        A folder of problems; by default the bundled samples in their gentle poses.
    only : sequence of str, optional
        Some of :data:`PARTS`; by default all. Others are on the page if they were measured before.
    repeats : int
        Timings of each kind, at least 1.
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

    Raises
    ------
    BenchmarkError
        For an unknown part, fewer than one repeat, or a measurement that fails.
    """
    chosen = PARTS if only is None else tuple(only)
    for name in chosen:
        if name not in PARTS:
            raise BenchmarkError(f"unknown part {name!r}; choose of {', '.join(PARTS)}")
    if repeats < 1:
        raise BenchmarkError(f"repeats is {repeats}; it must be at least 1")
    cases = _cases(reference)
    store = Measurements(out / "data", machine(), fresh)
    settings = f"repeats {repeats}, quick {quick}"

    def measured(name: str, of: str, measure: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        detail(name)
        return store.get(name, f"{of}, {settings}" if of else settings, measure)

    plan = {
        "cases": [case.name for case in cases],
        "reference": reference is not None,
        "repeats": repeats,
        "quick": quick,
    }
    # What a run is changes with its arguments, whatever is there.
    Measurements(store.folder, store.here, fresh=True).get(results.RUN, settings, lambda: plan)
    measured(results.MACHINE, "", lambda: {**store.here, "rates": rates()})
    if "solves" in chosen:
        for case in cases:
            measured(
                results.solves_name(case.name),
                case.digest,
                lambda c=case: measure_solves(c, repeats),
            )
        if not quick:
            cage = _cage()
            measured(
                results.CAGE,
                cage.digest,
                lambda: measure_solves(cage, repeats, [DEFAULT])[DEFAULT],
            )
    if "drags" in chosen:
        for case in cases:
            measured(
                results.drag_name(case.name), case.digest, lambda c=case: measure_drag(c, repeats)
            )
    if "start" in chosen:
        measured(results.START, "", lambda: measure_start(1 if quick else _STARTS))
    if "compilations" in chosen:
        measured(results.COMPILATIONS, "", count_compilations)
    for series in SERIES if "scaling" in chosen else ():
        name = results.series_name(series)
        more = _prefixed(name, detail)
        measured(name, "", lambda s=series, m=more: measure_scaling(s, repeats, quick, m))
    if "batches" in chosen:
        case = _middle(cases)
        more = _prefixed(results.BATCHES, detail)
        measured(results.BATCHES, case.digest, lambda: measure_batches(case, quick, more))
    return render(out)


def render(out: Path) -> Path:
    """Draw the figures and write the page of what was measured before, wherever that was.

    Returns
    -------
    Path
        The page, ``out.md``.

    Raises
    ------
    BenchmarkError
        When ``out/data`` holds no measurements, or one cannot be read; the message names the file.
    """
    found = results.read(out / "data")
    draw(found, out)
    written = out.with_name(out.name + ".md")
    write_text_atomically(written, page(found, out))
    return written


def _prefixed(name: str, detail: Callable[[str], None]) -> Callable[[str], None]:
    return lambda text: detail(f"{name}: {text}")


def _cases(reference: Path | None) -> list[Case]:
    if reference is not None:
        return list(reference_cases(reference).values())
    return [sample_case(name, "gentle") for name in names()]


def _cage() -> Case:
    """The cage that a goal names by its number of vertices."""
    problem = Problem(flower(goals.CAGE_VERTICES, 0), ring_of_handles(_CAGE_HANDLES))
    return Case(f"{goals.CAGE_VERTICES} vertices", problem)


def _middle(cases: list[Case]) -> Case:
    """The case that the goals name, or else the one with the middle number of cage vertices."""
    named = [case for case in cases if case.name == goals.REX]
    by_size = sorted(cases, key=lambda case: len(case.problem.domain.cage.exterior))
    return named[0] if named else by_size[len(by_size) // 2]
