"""Choose the vertices of a cage: simplify the loops of an outline together, so they stay disjoint.

The algorithm is that of Ramer, Douglas and Peucker. We do not use a library: shapely lets loops
come close and cuts off more, and scikit-image simplifies one loop at a time.
"""

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._arrays import Array, Floats, read_only
from glid_nb.geometry._loops import Loops, as_points, subdivided
from glid_nb.imaging.loops import in_conflict, passed_over, repair, significance

# Numbers of vertices from which the automatic tolerance is computed.
# _VERTICES: the aim, while the tolerance is below the offset.
# _MANY: more vertices than this raise the tolerance, up to _FAR offsets.
# _MOST: more vertices than this raise the tolerance without limit.
_VERTICES, _MANY, _MOST = 75, 115, 300
_VERTICES_PER_HOLE = 6  # added to these numbers for each hole
_FAR = 3.0  # times the offset
_LEAST_TOLERANCE = 0.25  # pixels
_SHARE = 0.01  # of the square root of the area: replaces the offset if that is smaller
_LOOP_SHARE = 0.08  # most tolerance, relative to the square root of the loop's own area
_GAP, _LEAST_GAP = 0.25, 0.1  # least distance of loops, relative to the room and in pixels
_MARGIN = 0.5  # share of the offset that edges may cut off
_MIN_EDGE = 0.2  # of the mean edge
_MAX_EDGE = 0.04  # of the perimeter
_PER_LOOP = 12  # an edge is short only if it is below the loop's perimeter over this
_FEWEST, _LEAST_ANGLE = 4, 0.05  # merging leaves at least this many edges; and larger angles


@dataclass(frozen=True, eq=False)
class Simplified:
    """Simplified loops, in pixel coordinates.

    ``tolerance`` is the largest distance in pixels by which dropping vertices moved the outline.
    Repairs reduce it in places; merging a short edge can add that edge's length.
    """

    exterior: Floats
    holes: tuple[Floats, ...]
    tolerance: float
    notes: tuple[str, ...]  # about repairs


def simplify(
    loops: tuple[Floats, ...],
    tolerance: float | None = None,
    max_vertices: int | None = None,
    min_edge: float | None = None,
    max_edge: float | None = None,
    *,
    offset: float = 0.0,
    room: float = 0.0,
) -> Simplified:
    """Drop vertices of loops, the exterior first. The loops never meet themselves or each other.

    The loops were moved away from the shape by ``offset``. If possible, the automatic tolerance
    stays below ``offset``, so that the shape stays inside. The loops are about ``room`` apart and
    keep a part of this distance. For the other arguments see `TraceOptions`.
    """
    whole, by_loop = Loops.of(loops), [significance(loop) for loop in loops]
    importance = np.concatenate(by_loop)
    # Three vertices of each loop are always kept.
    ranks = [np.argsort(np.argsort(-values, kind="stable")) for values in by_loop]
    fixed, fewest = np.concatenate(ranks) < 3, 3 * len(loops)
    gap = max(_GAP * room, _LEAST_GAP)

    def choose(limits: float | NDArray[np.float64]) -> tuple[NDArray[np.bool_], list[str]]:
        """(n,) mask of the vertices kept with these tolerances, and notes."""
        kept = (importance > limits) | fixed
        notes = repair(whole, importance, kept, gap)
        _merge_short_edges(whole, kept, min_edge, gap)
        return kept, notes

    if tolerance is None:
        areas = np.abs(whole.areas)
        tolerance = _automatic_tolerance(importance, len(loops) - 1, float(areas[0]), offset)
        kept, notes = choose(np.minimum(tolerance, _LOOP_SHARE * np.sqrt(areas))[whole.number])
    else:
        kept, notes = choose(tolerance)
    if max_vertices is not None and kept.sum() > max_vertices:
        rest = np.sort(importance[~fixed])[::-1]
        aim, excess = max_vertices, 0
        while True:
            aim = max(aim - excess, fewest)  # repairs put some vertices back
            tolerance = float(rest[min(aim - fewest, len(rest) - 1)]) if len(rest) else 0.0
            kept, notes = choose(tolerance)
            excess = int(kept.sum()) - max_vertices
            if excess <= 0 or aim == fewest:
                break
        if excess > 0:
            needed = f"the loops need {kept.sum()} to stay apart"
            notes.append(f"max_vertices={max_vertices} is too few: {needed}")
    moved = _enclosing(whole, kept, _MARGIN * offset, gap)
    exterior, *holes = map(read_only, _divided(moved, max_edge, max_vertices))
    return Simplified(exterior, tuple(holes), float(tolerance), tuple(notes))


def _automatic_tolerance(importance: Array, n_holes: int, area: float, offset: float) -> float:
    ranked = np.sort(importance)[::-1]

    def for_count(count: int) -> float:
        index = count + _VERTICES_PER_HOLE * n_holes
        return float(ranked[index]) if index < len(ranked) else 0.0

    near = max(offset, _SHARE * float(np.sqrt(area)), _LEAST_TOLERANCE)
    tolerance = min(max(for_count(_VERTICES), _LEAST_TOLERANCE), near)
    tolerance = max(tolerance, min(for_count(_MANY), _FAR * near))
    return max(tolerance, for_count(_MOST))


def _merge_short_edges(loops: Loops, kept: Array, min_edge: float | None, gap: float) -> None:
    """For each edge shorter than `min_edge`, drop one end from `kept` unless something is in the
    way."""
    if min_edge is None:
        min_edge = _MIN_EDGE * float(loops[kept].lengths.mean())
    shortest = np.minimum(min_edge, loops[kept].perimeters / _PER_LOOP)
    blocked = np.zeros(len(kept), dtype=bool)
    while True:
        index = np.flatnonzero(kept)
        simplified = loops[index]
        chosen = _droppable(simplified, blocked[index], shortest)
        if not len(chosen):
            return
        clear = _clear(simplified, chosen, gap)
        kept[index[chosen[clear]]] = False
        blocked[index[chosen[~clear]]] = True


def _droppable(loops: Loops, blocked: Array, shortest: Array) -> Array:
    """Vertices at short edges, one per edge, far enough apart to drop them independently."""
    length, around = loops.lengths, _around(loops)
    bases = shapely.linestrings(loops.points[around[:, [1, 3]]])
    height = np.asarray(shapely.distance(shapely.points(loops.points), bases))
    taken = np.zeros(len(length), dtype=bool)
    chosen: list[int] = []
    for edges, limit in zip(loops.split(np.arange(len(length))), shortest, strict=True):
        left = len(edges)
        for edge in edges[np.argsort(length[edges])]:
            if length[edge] >= limit or left <= _FEWEST:
                break
            ends = [int(end) for end in around[edge, 2:4] if not blocked[end]]
            if ends:
                vertex = min(ends, key=lambda end: height[end])
                if not taken[around[vertex]].any():
                    taken[around[vertex]] = True
                    chosen.append(vertex)
                    left -= 1
    return np.array(chosen, dtype=np.intp)


def _around(loops: Loops) -> NDArray[np.intp]:
    before, after, own = loops.before, loops.after, np.arange(len(loops.after))
    return np.stack([before[before], before, own, after, after[after]], axis=1)


def _clear(loops: Loops, vertices: NDArray[np.intp], gap: float) -> NDArray[np.bool_]:
    """Whether each vertex can be dropped.

    Its triangle with its neighbours, widened by `gap`, must not meet other edges. And the edge that
    replaces the triangle's two sides must not fold back onto its neighbours.
    """
    around = _around(loops)[vertices]
    corners = loops.points[around]
    triangle, edge = shapely.STRtree(loops.segments).query(
        shapely.polygons(corners[:, 1:4]), predicate="dwithin", distance=gap
    )
    # The two sides and the edges next to them are no obstacles.
    own = (edge[:, np.newaxis] == around[triangle, :4]).any(axis=1)
    clear = np.ones(len(vertices), dtype=bool)
    clear[triangle[~own]] = False
    z = corners @ [1, 1j]
    for a, b, c in ((0, 1, 3), (1, 3, 4)):
        clear &= np.abs(np.angle((z[:, c] - z[:, b]) / (z[:, a] - z[:, b]))) > _LEAST_ANGLE
    return clear


def _divided(loops: Loops, max_edge: float | None, max_vertices: int | None) -> list[Floats]:
    """Divide edges longer than `max_edge` into even parts; into fewer parts for `max_vertices`."""
    length = loops.lengths
    longest = _MAX_EDGE * float(length.sum()) if max_edge is None else max_edge
    most = np.inf if max_vertices is None else max(max_vertices, len(length))
    while (pieces := np.maximum(np.ceil(length / longest), 1).astype(int)).sum() > most:
        longest *= 1.1
    z = loops.points @ np.array([1, 1j])
    return list(map(as_points, map(subdivided, loops.split(z), loops.split(pieces))))


def _enclosing(loops: Loops, kept: NDArray[np.bool_], margin: float, gap: float) -> Loops:
    """The simplified loops. Edges that cut off more than `margin` move outwards unless loops would
    meet."""
    simplified = loops[kept]
    areas = simplified.areas
    shifts = _shifts(loops, kept, areas, margin)
    # Limits on the change of area, so that no hole vanishes or is inverted.
    low, high = np.full(len(areas), 0.3), np.full(len(areas), 1.2)
    low[0], high[0] = 0.5, np.inf
    while True:
        moved = Loops(simplified.points + shifts, simplified.number)
        ratio = moved.areas / areas
        still = (~((low < ratio) & (ratio < high)))[simplified.number]
        if not shifts[still].any():
            edges = in_conflict(moved, gap)
            still = np.concatenate([edges, simplified.after[edges]])
            if not shifts[still].any():
                return moved
        shifts[still] = 0


def _shifts(loops: Loops, kept: Array, areas: Array, margin: float) -> Floats:
    """(k, 2) shifts of the kept vertices after which no edge cuts off more than `margin`."""
    corners = loops[kept]
    outwards = np.where((areas > 0) == (np.arange(len(areas)) == 0), 1.0, -1.0)[corners.number]
    x, y = corners.edges.T
    normal = outwards[:, np.newaxis] * np.stack([y, -x], axis=1)
    normal /= np.hypot(x, y)[:, np.newaxis]
    cut = np.zeros(len(normal))
    for k, over in enumerate(passed_over(loops, kept)):
        if len(over):
            beyond = (loops.points[over] - corners.points[k]) @ normal[k]
            cut[k] = max(0.0, float(beyond.max()) - margin)
    before, cut_before = normal[corners.before], cut[corners.before]
    # A vertex moves to the intersection of its two moved edges, at most twice as far as the edges.
    middle = before + normal
    square = np.maximum(np.sum(middle**2, axis=1), 1e-12)
    (ax, ay), (bx, by) = before.T, normal.T
    sine = ax * by - ay * bx
    flat = np.abs(sine) < 0.2
    sine[flat] = 1.0
    meet = np.stack([cut_before * by - cut * ay, cut * ax - cut_before * bx], axis=1)
    meet /= sine[:, np.newaxis]
    most = np.maximum(cut, cut_before)
    straight = middle * (2 * most / square)[:, np.newaxis]
    shift = np.where(flat[:, np.newaxis], straight, meet)
    length = np.hypot(*shift.T)
    return shift * np.minimum(1.0, 2 * most / np.maximum(length, 1e-12))[:, np.newaxis]
