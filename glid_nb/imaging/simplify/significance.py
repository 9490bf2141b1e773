"""The algorithm of Ramer, Douglas and Peucker for all tolerances at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Loop = NDArray[np.float64]
"""(n, 2) vertices of a closed loop."""


def significance(loop: Loop) -> NDArray[np.float64]:
    """When the algorithm of Ramer, Douglas and Peucker drops each vertex of a closed loop.

    Parameters
    ----------
    loop
        (n, 2) vertices.

    Returns
    -------
    (n,) the smallest tolerance for which the vertex is dropped; infinite for two vertices far
    apart. Keeping the vertices above a tolerance is the algorithm's result for it, so one
    computation serves every tolerance and every number of vertices.
    """
    n = len(loop)
    start = int(np.argmax(np.hypot(*(loop - loop.mean(axis=0)).T)))
    points = np.roll(loop, -start, axis=0)
    z = points[:, 0] + 1j * points[:, 1]
    middle = int(np.argmax(np.abs(z - z[0])))
    z = np.append(z, z[0])
    result = np.zeros(n + 1)
    result[[0, middle]] = np.inf
    stack = [(0, middle, np.inf), (middle, n, np.inf)]
    while stack:
        low, high, limit = stack.pop()
        if high - low < 2:
            continue
        split, distance = _farthest(z[low + 1 : high], complex(z[low]), complex(z[high]))
        split += low + 1
        limit = min(limit, distance)
        result[split] = limit
        stack += [(low, split, limit), (split, high, limit)]
    return np.roll(result[:-1], start)


def _farthest(z: NDArray[np.complex128], a: complex, b: complex) -> tuple[int, float]:
    """The point with the largest distance from the segment from a to b, and that distance."""
    length = abs(b - a)
    # In a frame in which the segment runs from 0 along the real axis.
    turned = (z - a) * ((b - a).conjugate() / length if length > 0 else 1.0)
    along, across = turned.real, turned.imag
    beyond = np.maximum(np.maximum(-along, along - length), 0)
    square = across * across + beyond * beyond
    index = int(square.argmax())
    return index, float(square[index]) ** 0.5


def distances_from_segments(
    points: Loop, a: NDArray[np.float64], b: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(k,) distances of (k, 2) points from segments a, b, each (2,) or (k, 2)."""
    edge, apart = b - a, points - a
    squared = np.maximum(np.sum(edge * edge, axis=-1, keepdims=True), np.finfo(float).tiny)
    along = np.clip(np.sum(apart * edge, axis=-1, keepdims=True) / squared, 0, 1)
    return np.hypot(*(apart - along * edge).T)


def dropped_between(index: NDArray[np.intp], edge: int, n: int) -> NDArray[np.intp]:
    """The vertices of a loop of `n` that lie between the kept ones number `edge` and `edge` + 1.

    `index` holds the kept vertices, ascending.
    """
    low, high = index[edge], index[(edge + 1) % len(index)]
    return np.arange(low + 1, high if high > low else high + n) % n
