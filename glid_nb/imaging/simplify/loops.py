"""The loops of a cage in one array, and the importance of each vertex."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

Points = NDArray[np.float64]
"""(n, 2) in pixel coordinates."""


@dataclass(frozen=True, eq=False)
class Loops:
    """Closed loops, concatenated, the exterior first.

    ``points`` is (n, 2); ``number`` is (n,), the loop of each vertex, ascending from 0. Edge i
    leads from vertex i to vertex ``after[i]``.
    """

    points: Points
    number: NDArray[np.intp]

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.intp]) -> Loops:
        return Loops(self.points[chosen], self.number[chosen])

    @property
    def ends(self) -> NDArray[np.intp]:
        """(l,) index after the last vertex of each loop."""
        return np.cumsum(np.bincount(self.number))

    def split(self, values: NDArray) -> list[NDArray]:
        """Split (n, ...) values of the vertices or edges by loop."""
        return np.split(values, self.ends[:-1])

    @cached_property
    def after(self) -> NDArray[np.intp]:
        """(n,) index of the next vertex of the loop."""
        after = np.arange(1, len(self.points) + 1)
        after[self.ends - 1] = [0, *self.ends[:-1]]
        return after

    @cached_property
    def before(self) -> NDArray[np.intp]:
        """(n,) index of the previous vertex of the loop."""
        return np.argsort(self.after)

    @cached_property
    def edges(self) -> Points:
        """(n, 2) vectors."""
        return self.points[self.after] - self.points

    @property
    def lengths(self) -> NDArray[np.float64]:
        return np.hypot(*self.edges.T)

    def segments(self) -> NDArray[np.object_]:
        """(n,) the edges as shapely line strings."""
        ends = np.stack([self.points, self.points[self.after]], axis=1)
        return np.asarray(shapely.linestrings(ends), dtype=object)


def passed_over(loops: Loops, kept: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """For each edge of ``loops[kept]`` the vertices of ``loops`` that it skips, in order."""
    index = np.flatnonzero(kept)
    following = index[loops[index].after]
    ends = loops.ends[loops.number[index]]
    starts = ends - np.bincount(loops.number)[loops.number[index]]
    return [
        np.arange(low + 1, high)
        if low < high
        else np.concatenate([np.arange(low + 1, end), np.arange(start, high)])
        for low, high, start, end in zip(index, following, starts, ends, strict=True)
    ]


def significance(loop: Points) -> NDArray[np.float64]:
    """(n,) tolerances at which Ramer, Douglas and Peucker's algorithm drops the points of a loop.

    They are infinite for two vertices far apart. Keeping the vertices above a tolerance gives the
    algorithm's result for it, so one computation serves all tolerances and numbers of vertices.
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
    # Rotated so that the segment runs from 0 along the real axis.
    turned = (z - a) * ((b - a).conjugate() / length if length > 0 else 1.0)
    along, across = turned.real, turned.imag
    beyond = np.maximum(np.maximum(-along, along - length), 0)
    square = across * across + beyond * beyond
    index = int(square.argmax())
    return index, float(square[index]) ** 0.5
