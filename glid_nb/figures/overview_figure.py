"""The overview figure: a picture, its deformation, and how the solver got there."""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from numpy.typing import ArrayLike, NDArray

from glid_nb.figures.plots import CertificatePlot, EnergyPlot, StepPlot
from glid_nb.figures.style import (
    BLUE,
    CYAN,
    FONT_SIZE,
    GREY,
    HAIRLINE,
    INK,
    SMALL,
    VERMILION,
    distortion_colors,
)
from glid_nb.geometry import Cage
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.mesh import DeformedMesh, deformed_mesh
from glid_nb.imaging.rasterise import render_mesh
from glid_nb.imaging.render import OutputFrame
from glid_nb.imaging.texture import Texture

if TYPE_CHECKING:
    from glid_nb.solvers import Pose, Result

_NAMES = (
    "Source",
    "Deformation",
    "Distortion  max(σ₁, 1/σ₂)",
    "Energy",
    "Newton steps",
    "Certificate",
)

# Inches.
_NARROWEST = 4.5
_MARGIN = 0.12
_GAP = 0.34
_TITLE = 0.24
_KEY = 0.34
_PLOT = 1.35
_PLOT_TITLE = 0.4
_AXIS_LEFT = 0.36
_AXIS_BELOW = 0.3
_TALLEST = 3.0

# How much smaller than it could be a picture is drawn for the sake of a common scale.
_SHRINK = 1.7

_DPI = 300
_TICKS = (1, 1.1, 1.2, 1.5, 2, 3, 5, 10, 20, 50, 100, 1000, 10_000)
# Handles that miss their target by more than this share of the shape's size get a line.
_MISS = 0.004


def overview(
    image: ArrayLike | Texture, result: Result, pose: Pose | None = None, *, width: float = 7.0
) -> Figure:
    """A figure that shows a solve at one glance.

    Above, at one scale unless their sizes differ a lot: the picture with the cage, the offset cage
    and the handles; the deformed picture with targets (cyan discs) and the handles' images (black
    dots), joined by a line where they differ; the distortion max(sigma_1, 1 / sigma_2) over the
    deformed shape. Where it overlaps itself, both look as `rendering` draws it. Below: the
    energies and the Newton steps per iteration, and the certified lower bound on sigma_2 along the
    boundary with the sampled sigma_2.

    Parameters
    ----------
    image : (h, w, c) or (h, w) array, or Texture
        The picture that the cage was traced from.
    result : Result
        What :func:`glid_nb.solve` returned.
    pose : Pose, optional
        Other handles and targets to show than those of the solve.
    width : float
        Inches, at least 4.5; text keeps its size.

    Returns
    -------
    matplotlib.figure.Figure
        With an Agg canvas of its own and 300 dots per inch, outside of pyplot's list of figures.
        ``figure.savefig(path)`` writes it; so does `figure_png` into memory.

    Raises
    ------
    ValueError
        The figure would be too narrow for its text, or the picture is none.
    """
    if not width >= _NARROWEST:
        raise ValueError(f"width is {width} inches; the text needs at least {_NARROWEST}")
    texture = image if isinstance(image, Texture) else Texture.from_image(image)
    map = result.map
    pose = result.pose if pose is None else pose
    cage, outer = map.domain.cage, map.domain.offset_cage
    source = _Extent.around(outer.exterior)
    outline = [map(_dense(loop)) for loop in cage.loops]
    target = _Extent.around(np.concatenate(outline)).reaching(pose.targets)

    column = (width - 2 * _MARGIN - 2 * _GAP) / 3
    fits = [min(column / extent.width, _TALLEST / extent.height) for extent in (source, target)]
    # One scale for both, unless that would leave one of them tiny.
    scales = [min(fit, max(min(fits), fit / _SHRINK)) for fit in fits]
    row = max(source.height * scales[0], target.height * scales[1])
    height = 2 * _MARGIN + _TITLE + row + _KEY + _PLOT_TITLE + _PLOT + _AXIS_BELOW
    figure = Figure(figsize=(width, height), dpi=_DPI, facecolor="white")
    FigureCanvasAgg(figure)
    page = _Page(figure, width, height)

    lefts = [_MARGIN + i * (column + _GAP) for i in range(3)]
    top = height - _MARGIN - _TITLE
    mesh = deformed_mesh(map, 4000, 0.25 / (scales[1] * _DPI))
    cells = zip(lefts, (source, target, target), (scales[0], scales[1], scales[1]), strict=True)
    pictures = [
        page.picture(left, top, column, row, extent, scale) for left, extent, scale in cells
    ]
    _draw_source(pictures[0], texture, cage, outer, pose)
    _draw_result(pictures[1], texture, mesh, outline, map, pose)
    _draw_distortion(pictures[2], mesh, outline, map, page, lefts[2], top - row, column)
    _source_key(page, lefts[0], top - row, column)
    _result_key(page, lefts[1], top - row, column)

    below = _MARGIN + _AXIS_BELOW
    energy, steps, certificate = (
        page.axes(left + _AXIS_LEFT, below, column - _AXIS_LEFT, _PLOT) for left in lefts
    )
    EnergyPlot(energy).update(result.history, result.start_energy)
    StepPlot(steps).update(result.history)
    CertificatePlot(certificate, cage).update(result.certificate, map)

    for i, name in enumerate(_NAMES):
        y = height - _MARGIN if i < 3 else below + _PLOT + _PLOT_TITLE - 0.02
        page.title(lefts[i % 3], y, "abcdef"[i], name)
    return figure


def figure_png(figure: Figure) -> bytes:
    """The figure as a PNG file at its own resolution."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=figure.dpi)
    return buffer.getvalue()


@dataclass(frozen=True)
class _Extent:
    """A rectangle of the plane."""

    xmin: float
    ymin: float
    xmax: float
    ymax: float

    @classmethod
    def around(cls, points: NDArray[np.float64], margin: float = 0.02) -> _Extent:
        low, high = points.min(axis=0), points.max(axis=0)
        room = margin * float((high - low).max())
        return cls(*(float(v) for v in (*(low - room), *(high + room))))

    @property
    def width(self) -> float:
        return self.xmax - self.xmin

    @property
    def height(self) -> float:
        return self.ymax - self.ymin

    def reaching(self, points: NDArray[np.float64]) -> _Extent:
        """Enlarged to hold the points, though not by more than a quarter of its size per side."""
        if not len(points):
            return self
        most = 0.25 * max(self.width, self.height)
        room = 0.03 * max(self.width, self.height)
        low, high = points.min(axis=0) - room, points.max(axis=0) + room
        return _Extent(
            float(np.clip(low[0], self.xmin - most, self.xmin)),
            float(np.clip(low[1], self.ymin - most, self.ymin)),
            float(np.clip(high[0], self.xmax, self.xmax + most)),
            float(np.clip(high[1], self.ymax, self.ymax + most)),
        )


@dataclass(frozen=True)
class _Page:
    """A figure that is laid out in inches from its lower left corner."""

    figure: Figure
    width: float
    height: float

    def axes(self, left: float, bottom: float, width: float, height: float) -> Axes:
        w, h = self.width, self.height
        return self.figure.add_axes((left / w, bottom / h, width / w, height / h))

    def picture(
        self, left: float, top: float, column: float, row: float, extent: _Extent, scale: float
    ) -> Axes:
        """Axes in world units without frame, in the middle of a cell."""
        width, height = extent.width * scale, extent.height * scale
        axes = self.axes(left + (column - width) / 2, top - row + (row - height) / 2, width, height)
        axes.set_xlim(extent.xmin, extent.xmax)
        axes.set_ylim(extent.ymin, extent.ymax)
        axes.set_axis_off()
        return axes

    def title(self, left: float, top: float, letter: str, name: str) -> None:
        x, y = left / self.width, top / self.height
        style: dict[str, Any] = {"fontsize": FONT_SIZE, "va": "top", "color": INK}
        self.figure.text(x, y, letter, fontweight="bold", **style)
        self.figure.text(x + 0.14 / self.width, y, name, **style)


def _frame_of(axes: Axes) -> OutputFrame:
    """The pixels of picture axes."""
    (xmin, xmax), (ymin, ymax) = axes.get_xlim(), axes.get_ylim()
    box = axes.get_window_extent()
    size = max(1, round(box.width)), max(1, round(box.height))
    return OutputFrame(size, size[0] / (xmax - xmin), ((xmin + xmax) / 2, (ymin + ymax) / 2))


def _show(axes: Axes, picture: NDArray[np.uint8]) -> None:
    """Put an RGBA picture of the axes' own resolution onto white behind everything else."""
    alpha = picture[..., 3:] / 255
    opaque = np.rint(picture[..., :3] * alpha + 255 * (1 - alpha)).astype(np.uint8)
    extent = (*axes.get_xlim(), *axes.get_ylim())
    axes.imshow(opaque, extent=extent, aspect="auto", interpolation="nearest", zorder=0)


def _draw_source(axes: Axes, texture: Texture, cage: Cage, outer: Cage, pose: Pose) -> None:
    frame = _frame_of(axes)
    size = texture.width, texture.height
    corners = np.array([[0, 0], [size[0], 0], size, [0, size[1]]], dtype=float)
    world = PixelFrame(*size).to_world(corners)
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    _show(axes, render_mesh(texture, corners, frame.to_pixel(world), triangles, frame.size))
    for loops in (outer.loops, cage.loops):
        _draw_loops(axes, loops, color="white", linewidth=1.4, alpha=0.7)
    _draw_loops(axes, outer.loops, color=GREY, linewidth=0.4)
    _draw_loops(axes, cage.loops, color=BLUE, linewidth=0.6)
    _draw_dots(axes, pose.handles, INK, 3.4)


def _draw_result(
    axes: Axes,
    texture: Texture,
    mesh: DeformedMesh,
    outline: list[NDArray[np.float64]],
    map: HarmonicMap,
    pose: Pose,
) -> None:
    frame = _frame_of(axes)
    places = PixelFrame(texture.width, texture.height).to_pixel(mesh.vertices)
    positions = frame.to_pixel(mesh.images)
    _show(axes, render_mesh(texture, places, positions, mesh.triangles, frame.size, mesh.heights))
    if not len(pose):
        return
    images = map(pose.handles)
    size = float(np.ptp(np.concatenate(outline), axis=0).max())
    apart = np.linalg.norm(images - pose.targets, axis=1) > _MISS * size
    segments = np.stack([images[apart], pose.targets[apart]], axis=1)
    axes.add_collection(
        LineCollection(list(segments), colors=VERMILION, linewidths=0.9, zorder=3), autolim=False
    )
    _draw_dots(axes, pose.targets, CYAN, 5.0)
    _draw_dots(axes, images, "black", 2.2, edge=0.0)


def _draw_distortion(
    axes: Axes,
    mesh: DeformedMesh,
    outline: list[NDArray[np.float64]],
    map: HarmonicMap,
    page: _Page,
    left: float,
    bottom: float,
    column: float,
) -> None:
    fz, fzb = (np.abs(v) for v in map.wirtinger(mesh.vertices))
    with np.errstate(divide="ignore"):
        distortion = np.maximum(fz + fzb, 1 / np.maximum(fz - fzb, 0))
    # Spots beside a corner of the cage must not take the scale from the rest.
    highest = max(1.25, min(_quantile(distortion, mesh, 0.995), 1e4))
    clipped = float(distortion.max()) > 1.02 * highest
    norm = LogNorm(1.0, highest)
    colors = distortion_colors()
    n = colors.N
    strip = np.tile((colors(np.arange(n)) * 255).round().astype(np.uint8), (2, 1, 1))
    value = np.asarray(norm(np.clip(distortion, 1.0, highest)))
    places = np.stack([0.5 + value * (n - 1), np.ones(len(value))], axis=1)
    frame = _frame_of(axes)
    positions = frame.to_pixel(mesh.images)
    _show(axes, render_mesh(strip, places, positions, mesh.triangles, frame.size, mesh.heights))
    _draw_loops(axes, outline, color=INK, linewidth=0.5)

    bar = page.axes(left + 0.1 * column, bottom - 0.17, 0.8 * column, 0.07)
    scale = page.figure.colorbar(
        ScalarMappable(norm, colors),
        cax=bar,
        orientation="horizontal",
        extend="max" if clipped else "neither",
        extendfrac=0.04,
    )
    ticks = [tick for tick in _TICKS if tick <= highest * 1.001]
    ticks = _spaced(ticks, highest)
    scale.ax.xaxis.set_major_locator(FixedLocator(ticks))
    scale.ax.xaxis.set_minor_locator(NullLocator())
    scale.ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    scale.ax.tick_params(labelsize=SMALL, length=2, width=HAIRLINE, pad=1.5, colors=INK)
    scale.outline.set_linewidth(HAIRLINE)  # type: ignore[union-attr]
    scale.outline.set_edgecolor(INK)  # type: ignore[union-attr]


def _quantile(values: NDArray[np.float64], mesh: DeformedMesh, share: float) -> float:
    """What the values at the vertices stay below on this share of the undeformed area."""
    e = mesh.vertices[mesh.triangles][:, 1:] - mesh.vertices[mesh.triangles][:, :1]
    area = np.abs(e[:, 0, 0] * e[:, 1, 1] - e[:, 0, 1] * e[:, 1, 0])
    value = values[mesh.triangles].mean(axis=1)
    order = np.argsort(value)
    total = np.cumsum(area[order])
    return float(value[order[np.searchsorted(total, share * total[-1])]])


def _spaced(ticks: list[float], highest: float) -> list[float]:
    """Those ticks that keep a tenth of the colour bar apart, the first always."""
    kept: list[float] = []
    for tick in ticks:
        if not kept or np.log(tick / kept[-1]) > 0.1 * np.log(highest):
            kept.append(tick)
    return kept


def _draw_loops(axes: Axes, loops: Iterable[NDArray[np.float64]], **style: Any) -> None:
    for loop in loops:
        axes.plot(*np.concatenate([loop, loop[:1]]).T, solid_joinstyle="round", zorder=2, **style)


def _draw_dots(
    axes: Axes, points: NDArray[np.float64], color: str, size: float, edge: float = 0.6
) -> None:
    axes.plot(
        *points.T,
        linestyle="none",
        marker="o",
        color=color,
        markersize=size,
        markeredgecolor="white" if color != CYAN else INK,
        markeredgewidth=edge,
        zorder=4,
        clip_on=True,
    )


def _dense(loop: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points along a loop, eight per edge."""
    t = np.linspace(0, 1, 8, endpoint=False)[:, None]
    return (loop[:, None] + t * (np.roll(loop, -1, axis=0) - loop)[:, None]).reshape(-1, 2)


def _source_key(page: _Page, left: float, bottom: float, column: float) -> None:
    handles = [
        Line2D([], [], color=BLUE, linewidth=0.9, label="cage"),
        Line2D([], [], color=GREY, linewidth=0.7, label="offset cage"),
        _dot(INK, 3.4, "white", 0.6, "handles"),
    ]
    _key(page, left, bottom, column, handles)


def _result_key(page: _Page, left: float, bottom: float, column: float) -> None:
    handles = [
        _dot(CYAN, 5.0, INK, 0.6, "targets"),
        _dot("black", 2.2, "black", 0.0, "handles' images"),
    ]
    _key(page, left, bottom, column, handles)


def _dot(color: str, size: float, edge: str, edge_width: float, label: str) -> Line2D:
    return Line2D(
        [],
        [],
        linestyle="none",
        marker="o",
        color=color,
        markersize=size,
        markeredgecolor=edge,
        markeredgewidth=edge_width,
        label=label,
    )


def _key(page: _Page, left: float, bottom: float, column: float, handles: list[Line2D]) -> None:
    page.figure.legend(
        handles=handles,
        loc="upper center",
        bbox_to_anchor=((left + column / 2) / page.width, (bottom - 0.04) / page.height),
        ncols=len(handles),
        fontsize=SMALL,
        frameon=False,
        handlelength=1.2,
        handletextpad=0.4,
        columnspacing=1.0,
        borderpad=0.0,
        borderaxespad=0.0,
        labelcolor=INK,
    )
