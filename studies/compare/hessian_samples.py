"""Newton's method with fewer and fewer Hessian samples (Figure 8)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from glid_nb.figures.style import BLUE, GREEN, GREY, INK, LINE, ORANGE, SKY, SMALL
from studies import figures
from studies.cases import Case
from studies.compare.shapes import some
from studies.runs import outcome, run
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, digits, seconds

SAMPLES = (50, 100, 200, 400, 700, 1_000, 10_000)
_COLORS = (ORANGE, SKY, GREEN, "#cc79a7", GREY, BLUE, INK)
_MOST_ITERATIONS = 60
_RUNS = 2


def measure(case: Case, plan: Plan) -> Measurement:
    """A run for each number of samples, and how well its Hessian fits at the minimum."""
    runs = {}
    for count in SAMPLES:
        plan.detail(f"{case.name}: {count} Hessian samples")
        settings = {"hessian_samples": count, "max_iterations": _MOST_ITERATIONS}
        result = run("newton-staged", case, runs=_RUNS, **settings)
        runs[str(count)] = outcome(result)
    return {
        "name": case.name,
        "perimeter": case.perimeter,
        "runs": runs,
    }


def draw(found: list[Measurement], folder: Path) -> None:
    """Energy above the least against iterations and time."""
    data = found[0]
    figure = figures.figure(6.0, 3.0)
    axes = figure.subplots()
    least = min(figures.values_of(run["energy"]).min() for run in data["runs"].values())
    # The first are the widest, so that of curves on one another each is seen.
    widths = np.linspace(2.5 * LINE, 0.7 * LINE, len(_COLORS))
    for (count, run_), color, width in zip(data["runs"].items(), _COLORS, widths, strict=False):
        excess = figures.values_of(run_["energy"]) / least - 1
        keep = excess > 1e-12
        label = f"{int(count):,} samples"
        axes.semilogy(np.flatnonzero(keep), excess[keep], color=color, lw=width, label=label)
    figures.label_axes(axes, "iteration", "energy above its minimum, relative", data["name"])
    figure.legend(loc="outside right center", fontsize=SMALL, frameon=False)
    figures.save(figure, folder / "hessian-samples.png")


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Iterations, energy and time by the number of samples."""
    rows: list[Row] = []
    for data in found:
        for count, run_ in data["runs"].items():
            more = "" if run_["status"] == "converged" else "+"
            rows.append(
                {
                    "samples": f"{int(count):,}",
                    "spacing": digits(data["perimeter"] / int(count), 2),
                    "iterations": f"{run_['iterations']}{more}",
                    "energy": f"{run_['energy'][-1]:.8g}",
                    "time": seconds(run_["time"][-1]),
                }
            )
    return {"hessian-samples": rows}


STUDY = Study("hessian-samples", on_cases(some(("deer",), "gecko-extreme"), measure), tables, draw)
