"""The cage: a checked, immutable polygon with holes."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Array, Rebuilt, frozen, number_pairs, real_array
from glid_nb.geometry import _loops
from glid_nb.geometry._loops import GeometryError, Loops, loop_name, place, plain_name

# Parts of the boundary closer than this share of the cage's size count as touching. It is a few
# thousand roundings: below it, offsets and normal directions cannot be computed.
_RESOLUTION = 1e-12
_CLOSED = 1e-9  # of a loop's size; a last vertex this close to the first repeats it
_EDGES = 64  # edges that are tested for crossings at a time


@dataclass(frozen=True, eq=False, init=False)
class Cage(Rebuilt):
    """A bounded polygon with any number of holes; the boundary P of the certified domain.

    Loops list their vertices in order, in either direction, as pairs or as complex numbers. A last
    vertex that repeats the first is left out. Instead of a loop, ``exterior`` may be a polygon of
    shapely or another object with a ``__geo_interface__``, a polygon or feature of GeoJSON, or a
    list of rings, the exterior first.

    The constructor checks what the package relies on: finite coordinates, at least three distinct
    vertices per loop, loops that neither cross nor touch themselves or each other, every hole
    inside the exterior and outside every other hole. If not, a GeometryError names the loop, the
    vertex and its place. Loops are reversed if needed, with vertex 0 still first, so that the
    domain lies to the left of the boundary.
    """

    exterior: NDArray[np.float64]
    """(n, 2) read-only, counter-clockwise."""
    holes: tuple[NDArray[np.float64], ...]
    """Each (k, 2) read-only, clockwise."""

    def __init__(self, exterior: Any, holes: Iterable[Any] = ()) -> None:
        rings = _rings_of(exterior, holes)
        loops = [_checked_vertices(ring, loop_name(i)) for i, ring in enumerate(rings)]
        _check_loops(loops)
        for i, loop in enumerate(loops):
            if (_loops.signed_area(loop) > 0) != (i == 0):
                loop[1:] = loop[:0:-1].copy()
        oriented = map(frozen, loops)
        vars(self).update(exterior=next(oriented), holes=tuple(oriented))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The cage of a mapping with the keys ``cage`` and, optionally, ``holes``."""
        if "cage" not in data:
            raise GeometryError("the key 'cage' is missing: give the exterior loop there")
        return cls(data["cage"], _loops.loop_list(data.get("holes"), "holes"))

    def to_dict(self) -> dict[str, Any]:
        """The loops as nested lists under the keys ``cage`` and ``holes``, ready for JSON."""
        return {"cage": self.exterior.tolist(), "holes": [hole.tolist() for hole in self.holes]}

    @property
    def loops(self) -> tuple[NDArray[np.float64], ...]:
        """The exterior loop, then the holes."""
        return (self.exterior, *self.holes)

    @cached_property
    def loops_complex(self) -> tuple[NDArray[np.complex128], ...]:
        """The loops as read-only complex128 arrays x + iy."""
        return tuple(frozen(loop[:, 0] + 1j * loop[:, 1]) for loop in self.loops)

    def equals(self, other: Self) -> bool:
        """Whether all loops have the same vertices in the same order."""
        pairs = zip(self.loops, other.loops, strict=False)
        return self.n_holes == other.n_holes and all(np.array_equal(a, b) for a, b in pairs)

    @property
    def n_holes(self) -> int:
        """Number of hole loops."""
        return len(self.holes)

    @property
    def n_vertices(self) -> int:
        """Number of vertices over all loops."""
        return sum(len(loop) for loop in self.loops)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box (xmin, ymin, xmax, ymax)."""
        return self.polygon.bounds

    @property
    def longer_side(self) -> float:
        """Longer side of the bounding box."""
        xmin, ymin, xmax, ymax = self.bounds
        return max(xmax - xmin, ymax - ymin)

    @property
    def unit(self) -> float:
        """A twentieth of the longer side: about the world unit of a traced picture."""
        return self.longer_side / 20

    @cached_property
    def area(self) -> float:
        """Area of the domain without its holes."""
        return float(sum(_loops.signed_area(loop) for loop in self.loops))

    @cached_property
    def perimeter(self) -> float:
        """Length of the boundary over all loops."""
        whole = Loops.of(self.loops)
        return float(sum(lengths.sum() for lengths in whole.split(whole.lengths)))

    @cached_property
    def polygon(self) -> shapely.Polygon:
        """The domain as a prepared shapely polygon."""
        polygon = shapely.Polygon(self.exterior, self.holes)
        shapely.prepare(polygon)
        return polygon

    def contains(self, points: ArrayLike, tolerance: float = 0.0) -> NDArray[np.bool_]:
        """Which of the (..., 2) points lie in the closed domain. Points with NaN do not.

        Points outside by at most the tolerance count as inside. The tolerance is at least 1e-12 of
        the cage's size, so that rounded boundary points count as inside.
        """
        try:
            xy = real_array(points)
        except (TypeError, ValueError) as error:
            raise GeometryError(f"points must be pairs of numbers ({error})") from error
        if xy.shape[-1:] != (2,):
            raise GeometryError(f"points must have the shape (..., 2), not {xy.shape}")
        if not tolerance >= 0:
            raise GeometryError(f"tolerance must be at least 0, not {tolerance}")
        flat = xy.reshape(-1, 2)
        rounding = _RESOLUTION * max(self.longer_side, float(np.abs(self.bounds).max()))
        reach = max(tolerance, rounding)
        inside = shapely.intersects_xy(self.polygon, flat[:, 0], flat[:, 1])
        rest = np.flatnonzero(~inside)
        if rest.size:
            # Distances are slow; a wider polygon rules out most points.
            wider = shapely.buffer(self.polygon, 2 * max(reach, 1e-4 * self.longer_side))
            shapely.prepare(wider)
            rest = rest[shapely.intersects_xy(wider, flat[rest, 0], flat[rest, 1])]
            inside[rest] = shapely.dwithin(self.polygon, shapely.points(flat[rest]), reach)
        return inside.reshape(xy.shape[:-1])


def _rings_of(shape: Any, holes: Any) -> list[Any]:
    """The exterior and the holes of anything that a cage can be made of."""
    if isinstance(shape, Cage):
        raise GeometryError("it is a cage already; use it as it is, or give its exterior and holes")
    holes = () if holes is None else holes
    holes = holes if _geo_interface(holes) is None else [holes]
    if (geometry := _geo_interface(shape)) is not None:
        rings = _rings_of_geometry(geometry)
    elif _depth(shape) == 3:
        rings = list(shape)
    else:
        return [shape, *([holes] if _is_loop(holes) else holes)]
    if len(rings) > 1 and len(given := list(holes)):
        both = f"{len(rings) - 1} holes come with the exterior and {len(given)} beside it"
        raise GeometryError(f"{both}; give holes in one of the two ways")
    return [*rings, *holes]


def _is_loop(holes: Any) -> bool:
    """Whether it is one loop of pairs, not a list of loops."""
    return _depth(holes) == 2 and not np.iscomplexobj(holes[0])


def _rings_of_geometry(geometry: Mapping[str, Any]) -> list[Any]:
    if geometry.get("type") == "Feature":
        geometry = geometry.get("geometry") or {}
    kind, parts = geometry.get("type"), geometry.get("coordinates", ())
    if kind == "MultiPolygon" and len(parts) == 1:
        kind, parts = "Polygon", parts[0]
    if kind in ("LinearRing", "LineString"):
        kind, parts = "Polygon", [parts]
    if kind == "Polygon" and len(parts) == 0:
        raise GeometryError("the polygon is empty")
    if kind != "Polygon":
        count = f" of {len(parts)} parts" if kind == "MultiPolygon" else ""
        raise GeometryError(f"a cage is made of one polygon, not of a {kind}{count}; give one part")
    return [[point[:2] for point in ring] for ring in parts]  # without z


def _geo_interface(shape: Any) -> Mapping[str, Any] | None:
    """The GeoJSON of a shape, or of a mapping that is GeoJSON itself."""
    if isinstance(shape, Mapping) and "type" in shape:
        return shape
    return getattr(shape, "__geo_interface__", None)


def _depth(value: Any) -> int:
    """The nesting depth of lists or arrays, by their first elements: 2 for a loop of vertices."""
    if isinstance(value, np.ndarray):
        return value.ndim
    if not isinstance(value, list | tuple):
        return 0
    first: list[Any] = list(value[:1])
    return 1 + _depth(first[0]) if first else 0


def _checked_vertices(vertices: Any, name: str) -> Array:
    """A float64 copy of (n, 2) finite vertices, n >= 3, without a last one equal to the first."""
    if (geometry := _geo_interface(vertices)) is not None:
        vertices = _rings_of_geometry(geometry)[0]
    pairs = f"{name}: vertices must be pairs of numbers [[x, y], ...]"
    loop = number_pairs(vertices, pairs, GeometryError)
    if len(loop) > 3 and np.abs(loop[-1] - loop[0]).max() <= _CLOSED * np.ptp(loop, axis=0).max():
        loop = loop[:-1].copy()
    if len(loop) < 3:
        raise GeometryError(f"{name}: {len(loop)} vertices given, a loop needs at least 3")
    wrong = np.flatnonzero(~(np.abs(loop) <= 1e100).all(axis=1))
    if wrong.size:
        x, y = loop[wrong[0]]
        problem = f"is ({x}, {y}); replace the NaN or infinite coordinate or leave it out"
        if np.isfinite([x, y]).all():
            problem = f"at {place([x, y])} is too large to compute with; rescale the cage"
        raise GeometryError(f"{name}: vertex {wrong[0]} {problem}")
    return loop


def _check_loops(loops: list[Array]) -> None:
    """Raise unless the loops, the exterior first, bound a domain."""
    corners = np.concatenate(loops)
    resolution = _RESOLUTION * float(max(np.ptp(corners, axis=0).max(), np.abs(corners).max()))
    for i, loop in enumerate(loops):
        check_distinct(loop, i, resolution)
        _check_not_flat(loop, i, resolution)
        _check_fold_back(loop, i, resolution)
    _check_crossings(loops, resolution)
    _check_nesting(loops)


def check_distinct(loop: Array, number: int, resolution: float) -> None:
    """Raise where two vertices of a loop are closer than ``resolution``; 0 is the exterior."""
    name, plain = loop_name(number), plain_name(number)
    # Two of the copies are enough; thousands in one place would make millions of pairs.
    first = np.unique(loop, axis=0, return_index=True)[1]
    copies = np.setdiff1d(np.arange(len(loop)), first)
    kept = np.union1d(first, copies[:2])
    points: Any = shapely.points(loop[kept])
    near = shapely.STRtree(points).query(points, predicate="dwithin", distance=resolution)
    pairs = sorted((i, j) for i, j in kept[near].T.tolist() if i < j)
    if not pairs:
        return
    i, j = pairs[0]
    closes = pairs == [(0, len(loop) - 1)]
    problem = "touches itself; move one of the points that meet"
    if closes or j == i + 1:
        problem = "has two points in one place; leave one of them out"
    what = f"{name}: vertices {i} and {j} coincide at {place(loop[i])}"
    if closes:
        what = f"{name}: the last vertex {j} repeats vertex 0 at {place(loop[0])}; loops close by "
        what += "themselves, leave the last vertex out"
    raise GeometryError(f"{plain} {problem}", loop[i], what)


def _check_not_flat(loop: Array, number: int, resolution: float) -> None:
    arms = loop - loop[0]
    far = int(np.argmax(np.hypot(*arms.T)))
    axis = arms[far] / np.hypot(*arms[far])
    if np.abs(arms[:, 0] * axis[1] - arms[:, 1] * axis[0]).max() <= resolution:
        plain = "is flat, so its area is zero; move one of its points off the line, or remove it"
        what = f"{loop_name(number)}: all {len(loop)} vertices lie on one line, through vertex 0 at"
        what += f" {place(loop[0])} and vertex {far} at {place(loop[far])}"
        raise GeometryError(f"{plain_name(number)} {plain}", loop[0], what)


def _check_fold_back(loop: Array, number: int, resolution: float) -> None:
    after = Loops.of([loop]).segments
    before = np.roll(after, 1)
    corner_before, corner_after = np.roll(loop, 1, axis=0), np.roll(loop, -1, axis=0)
    near_after = shapely.distance(before, shapely.points(corner_after)) <= resolution
    near_before = shapely.distance(after, shapely.points(corner_before)) <= resolution
    folded = np.flatnonzero(near_after | near_before)
    if folded.size:
        i, n = int(folded[0]), len(loop)
        plain = f"{plain_name(number)} has a spike without width; leave out its tip"
        both = f"{loop_name(number)}: the edges {_edge((i - 1) % n, n)} and {_edge(i, n)}"
        what = f"{both} lie on top of each other up to vertex {i} at {place(loop[i])}"
        raise GeometryError(plain, loop[i], what)


def _check_crossings(loops: list[Array], resolution: float) -> None:
    """Raise for the first pair of edges that cross, or else touch other than as neighbours."""
    whole = Loops.of(loops)
    edges, number, sizes = whole.segments, whole.number, np.diff(whole.starts)
    index = np.arange(len(edges)) - whole.starts[number]
    tree, found = shapely.STRtree(edges), None
    # Some edges at a time: a tangle has millions of crossings, and the first one is enough.
    for start in range(0, len(edges), _EDGES):
        chunk = edges[start : start + _EDGES]
        e, f = tree.query(chunk, predicate="dwithin", distance=resolution)
        e += start
        step = np.where(number[e] == number[f], index[f] - index[e], -1)
        apart = (e < f) & (step != 1) & (step != sizes[number[e]] - 1)
        e, f = e[apart], f[apart]
        crossing = shapely.crosses(edges[e], edges[f])
        if crossing.any() or (found is None and len(e)):
            first = np.lexsort((f, e, ~crossing))[0]
            found = int(e[first]), int(f[first]), bool(crossing[first])
        if crossing.any():
            break
    if found is None:
        return
    e, f, crosses = found
    pair = edges[e], edges[f]
    common = shapely.get_coordinates(shapely.intersection(*pair))
    point = common[0] if len(common) else shapely.get_coordinates(shapely.shortest_line(*pair))[0]
    a, b = int(number[e]), int(number[f])
    edge_a, edge_b = (_edge(int(index[i]), int(sizes[number[i]])) for i in (e, f))
    verb = "cross" if crosses else "touch"
    if a != b:
        plain = f"{plain_name(b)} {verb}es {plain_name(a)}; move it away or merge the two"
        name_a = "the exterior loop" if a == 0 else loop_name(a)
        what = f"edge {edge_b} of {loop_name(b)} and edge {edge_a} of {name_a}"
    else:
        advice = "move the points apart that meet"
        if crosses:
            advice = "move its points, or change their order, so that no two sides cross"
        plain = f"{plain_name(a)} {verb}es itself; {advice}"
        what = f"{loop_name(a)}: the edges {edge_a} and {edge_b}"
    raise GeometryError(plain, point, f"{what} {verb} at {place(point)}")


def _check_nesting(loops: list[Array]) -> None:
    # The loops are known not to meet, so one vertex of each decides for the whole loop.
    starts: Any = shapely.points(np.array([loop[0] for loop in loops]))
    regions = [shapely.Polygon(loop) for loop in loops]
    outer, inner = shapely.STRtree(starts).query(regions, predicate="contains")
    around = sorted(zip(outer.tolist(), inner.tolist(), strict=True))
    for i, loop in enumerate(loops[1:], start=1):
        if (i, 0) in around:
            plain = f"{plain_name(i)} lies around the outline; swap the two"
            what = f"vertex 0 of the exterior loop at {place(loops[0][0])} lies in {loop_name(i)}"
            raise GeometryError(plain, loops[0][0], what)
        if (0, i) not in around:
            plain = f"{plain_name(i)} lies outside the outline; remove it or move it inside"
            what = f"vertex 0 of {loop_name(i)} at {place(loop[0])} is not in the exterior loop"
            raise GeometryError(plain, loop[0], what)
    for o, i in around:
        if o > 0:
            plain = f"{plain_name(i)} lies within {plain_name(o)}, where there is nothing to cut"
            what = f"vertex 0 of {loop_name(i)} is at {place(loops[i][0])}"
            raise GeometryError(f"{plain} out; remove the inner one", loops[i][0], what)


def _edge(i: int, n: int) -> str:
    return f"{i}-{(i + 1) % n}"
