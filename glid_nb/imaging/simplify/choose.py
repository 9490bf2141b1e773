"""Choose how many vertices a cage has, and which."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.simplify.conflicts import repair
from glid_nb.imaging.simplify.edges import divide_long_edges, merge_short_edges
from glid_nb.imaging.simplify.enclose import enclosing
from glid_nb.imaging.simplify.loops import Loops, Points, significance

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
        Pixels by which the loops were moved away from the shape. The automatic tolerance stays
        below it if possible, so that the shape stays inside.
    room
        Pixels that the loops are about apart; they keep a part of it.
    max_vertices, min_edge, max_edge
        As in `TraceOptions`.
    """
    ranked = _Ranked(loops)
    areas = np.array([abs(signed_area(loop)) for loop in loops])
    if tolerance is None:
        tolerance = ranked.automatic_tolerance(float(areas[0]), offset)
        limits = np.minimum(tolerance, _LOOP_SHARE * np.sqrt(areas))
    else:
        limits = np.full(len(loops), tolerance)
    gap = max(_GAP * room, _LEAST_GAP)

    kept, notes = ranked.choose(limits, min_edge, gap)
    if max_vertices is not None and kept.sum() > max_vertices:
        fewest = 3 * len(loops)
        aim, excess = max(max_vertices, fewest), 0
        while True:
            aim = max(aim - excess, fewest)  # repairs put some vertices back
            tolerance = ranked.tolerance_for_count(aim)
            kept, notes = ranked.choose(np.full(len(loops), tolerance), min_edge, gap)
            excess = int(kept.sum()) - max_vertices
            if excess <= 0 or aim == fewest:
                break
        if excess > 0:
            notes.append(
                f"max_vertices={max_vertices} is too few: the loops need {kept.sum()} to stay apart"
            )
    moved = enclosing(ranked.loops, kept, _MARGIN * offset, gap)
    divided = divide_long_edges(moved, max_edge, max_vertices)
    divided.points.setflags(write=False)
    exterior, *holes = divided.split(divided.points)
    return Simplified(exterior, tuple(holes), float(tolerance), tuple(notes))


class _Ranked:
    """Loops with the importance of each vertex, and the three of each loop that are always kept."""

    def __init__(self, loops: tuple[Points, ...]) -> None:
        number = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
        self.loops = Loops(np.concatenate(loops), number)
        by_loop = [significance(loop) for loop in loops]
        self.importance = np.concatenate(by_loop)
        ranks = [np.argsort(np.argsort(-values, kind="stable")) for values in by_loop]
        self.fixed = np.concatenate(ranks) < 3

    def choose(
        self, limits: NDArray[np.float64], min_edge: float | None, gap: float
    ) -> tuple[NDArray[np.bool_], list[str]]:
        """(n,) mask of the vertices kept with a tolerance per loop, and notes."""
        kept = (self.importance > limits[self.loops.number]) | self.fixed
        notes = repair(self.loops, self.importance, kept, gap)
        merge_short_edges(self.loops, kept, min_edge, gap)
        return kept, notes

    def automatic_tolerance(self, area: float, offset: float) -> float:
        ranked = np.sort(self.importance)[::-1]
        extra = _VERTICES_PER_HOLE * int(self.loops.number[-1])

        def for_count(count: int) -> float:
            return float(ranked[count + extra]) if count + extra < len(ranked) else 0.0

        near = max(offset, _SHARE * float(np.sqrt(area)), _LEAST_TOLERANCE)
        tolerance = min(max(for_count(_VERTICES), _LEAST_TOLERANCE), near)
        tolerance = max(tolerance, min(for_count(_MANY), _FAR * near))
        return max(tolerance, for_count(_MOST))

    def tolerance_for_count(self, count: int) -> float:
        """The least tolerance that keeps `count` vertices, or three per loop."""
        rest = np.sort(self.importance[~self.fixed])[::-1]
        room = min(max(count - int(self.fixed.sum()), 0), len(rest) - 1)
        return float(rest[room]) if len(rest) else 0.0
