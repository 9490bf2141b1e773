"""Newton's method with fewer and fewer Hessian samples (Figure 8)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from glid_nb.figures.style import BLUE, GREEN, GREY, INK, LINE, ORANGE, SKY, SMALL
from glid_nb.harmonic import HarmonicMap
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.curvature import contraction
from studies.comparisons.runs import last_of, outcome, run
from studies.comparisons.store import Measurement

SAMPLES = (50, 100, 200, 400, 700, 1_000, 10_000)
_COLORS = (ORANGE, SKY, GREEN, "#cc79a7", GREY, BLUE, INK)
_MOST_ITERATIONS = 60
_RUNS = 2


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """A run for each number of samples, and how well its Hessian fits at the minimum."""
    minimum = run("newton", case).map
    assert isinstance(minimum, HarmonicMap)
    runs = {}
    for count in SAMPLES:
        detail(f"{case.name}: {count} Hessian samples")
        result = last_of(
            _RUNS, "newton-staged", case, hessian_samples=count, max_iterations=_MOST_ITERATIONS
        )
        runs[str(count)] = {**outcome(result), "contraction": contraction(case, minimum, count)}
    return {
        "name": case.name,
        "perimeter": case.perimeter,
        "offset": case.offset,
        "runs": runs,
        "arrays": {},
    }


def draw(data: Measurement, path: Path) -> None:
    """Energy above the least against iterations and time."""
    figure = drawing.figure(9.0, 3.0)
    axes = figure.subplots(1, 2, sharey=True)
    least = min(drawing.values_of(run["energy"]).min() for run in data["runs"].values())
    # The first are the widest, so that of curves on one another each is seen.
    widths = np.linspace(2.5 * LINE, 0.7 * LINE, len(_COLORS))
    for (count, run_), color, width in zip(data["runs"].items(), _COLORS, widths, strict=False):
        excess = drawing.values_of(run_["energy"]) / least - 1
        keep = excess > 1e-12
        label = f"{int(count):,}"
        axes[0].semilogy(np.flatnonzero(keep), excess[keep], color=color, lw=width, label=label)
        axes[1].semilogy(
            1e3 * np.array(run_["time"])[keep], excess[keep], color=color, lw=width, label=label
        )
    axes[1].set_xscale("log")
    drawing.label_axes(axes[0], "iteration", "energy above its minimum, relative", data["name"])
    drawing.label_axes(axes[1], "milliseconds", "")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside right center", fontsize=SMALL, frameon=False,
        title="Hessian samples", title_fontsize=SMALL,
    )  # fmt: skip
    drawing.save(figure, path)
