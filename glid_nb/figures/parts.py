"""The parts of a figure that a narrow page shows below each other: panels, colour bars, legends."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from glid_nb._arrays import Floats
from glid_nb.figures.drawing import COLOR_BAR, CSS_DPI

_ROOM = 4.0  # CSS pixels around a part

Box = list[float]
"""x and y of the top left corner, width and height, in CSS pixels of the whole figure."""


def parts(figures: Sequence[Figure]) -> list[Box]:
    """Boxes that hold the panels, from left to right, then colour bars and legends.

    All figures have the same layout, and a box holds its part of every figure. They must have been
    drawn, because drawing arranges their axes. There are no parts in a figure with one panel, or
    if panels overlap from left to right, as those of several rows do.
    """
    both = [_panels_and_below(figure) for figure in figures]
    if len({(len(panels), len(below)) for panels, below in both}) > 1:
        return []
    panels = _around(figures, [panels for panels, _ in both])
    panels = panels[np.argsort(panels[:, 0])] if len(panels) else panels
    if len(panels) < 2 or (panels[1:, 0] < panels[:-1, 2]).any():
        return []
    found = np.concatenate([panels, _around(figures, [below for _, below in both])])
    size = CSS_DPI * figures[0].get_size_inches()
    low, high = (found[:, :2] - _ROOM).clip(0), np.minimum(found[:, 2:] + _ROOM, size)
    return np.hstack([low, high - low]).round(1).tolist()


def _panels_and_below(figure: Figure) -> tuple[list[Artist], list[Artist]]:
    bars: list[Artist] = [axes for axes in figure.axes if axes.get_label() == COLOR_BAR]
    return [axes for axes in figure.axes if axes not in bars], [*bars, *figure.legends]


def _around(figures: Sequence[Figure], artists: Sequence[Sequence[Artist]]) -> Floats:
    """(n, 4) left, top, right and bottom of the boxes around each artist of all figures."""
    pairs = zip(figures, artists, strict=True)
    boxes = np.array([[_box(figure, one) for one in own] for figure, own in pairs])
    boxes = boxes.reshape(len(figures), -1, 4)
    return np.concatenate([boxes[..., :2].min(axis=0), boxes[..., 2:].max(axis=0)], axis=1)


def _box(figure: Figure, artist: Artist) -> list[float]:
    """Left, top, right and bottom of an artist with its labels, in CSS pixels from the top left."""
    extent = artist.get_tightbbox()
    assert extent is not None
    (left, bottom), (right, top) = extent.get_points() * CSS_DPI / figure.dpi
    height = CSS_DPI * figure.get_size_inches()[1]
    return [left, height - top, right, height - bottom]
