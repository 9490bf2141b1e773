"""The parts of a figure that a narrow page shows below each other: panels, colour bars, legends."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from glid_nb._arrays import Floats
from glid_nb.figures.style import COLOR_BAR, CSS_DPI

_ROOM = 4.0  # CSS pixels around a part

Box = list[float]
"""x and y of the top left corner, width and height, in CSS pixels of the whole figure."""


def parts(figures: Sequence[Figure]) -> list[Box]:
    """Boxes that hold the panels, colour bars and legends, row by row from left to right.

    All figures have the same layout, and a box holds its part of every figure. They must have been
    drawn, because drawing arranges their axes. There are no parts in a figure with one panel, with
    panels that overlap, or with text outside of its panels.
    """
    both = [_panels_and_below(figure) for figure in figures]
    if any(figure.texts for figure in figures):
        return []
    if len({(len(panels), len(below)) for panels, below in both}) > 1:
        return []
    panels = _around(figures, [panels for panels, _ in both])
    if len(panels) < 2 or _overlap(panels):
        return []
    found = np.concatenate([panels, _around(figures, [below for _, below in both])])
    found = found[_in_rows(found)]
    size = CSS_DPI * figures[0].get_size_inches()
    low, high = (found[:, :2] - _ROOM).clip(0), np.minimum(found[:, 2:] + _ROOM, size)
    return np.hstack([low, high - low]).round(1).tolist()


def _overlap(boxes: Floats) -> bool:
    """Whether two of (n, 4) boxes have a common point inside."""
    low = np.maximum(boxes[:, None, :2], boxes[:, :2])
    high = np.minimum(boxes[:, None, 2:], boxes[:, 2:])
    common = (low < high).all(axis=-1)
    return bool(common[~np.eye(len(boxes), dtype=bool)].any())


def _in_rows(boxes: Floats) -> list[int]:
    """The order of reading. A box that begins below all of a row begins the next one."""
    rows: list[list[int]] = []
    bottom = -np.inf
    for i in np.argsort(boxes[:, 1]):
        if boxes[i, 1] >= bottom - _ROOM:
            rows.append([])
            bottom = boxes[i, 3]
        rows[-1].append(int(i))
        bottom = min(bottom, boxes[i, 3])
    return [i for row in rows for i in sorted(row, key=lambda i: boxes[i, 0])]


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
    own = [artist.get_tightbbox()]
    if isinstance(artist, Axes) and (legend := artist.get_legend()):
        own.append(legend.get_tightbbox())  # which may have no part in the layout
    extent = Bbox.union([box for box in own if box is not None])
    (left, bottom), (right, top) = extent.get_points() * CSS_DPI / figure.dpi
    height = CSS_DPI * figure.get_size_inches()[1]
    return [left, height - top, right, height - bottom]
