"""Where simplified loops meet, or nearly do, and putting vertices back there."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb.geometry._loops import edge_lengths, segments
from glid_nb.imaging.simplify.significance import Loop, dropped_between


def repair(
    loops: tuple[Loop, ...],
    importance: list[NDArray[np.float64]],
    kept: list[NDArray[np.bool_]],
    gap: float,
) -> list[str]:
    """Put vertices back, in place, where simplified loops meet or nearly do; a note if any were."""
    before = sum(map(np.count_nonzero, kept))
    place: NDArray[np.float64] | None = None
    while True:
        simplified = [loop[keep] for loop, keep in zip(loops, kept, strict=True)]
        back = _put_back(edges_in_conflict(simplified, gap), loops, importance, kept)
        if back is None:  # only now, with no crossings left, can loops be said to contain others
            back = _put_back(_jumped(simplified, loops, kept), loops, importance, kept)
        if back is None:
            break
        place = back
    if place is None:
        return []
    count = sum(map(np.count_nonzero, kept)) - before
    return [
        f"simplification would have made the cage meet itself; {count} "
        f"{'vertex was' if count == 1 else 'vertices were'} kept, near ({place[0]:.0f}, "
        f"{place[1]:.0f}) among others"
    ]


def edges_in_conflict(loops: list[Loop], gap: float) -> list[tuple[int, int]]:
    """(loop, edge) for the edges that cross, or come closer than `gap` to, an edge elsewhere.

    Edges of one loop are elsewhere to each other if the way along the loop is several gaps long;
    nearer ones, as the sides of a short edge, only count when they cross.
    """
    number = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    index = np.concatenate([np.arange(len(loop)) for loop in loops])
    edges = np.concatenate([segments(loop) for loop in loops])
    length = np.concatenate([edge_lengths(loop) for loop in loops])
    e, f = shapely.STRtree(edges).query(edges, predicate="dwithin", distance=gap)
    e, f = e[e < f], f[e < f]
    size = np.array([len(loop) for loop in loops])[number[e]]
    same = number[e] == number[f]
    step = index[f] - index[e]
    adjacent = same & ((step == 1) | (step == size - 1))
    e, f, same = e[~adjacent], f[~adjacent], same[~adjacent]
    if not len(e):
        return []
    travelled = np.concatenate([[0.0], np.cumsum(length)])
    total = np.array([length[number == k].sum() for k in range(len(loops))])[number[e]]
    forth = travelled[f] - travelled[e + 1]
    back = total - forth - length[e] - length[f]
    near = same & (np.minimum(forth, back) < 4 * gap)
    conflict = ~near
    conflict[near] = shapely.intersects(edges[e[near]], edges[f[near]])
    hit = np.unique(np.concatenate([e[conflict], f[conflict]]))
    return [(int(number[k]), int(index[k])) for k in hit]


def _jumped(
    simplified: list[Loop], loops: tuple[Loop, ...], kept: list[NDArray[np.bool_]]
) -> list[tuple[int, int]]:
    """(loop, edge) for the edges that passed over a whole other loop when vertices were dropped."""
    if len(loops) == 1:
        return []
    regions = np.array([shapely.Polygon(loop) for loop in simplified])
    starts = np.array([loop[0] for loop in simplified])
    inside = np.array(
        [shapely.contains_xy(region, starts[:, 0], starts[:, 1]) for region in regions]
    )
    expected = np.zeros_like(inside)
    expected[0] = True
    wrong = inside != expected
    np.fill_diagonal(wrong, False)
    found = []
    for pair in np.argwhere(wrong):
        for number, other in (pair, pair[::-1]):
            # Which edge passed over the loop: the nearest one with vertices to put back.
            index = np.flatnonzero(kept[number])
            dropped = np.diff(index, append=index[0] + len(kept[number])) > 1
            if dropped.any():
                edges = segments(simplified[number])[dropped]
                nearest = int(np.argmin(shapely.distance(edges, shapely.Point(starts[other]))))
                found.append((int(number), int(np.flatnonzero(dropped)[nearest])))
    return found


def _put_back(
    edges: list[tuple[int, int]],
    loops: tuple[Loop, ...],
    importance: list[NDArray[np.float64]],
    kept: list[NDArray[np.bool_]],
) -> NDArray[np.float64] | None:
    """Put the most important vertex back into every edge (loop, edge); one of them, if any."""
    indices = [np.flatnonzero(keep) for keep in kept]
    place = None
    for number, edge in edges:
        between = dropped_between(indices[number], edge, len(loops[number]))
        if len(between):
            back = between[np.argmax(importance[number][between])]
            kept[number][back] = True
            place = loops[number][back]
    return place
