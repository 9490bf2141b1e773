"""Colours (distinguishable by colour-blind people), sizes and legends of all figures and plots."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:  # matplotlib takes half a second to import; the editor's first canvas needs none
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap

# Greys, and the colours of Okabe and Ito.
INK = "#2b2b2b"
GREY = "#7f7f7f"
FAINT = "#b8b8b8"
BLUE = "#0072b2"
SKY = "#56b4e9"
ORANGE = "#e69f00"
VERMILION = "#d55e00"
GREEN = "#009e73"
PURPLE = "#cc79a7"
CYAN = "#00d5e0"
NAMED = (INK, GREY, BLUE, SKY, ORANGE, VERMILION, GREEN, PURPLE, CYAN)

FONT_SIZE = 8.0
SMALL = 7.0
LINE = 1.2
HAIRLINE = 0.6

LEGEND = {
    "fontsize": SMALL,
    "frameon": False,
    "labelcolor": INK,
    "handlelength": 1.1,
    "handletextpad": 0.4,
    "borderpad": 0.1,
}
"""The look of every legend: keywords of matplotlib's."""


def distortion_colors() -> Colormap:
    """Pale where the map is isometric, dark where it is not: magma's scale without its black.

    Perceptually uniform, with a lightness that only falls, so it also reads in grey.
    """
    from matplotlib import colormaps  # noqa: PLC0415 - as above
    from matplotlib.colors import ListedColormap  # noqa: PLC0415

    magma = colormaps["magma_r"]
    return ListedColormap([magma(0.02 + 0.8 * i / 255) for i in range(256)], name="distortion")


def tidy(axes: Axes) -> None:
    """Two thin spines, small ticks outside, no box."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set(color=INK, linewidth=HAIRLINE)
    ticks = {"colors": INK, "labelsize": SMALL, "width": HAIRLINE, "length": 2.5, "pad": 2}
    axes.tick_params(which="both", direction="out", **ticks)
    axes.tick_params(which="minor", length=1.5)
