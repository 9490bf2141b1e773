"""The paper's comparisons, measured, drawn and judged on one machine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from glid_nb._errors import InputError
from glid_nb._files import write_text_atomically
from studies.comparisons.experiments import NAMES, Shapes, draw_all, measure_all
from studies.comparisons.page import page
from studies.comparisons.store import Store

__all__ = ["NAMES", "ComparisonError", "compare_all"]


class ComparisonError(InputError):
    """There is no such experiment."""


def compare_all(
    out: Path,
    reference: Path | None = None,
    *,
    only: Sequence[str] | None = None,
    fresh: bool = False,
    detail: Callable[[str], None] = lambda _: None,
) -> Path:
    """Measure, draw and write the page ``out.md`` beside the folder ``out`` of its figures.

    Measurements are kept in ``out/data``; what is there already is not measured again.

    Parameters
    ----------
    out : Path
    reference : Path, optional
        A folder of problems; those named like the paper's shapes replace our own.
    only : sequence of str, optional
        Some of :data:`NAMES`; by default all. Others are on the page if they were measured before.
    fresh : bool
        Measure again what is there already, of the chosen ones.
    detail : callable
        Told what is being done.

    Returns
    -------
    Path
        The page.
    """
    chosen = NAMES if only is None else tuple(only)
    for name in chosen:
        if name not in NAMES:
            raise ComparisonError(f"unknown experiment {name!r}; choose of {', '.join(NAMES)}")
    shapes = Shapes.of(reference)
    results = measure_all(Store(out / "data", fresh), shapes, chosen, detail)
    draw_all(results, out)
    written = out.with_name(out.name + ".md")
    write_text_atomically(written, page(results, out.name))
    return written
