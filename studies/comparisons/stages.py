"""The time of one iteration, split over its four stages (Figure 9)."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jax
import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.energies import SymmetricDirichlet
from glid_nb.figures.style import BLUE, GREEN, ORANGE, SKY, SMALL
from glid_nb.methods.subspace import SubspaceProblem
from glid_nb.solvers import Options
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.store import Measurement

Array = NDArray[Any]

STAGES = ("gradient", "Hessian", "Cholesky", "line search")
_REPEATS = 25


@double_precision
def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Seconds of the four stages of one iteration with the paper's sampling.

    The stages are run one by one, a step into the solve. The line search's program also evaluates
    the new point, whose time is taken off it.
    """
    detail(f"{case.name}: stages")
    options = Options(sampling="uniform", certificate="lipschitz", align=False)
    problem = SubspaceProblem(case.problem.domain, case.problem.pose, SymmetricDirichlet(), options)
    point = problem.evaluate(problem.start)
    seconds: dict[str, float] = {}
    with single_blas_thread():
        for _ in range(2):
            h = problem.hessian(point, "projected") + problem.p2p_hessian
            direction = _newton_step(h, np.asarray(point.gradient))
            before = point
            point = problem.advance(point, direction, False).point
        stages: dict[str, Callable[[], Any]] = {
            "gradient": lambda: problem.evaluate(np.asarray(before.coefficients)),
            "Hessian": lambda: problem.hessian(before, "projected"),
            "Cholesky": lambda: _newton_step(h, np.asarray(before.gradient)),
            "line search": lambda: problem.advance(before, direction, False),
        }
        for name, run in stages.items():
            taken = []
            for _ in range(_REPEATS):
                began = time.perf_counter()
                jax.block_until_ready(run())
                taken.append(time.perf_counter() - began)
            seconds[name] = float(np.median(taken))
    seconds["line search"] = max(seconds["line search"] - seconds["gradient"], 0.0)
    return {"name": case.name, "unknowns": case.unknowns, "seconds": seconds, "arrays": {}}


def _newton_step(h: Array, gradient: Array) -> Array:
    factor = scipy.linalg.cho_factor(h, lower=True, check_finite=False)
    return -scipy.linalg.cho_solve(factor, gradient, check_finite=False)


def draw(cases: list[Measurement], path: Path) -> None:
    """Bars of the four stages for each shape."""
    figure = drawing.figure(9.0, 3.0)
    axes = figure.subplots()
    place = np.arange(len(cases))
    for i, (stage, color) in enumerate(zip(STAGES, (SKY, BLUE, ORANGE, GREEN), strict=True)):
        values = [1e3 * data["seconds"][stage] for data in cases]
        axes.bar(place + 0.2 * (i - 1.5), values, 0.19, color=color, label=stage)
    axes.set_xticks(place, [f"{d['name']}\n{d['unknowns']}" for d in cases], fontsize=SMALL)
    drawing.label_axes(axes, "shape and unknowns", "milliseconds")
    axes.legend(fontsize=SMALL, frameon=False, ncols=4)
    drawing.save(figure, path)
