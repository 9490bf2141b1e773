"""Colours (distinguishable by colour-blind people), sizes and legends of all figures and plots."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from glid_nb._arrays import Array

if TYPE_CHECKING:  # matplotlib takes half a second to import, and the first canvas does without
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

CSS_DPI = 108.0  # CSS pixels per inch of a figure in a notebook
COLOR_BAR = "<colorbar>"  # matplotlib's label of its axes

FONT_SIZE = 9.0
SMALL = 8.0
LINE = 1.2
HAIRLINE = 0.6

FULL_MARGIN = 0.5  # panels with at least this certified sigma_2 have the best colour

LEGEND = {"fontsize": SMALL, "frameon": False, "labelcolor": INK}
LEGEND |= {"handlelength": 1.1, "handletextpad": 0.4, "borderpad": 0.1}
"""The look of every legend, as keywords of matplotlib."""

COLORS = (
    *("#fcf4b6", "#fecc8f", "#fea16e", "#f8765c", "#e75263"),
    *("#c43c75", "#a02f7f", "#7b2382", "#57157e", "#331067"),
)
"""Ten stops of `distortion_colors`, from isometric to distorted, without matplotlib."""


def distortion_colors() -> "Colormap":
    """Pale for isometric, dark for distorted, also in grey: magma without its black end."""
    from matplotlib import colormaps  # noqa: PLC0415 - as above
    from matplotlib.colors import ListedColormap  # noqa: PLC0415

    magma = colormaps["magma_r"]
    return ListedColormap([magma(0.02 + 0.8 * i / 255) for i in range(256)], name="distortion")


def rgb(colors: Sequence[str]) -> Array:
    """(n, 3) colours of ``#rrggbb`` texts."""
    return np.array([[int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)] for color in colors])


def tidy(axes: "Axes") -> None:
    """Draw two thin spines and small ticks outside, but no box."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set(color=INK, linewidth=HAIRLINE)
    ticks = {"colors": INK, "labelsize": SMALL, "width": HAIRLINE, "length": 2.5, "pad": 2}
    axes.tick_params(which="both", direction="out", **ticks)
    axes.tick_params(which="minor", length=1.5)
