"""One look for every figure and plot: colours that colour-blind people can tell apart, sizes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:  # half a second of imports that the editor's first canvas does not wait for
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap

# The ink of axes and text, and Okabe and Ito's colours.
INK = "#2b2b2b"
GREY = "#7f7f7f"
FAINT = "#b8b8b8"
BLUE = "#0072b2"
SKY = "#56b4e9"
ORANGE = "#e69f00"
VERMILION = "#d55e00"
GREEN = "#009e73"
CYAN = "#00d5e0"

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
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(INK)
        axes.spines[side].set_linewidth(HAIRLINE)
    axes.tick_params(
        which="both",
        colors=INK,
        labelsize=SMALL,
        width=HAIRLINE,
        length=2.5,
        pad=2,
        direction="out",
    )
    axes.tick_params(which="minor", length=1.5)
