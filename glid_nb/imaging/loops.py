"""The loops of a cage in one array, where they meet, and the importance of each vertex."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._arrays import Array
from glid_nb.geometry._loops import next_index, signed_area

Points = NDArray[np.float64]  # (n, 2) in pixel coordinates


@dataclass(frozen=True, eq=False)
class Loops:
    """Closed loops, concatenated, the exterior first; edge i is from vertex i to ``after[i]``."""

    points: Points
    number: NDArray[np.intp]  # (n,) the loop of each vertex, ascending from 0

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
        return next_index(self.number)

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

    @property
    def areas(self) -> NDArray[np.float64]:
        """(l,) signed areas of the loops."""
        return np.array([signed_area(loop) for loop in self.split(self.points)])

    def segments(self) -> NDArray[np.object_]:
        """(n,) the edges as shapely line strings."""
        ends = np.stack([self.points, self.points[self.after]], axis=1)
        return np.asarray(shapely.linestrings(ends), dtype=object)

    def passed_over(self, kept: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
        """For each edge of ``self[kept]`` the vertices that it skips, in order."""
        index = np.flatnonzero(kept)
        following, number = index[self[index].after], self.number[index]
        sizes = np.bincount(self.number)[number]
        starts = self.ends[number] - sizes
        return [
            start + (low + 1 - start + np.arange((high - low - 1) % size)) % size
            for low, high, start, size in zip(index, following, starts, sizes, strict=True)
        ]

    def in_conflict(self, gap: float) -> NDArray[np.intp]:
        """The edges that cross another edge, or come closer to it than `gap` and not just along a
        loop, as the neighbours of a short edge do."""
        segments, length, after = self.segments(), self.lengths, self.after
        e, f = shapely.STRtree(segments).query(segments, predicate="dwithin", distance=gap)
        apart = (e < f) & (after[e] != f) & (after[f] != e)
        e, f = e[apart], f[apart]
        same = self.number[e] == self.number[f]
        travelled = np.cumsum(length)
        forth = travelled[f] - length[f] - travelled[e]
        back = np.bincount(self.number, length)[self.number[e]] - forth - length[e] - length[f]
        near = same & (np.minimum(forth, back) < 4 * gap)
        conflict = ~near
        conflict[near] = shapely.intersects(segments[e[near]], segments[f[near]])
        return np.unique(np.concatenate([e[conflict], f[conflict]]))


def repair(loops: Loops, importance: Array, kept: Array, gap: float) -> list[str]:
    """Put vertices back into `kept` where simplified loops meet or nearly meet; notes."""
    before = np.count_nonzero(kept)
    place = loops.points[0]
    while True:
        simplified, over = loops[kept], loops.passed_over(kept)
        edges = [edge for edge in simplified.in_conflict(gap) if len(over[edge])]
        if not edges:  # containment is defined once there are no crossings
            edges = _jumped(simplified, over)
        if not edges:
            break
        back = [over[edge][np.argmax(importance[over[edge]])] for edge in edges]
        kept[back] = True
        place = loops.points[back[-1]]
    count = np.count_nonzero(kept) - before
    vertices = "vertex was" if count == 1 else "vertices were"
    where = f"{count} {vertices} kept, near ({place[0]:.0f}, {place[1]:.0f}) among others"
    return [f"simplification would have made the cage meet itself; {where}"] if count else []


def _jumped(simplified: Loops, over: list[NDArray[np.intp]]) -> list[int]:
    """The edges that passed over a whole loop when vertices were dropped."""
    separate = simplified.split(simplified.points)
    starts = np.array([loop[0] for loop in separate])
    inside = np.array([shapely.contains_xy(shapely.Polygon(loop), *starts.T) for loop in separate])
    inside[0] = ~inside[0]  # all others lie in the exterior
    np.fill_diagonal(inside, False)
    segments = simplified.segments()
    mendable = np.array([len(vertices) > 0 for vertices in over])
    found = []
    for pair in np.argwhere(inside):
        for number, other in (pair, pair[::-1]):
            # Take the nearest edge with vertices to put back.
            edges = np.flatnonzero(mendable & (simplified.number == number))
            if len(edges):
                distance = shapely.distance(segments[edges], shapely.Point(starts[other]))
                found.append(int(edges[np.argmin(distance)]))
    return found


def significance(loop: Points) -> NDArray[np.float64]:
    """(n,) tolerances at which Ramer, Douglas and Peucker drop a loop's points, two never."""
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
    length = abs(b - a)
    # Rotated so that the segment runs from 0 along the real axis.
    turned = (z - a) * ((b - a).conjugate() / length if length > 0 else 1.0)
    along, across = turned.real, turned.imag
    beyond = np.maximum(np.maximum(-along, along - length), 0)
    square = across * across + beyond * beyond
    index = int(square.argmax())
    return index, float(square[index]) ** 0.5
