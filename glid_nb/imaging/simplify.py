"""Simplifying the loops of an outline together, so that they stay the loops of a cage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

Loop = NDArray[np.float64]

# What the automatic tolerance aims at, in this order: about _VERTICES, without leaving the offset;
# not many more than _MANY, without leaving a few times the offset; never more than _MOST.
_VERTICES, _MANY, _MOST = 75, 100, 300
_VERTICES_PER_HOLE = 6
_FAR = 3.0
_LEAST_TOLERANCE = 0.25  # pixels
_SHARE = 0.01  # of the square root of the area: the automatic tolerance where the offset is smaller
_LOOP_SHARE = 0.08  # likewise, of each loop's own area: small holes keep their form
_MIN_EDGE = 0.2  # of the mean edge
_MAX_EDGE = 0.04  # of the perimeter
_FEWEST_PER_LOOP = 8  # edges that a loop keeps before its edges count as short
_GAP, _LEAST_GAP = 0.25, 0.1  # times the offset, and in pixels: what loops keep apart if they can
_MARGIN = 0.5  # of the offset may be cut off
_LEAST_ANGLE = 0.05


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
    max_vertices, min_edge, max_edge
        As in `TraceOptions`.
    """
    importance = [significance(loop) for loop in loops]
    areas = [shapely.Polygon(loop).area for loop in loops]
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
        room = max(max_vertices - 3 * len(loops), 0)
        tolerance = float(np.sort(free)[::-1][room])
        kept = [(v > tolerance) | f for v, f in zip(importance, forced, strict=True)]

    gap = max(_GAP * offset, _LEAST_GAP)
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
    """(k,) distances of (k, 2) points from the segment a, b."""
    edge = b - a
    squared = float(edge @ edge)
    apart = points - a
    if squared > 0:
        along = np.clip(apart @ edge / squared, 0, 1)
        apart = apart - along[:, np.newaxis] * edge
    return np.hypot(apart[:, 0], apart[:, 1])


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
        added = False
        for number, edge in _edges_in_conflict(simplified, gap) or _jumped(simplified, loops, kept):
            index = np.flatnonzero(kept[number])
            low, high = index[edge], index[(edge + 1) % len(index)]
            between = np.arange(low + 1, high if high > low else high + len(loops[number]))
            between %= len(loops[number])
            if len(between):
                back = between[np.argmax(importance[number][between])]
                kept[number][back] = added = True
                place = loops[number][back]
        if not added:
            break
    if place is None:
        return []
    count = sum(map(np.count_nonzero, kept)) - before
    return [
        f"simplification would have made the cage meet itself; {count} "
        f"{'vertex was' if count == 1 else 'vertices were'} kept, near ({place[0]:.0f}, "
        f"{place[1]:.0f}) among others"
    ]


def _edges_in_conflict(loops: list[Loop], gap: float) -> list[tuple[int, int]]:
    """(loop, edge) for the edges that cross, or come closer than `gap` to, an edge elsewhere.

    Edges of one loop are elsewhere to each other if the way along the loop is several gaps long;
    nearer ones, as the sides of a short edge, only count when they cross.
    """
    number = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    index = np.concatenate([np.arange(len(loop)) for loop in loops])
    starts = np.concatenate(loops)
    ends = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    segments = shapely.linestrings(np.stack([starts, ends], axis=1))
    e, f = shapely.STRtree(segments).query(segments, predicate="dwithin", distance=gap)
    e, f = e[e < f], f[e < f]
    size = np.array([len(loop) for loop in loops])[number[e]]
    same = number[e] == number[f]
    step = index[f] - index[e]
    adjacent = same & ((step == 1) | (step == size - 1))
    e, f, same = e[~adjacent], f[~adjacent], same[~adjacent]
    if not len(e):
        return []
    length = np.hypot(*(ends - starts).T)
    travelled = np.concatenate([[0.0], np.cumsum(length)])
    total = np.array([length[number == k].sum() for k in range(len(loops))])[number[e]]
    forth = travelled[f] - travelled[e + 1]
    back = total - forth - length[e] - length[f]
    near = same & (np.minimum(forth, back) < 4 * gap)
    conflict = ~near
    conflict[near] = shapely.intersects(segments[e[near]], segments[f[near]])
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
    for outer, inner in np.argwhere(wrong):
        for number, other in ((outer, inner), (inner, outer)):
            index = np.flatnonzero(kept[number])
            for edge, (low, high) in enumerate(zip(index, np.roll(index, -1), strict=True)):
                span = np.arange(low, (high if high > low else high + len(loops[number])) + 1)
                if len(span) < 3:
                    continue
                cut = shapely.Polygon(loops[number][span % len(loops[number])]).buffer(0)
                if shapely.contains_xy(cut, *starts[other]):
                    found.append((int(number), edge))
    return found


def _merge_short_edges(
    loops: tuple[Loop, ...], kept: list[NDArray[np.bool_]], min_edge: float | None, gap: float
) -> None:
    """Drop an end of every edge shorter than `min_edge`, in place, where nothing is in the way."""
    lengths = [_lengths(loop[keep]) for loop, keep in zip(loops, kept, strict=True)]
    if min_edge is None:
        min_edge = _MIN_EDGE * float(np.concatenate(lengths).mean())
    for number in range(len(loops)):
        shortest = min(min_edge, float(lengths[number].sum()) / _FEWEST_PER_LOOP)
        stuck: set[int] = set()
        while np.count_nonzero(kept[number]) > 3:
            index = np.flatnonzero(kept[number])
            length = _lengths(loops[number][index])
            short = [int(i) for i in np.flatnonzero(length < shortest) if index[i] not in stuck]
            if not short:
                break
            edge = min(short, key=lambda i: length[i])
            simplified = [loop[keep] for loop, keep in zip(loops, kept, strict=True)]
            ends = [edge, (edge + 1) % len(index)]
            for vertex in sorted(ends, key=lambda i: _height(simplified[number], i)):
                if _can_drop(simplified, number, vertex, gap):
                    kept[number][index[vertex]] = False
                    break
            else:
                stuck.add(int(index[edge]))


def _lengths(loop: Loop) -> NDArray[np.float64]:
    return np.hypot(*(np.roll(loop, -1, axis=0) - loop).T)


def _height(loop: Loop, vertex: int) -> float:
    """Distance of a vertex from the segment between its neighbours."""
    after = (vertex + 1) % len(loop)
    return float(_distances(loop[[vertex]], loop[vertex - 1], loop[after])[0])


def _can_drop(loops: list[Loop], number: int, vertex: int, gap: float) -> bool:
    """Whether the triangle at a vertex, widened by `gap`, is clear of all other edges."""
    loop = loops[number]
    n = len(loop)
    triangle = shapely.Polygon(loop[[vertex - 1, vertex, (vertex + 1) % n]])
    # The edges from the vertex after the next one round to the one before the last.
    rest = np.roll(loop, -(vertex + 2), axis=0)[: n - 3]
    others: list[BaseGeometry] = [
        shapely.LineString(rest) if len(rest) > 1 else shapely.Point(rest[0])
    ]
    others += [shapely.LinearRing(other) for k, other in enumerate(loops) if k != number]
    if any(shapely.dwithin(triangle, other, gap) for other in others):
        return False
    # The neighbouring edges must not fold onto the new one.
    corner = loop[[vertex - 2, vertex - 1, (vertex + 1) % n, (vertex + 2) % n]]
    return all(_angle(*corner[i : i + 3]) > _LEAST_ANGLE for i in (0, 1))


def _angle(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> float:
    """The angle at b in [0, pi]."""
    u, v = a - b, c - b
    return float(np.arctan2(abs(u[0] * v[1] - u[1] * v[0]), u @ v))


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
        outwards = 1.0 if (_signed_area(simplified[number]) > 0) == (number == 0) else -1.0
        shifts.append(_shifts(loop, np.flatnonzero(keep), outwards, margin))
    while True:
        moved = [loop + shift for loop, shift in zip(simplified, shifts, strict=True)]
        changed = False
        for number, (before, after) in enumerate(zip(simplified, moved, strict=True)):
            ratio = _signed_area(after) / _signed_area(before)
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
    for k, (low, high) in enumerate(zip(index, np.roll(index, -1), strict=True)):
        between = np.arange(low + 1, high if high > low else high + len(loop)) % len(loop)
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


def _signed_area(loop: Loop) -> float:
    x, y = (loop - loop[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _divide_long_edges(
    loops: list[Loop], max_edge: float | None, max_vertices: int | None
) -> list[Loop]:
    length = [_lengths(loop) for loop in loops]
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
