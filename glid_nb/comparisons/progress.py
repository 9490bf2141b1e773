"""All methods from the identity to convergence (Figures 1, 10 and 11, Table 2, speed ratios)."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import NullFormatter

from glid_nb.compare import methods
from glid_nb.comparisons import drawing
from glid_nb.comparisons.cases import Case
from glid_nb.comparisons.drawing import LOOK
from glid_nb.comparisons.runs import (
    MESH_VERTICES,
    display_mesh,
    run_recorded,
    summary,
    thumbnails,
)
from glid_nb.comparisons.store import Measurement
from glid_nb.geometry import triangulate
from glid_nb.imaging.style import LINE, SMALL

HARMONIC = ("newton", "newton-paper", "newton-unmodified", "newton-eigen", "lbfgs")
MESH = ("slim", "aqp")
# First-order methods end here if they have not converged; the paper's took up to 1,818, 170, 400.
_FOLLOWED = ("newton", "newton-eigen", "slim", "aqp")
_LEAST_GAP = 1e-9
LIMITS = {"lbfgs": 300, "slim": 120, "aqp": 400, "newton-eigen": 120}
MOST_TIMES = 60
"""A method on a mesh is stopped when it has taken so many times as long as ours."""


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Every method on one shape, started at the identity as in the paper."""
    display = display_mesh(case)
    mesh = triangulate(case.problem.domain.cage, MESH_VERTICES, points=case.problem.pose.handles)
    runs: dict[str, Any] = {}
    arrays = {
        "display": display.vertices,
        "display_triangles": display.triangles,
        "mesh": mesh.vertices,
        "mesh_triangles": mesh.triangles,
        "targets": case.problem.pose.targets,
    }
    known = methods(available=True)
    for method in (*HARMONIC, *MESH):
        if method not in known:
            continue
        detail(f"{case.name}: {LOOK[method][0]}")
        seconds = math.inf
        if method in MESH:
            seconds = MOST_TIMES * runs["newton"]["time"][-1]
        result, images = run_recorded(
            method,
            case,
            display,
            mesh,
            max_iterations=LIMITS.get(method),
            iterates=method in _FOLLOWED,
            seconds=seconds,
        )
        runs[method] = summary(result, images)
        chosen, pictures = thumbnails(images, runs[method]["visible"])
        if method not in _FOLLOWED:
            chosen = [result.iterations]
        runs[method]["thumbnails"] = chosen
        arrays[f"images_{method}"] = pictures
        arrays[f"reached_{method}"] = np.asarray(result.map(case.problem.pose.handles))
    unknowns = 4 * case.problem.domain.n_coefficients - 10 * case.problem.domain.n_holes - 2
    return {
        "name": case.name,
        "unknowns": unknowns,
        "holes": case.problem.domain.n_holes,
        "runs": runs,
        "arrays": arrays,
    }


def draw(data: Measurement, path: Path) -> None:
    """Rows of thumbnails, and energies against iterations and time."""
    runs, arrays = data["runs"], data["arrays"]
    rows = [m for m in ("newton", "newton-eigen", "newton-unmodified", "slim", "aqp") if m in runs]
    figure = drawing.figure(12.0, 1.3 * len(rows))
    left, right = drawing.side_by_side(figure, (1.25, 1.0))
    grid = left.subplots(len(rows), 3, squeeze=False)
    final = drawing.densities(
        arrays["display"], arrays["display_triangles"], arrays["images_newton"][-1]
    )
    most = float(np.clip(np.quantile(final, 0.97), 3.0, 12.0))
    colors = None
    for row, method in zip(grid, rows, strict=True):
        run = runs[method]
        kind = "mesh" if method in MESH else "display"
        rest, triangles = arrays[kind], arrays[f"{kind}_triangles"]
        pictures = arrays[f"images_{method}"]
        for axes in row:
            axes.set_axis_off()
        for axes, iteration, images in zip(row, run["thumbnails"], pictures, strict=False):
            pose = np.hstack([arrays["targets"], arrays[f"reached_{method}"]])
            ends = iteration == run["thumbnails"][-1]
            shown = pose if ends else pose[:, [0, 1, 0, 1]]
            colors = drawing.draw_map(axes, rest, triangles, images, shown, most)
            axes.set_title(f"iteration {iteration}", fontsize=SMALL - 1, pad=2)
        note = f"{run['visible']} it., {_seconds(run['visible_time'])}"
        if run["status"] in ("indefinite", "blocked"):
            note = f"halts after {run['iterations']} it."
        row[0].text(
            -0.02, 0.5, f"{LOOK[method][0]}\n{note}", transform=row[0].transAxes,
            fontsize=SMALL, rotation=90, ha="right", va="center", color=LOOK[method][1],
        )  # fmt: skip
    if colors is not None:
        drawing.color_bar(left, colors, grid, "symmetric Dirichlet density")
    plots = right.subplots(2, 2)
    least = runs["newton"]["energy"][-1]
    for axes_row, names, space in zip(
        plots, (HARMONIC, MESH), ("harmonic subspace", "triangle mesh"), strict=True
    ):
        for axes, against in zip(axes_row, ("iteration", "time"), strict=True):
            for method in names:
                if method in runs:
                    _curve(axes, runs[method], method, against, least)
            axes.set_yscale("log")
            axes.set_xscale("log")
            axes.xaxis.set_minor_formatter(NullFormatter())
            unit = "seconds" if against == "time" else "iteration"
            drawing.label_axes(axes, unit, "relative energy gap", space)
            axes.legend(fontsize=SMALL - 1.5, frameon=False)
    drawing.save(figure, path)


def _curve(axes: Any, run: dict[str, Any], method: str, against: str, least: float) -> None:
    """Energy over that of the method's own last iterate, or over ours where it got nowhere."""
    label, color, style = LOOK[method]
    energy = drawing.gap(run["energy"])
    last = float(energy[-1]) if run["status"] not in ("indefinite", "blocked") else least
    gap = energy / min(last, 2 * least) - 1
    x = np.arange(len(energy)) + 1 if against == "iteration" else np.array(run["time"])
    keep = np.isfinite(gap) & (gap > _LEAST_GAP) & (x > 0)
    if keep.any():
        axes.plot(x[keep], gap[keep], style, color=color, lw=LINE, label=label)
        if run["status"] == "indefinite":
            axes.plot(x[keep][-1], gap[keep][-1], "x", color=color, ms=5)


def _seconds(value: float) -> str:
    return f"{value * 1e3:.0f} ms" if value < 1 else f"{value:.1f} s"
