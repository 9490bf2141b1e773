"""Cuts: a cage without a thin slit along a line."""

from numbers import Real
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from glid_nb._arguments import check_type
from glid_nb._arrays import Array, Floats, number_pairs
from glid_nb._errors import about
from glid_nb.geometry._loops import GeometryError, place
from glid_nb.geometry.cage import Cage

# Of the cage's longer side: the default width of a slit, narrow enough to be hardly seen in the
# undeformed picture, and the least one. Pages draw in single precision, which needs that much room
# for the two offsets in the slit.
_WIDTH = 0.004
_LEAST_WIDTH = 1e-4
# In widths: an end of the line that is closer to the boundary is led across it. Otherwise a bridge
# thinner than the slit would remain.
_REACH = 2.0
_MITRE_LIMIT = 2.0  # longest mitre at a sharp corner of the slit, in halves of the width
_CROWDED = 0.5  # in widths: the least distance of a new vertex from its neighbours


def cut(cage: Cage, line: ArrayLike, width: float | None = None) -> tuple[Cage, ...]:
    """Cut a cage along a line: take a thin slit along it out of the shape.

    A part that hung together with the rest along the line, such as an arm drawn across a body,
    becomes loose: a map of the cut cage moves it independently, and in front of the rest where its
    pins have a greater depth. The cut cage is a cage like any other, so proofs hold for it too.

    ``line`` is a list of points (x, y), at least two, in the cage's units. It may begin or end
    outside the shape or in a hole; an end that stops just short of the boundary is led across it. A
    line inside the shape becomes a thin hole. ``width`` is that of the slit, by default 0.004 of
    the longer side of the cage's bounding box, and at least 0.0001 of it.

    Returns the pieces, the largest first. It is one piece unless the line crosses the whole shape.
    Vertices outside the slit stay where they are, and holes that it does not meet stay holes. The
    sides of the slit get vertices as far apart as the cage's own are on average. Scraps smaller
    than the square of the width are left out.

    A GeometryError for points that are no finite numbers, a line without length, one that crosses
    itself or misses the shape, and for a width that is too small or leaves nothing.

    >>> import glid_nb as glid
    >>> cage = glid.Cage([[0, 0], [6, 0], [6, 4], [0, 4]])
    >>> (trousers,) = glid.cut(cage, [[3, -1], [3, 2]])
    >>> trousers.n_vertices, round(trousers.area, 3)
    (8, 23.952)
    >>> left, right = glid.cut(cage, [[2, -1], [2, 5]])[::-1]
    >>> left.bounds
    (0.0, 0.0, 1.988, 4.0)
    """
    check_type("cage", cage, Cage, "make one with Cage(points)")
    width = _checked_width(width, cage)
    path = _led_across(_checked_line(line, cage), cage, width)
    slit = path.buffer(0.5 * width, cap_style="flat", join_style="mitre", mitre_limit=_MITRE_LIMIT)
    slit = slit.segmentize(max(cage.perimeter / cage.n_vertices, width))
    rest = shapely.get_parts(shapely.difference(cage.polygon, slit))
    parts = [part for part in rest if part.area > width**2]
    if not parts:
        raise GeometryError(
            "the cut leaves nothing of the shape; make it narrower",
            path.coords[0],
            f"its width is {width:.6g}",
        )
    parts.sort(key=lambda part: part.area, reverse=True)
    return tuple(_cage_of(part, cage, _CROWDED * width) for part in parts)


def _checked_width(width: float | None, cage: Cage) -> float:
    if width is None:
        return _WIDTH * cage.longer_side
    if not (isinstance(width, Real) and 0 < width <= 1e100):
        raise GeometryError(f"the cut's width must be a positive number, not {width!r:.60}")
    least = _LEAST_WIDTH * cage.longer_side
    if width < least:
        what = f"the cut's width {width:.3g} is too small for an offset cage that pages can draw"
        raise GeometryError(f"{what}; use at least {least:.3g}")
    return float(width)


def _checked_line(line: ArrayLike, cage: Cage) -> shapely.LineString:
    """The line without repeated points, which goes through the cage and does not cross itself."""
    points = number_pairs(line, "a cut must be a line of points (x, y)", GeometryError)
    wrong = np.flatnonzero(~(np.abs(points) <= 1e100).all(axis=1))
    if wrong.size:
        i = int(wrong[0])
        raise GeometryError(f"point {i} of the cut is {tuple(points[i])}; give finite numbers")
    moved = np.ones(len(points), dtype=bool)
    moved[1:] = (np.diff(points, axis=0) != 0).any(axis=1)
    points = points[moved]
    if len(points) < 2:
        raise GeometryError("a cut needs two different points; draw a line across the shape")
    path = shapely.LineString(points)
    if not path.is_simple:
        at = _crossing(points)
        what = "the cut crosses itself; draw it without a loop, or make two cuts"
        raise GeometryError(what, at, f"at {place(at)}")
    if not (cage.polygon.crosses(path) or cage.polygon.contains(path)):
        what = "the cut misses the shape; draw it across the part that should come loose"
        raise GeometryError(what, points[0], f"it begins at {place(points[0])}")
    return path


def _crossing(points: Floats) -> Floats:
    """The first place where a line of points meets itself."""
    edges: Any = shapely.linestrings(np.stack([points[:-1], points[1:]], axis=1))
    e, f = shapely.STRtree(edges).query(edges, predicate="intersects")
    for i, j in sorted(zip(e.tolist(), f.tolist(), strict=True)):
        common = shapely.intersection(edges[i], edges[j])
        # Neighbours always share the point between them, and more only if they fold back.
        if i < j and (j > i + 1 or common.length > 0):
            return shapely.get_coordinates(common)[0]
    raise AssertionError("a line that is not simple meets itself")


def _led_across(path: shapely.LineString, cage: Cage, width: float) -> shapely.LineString:
    """The line, with an end that lies in the shape close to its boundary led across it."""
    points = shapely.get_coordinates(path)
    first, last = (_way_out(points[k], points[j], cage, width) for k, j in ((0, 1), (-1, -2)))
    longer = shapely.LineString([*first, *points, *last])
    return longer if longer.is_simple else path


def _way_out(end: Floats, inner: Floats, cage: Cage, width: float) -> list[Floats]:
    """The point across the boundary to which an end of the line is led; none if it stays."""
    tip, border = shapely.Point(end), cage.polygon.boundary
    gap = border.distance(tip)
    if gap > _REACH * width or not cage.polygon.intersects(tip):
        return []
    onward = (end - inner) / np.hypot(*(end - inner))
    straight = end + (_REACH + 1) * width * onward
    if not cage.polygon.intersects(shapely.Point(straight)):
        return [straight]
    nearest = shapely.get_coordinates(shapely.shortest_line(tip, border))[1]
    sideways = (nearest - end) / gap if gap > 0 else onward
    return [nearest + width * sideways]


def _cage_of(part: shapely.Polygon, cage: Cage, least: float) -> Cage:
    """The cage of a piece, if possible without new vertices that are close to another one."""
    rings = [shapely.get_coordinates(ring)[:-1] for ring in (part.exterior, *part.interiors)]
    thinned = [_thinned(ring, cage, least) for ring in rings]
    try:
        return Cage(thinned[0], thinned[1:])
    except GeometryError:
        with about("the cut shape", GeometryError):
            return Cage(rings[0], rings[1:])


def _thinned(ring: Array, cage: Cage, least: float) -> Array:
    """A ring without edges shorter than ``least`` at the slit, which would make steep coordinates.

    A vertex of the cage stays, and one on its boundary gives way only to such a vertex, which then
    is the corner of the slit. So the boundary elsewhere does not move.
    """
    gap = shapely.distance(cage.polygon.boundary, shapely.points(ring))
    known = set(map(tuple, np.concatenate(cage.loops).tolist()))
    rank = np.where(gap > 1e-9 * cage.longer_side, 2, 1)
    rank[[tuple(vertex) in known for vertex in ring.tolist()]] = 0
    after = np.roll(np.arange(len(ring)), -1)
    short = np.hypot(*(ring[after] - ring).T) < least
    edges = np.flatnonzero(short & ((rank != rank[after]) | (rank == 2)))
    return np.delete(ring, np.where(rank[edges] > rank[after[edges]], edges, after[edges]), axis=0)
