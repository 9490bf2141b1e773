"""Pieces of figures: maps coloured by their distortion, curves of energies."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from glid_nb.imaging.style import (
    BLUE,
    CYAN,
    FAINT,
    GREEN,
    GREY,
    INK,
    ORANGE,
    SKY,
    SMALL,
    VERMILION,
    distortion_colors,
    tidy,
)

Array = NDArray[Any]

LOOK = {
    "newton": ("Newton, ours", BLUE, "-"),
    "newton-paper": ("Newton, paper's settings", SKY, "-"),
    "newton-staged": ("Newton, stage by stage", SKY, "-"),
    "newton-unmodified": ("Newton, unmodified", GREY, "--"),
    "newton-eigen": ("Newton-Eigen", GREEN, "-"),
    "newton-shift": ("Newton, shifted", FAINT, "-"),
    "lbfgs": ("L-BFGS", INK, ":"),
    "slim": ("SLIM", ORANGE, "-"),
    "aqp": ("AQP", VERMILION, "-"),
    "gradient-descent": ("gradient descent", FAINT, ":"),
    "arap-mesh": ("ARAP, local/global", FAINT, "--"),
    "bdhm": ("BDHM", VERMILION, "-"),
}
"""Name, colour and line of each method, the same in every figure."""

MOST_DISTORTED = 6.0
"""Upper end of the distortion colour map: the symmetric Dirichlet density; 2 is an isometry."""

DPI = 130


def figure(width: float, height: float) -> Figure:
    """An empty figure, inches."""
    return Figure(figsize=(width, height), dpi=DPI, layout="constrained")


def side_by_side(drawn: Figure, ratios: tuple[float, float]) -> tuple[Any, Any]:
    """Two parts of a figure, each with a layout of its own."""
    parts: Any = drawn.subfigures(1, 2, width_ratios=ratios)
    return parts[0], parts[1]


def save(drawn: Figure, path: Path) -> None:
    """Write a figure as PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    drawn.savefig(path, facecolor="white", metadata={"Software": None})


def densities(rest: Array, triangles: Array, images: Array) -> Array:
    """(t,) symmetric Dirichlet density of a piecewise linear map; infinite where it folds."""
    source, image = (
        np.stack([v[triangles[:, k]] - v[triangles[:, 0]] for k in (1, 2)], axis=-1)
        for v in (rest.astype(float), images.astype(float))
    )
    jacobian = image @ np.linalg.inv(source)
    det = np.linalg.det(jacobian)
    dirichlet = (jacobian**2).sum(axis=(1, 2)) / 2
    positive = det > 0
    return np.where(positive, dirichlet * (1 + np.where(positive, det, 1.0) ** -2), np.inf)


def draw_map(
    axes: Axes,
    rest: Array,
    triangles: Array,
    images: Array,
    pose: Array | None = None,
    most: float = MOST_DISTORTED,
    values: Array | None = None,
) -> Any:
    """A map's image coloured by its distortion, folded triangles in black.

    ``pose`` (h, 4) holds targets and reached positions: cyan discs and black dots.
    """
    # From the left of the undeformed shape to its right: sheets over one another do not mingle.
    order = np.argsort(rest[triangles, 0].mean(axis=1), kind="stable")
    triangles = triangles[order]
    density = densities(rest, triangles, images)
    folded = ~np.isfinite(density)
    shown = density if values is None else values[order]
    colors = PolyCollection(
        list(images[triangles[~folded]]),
        array=np.clip(shown[~folded], None, most),
        cmap=distortion_colors(),
        clim=(0.0 if values is not None else 2.0, most),
        edgecolors="face",
        linewidths=0.2,
    )
    axes.add_collection(colors)
    if folded.any():
        axes.add_collection(PolyCollection(list(images[triangles[folded]]), facecolors="black"))
    if pose is not None and len(pose):
        axes.scatter(pose[:, 0], pose[:, 1], s=11, color=CYAN, lw=0, zorder=3)
        axes.scatter(pose[:, 2], pose[:, 3], s=1.5, color=INK, zorder=4)
    low, high = images.min(axis=0), images.max(axis=0)
    if pose is not None and len(pose):
        low, high = np.minimum(low, pose[:, :2].min(axis=0)), np.maximum(high, pose[:, :2].max(0))
    pad = 0.03 * float((high - low).max())
    axes.set(xlim=(low[0] - pad, high[0] + pad), ylim=(low[1] - pad, high[1] + pad))
    axes.set_aspect("equal")
    axes.set_axis_off()
    return colors


def color_bar(drawn: Figure, colors: Any, axes: Any, label: str) -> None:
    """A slim colour bar beside axes."""
    bar = drawn.colorbar(colors, ax=axes, shrink=0.7, aspect=30, pad=0.01)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=SMALL, length=2)
    bar.set_label(label, fontsize=SMALL)


def label_axes(axes: Axes, x: str, y: str, title: str = "") -> None:
    """Names of the axes and the look of all plots."""
    tidy(axes)
    axes.set_xlabel(x, fontsize=SMALL)
    axes.set_ylabel(y, fontsize=SMALL)
    axes.set_title(title, fontsize=SMALL + 1, loc="left")


def values_of(energies: Any) -> Array:
    """Energies as an array; those that are null in the file are infinite."""
    return np.array([np.inf if e is None else e for e in energies], dtype=float)
