"""Pieces of figures: maps coloured by their distortion, curves of energies."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from glid_nb._files import write_atomically
from glid_nb.figures.style import CYAN, INK, SMALL, distortion_colors, tidy
from glid_nb.geometry import Triangulation
from studies.distortion import densities

Array = NDArray[Any]

DPI = 130
WEBP = {"quality": 80, "method": 6}
"""How figures are compressed. PNGs of the same figures are 4 to 5 times as large."""


def figure(width: float, height: float) -> Figure:
    """An empty figure, inches."""
    return Figure(figsize=(width, height), dpi=DPI, layout="constrained")


def save(drawn: Figure, path: Path) -> None:
    """Write a figure as WebP."""
    path.parent.mkdir(parents=True, exist_ok=True)
    buffer = io.BytesIO()
    drawn.savefig(buffer, format="webp", facecolor="white", pil_kwargs=WEBP)
    write_atomically(path, buffer.getvalue())


def draw_map(
    axes: Axes, mesh: Triangulation, images: Array, pose: Array | None = None, most: float = 6.0
) -> Any:
    """Draw a map's image, coloured by its distortion; folded triangles are black.

    ``pose`` (h, 4) holds targets and reached positions, drawn as cyan discs and black dots. Values
    above ``most`` have the colour of ``most``; :func:`color_bar` shows this.
    """
    # Draw from left to right of the undeformed shape, so that overlapping sheets stay separate.
    order = np.argsort(mesh.vertices[mesh.triangles, 0].mean(axis=1), kind="stable")
    triangles, density = mesh.triangles[order], densities(mesh, images)[order]
    folded = ~np.isfinite(density)
    colors = PolyCollection(
        list(images[triangles[~folded]]),
        array=density[~folded],
        cmap=distortion_colors(),
        clim=(2.0, most),
        edgecolors="face",
        linewidths=0.2,
    )
    axes.add_collection(colors)
    if folded.any():
        axes.add_collection(PolyCollection(list(images[triangles[folded]]), facecolors="black"))
    if pose is not None and len(pose):
        # A line connects each handle with its target.
        axes.add_collection(LineCollection(list(pose.reshape(-1, 2, 2)), colors=CYAN, lw=0.7))
        axes.scatter(pose[:, 0], pose[:, 1], s=11, color=CYAN, lw=0, zorder=3)
        axes.scatter(pose[:, 2], pose[:, 3], s=1.5, color=INK, zorder=4)
    axes.margins(0.03)
    # Align boxes of different heights, and their titles, at the top.
    axes.set_aspect("equal", anchor="N")
    axes.set_axis_off()
    return colors


def color_bar(drawn: Figure, colors: Any, axes: Any, label: str) -> None:
    """A slim colour bar beside axes, with an arrow if a map in them exceeds its range."""
    most = colors.get_clim()[1]
    maps = [c for ax in np.ravel(axes) for c in ax.collections if isinstance(c, PolyCollection)]
    drawn_values = [values for c in maps if (values := c.get_array()) is not None and len(values)]
    beyond = any(float(values.max()) > most for values in drawn_values)
    bar = drawn.colorbar(
        colors,
        ax=axes,
        shrink=0.7,
        aspect=30,
        pad=0.01,
        panchor=False,
        extend="max" if beyond else "neither",
    )
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=SMALL, length=2)
    bar.set_label(label, fontsize=SMALL)


def label_axes(axes: Axes, x: str, y: str, title: str = "") -> None:
    """Label the axes, in the style of all plots."""
    tidy(axes)
    axes.set_xlabel(x, fontsize=SMALL)
    axes.set_ylabel(y, fontsize=SMALL)
    axes.set_title(title, fontsize=SMALL + 1, loc="left")


def values_of(energies: Any) -> Array:
    """Energies as an array; null in the file means infinite."""
    return np.array([np.inf if e is None else e for e in energies], dtype=float)
