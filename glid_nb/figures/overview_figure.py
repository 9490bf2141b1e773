"""The overview figure: a picture, its deformation, and the course of the solve."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from glid_nb._arrays import Floats
from glid_nb.energies import isometry_energy
from glid_nb.figures import drawing
from glid_nb.figures.drawing import NotebookFigure
from glid_nb.figures.plots import CertificatePlot, EnergyPlot, StepPlot
from glid_nb.figures.shapes import DrawnMap, draw_deformed, draw_distortion, hold
from glid_nb.figures.style import BLUE, FONT_SIZE, GREY, INK, LEGEND, SMALL
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import PixelFrame, as_rgba8
from glid_nb.pose import Pose
from glid_nb.solvers import Result

# Inches.
_NARROWEST = 4.5  # figure
_PLOTS = 2.2  # height of the plots with their text
_WRITTEN = 0.75  # height of the text above and below a picture
_TALLEST = 3.0  # picture
_LEGEND_ROW = 2.1  # columns narrower than this list their legend's entries vertically

_NAMES = ("Source", "Deformation", "Distortion", "Energy", "Newton steps", "Certificate")

_SHRINK = 1.7  # a common scale may make a picture smaller by this factor
_DPI = 300
_VERTICES = 12_000
_OVERSAMPLING = 2  # of the deformed picture


def overview(
    image: ArrayLike, result: Result, pose: Pose | None = None, *, width: float = 7.0
) -> Figure:
    """A figure that summarises a solve.

    The upper row shows three pictures, with one scale unless sizes differ a lot. The first is the
    picture with both cages and the handles. The second is the deformed picture with targets (cyan
    discs) and the handles' images (black dots); lines join them where they differ. The third is the
    distortion max(sigma_1, 1 / sigma_2). The lower row shows the energies and the Newton steps per
    iteration, and the certified and the sampled sigma_2 along the boundary.

    The image is the one from which the cage was traced. The result is that of
    :func:`glid_nb.solve`. The handles and targets of a given pose are shown instead of the solve's.
    The width is in inches, at least 4.5; the size of the text does not depend on it.

    The figure has 300 dots per inch and is not registered in pyplot. ``figure.savefig(path)``
    writes it. Raises a ValueError when the width is too small, a TypeError for a map of a mesh.
    """
    if not width >= _NARROWEST:
        raise ValueError(f"width is {width} inches; the text needs at least {_NARROWEST}")
    picture = as_rgba8(image)
    map, certificate = result.map, result.certificate
    if certificate is None or not isinstance(map, HarmonicMap):
        raise TypeError("the overview shows a certified map, but this result has a map of a mesh")
    pose = result.pose if pose is None else pose
    cage, pixels = map.domain.cage, _OVERSAMPLING * _DPI * width / 3
    sheet = DrawnMap.of(map, pose, _VERTICES, 0.5 * cage.longer_side / pixels)
    target = drawing.enlarged(drawing.box_around(np.concatenate(sheet.outline)), pose.targets)
    views = _common_scale(drawing.box_around(map.domain.offset_cage.exterior), target)

    across, up = np.ptp(views[0], axis=0)
    tall = min(width / 3 * up / across, _TALLEST)
    figure = NotebookFigure(width, tall + _WRITTEN + _PLOTS, _DPI)
    figure.set_layout_engine("constrained", w_pad=0.08, h_pad=0.04)
    halves: Any = figure.subfigures(2, 1, height_ratios=[tall + _WRITTEN, _PLOTS])
    pictures, plots = (half.subplots(1, 3) for half in halves)
    for axes, view in zip(pictures, views[[0, 1, 1]], strict=True):
        hold(axes, view)
    for axes, letter, name in zip((*pictures, *plots), "abcdef", _NAMES, strict=True):
        _label(axes, letter, name, (0, 4) if axes in pictures else (-24, 26))

    drawing.picture(pictures[0], picture, PixelFrame(picture.shape[1], picture.shape[0]))
    _mark_source(pictures[0], map, pose)
    draw_deformed(pictures[1], picture, sheet, pixels * max(1, up / across))
    drawing.targets(pictures[1], map, pose)
    _add_legend(pictures[1])
    draw_distortion(pictures[2:], [sheet], "distortion", extendfrac=0.04)
    minimum = isometry_energy(result.energy_measure)
    EnergyPlot(plots[0]).update([result.initial, *result.history], minimum=minimum)
    plots[0].set_ylabel(f"E − {minimum:.3g}" if minimum else "E", fontsize=SMALL, labelpad=0)
    StepPlot(plots[1]).update(result.history)
    CertificatePlot(plots[2], cage).update(certificate, map)
    figure.draw_without_rendering()  # lays out the axes
    return figure


def _common_scale(*boxes: Floats) -> Floats:
    """Enlarge boxes to one aspect ratio and one size, unless a box would become much too large."""
    sizes = np.array([np.ptp(box, axis=0) for box in boxes])
    common = sizes.max(axis=0)
    half = common / 2 * np.minimum(1, _SHRINK / (common / sizes).min(axis=1))[:, None]
    middle = np.mean(boxes, axis=1)
    return np.stack([middle - half, middle + half], axis=1)


def _label(axes: Axes, letter: str, name: str, shift: tuple[float, float]) -> None:
    for text, indent, weight in ((letter, 0, "bold"), (name, 10, "normal")):
        place = (0, 1), (shift[0] + indent, shift[1]), "axes fraction", "offset points"
        axes.annotate(text, *place, fontsize=FONT_SIZE, fontweight=weight, color=INK)


def _mark_source(axes: Axes, map: HarmonicMap, pose: Pose) -> None:
    cage, outer = map.domain.cage.loops, map.domain.offset_cage.loops
    drawing.loops(axes, [*outer, *cage], color="white", linewidth=1.4, alpha=0.7)
    drawing.loops(axes, cage, color=BLUE, linewidth=0.6, label="cage")
    drawing.loops(axes, outer, color=GREY, linewidth=0.4, label="offset cage")
    drawing.dots(axes, pose.handles, INK, 3.4, edge=0.6, label="handles")
    _add_legend(axes)


def _add_legend(axes: Axes) -> None:
    handles, _ = axes.get_legend_handles_labels()
    fits = axes.figure.bbox.width / 3 > _LEGEND_ROW * axes.figure.dpi
    look: Any = {"bbox_to_anchor": (0.5, 0.0), "columnspacing": 1.0, **LEGEND}
    axes.legend(loc="upper center", ncols=len(handles) if fits else 1, **look)
