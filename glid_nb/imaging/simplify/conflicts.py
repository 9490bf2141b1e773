"""Put vertices back where simplified loops meet or nearly meet."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb.imaging.simplify.loops import Loops, passed_over


def repair(
    loops: Loops, importance: NDArray[np.float64], kept: NDArray[np.bool_], gap: float
) -> list[str]:
    """Put vertices back into `kept` where simplified loops meet or nearly meet; notes."""
    before = np.count_nonzero(kept)
    place = loops.points[0]
    while True:
        simplified, over = loops[kept], passed_over(loops, kept)
        edges = [edge for edge in edges_in_conflict(simplified, gap) if len(over[edge])]
        if not edges:  # containment is defined once there are no crossings
            edges = _jumped(simplified, over)
        if not edges:
            break
        back = [over[edge][np.argmax(importance[over[edge]])] for edge in edges]
        kept[back] = True
        place = loops.points[back[-1]]
    count = np.count_nonzero(kept) - before
    if not count:
        return []
    return [
        f"simplification would have made the cage meet itself; {count} "
        f"{'vertex was' if count == 1 else 'vertices were'} kept, near ({place[0]:.0f}, "
        f"{place[1]:.0f}) among others"
    ]


def edges_in_conflict(loops: Loops, gap: float) -> NDArray[np.intp]:
    """The edges that cross another edge or come closer to it than `gap`.

    Edges that are less than a few gaps apart along the same loop, such as the neighbours of a short
    edge, only count if they cross.
    """
    segments, length, after = loops.segments(), loops.lengths, loops.after
    e, f = shapely.STRtree(segments).query(segments, predicate="dwithin", distance=gap)
    apart = (e < f) & (after[e] != f) & (after[f] != e)
    e, f = e[apart], f[apart]
    same = loops.number[e] == loops.number[f]
    travelled = np.cumsum(length)
    forth = travelled[f] - length[f] - travelled[e]
    back = np.bincount(loops.number, length)[loops.number[e]] - forth - length[e] - length[f]
    near = same & (np.minimum(forth, back) < 4 * gap)
    conflict = ~near
    conflict[near] = shapely.intersects(segments[e[near]], segments[f[near]])
    return np.unique(np.concatenate([e[conflict], f[conflict]]))


def _jumped(simplified: Loops, over: list[NDArray[np.intp]]) -> list[int]:
    """The edges that passed over a whole loop when vertices were dropped."""
    separate = simplified.split(simplified.points)
    starts = np.array([loop[0] for loop in separate])
    inside = np.array([shapely.contains_xy(shapely.Polygon(loop), *starts.T) for loop in separate])
    expected = np.zeros_like(inside)
    expected[0] = True
    wrong = inside != expected
    np.fill_diagonal(wrong, False)
    segments = simplified.segments()
    mendable = np.array([len(vertices) > 0 for vertices in over])
    found = []
    for pair in np.argwhere(wrong):
        for number, other in (pair, pair[::-1]):
            # Take the nearest edge with vertices to put back.
            edges = np.flatnonzero(mendable & (simplified.number == number))
            if len(edges):
                distance = shapely.distance(segments[edges], shapely.Point(starts[other]))
                found.append(int(edges[np.argmin(distance)]))
    return found
