"""Move edges outwards where simplification would cut off a part of the shape."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.simplify.conflicts import edges_in_conflict
from glid_nb.imaging.simplify.loops import Loops, Points, passed_over


def enclosing(loops: Loops, kept: NDArray[np.bool_], margin: float, gap: float) -> Loops:
    """The simplified loops, with edges that cut off more than `margin` moved outwards.

    A chord of a convex arc cuts off a part of the shape. It is moved in parallel by the height of
    that part, unless this would make loops meet.
    """
    simplified = loops[kept]
    areas = _areas(simplified)
    shifts = _shifts(loops, kept, areas, margin)
    # Limits on the change of area, so that no hole vanishes or is inverted.
    low, high = np.full(len(areas), 0.3), np.full(len(areas), 1.2)
    low[0], high[0] = 0.5, np.inf
    while True:
        moved = Loops(simplified.points + shifts, simplified.number)
        ratio = _areas(moved) / areas
        still = (~((low < ratio) & (ratio < high)))[simplified.number]
        if not shifts[still].any():
            edges = edges_in_conflict(moved, gap)
            still = np.concatenate([edges, simplified.after[edges]])
            if not shifts[still].any():
                return moved
        shifts[still] = 0


def _areas(loops: Loops) -> NDArray[np.float64]:
    return np.array([signed_area(loop) for loop in loops.split(loops.points)])


def _shifts(
    loops: Loops, kept: NDArray[np.bool_], areas: NDArray[np.float64], margin: float
) -> Points:
    """(k, 2) shifts of the kept vertices after which no edge cuts off more than `margin`."""
    corners = loops[kept]
    outwards = np.where((areas > 0) == (np.arange(len(areas)) == 0), 1.0, -1.0)[corners.number]
    x, y = corners.edges.T
    normal = outwards[:, np.newaxis] * np.stack([y, -x], axis=1)
    normal /= np.hypot(x, y)[:, np.newaxis]
    cut = np.zeros(len(normal))
    for k, over in enumerate(passed_over(loops, kept)):
        if len(over):
            beyond = (loops.points[over] - corners.points[k]) @ normal[k]
            cut[k] = max(0.0, float(beyond.max()) - margin)
    preceding = np.argsort(corners.after)
    before, cut_before = normal[preceding], cut[preceding]
    # A vertex moves to the intersection of its moved edges, but not farther than twice their moves.
    middle = before + normal
    square = np.maximum(np.sum(middle**2, axis=1), 1e-12)
    sine = before[:, 0] * normal[:, 1] - before[:, 1] * normal[:, 0]
    flat = np.abs(sine) < 0.2
    sine = np.where(flat, 1.0, sine)
    meet = np.stack(
        [
            (cut_before * normal[:, 1] - cut * before[:, 1]) / sine,
            (cut * before[:, 0] - cut_before * normal[:, 0]) / sine,
        ],
        axis=1,
    )
    most = np.maximum(cut, cut_before)
    straight = middle * (2 * most / square)[:, np.newaxis]
    shift = np.where(flat[:, np.newaxis], straight, meet)
    length = np.hypot(*shift.T)
    return shift * np.minimum(1.0, 2 * most / np.maximum(length, 1e-12))[:, np.newaxis]
