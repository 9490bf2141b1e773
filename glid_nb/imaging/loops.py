"""Find places where the loops of a cage meet, and rate the importance of each vertex."""

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._arrays import Array, Floats
from glid_nb.geometry._loops import Loops


def passed_over(loops: Loops, kept: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """For each edge of ``loops[kept]``: the vertices that it skips, in order."""
    over = []
    for loop in loops.split(np.arange(len(kept))):
        ahead = np.roll(loop, -int(np.argmax(kept[loop])))  # starts at a kept vertex
        over += [run[1:] for run in np.split(ahead, np.flatnonzero(kept[ahead])[1:])]
    return over


def in_conflict(loops: Loops, gap: float) -> NDArray[np.intp]:
    """The edges that cross another edge or come closer to it than `gap`.

    Close edges of one loop do not count if the way between them along the loop is short, as it is
    for the two neighbours of a short edge.
    """
    segments, after = loops.segments, loops.after
    e, f = shapely.STRtree(segments).query(segments, predicate="dwithin", distance=gap)
    apart = (e < f) & (after[e] != f) & (after[f] != e)
    e, f = e[apart], f[apart]
    near = (loops.number[e] == loops.number[f]) & (loops.way_between(e, f) < 4 * gap)
    conflict = ~near
    conflict[near] = shapely.intersects(segments[e[near]], segments[f[near]])
    return np.unique(np.concatenate([e[conflict], f[conflict]]))


def repair(loops: Loops, importance: Array, kept: Array, gap: float) -> list[str]:
    """Put vertices back into `kept` where simplified loops meet or nearly meet. Returns notes."""
    before = np.count_nonzero(kept)
    place = loops.points[0]
    while True:
        simplified, over = loops[kept], passed_over(loops, kept)
        edges = [edge for edge in in_conflict(simplified, gap) if len(over[edge])]
        if not edges:  # containment is defined once there are no crossings
            edges = _jumped(simplified, over)
        if not edges:
            break
        back = [over[edge][np.argmax(importance[over[edge]])] for edge in edges]
        kept[back] = True
        place = loops.points[back[-1]]
    count = np.count_nonzero(kept) - before
    vertices = "vertex was" if count == 1 else "vertices were"
    where = f"{count} {vertices} kept, for example near ({place[0]:.0f}, {place[1]:.0f})"
    return [f"simplification would have made the cage meet itself; {where}"] if count else []


def _jumped(simplified: Loops, over: list[NDArray[np.intp]]) -> list[int]:
    """The edges that passed over a whole loop when vertices were dropped."""
    separate = simplified.split(simplified.points)
    starts = np.array([loop[0] for loop in separate])
    inside = np.array([shapely.contains_xy(shapely.Polygon(loop), *starts.T) for loop in separate])
    inside[0] = ~inside[0]  # all others lie in the exterior
    np.fill_diagonal(inside, False)
    segments = simplified.segments
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


def significance(loop: Floats) -> NDArray[np.float64]:
    """(n,) tolerances at which the algorithm of Ramer, Douglas and Peucker drops each point of a
    loop. It never drops two of them."""
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
    # Rotate so that the segment starts at 0 and runs along the real axis.
    turned = (z - a) * ((b - a).conjugate() / length if length > 0 else 1.0)
    along, across = turned.real, turned.imag
    beyond = np.maximum(np.maximum(-along, along - length), 0)
    square = across * across + beyond * beyond
    index = int(square.argmax())
    return index, float(square[index]) ** 0.5
