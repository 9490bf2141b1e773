"""Edits of a cage's vertices, as functions of loops. The loops need not form a valid cage."""

from collections.abc import Iterable
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import ArrayLike

from glid_nb._arrays import Floats, number_pairs, read_only
from glid_nb.geometry import GeometryError, loop_name
from glid_nb.geometry._loops import Loops

_DRAWN = 0.002  # of a picture's longer side: the tolerance that simplifies drawn lines
_LONGEST = 0.04  # of a drawn outline's length: longer edges are divided

AnyLoops: TypeAlias = tuple[Floats, ...]
"""The exterior, then the holes, as read-only (n, 2) arrays. They may be invalid as a cage."""


def move_vertex(loops: AnyLoops, loop: int, index: int, to: ArrayLike) -> AnyLoops:
    vertices = _loop(loops, loop, index).copy()
    vertices[index] = checked_point(to)
    return _with(loops, loop, vertices)


def insert_vertex(loops: AnyLoops, loop: int, edge: int, at: ArrayLike) -> AnyLoops:
    """Insert a vertex between vertex ``edge`` and the next one."""
    vertices = _loop(loops, loop, edge)
    return _with(loops, loop, np.insert(vertices, edge + 1, checked_point(at), axis=0))


def delete_vertices(loops: AnyLoops, vertices: Iterable[tuple[int, int]]) -> AnyLoops:
    """Delete some vertices (loop, index). Holes with fewer than three vertices left are removed.

    Raises a GeometryError if the exterior would have fewer than three vertices left.
    """
    gone: dict[int, set[int]] = {}
    for loop, index in vertices:
        _loop(loops, loop, index)
        gone.setdefault(loop, set()).add(index)
    if len(loops) and len(loops[0]) - len(gone.get(0, ())) < 3:
        raise GeometryError("the outline needs at least 3 points; move them instead", loops[0][0])
    rest = (np.delete(loop, list(gone.get(i, ())), axis=0) for i, loop in enumerate(loops))
    return tuple(read_only(loop) for i, loop in enumerate(rest) if i == 0 or len(loop) >= 3)


def drawn(points: ArrayLike, size: tuple[int, int]) -> Floats:
    """The (n, 2) vertices, in pixels, of a cage from an outline drawn over a picture of ``size``.

    Of an outline that crosses itself, the largest part is kept. Parts outside the picture are cut
    off. Long edges are divided, so that the whole shape can bend. Raises a GeometryError if the
    outline encloses nothing.
    """
    line = number_pairs(points, "an outline must be a list of pixels (x, y)", GeometryError)
    region = shapely.make_valid(shapely.Polygon(line if len(line) > 2 else None))
    region = shapely.intersection(region, shapely.box(0, 0, *size))
    tolerance = _DRAWN * max(size)
    parts = shapely.get_parts(shapely.get_parts(region))  # a collection may hold several polygons
    parts = [part for part in parts if part.area > tolerance**2]  # lines have no area
    if not parts:
        raise GeometryError("the outline encloses nothing of the picture; draw around the shape")
    ring = max(parts, key=lambda part: part.area).exterior.simplify(tolerance)
    return shapely.get_coordinates(ring.segmentize(_LONGEST * ring.length))[:-1]


def drawn_line(points: ArrayLike, size: tuple[int, int]) -> Floats:
    """The (k, 2) points, in pixels, of a line drawn over a picture of ``size``, without the
    trembling of the hand."""
    line = number_pairs(points, "a cut must be a line of pixels (x, y)", GeometryError)
    if len(line) < 2 or not np.isfinite(line).all():
        return line  # `geometry.cut` says what is wrong
    return shapely.get_coordinates(shapely.LineString(line).simplify(_DRAWN * max(size)))


def nearest_edge(loops: AnyLoops, point: ArrayLike) -> tuple[int, int, Floats]:
    """The edge (loop, index) nearest to a point, and the nearest point on this edge."""
    p, whole = shapely.Point(checked_point(point)), Loops.of(loops)
    nearest = int(np.argmin(shapely.distance(whole.segments, p)))
    loop = int(whole.number[nearest])
    way = shapely.shortest_line(whole.segments[nearest], p)
    return loop, nearest - int(whole.starts[loop]), shapely.get_coordinates(way)[0]


def around(loops: AnyLoops, point: ArrayLike) -> int | None:
    """Index of the loop of the hole that contains a point, or None."""
    holes = enumerate(loops[1:], start=1)
    return next((i for i, loop in holes if contains(loop, point)), None)


def contains(loop: Floats, point: ArrayLike) -> bool:
    return bool(shapely.contains_xy(shapely.Polygon(loop), *checked_point(point)))


def checked_point(point: ArrayLike) -> Floats:
    """The point as a (2,) array. Raises a GeometryError if it is no pair of finite numbers."""
    wanted = f"a point must be a pair of finite numbers, not {point!r:.60}"
    p = number_pairs([point], wanted, GeometryError)[0]
    if not np.isfinite(p).all():
        raise GeometryError(wanted)
    return p


def _loop(loops: AnyLoops, loop: int, index: int) -> Floats:
    if not 0 <= loop < len(loops):
        raise GeometryError(f"there is no loop {loop}; there are {len(loops)}, counted from 0")
    count = len(loops[loop])
    if not 0 <= index < count:
        raise GeometryError(f"{loop_name(loop)} has no vertex {index}; it has {count}, from 0 on")
    return loops[loop]


def _with(loops: AnyLoops, index: int, loop: Floats) -> AnyLoops:
    return (*loops[:index], read_only(loop), *loops[index + 1 :])
