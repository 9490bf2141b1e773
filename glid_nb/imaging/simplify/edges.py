"""Edges that are too short are merged, edges that are too long are divided."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb.geometry._loops import edge_lengths, segments
from glid_nb.imaging.simplify.significance import Loop, distances_from_segments

_MIN_EDGE = 0.2  # of the mean edge
_MAX_EDGE = 0.04  # of the perimeter
_PER_LOOP = 12  # edges longer than a loop's perimeter over this never count as short
_FEWEST, _LEAST_ANGLE = 4, 0.05  # what merging leaves of a loop, and at its corners


def merge_short_edges(
    loops: tuple[Loop, ...], kept: list[NDArray[np.bool_]], min_edge: float | None, gap: float
) -> None:
    """Drop an end of every edge shorter than `min_edge`, in place, where nothing is in the way."""
    lengths = [edge_lengths(loop[keep]) for loop, keep in zip(loops, kept, strict=True)]
    if min_edge is None:
        min_edge = _MIN_EDGE * float(np.concatenate(lengths).mean())
    shortest = [min(min_edge, float(length.sum()) / _PER_LOOP) for length in lengths]
    blocked = [np.zeros(len(loop), dtype=bool) for loop in loops]
    while True:
        simplified = [loop[keep] for loop, keep in zip(loops, kept, strict=True)]
        chosen = [
            _droppable(loop, blocked[number][kept[number]], shortest[number])
            for number, loop in enumerate(simplified)
        ]
        if not any(map(len, chosen)):
            break
        clear = _clear(simplified, chosen, gap)
        for number, vertices in enumerate(chosen):
            original = np.flatnonzero(kept[number])[vertices]
            kept[number][original[clear[number]]] = False
            blocked[number][original[~clear[number]]] = True


def _droppable(loop: Loop, blocked: NDArray[np.bool_], shortest: float) -> NDArray[np.intp]:
    """Vertices at short edges, one per edge, so far apart that each can be judged by itself."""
    n = len(loop)
    if n <= _FEWEST:
        return np.zeros(0, dtype=np.intp)
    length = edge_lengths(loop)
    before, after = np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0)
    height = distances_from_segments(loop, before, after)
    taken = np.zeros(n, dtype=bool)
    chosen: list[int] = []
    for edge in np.argsort(length):
        if length[edge] >= shortest or n - len(chosen) <= _FEWEST:
            break
        ends = [end for end in (int(edge), int(edge + 1) % n) if not blocked[end]]
        if ends:
            vertex = min(ends, key=lambda end: height[end])
            around = np.arange(vertex - 2, vertex + 3) % n
            if not taken[around].any():
                taken[around] = True
                chosen.append(vertex)
    return np.array(chosen, dtype=np.intp)


def _clear(
    loops: list[Loop], chosen: list[NDArray[np.intp]], gap: float
) -> list[NDArray[np.bool_]]:
    """For every chosen vertex, whether its triangle, widened by `gap`, is clear of other edges.

    Also whether the edge that replaces the triangle's two sides leaves an angle to its neighbours.
    """
    tree = shapely.STRtree(np.concatenate([segments(loop) for loop in loops]))
    first = np.cumsum([0, *map(len, loops)])
    result = []
    for number, (loop, vertices) in enumerate(zip(loops, chosen, strict=True)):
        n = len(loop)
        around = loop[(vertices[:, np.newaxis] + [-2, -1, 0, 1, 2]) % n]
        triangles = shapely.polygons(around[:, 1:4])
        triangle, edge = tree.query(triangles, predicate="dwithin", distance=gap)
        # The two sides and the edges that start or end at their ends are no obstacles.
        step = (edge - first[number] - vertices[triangle] + 2) % n
        own = (edge >= first[number]) & (edge < first[number + 1]) & (step < 4)
        clear = np.ones(len(vertices), dtype=bool)
        clear[triangle[~own]] = False
        clear &= _angles(around[:, 0], around[:, 1], around[:, 3]) > _LEAST_ANGLE
        clear &= _angles(around[:, 1], around[:, 3], around[:, 4]) > _LEAST_ANGLE
        result.append(clear)
    return result


def _angles(a: Loop, b: Loop, c: Loop) -> NDArray[np.float64]:
    """(k,) angles at b in [0, pi]."""
    u, v = a - b, c - b
    return np.arctan2(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), np.sum(u * v, axis=1))


def divide_long_edges(
    loops: list[Loop], max_edge: float | None, max_vertices: int | None
) -> list[Loop]:
    length = [edge_lengths(loop) for loop in loops]
    longest = max_edge
    if longest is None:
        longest = _MAX_EDGE * float(sum(values.sum() for values in length))
    pieces = [np.maximum(np.ceil(values / longest), 1).astype(int) for values in length]
    while max_vertices is not None and sum(map(np.sum, pieces)) > max_vertices:
        longest *= 1.1
        pieces = [np.maximum(np.ceil(values / longest), 1).astype(int) for values in length]
        if all((values == 1).all() for values in pieces):
            break
    result = []
    for loop, counts in zip(loops, pieces, strict=True):
        parts = np.repeat(np.arange(len(loop)), counts)
        first = np.cumsum(counts) - counts
        share = (np.arange(len(parts)) - first[parts]) / counts[parts]
        edge = np.roll(loop, -1, axis=0) - loop
        result.append(loop[parts] + share[:, np.newaxis] * edge[parts])
    return result
