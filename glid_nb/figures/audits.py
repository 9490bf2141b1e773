"""The figure of an audit: the determinant on the source, and what folds."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap, Normalize, to_rgba

from glid_nb._arguments import check_type
from glid_nb._arrays import Floats
from glid_nb.auditing import Audit
from glid_nb.figures import drawing, style
from glid_nb.figures.drawing import NotebookFigure
from glid_nb.figures.style import INK, VERMILION

_WIDTH, _TALLEST = 4.6, 4.6  # inches
_HIGHEST = 98  # percentile of the determinants that has the last colour
_TITLES = {"proved": "free of folds, proved", "undecided": "undecided"}
_TITLES |= {"collapses": "collapses: the determinant is 0 at the ring"}


def folds(audit: Audit) -> NotebookFigure:
    """The determinant of an audited warp, drawn on its source: pale from 1 on, dark near 0.

    Pieces with a negative determinant are vermilion and hatched. A ring marks the proved fold, or
    the smallest determinant. Axes of fields have y down, like pixels.
    """
    check_type("audit", audit, Audit, "glid_nb.audit makes one")
    box = _box(audit)
    across, up = np.ptp(box, axis=0)
    tall = min(max(_WIDTH * up / across, 0.8), _TALLEST)
    figure = NotebookFigure(_WIDTH, tall + 0.9)
    axes = figure.add_subplot()
    values = np.where(np.isfinite(audit.determinants), audit.determinants, 0.0)
    top = float(np.percentile(values, _HIGHEST))
    norm = Normalize(0.0, top if top > 0 else 1.0)
    look: Any = {"norm": norm, "cmap": style.distortion_colors().reversed()}
    if audit.outlines is None:
        drawn = _draw_field(axes, audit, look)
    else:
        drawn = PolyCollection([*audit.outlines], array=values, edgecolors="face", **look)
        drawn.set(linewidth=0.2, rasterized=True)
        axes.add_collection(drawn)
        _hatch(axes, audit.outlines[audit.signs < 0])
    ring = {"markersize": 13, "fillstyle": "none", "color": INK, "clip_on": False}
    where = audit.point or audit.where
    axes.plot(*where, "o", path_effects=drawing.ON_WHITE, **ring)
    axes.set(xlim=box[:, 0], ylim=box[::-1, 1] if audit.kind == "field" else box[:, 1])
    axes.set_aspect("equal")
    style.tidy(axes)
    bad = audit.verdict != "proved"
    title = _TITLES.get(audit.verdict) or _folding(audit)
    axes.set_title(title, fontsize=style.FONT_SIZE, color=VERMILION if bad else INK)
    label = "smallest determinant" if audit.kind == "field" else "determinant"
    ends = "both" if values.min() < 0 else "max"
    drawing.color_bar([axes], drawn, label, format="{x:g}", extend=ends, shrink=0.5, aspect=36)
    return figure


def _folding(audit: Audit) -> str:
    if not audit.folded and audit.kind == "mesh":
        return "folds: the images wind more than once round the ring"
    unit = {"field": "cells", "mesh": "triangles"}.get(audit.kind)
    if unit is None:
        return "folds at the ring, proved"
    return f"folds: {audit.folded:,} of {audit.pieces:,} {unit}"


def _draw_field(axes: Axes, audit: Audit, look: Any) -> Any:
    values, negative = audit.determinants, audit.signs < 0
    h, w = values.shape
    extent = (0, w, h, 0)
    drawn = axes.imshow(values, extent=extent, interpolation="nearest", **look)
    folded = np.ma.masked_equal(negative.astype(np.uint8), 0)
    if folded.count():
        colors = ListedColormap([to_rgba(VERMILION)])
        axes.imshow(folded, cmap=colors, extent=extent, interpolation="nearest")
        if min(h, w) > 1:  # contours need two rows and columns
            x, y = np.arange(w) + 0.5, np.arange(h) + 0.5
            hatch: Any = {"levels": [0.5, 1.5], "colors": "none", "hatches": ["/////"]}
            axes.contourf(x, y, negative.astype(float), **hatch)
    return drawn


def _hatch(axes: Axes, outlines: Floats) -> None:
    look: Any = {"facecolors": VERMILION, "edgecolors": INK, "linewidths": 0.0, "hatch": "/////"}
    if len(outlines):
        axes.add_collection(PolyCollection([*outlines], **look))


def _box(audit: Audit) -> Floats:
    if audit.outlines is None:
        h, w = audit.determinants.shape
        return np.array([[0.0, 0.0], [w, h]])
    return drawing.box_around(audit.outlines.reshape(-1, 2), 0.02)
