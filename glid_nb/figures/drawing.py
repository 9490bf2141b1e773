"""Parts of figures of shapes: the figure itself, loops, dots, pictures, colour bars."""

import io
import json
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import Collection, LineCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patheffects import withStroke
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray
from PIL import Image, ImageColor
from PIL.PngImagePlugin import PngInfo

from glid_nb._arrays import Floats
from glid_nb.figures.parts import parts
from glid_nb.figures.style import CSS_DPI, CYAN, HAIRLINE, INK, NAMED, SMALL
from glid_nb.imaging import PixelFrame
from glid_nb.pose import Pose

_MISS = 0.004  # of the axes' size: handles farther from their target get a line
_SHOWN_DPI = 150.0  # resolution of a figure in a notebook
PARTS = "glid_nb parts"  # the name of a text in a PNG file
MANY = 256  # a collection with more values than this is a field
_ROUND, _COARSE = (1, 1.1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 7), (1, 2, 5)  # ticks of a decade

ON_WHITE: Any = [withStroke(linewidth=2.0, foreground="white")]  # legible on every picture


class NotebookFigure(Figure):
    """A matplotlib figure that a notebook shows as a picture. It is not registered in pyplot."""

    def __init__(self, width: float, height: float, dpi: float = _SHOWN_DPI) -> None:
        super().__init__((width, height), dpi, facecolor="white", layout="constrained")
        FigureCanvasAgg(self)

    def __repr__(self) -> str:
        """Leave out the size, which depends on fonts, so that saved outputs stay comparable."""
        return f"<{type(self).__name__}>"

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        return notebook_png(self)

    def _ipython_display_(self) -> None:
        # Do not use IPython's formatters: ipywidgets' interact sets one of its own for figures.
        from IPython.display import publish_display_data  # noqa: PLC0415 - notebooks alone need it

        png, size = self._repr_png_()
        publish_display_data({"text/plain": repr(self), "image/png": png}, {"image/png": size})


def notebook_png(figure: Figure) -> tuple[bytes, dict[str, int]]:
    """The figure as a small PNG file for a notebook, and its size there in CSS pixels.

    The file names the figure's parts in a text of its own, which programs that show pictures
    ignore. The site reads it, to draw the figure for a phone.
    """
    width, height = (CSS_DPI * figure.get_size_inches()).round().astype(int).tolist()
    file, picture = io.BytesIO(), Image.open(io.BytesIO(figure_png(figure, _SHOWN_DPI)))
    values = [collection.get_array() for collection in figure.findobj(Collection)]
    field = any(array is not None and array.size > MANY for array in values)
    # A palette has too few colours for a smooth field, which would then show bands.
    smooth = field and not figure.findobj(AxesImage)
    drawn = (_rounded if smooth else _in_256_colors)(picture.convert("RGB"))
    about = PngInfo()
    if found := parts([figure]):
        about.add_text(PARTS, json.dumps(found))
    drawn.save(file, "png", optimize=True, pnginfo=about)
    return file.getvalue(), {"width": width, "height": height}


def _in_256_colors(picture: Image.Image) -> Image.Image:
    """Reduce a picture to 256 colours, for a file of a quarter of the size. The named colours,
    which may cover few pixels, stay exact."""
    named = [ImageColor.getrgb(color) for color in NAMED]
    drawn = picture.quantize(256 - len(named), Image.Quantize.MAXCOVERAGE, kmeans=3)
    colors = (drawn.getpalette() or [])[: 3 * (256 - len(named))]
    for color in named:
        drawn.paste(len(colors) // 3, mask=Image.fromarray((np.asarray(picture) == color).all(2)))
        colors += color
    drawn.putpalette(colors)
    return drawn


def _rounded(picture: Image.Image) -> Image.Image:
    """Round all colours, by at most 3 of 255, for a file of half the size."""
    step = 255 / 47
    return Image.fromarray(np.round(np.round(np.asarray(picture) / step) * step).astype(np.uint8))


def figure_png(figure: Figure, dpi: float | None = None) -> bytes:
    """The figure as a PNG file, by default at its own resolution."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi or figure.dpi)
    return buffer.getvalue()


def box_around(points: Floats, margin: float = 0.02) -> Floats:
    """(2, 2) lower and upper corner of the points' bounding box, with a margin."""
    low, high = points.min(axis=0), points.max(axis=0)
    room = margin * (high - low).max()
    return np.stack([low - room, high + room])


def enlarged(box: Floats, points: Floats) -> Floats:
    """Enlarge the box to contain the points, by at most a quarter of its size on each side."""
    size = np.ptp(box, axis=0).max()
    held = points.clip(box[0] - 0.22 * size, box[1] + 0.22 * size)
    corners = np.concatenate([box, held - 0.03 * size, held + 0.03 * size])
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


def picture(axes: Axes, pixels: NDArray[np.uint8], frame: PixelFrame) -> None:
    """Draw an RGBA picture on white, behind everything else."""
    white = Image.new("RGBA", pixels.shape[1::-1], "white")
    white.alpha_composite(Image.fromarray(pixels))
    xmin, ymin, xmax, ymax = frame.bounds
    axes.imshow(white, extent=(xmin, xmax, ymin, ymax), zorder=0)


def loops(axes: Axes, closed: Iterable[Floats], label: str = "", **style: Any) -> None:
    """Closed lines with one entry in the legend."""
    for loop in closed:
        points = np.concatenate([loop, loop[:1]]).T
        axes.plot(*points, solid_joinstyle="round", zorder=2, label=label, **style)
        label = ""


def dots(axes: Axes, points: Floats, color: str, size: float, edge: float, label: str) -> None:
    """Round dots with one entry in the legend; those in cyan have a dark edge."""
    line = "white" if color != CYAN else INK
    style: dict[str, Any] = {"markersize": size, "markeredgewidth": edge, "markeredgecolor": line}
    axes.plot(*points.T, "o", color=color, zorder=4, label=label, **style)


def targets(axes: Axes, map: Any, pose: Pose) -> None:
    """Draw targets and the handles' images, with lines between pairs that are visibly apart."""
    size = max(np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim()))
    images = map(pose.handles) if len(pose) else pose.handles
    apart = np.linalg.norm(images - pose.targets, axis=1) > _MISS * size
    segments = np.stack([images[apart], pose.targets[apart]], axis=1)
    lines = LineCollection(list(segments), colors=INK, linewidths=0.9, zorder=3)
    lines.set_path_effects(ON_WHITE)
    axes.add_collection(lines, autolim=False)
    dots(axes, pose.targets, CYAN, 5.0, edge=0.6, label="targets")
    dots(axes, images, "black", 2.2, edge=0.0, label="handles' images")


def label_levels(axes: Axes, lines: Any, labels: dict[float, str]) -> None:
    """Write values on contour lines, legible on every colour."""
    texts = axes.clabel(lines, [*labels], fmt=labels, fontsize=SMALL, colors=INK, inline_spacing=2)
    for text in texts:
        text.set_path_effects(ON_WHITE)


def log_ticks(low: float, high: float) -> list[float]:
    """Round numbers from ``low`` to ``high``, at least a tenth of a logarithmic scale apart."""
    ticks: list[float] = []
    steps = _COARSE if high > 8 * low else _ROUND
    for decade in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1):
        for tick in (m * 10.0**decade for m in steps):
            inside = low / 1.001 <= tick <= high * 1.001
            if inside and (not ticks or math.log(tick / ticks[-1]) > 0.1 * math.log(high / low)):
                ticks.append(tick)
    return ticks


def color_bar(axes: Any, colors: Any, label: str, **look: Any) -> Axes:
    """Add a slim colour bar below axes. Returns the axes of the bar."""
    place = {"location": "bottom", "shrink": 0.8, "aspect": 24, "pad": 0.02, "panchor": False}
    scale = np.ravel(axes)[0].figure.colorbar(colors, ax=axes, **{**place, **look})
    scale.set_label(label, fontsize=SMALL, labelpad=1, color=INK)
    scale.ax.xaxis.set_minor_locator(NullLocator())
    scale.ax.tick_params(labelsize=SMALL, length=2, width=HAIRLINE, pad=1.5, colors=INK)
    scale.outline.set(linewidth=HAIRLINE, edgecolor=INK)
    return scale.ax
