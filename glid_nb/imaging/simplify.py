"""Simplifying the loops of an outline together, so that they stay the loops of a cage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from glid_nb.geometry._loops import edge_lengths, segments, signed_area

Loop = NDArray[np.float64]

# What the automatic tolerance aims at, in this order: about _VERTICES, without leaving the offset;
# not many more than _MANY, without leaving a few times the offset; never more than _MOST.
_VERTICES, _MANY, _MOST = 75, 115, 300
_VERTICES_PER_HOLE = 6
_FAR = 3.0
_LEAST_TOLERANCE = 0.25  # pixels
_SHARE = 0.01  # of the square root of the area: the automatic tolerance where the offset is smaller
_LOOP_SHARE = 0.08  # likewise, of each loop's own area: small holes keep their form
_MIN_EDGE = 0.2  # of the mean edge
_MAX_EDGE = 0.04  # of the perimeter
_FEWEST_PER_LOOP = 8  # edges that a loop keeps before its edges count as short
_GAP, _LEAST_GAP = 0.25, 0.1  # times the room, and in pixels: what loops keep apart if they can
_MARGIN = 0.5  # of the offset may be cut off
_FEWEST, _LEAST_ANGLE = 4, 0.05  # what merging leaves of a loop, and at its corners


@dataclass(frozen=True, eq=False)
class Simplified:
    """Simplified loops.

    Attributes
    ----------
    exterior
        (n, 2) vertices in pixel coordinates.
    holes
        (k, 2) each.
    tolerance
        Largest distance in pixels that dropping vertices moved the outline by. Repairs make it
        smaller in places; merging a short edge can add that edge's length.
    notes
        Sentences about repairs.
    """

    exterior: Loop
    holes: tuple[Loop, ...]
    tolerance: float
    notes: tuple[str, ...]


def simplify(
    loops: tuple[Loop, ...],
    tolerance: float | None = None,
    *,
    offset: float = 0.0,
    room: float = 0.0,
    max_vertices: int | None = None,
    min_edge: float | None = None,
    max_edge: float | None = None,
) -> Simplified:
    """Drop vertices without making a loop meet itself or another one.

    Parameters
    ----------
    loops
        The exterior, then the holes, (n, 2) each, in pixel coordinates; they must not meet.
    tolerance
        Largest distance in pixels that the outline may move; None: chosen for about 80 vertices.
    offset
        How far the loops were moved away from the shape, in pixels. The automatic tolerance stays
        below it if it can, and then the shape stays inside.
    room
        The loops are at least about this far apart, in pixels, and shall stay so in proportion.
    max_vertices, min_edge, max_edge
        As in `TraceOptions`.
    """
    importance = [significance(loop) for loop in loops]
    areas = [abs(signed_area(loop)) for loop in loops]
    if tolerance is None:
        tolerance = _automatic_tolerance(importance, areas[0], offset)
        limits = np.minimum(tolerance, _LOOP_SHARE * np.sqrt(areas))
    else:
        limits = np.full(len(loops), tolerance)
    forced = [_largest_three(values) for values in importance]
    kept = [(v > t) | f for v, t, f in zip(importance, limits, forced, strict=True)]
    notes: list[str] = []
    if max_vertices is not None and sum(map(np.count_nonzero, kept)) > max_vertices:
        free = np.concatenate([v[~f] for v, f in zip(importance, forced, strict=True)])
        most = max(max_vertices - 3 * len(loops), 0)
        tolerance = float(np.sort(free)[::-1][most])
        kept = [(v > tolerance) | f for v, f in zip(importance, forced, strict=True)]

    gap = max(_GAP * room, _LEAST_GAP)
    notes += _repair(loops, importance, kept, gap)
    _merge_short_edges(loops, kept, min_edge, gap)
    count = sum(map(np.count_nonzero, kept))
    if max_vertices is not None and count > max_vertices:
        notes.append(
            f"max_vertices={max_vertices} is too few: the loops need {count} to keep apart"
        )
    result = _enclosing(loops, kept, _MARGIN * offset, gap)
    result = _divide_long_edges(result, max_edge, max_vertices)
    for loop in result:
        loop.setflags(write=False)
    return Simplified(result[0], tuple(result[1:]), float(tolerance), tuple(notes))


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
    middle = int(np.argmax(np.hypot(*(points - points[0]).T)))
    closed = np.concatenate([points, points[:1]])
    result = np.zeros(n + 1)
    result[[0, middle]] = np.inf
    stack = [(0, middle, np.inf), (middle, n, np.inf)]
    while stack:
        low, high, limit = stack.pop()
        if high - low < 2:
            continue
        distance = _distances(closed[low + 1 : high], closed[low], closed[high])
        split = int(np.argmax(distance))
        limit = min(limit, float(distance[split]))
        split += low + 1
        result[split] = limit
        stack += [(low, split, limit), (split, high, limit)]
    return np.roll(result[:-1], start)


def _distances(points: Loop, a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) distances of (k, 2) points from segments a, b, each (2,) or (k, 2)."""
    edge, apart = b - a, points - a
    squared = np.maximum(np.sum(edge * edge, axis=-1, keepdims=True), np.finfo(float).tiny)
    along = np.clip(np.sum(apart * edge, axis=-1, keepdims=True) / squared, 0, 1)
    return np.hypot(*(apart - along * edge).T)


def _automatic_tolerance(
    importance: list[NDArray[np.float64]], area: float, offset: float
) -> float:
    ranked = np.sort(np.concatenate(importance))[::-1]
    extra = _VERTICES_PER_HOLE * (len(importance) - 1)

    def for_count(count: int) -> float:
        return float(ranked[count + extra]) if count + extra < len(ranked) else 0.0

    near = max(offset, _SHARE * float(np.sqrt(area)), _LEAST_TOLERANCE)
    tolerance = min(max(for_count(_VERTICES), _LEAST_TOLERANCE), near)
    tolerance = max(tolerance, min(for_count(_MANY), _FAR * near))
    return max(tolerance, for_count(_MOST))


def _largest_three(values: NDArray[np.float64]) -> NDArray[np.bool_]:
    chosen = np.zeros(len(values), dtype=bool)
    chosen[np.argsort(-values, kind="stable")[:3]] = True
    return chosen


def _repair(
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
        back = _put_back(_edges_in_conflict(simplified, gap), loops, importance, kept)
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
        between = _between(indices[number], edge, len(loops[number]))
        if len(between):
            back = between[np.argmax(importance[number][between])]
            kept[number][back] = True
            place = loops[number][back]
    return place


def _between(index: NDArray[np.intp], edge: int, n: int) -> NDArray[np.intp]:
    """The vertices of a loop of `n` that were dropped between the kept ones `edge` and `edge` + 1."""
    low, high = index[edge], index[(edge + 1) % len(index)]
    return np.arange(low + 1, high if high > low else high + n) % n


def _edges_in_conflict(loops: list[Loop], gap: float) -> list[tuple[int, int]]:
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


def _merge_short_edges(
    loops: tuple[Loop, ...], kept: list[NDArray[np.bool_]], min_edge: float | None, gap: float
) -> None:
    """Drop an end of every edge shorter than `min_edge`, in place, where nothing is in the way."""
    lengths = [edge_lengths(loop[keep]) for loop, keep in zip(loops, kept, strict=True)]
    if min_edge is None:
        min_edge = _MIN_EDGE * float(np.concatenate(lengths).mean())
    shortest = [min(min_edge, float(length.sum()) / _FEWEST_PER_LOOP) for length in lengths]
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
    height = _distances(loop, before, after)
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


def _enclosing(
    loops: tuple[Loop, ...], kept: list[NDArray[np.bool_]], margin: float, gap: float
) -> list[Loop]:
    """The simplified loops, with edges moved outwards that cut off more than `margin`.

    A chord of a convex arc cuts off a part of the shape. The edge is moved in parallel by that much;
    where this would make loops meet, it stays.
    """
    simplified = [loop[keep] for loop, keep in zip(loops, kept, strict=True)]
    shifts = []
    for number, (loop, keep) in enumerate(zip(loops, kept, strict=True)):
        outwards = 1.0 if (signed_area(simplified[number]) > 0) == (number == 0) else -1.0
        shifts.append(_shifts(loop, np.flatnonzero(keep), outwards, margin))
    while True:
        moved = [loop + shift for loop, shift in zip(simplified, shifts, strict=True)]
        changed = False
        for number, (before, after) in enumerate(zip(simplified, moved, strict=True)):
            ratio = signed_area(after) / signed_area(before)
            if not 0.5 < ratio < 2 and shifts[number].any():
                shifts[number][:] = 0
                changed = True
        for number, edge in [] if changed else _edges_in_conflict(moved, gap):
            ends = [edge, (edge + 1) % len(moved[number])]
            if shifts[number][ends].any():
                shifts[number][ends] = 0
                changed = True
        if not changed:
            return moved


def _shifts(
    loop: Loop, index: NDArray[np.intp], outwards: float, margin: float
) -> NDArray[np.float64]:
    """(k, 2) how to move the vertices `index` so that no edge cuts off more than `margin`."""
    corners = loop[index]
    edge = np.roll(corners, -1, axis=0) - corners
    normal = outwards * np.stack([edge[:, 1], -edge[:, 0]], axis=1)
    normal /= np.hypot(*edge.T)[:, np.newaxis]
    cut = np.zeros(len(index))
    for k in range(len(index)):
        between = _between(index, k, len(loop))
        if len(between):
            cut[k] = max(0.0, float(((loop[between] - corners[k]) @ normal[k]).max()) - margin)
    before, cut_before = np.roll(normal, 1, axis=0), np.roll(cut, 1)
    # A vertex moves to where the two moved edges meet, but not farther than twice their moves.
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


def _divide_long_edges(
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
