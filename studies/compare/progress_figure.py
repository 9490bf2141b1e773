"""Rows of intermediate maps of each solver, and its energy against iterations and time."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import NullFormatter
from numpy.typing import NDArray
from scipy.spatial import KDTree

from glid_nb.figures.style import BLUE, GREEN, GREY, INK, LINE, ORANGE, SKY, SMALL, VERMILION
from glid_nb.geometry import Triangulation
from studies import figures
from studies.distortion import densities
from studies.runs import ENDED
from studies.store import Measurement

Array = NDArray[Any]

LOOK = {
    "newton": ("Newton, ours", BLUE, "-"),
    "newton-paper": ("Newton, paper's settings", SKY, "-"),
    "newton-unmodified": ("Newton, unmodified", GREY, "--"),
    "newton-eigen": ("Newton-Eigen", GREEN, "-"),
    "lbfgs": ("L-BFGS", INK, ":"),
    "slim": ("SLIM", ORANGE, "-"),
    "aqp": ("AQP", VERMILION, "-"),
}
"""Name, colour and line of each method."""
HARMONIC = ("newton", "newton-paper", "newton-unmodified", "newton-eigen", "lbfgs")
MESH = ("slim", "aqp")
_ROWS = ("newton", "newton-eigen", "newton-unmodified", *MESH)
_PICTURES = 4
_LABEL = 0.75  # width of a row's label, in pictures
_LEAST_GAP = 1e-9


def draw(found: list[Measurement], folder: Path) -> None:
    """Two figures for each shape: the maps, and the energies."""
    for data in found:
        rows = [method for method in _ROWS if method in data["runs"]]
        maps, energies = (figures.figure(width, 1.5 * len(rows)) for width in (7.7, 5.3))
        _draw_maps(maps, data, rows)
        _draw_energies(energies, data["runs"])
        figures.save(maps, folder / f"progress-{data['name']}.webp")
        figures.save(energies, folder / f"energies-{data['name']}.webp")


def _draw_maps(figure: Any, data: Measurement, rows: list[str]) -> None:
    runs, arrays = data["runs"], data["arrays"]
    ratios = (_LABEL, *(1.0,) * _PICTURES)
    grid = figure.subplots(len(rows), 1 + _PICTURES, squeeze=False, width_ratios=ratios)
    meshes = {
        kind: Triangulation(arrays[kind], arrays[f"{kind}_triangles"], 0)
        for kind in ("display", "mesh")
    }
    final = densities(meshes["display"], arrays["images_newton"][-1])
    most = float(np.clip(np.quantile(final, 0.97), 3.0, 12.0))
    colors = None
    for (label, *row), method in zip(grid, rows, strict=True):
        mesh = meshes["mesh" if method in MESH else "display"]
        handles = KDTree(mesh.vertices).query(arrays["handles"])[1]  # handles are vertices
        pictures = arrays[f"images_{method}"]
        titles = [f"iteration {i}" for i in runs[method]["thumbnails"]]
        if runs[method].get("minimum") is not None:
            titles.append("its minimum")
        for axes in (label, *row):
            axes.set_axis_off()
        # Align rows at the right, so that the ends of all methods are in one column.
        for axes, title, images in zip(row[-len(titles) :], titles, pictures, strict=True):
            pose = np.hstack([arrays["targets"], images[handles]])
            colors = figures.draw_map(axes, mesh, images, pose, most)
            density = densities(mesh, images)
            largest = f"maximum {density[np.isfinite(density)].max():.2g}"
            axes.set_title(f"{title}\n{largest}", fontsize=SMALL - 1, pad=2)
        name, color, _ = LOOK[method]
        label.text(
            0.0, 0.5, name, transform=label.transAxes,
            fontsize=SMALL, va="center", color=color,
        )  # fmt: skip
    figures.color_bar(figure, colors, grid, "symmetric Dirichlet density")


def _draw_energies(figure: Any, runs: dict[str, Any]) -> None:
    plots = figure.subplots(2, 2, sharey="row")
    shown = {}
    for axes_row, names, space in zip(
        plots, (HARMONIC, MESH), ("harmonic subspace", "triangle mesh"), strict=True
    ):
        for axes, against in zip(axes_row, ("iteration", "seconds"), strict=True):
            for method in names:
                if method in runs:
                    line = _curve(axes, runs[method], method, against, _least(runs, method))
                    shown.setdefault(LOOK[method][0], line)
            axes.set_yscale("log")
            axes.set_xscale("log")
            axes.xaxis.set_minor_formatter(NullFormatter())
            figures.label_axes(axes, against, "energy above its minimum, relative", space)
    for axes in plots[:, 1]:
        axes.set_ylabel("")
    figure.legend(
        shown.values(), shown.keys(), loc="outside lower center", ncols=4, fontsize=SMALL,
        frameon=False,
    )  # fmt: skip


def _least(runs: dict[str, Any], method: str) -> float:
    """The energy that a method approaches: the minimum on its mesh, its own last energy if it
    converged, or ours.

    Settings of Newton's method differ in their samples, so their minima differ in some digits.
    """
    run = runs[method]
    if run.get("minimum") is not None:
        return run["minimum"]
    if method in MESH or run["status"] in ENDED:
        return run["energy"][-1]
    return runs["newton"]["energy"][-1]


def _curve(axes: Any, run: dict[str, Any], method: str, against: str, least: float) -> Any:
    """The relative energy gap; a cross where the method halted."""
    label, color, style = LOOK[method]
    gap = figures.values_of(run["energy"]) / least - 1
    # The start, iteration 0, has no place on a logarithmic axis.
    x = np.arange(len(gap)) if against == "iteration" else np.array(run["time"])
    keep = np.isfinite(gap) & (gap > _LEAST_GAP) & (x > 0)
    (line,) = axes.plot(x[keep], gap[keep], style, color=color, lw=LINE, label=label)
    if keep.any() and run["status"] in ("indefinite", "blocked"):
        axes.plot(x[keep][-1], gap[keep][-1], "x", color=color, ms=5)
    return line
