"""Marching squares: the closed curves around where a field is positive."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def closed_contours(field: NDArray[np.floating]) -> list[NDArray[np.float64]]:
    """The zero level set of a field that is negative all along its border and nowhere zero.

    As `skimage.measure.find_contours` with ``fully_connected="high"``, in a quarter of the time.

    Returns
    -------
    (n, 2) vertices (row, column) of each curve, the first not repeated at the end. With rows
    downwards, the field is positive on a curve's right.
    """
    positive = field > 0
    width = field.shape[1]
    # A curve passes between two neighbours of different sign, `high` and `low`; `side` is the step
    # from the one to the other, `ahead` that of the curve.
    row, left = np.divmod(np.flatnonzero(positive[:, 1:] != positive[:, :-1]), width - 1)
    top, column = np.divmod(np.flatnonzero(positive[1:] != positive[:-1]), width)
    one = np.concatenate([np.stack([row, left], axis=1), np.stack([top, column], axis=1)])
    step = np.repeat([[0, 1], [1, 0]], [len(row), len(top)], axis=0)
    swapped = ~positive[tuple(one.T)]
    high = one + step * swapped[:, None]
    side = np.where(swapped[:, None], -step, step)
    low = high + side
    ahead = side[:, ::-1] * [1, -1]
    # It turns between the low pixel and a positive one ahead of that: this one and the high pixel
    # belong together, though they may touch in a corner only.
    turns = positive[tuple((low + ahead).T)][:, None]
    goes_on = positive[tuple((high + ahead).T)][:, None]
    next_high = np.where(turns, low + ahead, np.where(goes_on, high + ahead, high))
    next_low = np.where(turns, low, np.where(goes_on, low, high) + ahead)
    gaps, next_gaps = _gaps(high, low, width), _gaps(next_high, next_low, width)
    order = np.argsort(gaps)
    following = order[np.searchsorted(gaps, next_gaps, sorter=order)]
    above, below = (field[tuple(p.T)].astype(np.float64)[:, np.newaxis] for p in (high, low))
    vertices = high + side * (above / (above - below))
    return [vertices[cycle] for cycle in _cycles(following)]


def _gaps(one: NDArray[np.integer], other: NDArray[np.integer], width: int) -> NDArray[np.integer]:
    """A number for the gap between two neighbours."""
    first = np.minimum(one, other)
    return 2 * (first[:, 0] * width + first[:, 1]) + (one[:, 0] != other[:, 0])


def _cycles(following: NDArray[np.intp]) -> list[list[int]]:
    """The cycles of a permutation, each from its least element."""
    after: list[int] = following.tolist()
    seen = bytearray(len(after))
    result = []
    for start in range(len(after)):
        cycle = []
        i = start
        while not seen[i]:
            seen[i] = 1
            cycle.append(i)
            i = after[i]
        if cycle:
            result.append(cycle)
    return result
