"""Simplify the loops of an outline together, so that they stay disjoint: which vertices a cage has.

They are those that the algorithm of Ramer, Douglas and Peucker keeps. Libraries were tried and
lost: shapely lets loops come close and cuts off more; scikit-image takes one loop at a time.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array, read_only
from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.edges import divide_long_edges, enclosing, merge_short_edges
from glid_nb.imaging.loops import Loops, Points, repair, significance

# Numbers of vertices for the automatic tolerance: about _VERTICES while it is below the offset, not
# many more than _MANY while it is below a few times the offset, and never more than _MOST.
_VERTICES, _MANY, _MOST = 75, 115, 300
_VERTICES_PER_HOLE = 6
_FAR = 3.0  # times the offset
_LEAST_TOLERANCE = 0.25  # pixels
_SHARE = 0.01  # replaces a smaller offset, relative to the square root of the area
_LOOP_SHARE = 0.08  # most tolerance relative to the loop's own area; small holes keep their form
_GAP, _LEAST_GAP = 0.25, 0.1  # distance of loops, relative to the room and in pixels
_MARGIN = 0.5  # of the offset may be cut off


@dataclass(frozen=True, eq=False)
class Simplified:
    """Simplified loops, in pixel coordinates.

    ``tolerance`` is the largest distance in pixels by which dropping vertices moved the outline.
    Repairs reduce it in places; merging a short edge can add that edge's length.
    """

    exterior: Points
    holes: tuple[Points, ...]
    tolerance: float
    notes: tuple[str, ...]  # about repairs


def simplify(
    loops: tuple[Points, ...],
    tolerance: float | None = None,
    max_vertices: int | None = None,
    min_edge: float | None = None,
    max_edge: float | None = None,
    *,
    offset: float = 0.0,
    room: float = 0.0,
) -> Simplified:
    """Drop vertices without making a loop meet itself or another one.

    The ``loops``, the exterior, then the holes, are (n, 2) in pixel coordinates and must not meet.
    The outline may move by the ``tolerance`` in pixels; None: chosen for about 80 vertices.
    ``offset`` is by how many pixels the loops were moved away from the shape: the automatic
    tolerance stays below it if possible, so that the shape stays inside. They are about ``room``
    pixels apart, and keep a part of that. The rest is as in `TraceOptions`.
    """
    whole = Loops(np.concatenate(loops), np.repeat(np.arange(len(loops)), list(map(len, loops))))
    by_loop = [significance(loop) for loop in loops]
    importance = np.concatenate(by_loop)
    # Three vertices of each loop are always kept.
    ranks = [np.argsort(np.argsort(-values, kind="stable")) for values in by_loop]
    fixed, fewest = np.concatenate(ranks) < 3, 3 * len(loops)
    gap = max(_GAP * room, _LEAST_GAP)

    def choose(limits: float | NDArray[np.float64]) -> tuple[NDArray[np.bool_], list[str]]:
        """(n,) mask of the vertices kept with these tolerances, and notes."""
        kept = (importance > limits) | fixed
        notes = repair(whole, importance, kept, gap)
        merge_short_edges(whole, kept, min_edge, gap)
        return kept, notes

    if tolerance is None:
        areas = np.array([abs(signed_area(loop)) for loop in loops])
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
    moved = enclosing(whole, kept, _MARGIN * offset, gap)
    divided = divide_long_edges(moved, max_edge, max_vertices)
    exterior, *holes = divided.split(read_only(divided.points))
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
