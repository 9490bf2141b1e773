"""Simplifying the loops of an outline together, so that they stay the loops of a cage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry._loops import signed_area
from glid_nb.imaging.simplify.conflicts import repair
from glid_nb.imaging.simplify.edges import divide_long_edges, merge_short_edges
from glid_nb.imaging.simplify.enclose import enclosing
from glid_nb.imaging.simplify.significance import Loop, significance

# What the automatic tolerance aims at, in this order: about _VERTICES, without leaving the offset;
# not many more than _MANY, without leaving a few times the offset; never more than _MOST.
_VERTICES, _MANY, _MOST = 75, 115, 300
_VERTICES_PER_HOLE = 6
_FAR = 3.0
_LEAST_TOLERANCE = 0.25  # pixels
_SHARE = 0.01  # of the square root of the area: the automatic tolerance where the offset is smaller
_LOOP_SHARE = 0.08  # likewise, of each loop's own area: small holes keep their form
_GAP, _LEAST_GAP = 0.25, 0.1  # times the room, and in pixels: what loops keep apart if they can
_MARGIN = 0.5  # of the offset may be cut off


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
    gap = max(_GAP * room, _LEAST_GAP)

    kept, notes = _choose(loops, importance, limits, min_edge, gap)
    if max_vertices is not None and _count(kept) > max_vertices:
        fewest = 3 * len(loops)
        aim, excess = max(max_vertices, fewest), 0
        while True:
            aim = max(aim - excess, fewest)  # repairs put some vertices back
            tolerance = _tolerance_for_count(importance, aim)
            limits = np.full(len(loops), tolerance)
            kept, notes = _choose(loops, importance, limits, min_edge, gap)
            excess = _count(kept) - max_vertices
            if excess <= 0 or aim == fewest:
                break
        if excess > 0:
            notes.append(
                f"max_vertices={max_vertices} is too few: the loops need {_count(kept)} to keep "
                "apart"
            )
    result = enclosing(loops, kept, _MARGIN * offset, gap)
    result = divide_long_edges(result, max_edge, max_vertices)
    for loop in result:
        loop.setflags(write=False)
    return Simplified(result[0], tuple(result[1:]), float(tolerance), tuple(notes))


def _choose(
    loops: tuple[Loop, ...],
    importance: list[NDArray[np.float64]],
    limits: NDArray[np.float64],
    min_edge: float | None,
    gap: float,
) -> tuple[list[NDArray[np.bool_]], list[str]]:
    """Which vertices to keep with a tolerance for each loop, and notes."""
    kept = _above(importance, limits)
    notes = repair(loops, importance, kept, gap)
    merge_short_edges(loops, kept, min_edge, gap)
    return kept, notes


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


def _above(
    importance: list[NDArray[np.float64]], limits: NDArray[np.float64]
) -> list[NDArray[np.bool_]]:
    """The vertices above each loop's limit, and at least the three most important ones."""
    kept = [values > limit for values, limit in zip(importance, limits, strict=True)]
    for keep, values in zip(kept, importance, strict=True):
        keep[np.argsort(-values, kind="stable")[:3]] = True
    return kept


def _count(kept: list[NDArray[np.bool_]]) -> int:
    return int(sum(map(np.count_nonzero, kept)))


def _tolerance_for_count(importance: list[NDArray[np.float64]], count: int) -> float:
    """The least tolerance with which `_above` keeps `count` vertices, or three a loop."""
    rest = np.concatenate([np.sort(values)[:-3] for values in importance])
    room = min(max(count - 3 * len(importance), 0), len(rest) - 1)
    return float(np.sort(rest)[::-1][room]) if len(rest) else 0.0
