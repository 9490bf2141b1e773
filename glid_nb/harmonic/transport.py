"""Geometries through a map and back, with edges that follow the curves within a tolerance.

The image of a segment of length h departs from its chord by at most ``h^2 / 8 max |f''|``, and
``|f''| <= |f_zz| + |f_zbar zbar|``, which `Jets` bound. The second derivative of the inverse is at
most ``|f''| / sigma_2^3`` (`docs/proof.md`, Lemma 30).
"""

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from glid_nb._arguments import unmet
from glid_nb._arrays import Array, first_masked, is_finite, read_only
from glid_nb._errors import InputError
from glid_nb.geometry import as_points
from glid_nb.harmonic.expansions import jets_at

if TYPE_CHECKING:
    from glid_nb.harmonic.map import HarmonicMap

_TOLERANCE = 1e-3  # of the cage's unit
_MOST_POINTS = 20_000_000
_ROUNDS = 60
_FINER = 3  # how often what is not valid is divided anew, by a tenth of the tolerance
_ON_EDGE = 1e-14  # of the cage's size; vertices this close to an edge touch it
_RESOLUTION = 1e-9  # of the cage's size; what is left of a geometry inside is larger

POINT, LINE, RING, POLYGON = 0, 1, 2, 3  # of shapely.get_type_id
_COLLECT: dict[int, Callable[..., Any]] = {
    4: shapely.multipoints,
    5: shapely.multilinestrings,
    6: shapely.multipolygons,
    7: shapely.geometrycollections,
}


class TransportError(InputError):
    """A geometry, a label image or a tolerance cannot be carried through a map."""


@dataclass(frozen=True, eq=False)
class Transported:
    """Geometries or labels on the other side of a map, and what could not be carried over."""

    geometry: Any
    """What was given, of the same kind: a geometry of shapely, an array of them, GeoJSON, or a
    label image. Arrays of polygons become geometries of shapely."""
    outside: Array
    """Indices of the geometries that lie outside the domain as a whole; they are empty. For a label
    image: the labels that are lost."""
    cut: Array
    """Indices of the geometries of which a part lies outside; it is cut off. For a label image: the
    labels of which a part lies outside."""
    overlapping: Array
    """Indices of the geometries that are not valid on the other side. A locally injective map makes
    such geometries only where its image overlaps itself, or where the tolerance is coarser than
    the geometry. Back through a map: those that lie where the image overlaps itself."""
    tolerance: float
    """Largest distance of edges from the true curves; half a pixel's diagonal for label images."""


class _Side(NamedTuple):
    """One direction of a map: at (k,) complex points images, their errors, bounds on the second
    derivative, and the radius within which these hold."""

    images: Callable[[Array], tuple[Array, Array, Array, Array]]
    region: Any  # the polygon in which geometries are carried over
    several: Callable[[Array], Array]  # where points have several images
    beside: float  # how far the region may lie from the true one


def transport(
    map: "HarmonicMap",
    geometry: Any,
    *,
    tolerance: float | None = None,
    frame: Any = None,
    back: bool = False,
) -> Transported:
    """See `HarmonicMap.transport`."""
    if frame is not None or _is_labels(geometry):
        return _labels(map, _checked_labels(geometry), frame, back)
    tolerance = _checked_tolerance(map, tolerance)
    listed, rebuilt = _listed(geometry)
    side = _backward(map, tolerance) if back else _forward(map)
    inside, outside, cut = _clipped(listed, side, map.domain.cage.longer_side)
    made = _carried(inside, side, tolerance)
    invalid = np.flatnonzero(~shapely.is_valid(made))
    if invalid.size:  # where rings touch, both must turn at the same point
        inside[invalid] = [_noded(one, map.domain.cage.longer_side) for one in inside[invalid]]
        made[invalid] = _carried(inside[invalid], _once_each(side), tolerance)
        invalid = invalid[~shapely.is_valid(made[invalid])]
    finer = tolerance
    for _ in range(_FINER):
        if not invalid.size:
            break
        finer /= 10
        made[invalid] = _carried(inside[invalid], _once_each(side), finer)
        invalid = invalid[~shapely.is_valid(made[invalid])]
    overlapping = np.union1d(invalid, _several(inside, side))
    outside, cut, overlapping = (
        read_only(np.asarray(part, dtype=int)) for part in (outside, cut, overlapping)
    )
    return Transported(rebuilt(made), outside, cut, overlapping, tolerance)


def _once_each(side: _Side) -> _Side:
    """The same direction, with one image for all copies of a point, to the last bit."""

    def images(z: Array) -> tuple[Array, Array, Array, Array]:
        distinct, which = np.unique(z, return_inverse=True)
        value, error, second, radius = side.images(distinct)
        return value[which], error[which], second[which], radius[which]

    return side._replace(images=images)


def _noded(geometry: Any, size: float) -> Any:
    """A polygon, or several, with a vertex wherever another vertex of it lies on an edge."""
    if shapely.get_type_id(geometry) not in (POLYGON, 6):
        return geometry
    corners = np.unique(shapely.get_coordinates(geometry), axis=0)
    points: Any = shapely.points(corners)
    tree = shapely.STRtree(points)

    def noded(ring: Array) -> Array:
        edges: Any = shapely.linestrings(np.stack([ring[:-1], ring[1:]], axis=1))
        edge, corner = tree.query(edges, predicate="dwithin", distance=_ON_EDGE * size)
        share = shapely.line_locate_point(edges[edge], points[corner])
        within = (share > 0) & (share < shapely.length(edges[edge]))
        edge, corner, share = edge[within], corner[within], share[within]
        order = np.lexsort((share, edge))
        return np.insert(ring, edge[order] + 1, corners[corner[order]], axis=0)

    polygons: list[Any] = []
    for part in shapely.get_parts(np.array([geometry])):
        loops = [
            noded(shapely.get_coordinates(ring)) for ring in np.atleast_1d(shapely.get_rings(part))
        ]
        polygons.append(shapely.Polygon(loops[0], loops[1:]))
    whole = shapely.get_type_id(geometry) == POLYGON
    return polygons[0] if whole else shapely.MultiPolygon(polygons)


def _checked_tolerance(map: "HarmonicMap", tolerance: Any) -> float:
    if tolerance is None:
        return _TOLERANCE * map.domain.cage.unit
    known = isinstance(tolerance, int | float | np.number) and not isinstance(tolerance, bool)
    if not (known and is_finite(tolerance) and float(tolerance) > 0):
        raise TransportError(f"tolerance must be a positive number, not {tolerance!r:.40}")
    return float(tolerance)


def _forward(map: "HarmonicMap") -> _Side:
    def images(z: Array) -> tuple[Array, Array, Array, Array]:
        jets = jets_at(map, z)
        return jets.f, jets.f_error, jets.second, jets.radius

    return _Side(images, map.domain.cage.polygon, lambda z: np.zeros(len(z), dtype=bool), 0.0)


def _backward(map: "HarmonicMap", tolerance: float) -> _Side:
    inverse = map.inverse
    edge = _carried(np.array([map.domain.cage.polygon]), _forward(map), tolerance / 4)[0]
    region = edge if edge.is_valid else shapely.buffer(shapely.make_valid(edge), 0)
    # A simple curve winds once around what lies inside. So does the true image of the boundary, as
    # it is nearer to that curve than these points are: they have one preimage.
    once = shapely.buffer(edge, -2 * tolerance) if edge.is_valid else shapely.Polygon()
    shapely.prepare(once)

    def images(w: Array) -> tuple[Array, Array, Array, Array]:
        # The region is a polygon, so points of its edges may lie beside the true image.
        index, z, jets, radius = inverse.nearby(w)
        if len(index) < len(w):
            missing = np.setdiff1d(np.arange(len(w)), index)[0]
            where = f"({np.real(w[missing]):.6g}, {np.imag(w[missing]):.6g})"
            raise TransportError(f"no preimage was found for {where}; take a smaller tolerance")
        s = jets.sigma2_lower
        with np.errstate(all="ignore"):
            # Within half of s / |f''| the smaller singular value is at least s / 2.
            reach = np.minimum(jets.radius, s / (2 * jets.second)) * s / 2
            second = 8 * jets.second / s**3
        known = (s > 0) & np.isfinite(radius)
        return z, radius, np.where(known, second, np.inf), np.where(known, reach, 0.0)

    def several(w: Array) -> Array:
        found = np.zeros(len(w), dtype=bool)
        doubtful = ~shapely.contains_xy(once, np.real(w), np.imag(w))
        found[doubtful] = inverse.locate(w[doubtful], all=True).found > 1
        return found

    return _Side(images, region, several, tolerance)


def _several(geometries: Array, side: _Side) -> Array:
    points, index = shapely.get_coordinates(geometries, return_index=True)
    return np.unique(index[side.several(points @ np.array([1, 1j]))])


def _clipped(geometries: Array, side: _Side, size: float) -> tuple[Array, Array, Array]:
    """The parts inside the region, and indices of those outside and of those that are cut."""
    region, beside_by = side.region, side.beside + _RESOLUTION * size
    shapely.prepare(region)
    whole = shapely.covers(region, geometries) | shapely.is_empty(geometries)
    result, beside = geometries.copy(), np.flatnonzero(~whole)
    if beside.size:
        before = geometries[beside]
        bad = np.flatnonzero(~shapely.is_valid(before))
        if bad.size:
            i = beside[bad[0]]
            reason = shapely.is_valid_reason(geometries[i])
            raise TransportError(f"geometry {i} is not valid, so it cannot be cut: {reason}")
        touching = shapely.intersects(region, before)
        inside = np.full(len(before), None, dtype=object)
        inside[touching] = shapely.intersection(region, before[touching])
        inside[~touching] = shapely.Polygon()
        # What only touches the region leaves points or lines.
        less = shapely.get_dimensions(inside) < shapely.get_dimensions(before)
        mixed = (shapely.get_type_id(inside) == 7) & (shapely.get_type_id(before) != 7)
        for i in np.flatnonzero(mixed):
            parts = shapely.get_parts(inside[i])
            same = shapely.get_dimensions(parts) == shapely.get_dimensions(before[i])
            inside[i] = _multi(parts[same])
        inside[less] = shapely.Polygon()
        result[beside] = inside
        away = shapely.is_empty(inside)
        lost = shapely.area(before) - shapely.area(inside) > beside_by * shapely.length(before)
        of_lines = shapely.get_dimensions(before) == 1
        lost |= of_lines & (shapely.length(before) - shapely.length(inside) > 4 * beside_by)
        lost |= shapely.get_num_geometries(before) != shapely.get_num_geometries(inside)
        return result, beside[away], beside[~away & lost]
    return result, beside, beside


def _multi(parts: Array) -> Any:
    if len(parts) == 1:
        return parts[0]
    return _COLLECT[{0: 4, 1: 5, 2: 6}[int(shapely.get_dimensions(parts[0]))]](parts)


def _carried(geometries: Array, side: _Side, tolerance: float) -> Array:
    """The images of geometries, as an array of the same length."""
    parts, of = shapely.get_parts(geometries, return_index=True)
    parts, of = parts[~shapely.is_empty(parts)], of[~shapely.is_empty(parts)]
    kinds = shapely.get_type_id(parts)
    if (kinds > POLYGON).any():  # collections within collections
        parts = np.array(parts, dtype=object)
        nested = kinds > POLYGON
        parts[nested] = _carried(parts[nested], side, tolerance)
    polygons = np.flatnonzero(kinds == POLYGON)
    rings, of_ring = shapely.get_rings(parts[polygons], return_index=True)
    lines = np.flatnonzero((kinds == LINE) | (kinds == RING))
    points = np.flatnonzero(kinds == POINT)
    paths = np.concatenate([rings, parts[lines], parts[points]])
    made = _images_of(paths, side, tolerance)
    result = parts.copy()
    if len(polygons):
        result[polygons] = shapely.polygons(made[: len(rings)], indices=of_ring)
    result[lines] = made[len(rings) : len(rings) + len(lines)]
    result[points] = made[len(rings) + len(lines) :]
    images = geometries.copy()
    types = shapely.get_type_id(geometries)
    simple = (types <= POLYGON) & ~shapely.is_empty(geometries)
    images[simple] = result[np.searchsorted(of, np.flatnonzero(simple))]
    for kind, collect in _COLLECT.items():
        chosen = np.flatnonzero((types == kind) & ~shapely.is_empty(geometries))
        if chosen.size:
            members = np.isin(of, chosen)
            images[chosen] = collect(result[members], indices=np.searchsorted(chosen, of[members]))
    return images


def _images_of(paths: Array, side: _Side, tolerance: float) -> Array:
    """The images of rings, lines and points, divided as the tolerance asks for."""
    if not len(paths):
        return paths
    xy, of = shapely.get_coordinates(paths, return_index=True)
    z, of = divided(xy @ np.array([1, 1j]), of, side.images, tolerance)
    made = np.full(len(paths), None, dtype=object)
    kinds, images = shapely.get_type_id(paths), as_points(z)
    # Rings close exactly, whatever their ends were computed as.
    for kind, make in ((RING, shapely.linearrings), (LINE, shapely.linestrings)):
        chosen = np.flatnonzero(kinds == kind)
        if chosen.size:
            members = np.isin(of, chosen)
            made[chosen] = make(images[members], indices=np.searchsorted(chosen, of[members]))
    chosen = np.flatnonzero(kinds == POINT)
    made[chosen] = shapely.points(images[np.isin(of, chosen)])
    return made


def divided(
    z: Array,
    of: Array,
    images: Callable[[Array], tuple[Array, Array, Array, Array]],
    tolerance: float,
) -> tuple[Array, Array]:
    """Images of the points of polylines with points added, and the polyline that each belongs to.

    ``of`` numbers the polylines. Every chord of the result is within the tolerance of the exact
    image of its edge.
    """
    value, error, second, radius = images(z)
    edge = np.flatnonzero(of[1:] == of[:-1])
    start, end = z[edge], z[edge + 1]
    length = np.abs(end - start)
    bend = np.where(length <= radius[edge], second[edge], np.inf)
    # Where one disc does not hold an edge, several do: halves, until they do.
    which = np.flatnonzero(np.isinf(bend))
    low, high = np.zeros(len(which)), np.ones(len(which))
    bend[which] = 0
    for _ in range(_ROUNDS):
        if not which.size:
            break
        middle = start[which] + (low + high) / 2 * (end - start)[which]
        _, _, m, r = images(middle)
        holds = length[which] * (high - low) / 2 * (1 + 1e-9) <= r
        np.maximum.at(bend, which[holds], m[holds])
        which, low, high = which[~holds], low[~holds], high[~holds]
        half = (low + high) / 2
        which = np.concatenate([which, which])
        low, high = np.concatenate([low, half]), np.concatenate([half, high])
        if len(which) > _MOST_POINTS:
            break
    bend[which] = np.inf
    largest = error.max(initial=0.0)
    left = tolerance - 2 * largest
    wanted = length * np.sqrt(bend / (8 * left)) if left > 0 else np.full(len(edge), np.inf)
    pieces = np.maximum(np.ceil(wanted * (1 + 1e-9)), 1)
    if not pieces.sum() <= _MOST_POINTS:
        what = f"a tolerance of {tolerance:.3g} needs too many points, or is below the rounding"
        raise TransportError(f"{what} of {largest:.3g}; take a larger one")
    added = pieces.astype(int) - 1
    if not added.any():
        return value, of
    counts = np.ones(len(z), dtype=int)
    counts[edge] += added
    first = np.cumsum(counts) - counts
    result, owner = np.empty(counts.sum(), dtype=complex), np.repeat(of, counts)
    result[first] = value
    own = np.repeat(np.arange(len(edge)), added)
    step = np.arange(len(own)) - np.repeat(np.cumsum(added) - added, added) + 1
    between = start[own] + step / pieces[own] * (end - start)[own]
    result[first[edge[own]] + step] = images(between)[0]
    return result, owner


def _listed(given: Any) -> tuple[Array, Callable[[Array], Any]]:
    """An array of finite geometries, and what makes the given kind of thing of an array."""
    geometries, rebuilt = _read(given)
    xy, of = shapely.get_coordinates(geometries, return_index=True)
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if bad.size:
        x, y = xy[bad[0]]
        what = f"geometry {of[bad[0]]} has a corner at ({x:g}, {y:g})"
        raise TransportError(f"{what}; coordinates must be finite")
    return geometries, rebuilt


def _read(given: Any) -> tuple[Array, Callable[[Array], Any]]:
    if isinstance(given, shapely.Geometry):
        return np.array([given], dtype=object), lambda made: made[0]
    if isinstance(given, Mapping):
        return _of_geojson(given)
    if (interface := getattr(given, "__geo_interface__", None)) is not None and not hasattr(
        given, "__len__"
    ):
        return _of_geojson(interface)
    try:
        items = list(given)
    except TypeError:
        what = f"{type(given).__name__} is no geometry; give one of shapely, GeoJSON, arrays"
        raise TransportError(f"{what} of polygons or a label image") from None
    result = np.empty(len(items), dtype=object)
    for i, item in enumerate(items):
        if item is None:
            result[i] = shapely.Polygon()
        elif isinstance(item, shapely.Geometry):
            result[i] = item
        else:
            result[i] = _polygon(item, i)
    return result, lambda made: made


def _polygon(ring: Any, number: int) -> Any:
    wanted = f"polygon {number} must be a (k, 2) array of at least 3 points"
    if (masked := first_masked(ring)) is not None:
        raise TransportError(f"point {masked} of polygon {number} is masked; leave it out")
    try:
        corners = np.asarray(ring, dtype=float)
    except (TypeError, ValueError) as error:
        raise TransportError(f"{wanted} ({error})") from None
    if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 3:
        raise TransportError(f"{wanted}; the shape is {corners.shape}")
    if not np.isfinite(corners).all():
        raise TransportError(f"polygon {number} has coordinates that are not finite")
    return shapely.Polygon(corners)


def _of_geojson(data: Mapping[str, Any]) -> tuple[Array, Callable[[Array], Any]]:
    kind = data.get("type")
    if kind == "FeatureCollection":
        features = list(data.get("features") or ())
    elif kind == "Feature":
        features = [data]
    else:
        return np.array([_shape(data)], dtype=object), lambda made: _mapping(made[0])
    for i, one in enumerate(features):
        if not isinstance(one, Mapping):
            kind = type(one).__name__
            raise TransportError(f"feature {i} of the GeoJSON must be a mapping, not {kind}")
    shapes = np.empty(len(features), dtype=object)
    shapes[:] = [_shape(one.get("geometry")) for one in features]

    def rebuilt(made: Array) -> Any:
        new = [
            {**one, "geometry": _mapping(image)} for one, image in zip(features, made, strict=True)
        ]
        return {**data, "features": new} if kind == "FeatureCollection" else new[0]

    return shapes, rebuilt


def _shape(geometry: Any) -> Any:
    if geometry is None:
        return shapely.Polygon()
    if not (isinstance(geometry, Mapping) and isinstance(geometry.get("type"), str)):
        raise TransportError('the GeoJSON is not valid: a geometry is a mapping with a "type"')
    try:
        return shapely.geometry.shape(dict(geometry))
    except (TypeError, ValueError, KeyError, AttributeError, shapely.errors.ShapelyError) as error:
        raise TransportError(f"the GeoJSON is not valid: {error}") from None


def _mapping(geometry: Any) -> dict[str, Any] | None:
    """GeoJSON, None for an empty geometry."""
    return None if geometry.is_empty else dict(shapely.geometry.mapping(geometry))


# Labels


def _is_labels(given: Any) -> bool:
    kind = getattr(getattr(given, "dtype", None), "kind", "")
    return getattr(given, "ndim", 0) == 2 and kind != "" and kind in "iub"


def _checked_labels(given: Any) -> NDArray[Any]:
    """(h, w) whole numbers of their own type."""
    if isinstance(given, np.ma.MaskedArray) and np.ma.getmaskarray(given).any():
        raise TransportError("the label image is masked; fill it, for example with 0")
    try:
        labels = np.asarray(given)
    except ValueError as error:
        raise TransportError(f"a label image is (h, w) whole numbers: {error}") from None
    if labels.dtype.kind not in "iub" or labels.ndim != 2 or not labels.size:
        what = f"{labels.dtype.name} values of the shape {labels.shape}"
        wanted = "a frame is for a label image, (h, w) whole numbers"
        hint = "geometries are in the map's coordinates and take none"
        raise TransportError(f"{wanted}, not {what}; {hint}")
    return labels


def _check_frame(frame: Any) -> None:
    if not all(hasattr(frame, one) for one in ("width", "height", "to_world", "to_pixel")):
        wanted = "such as glid_nb.PixelFrame(width, height)"
        raise TransportError(f"frame must be the place of pixels, {wanted}, not {frame!r:.40}")


def _labels(map: "HarmonicMap", labels: NDArray[Any], frame: Any, back: bool) -> Transported:
    """Each pixel takes the label that its centre comes from; 0 where it comes from nowhere."""
    if frame is None:
        raise TransportError(
            "a label image needs its place: give frame=glid_nb.PixelFrame(width, height)"
        )
    _check_frame(frame)
    height, width = labels.shape
    if (frame.width, frame.height) != (width, height):
        given = f"the labels have {height} rows and {width} columns"
        swapped = (frame.width, frame.height) == (height, width)
        hint = "; rows and columns are swapped" if swapped else ""
        raise TransportError(
            f"{given}, the frame is {frame.width} wide and {frame.height} high{hint}"
        )
    # In the order of rows, which ravel() below relies on.
    result, several = np.zeros(labels.shape, labels.dtype), np.zeros(labels.shape, dtype=bool)
    centres = frame.to_world(pixel_centres(width, height))
    if back:
        known = map.domain.cage.contains(centres)
        sources = as_points(jets_at(map, centres[known] @ np.array([1, 1j])).f)
    else:
        found = map.inverse.locate(centres, all=True)
        known, first = found.found > 0, np.diff(found.index, prepend=-1) > 0
        sources, several = found.points[first], (found.found > 1).reshape(labels.shape)
    column, row = np.floor(frame.to_pixel(sources)).astype(int).T
    there = (row >= 0) & (row < height) & (column >= 0) & (column < width)
    chosen = np.flatnonzero(known)[there]
    result.ravel()[chosen] = labels[row[there], column[there]]
    before, after = np.unique(labels), np.unique(result)
    region = map.inverse(centres) if back else centres
    inside = map.domain.cage.contains(region).reshape(labels.shape)
    cut = np.intersect1d(np.unique(labels[~inside]), after)
    parts = np.setdiff1d(before, after), cut, np.unique(result[several])
    lost, cut, overlapping = (read_only(part[part != 0]) for part in parts)
    return Transported(result, lost, cut, overlapping, 0.5 * np.sqrt(2) * frame.units_per_pixel)


@functools.lru_cache(maxsize=2)
def pixel_centres(width: int, height: int) -> Array:
    """(width * height, 2) centres of pixels, row by row."""
    y, x = np.mgrid[:height, :width] + 0.5
    return read_only(np.stack([x, y], axis=-1).reshape(-1, 2))


# Displacements


@dataclass(frozen=True, eq=False)
class DisplacementField:
    """A map or its inverse as displacements on a grid. `glid_nb.audit` says whether it folds.

    Coordinates are pixels of the frame, x right and y down from the picture's top left corner.
    """

    values: Array
    """(rows, columns, 2): x and y of the displacement; 0 where there is none."""
    known: Array
    """(rows, columns) bool: where the map is defined."""
    origin: tuple[float, float]
    """x and y of the first sample."""
    spacing: tuple[float, float]
    """x and y from a sample to the next."""
    error: float
    """Proved bound on the error of bilinear interpolation, in pixels: in all cells that lie in the
    domain, or for the inverse in the image. Infinite where nothing is proved: for the inverse of a
    map whose image overlaps itself."""
    inverse: bool
    """Whether these are displacements of the inverse, which resamplers ask for."""

    def at(self, pixels: Any) -> Array:
        """(k, 2) displacements at (k, 2) pixels by bilinear interpolation, by the nearest cell
        outside of the grid."""
        given = np.reshape(np.asarray(pixels, dtype=float), (-1, 2))
        rows, columns = self.known.shape
        x, y = ((given - self.origin) / self.spacing).T
        i = np.clip(np.floor(y).astype(int), 0, max(rows - 2, 0))
        j = np.clip(np.floor(x).astype(int), 0, max(columns - 2, 0))
        v, u = (y - i)[:, None], (x - j)[:, None]
        i1, j1 = np.minimum(i + 1, rows - 1), np.minimum(j + 1, columns - 1)
        top = (1 - u) * self.values[i, j] + u * self.values[i, j1]
        return (1 - v) * top + v * ((1 - u) * self.values[i1, j] + u * self.values[i1, j1])

    @property
    def vectors(self) -> Array:
        """(k, 2, 2) start and displacement of each known sample, as (row, column): napari's
        layer of vectors. In napari, (0, 0) is the centre of the first pixel."""
        row, column = np.nonzero(self.known)
        start = np.stack([row, column], axis=1) * self.spacing[::-1] + self.origin[::-1] - 0.5
        return np.stack([start, self.values[row, column][:, ::-1]], axis=1)


def displacement_field(
    map: "HarmonicMap", frame: Any, shape: Any = None, *, inverse: bool = False
) -> DisplacementField:
    """See `HarmonicMap.displacement_field`."""
    _check_frame(frame)
    listed = (frame.height, frame.width) if shape is None else shape
    size: tuple[Any, ...] = tuple(listed) if isinstance(listed, list | tuple | np.ndarray) else ()
    whole = len(size) == 2 and not any(unmet(int, one, {"least": 2}) for one in size)
    if not whole:
        raise TransportError(f"shape must be (rows, columns), at least 2 each, not {shape!r:.40}")
    rows, columns = size
    spacing = frame.width / columns, frame.height / rows
    origin = spacing[0] / 2, spacing[1] / 2
    pixels = (pixel_centres(columns, rows)) * spacing
    w = frame.to_world(pixels)
    values = np.zeros((rows * columns, 2))
    if inverse:
        found = map.inverse.locate(w, all=True)
        known = found.found > 0
        values[found.index] = frame.to_pixel(found.points) - pixels[found.index]
        side = _backward(map, _TOLERANCE * map.domain.cage.unit)
        region, images = side.region, side.images
    else:
        known = map.domain.cage.contains(w)
        f = as_points(jets_at(map, w[known] @ np.array([1, 1j])).f)
        values[known] = frame.to_pixel(f) - pixels[known]
        region, images = map.domain.cage.polygon, _forward(map).images
    known = known.reshape(rows, columns)
    cells = known[1:, 1:] & known[:-1, 1:] & known[1:, :-1] & known[:-1, :-1]
    grid = w.reshape(rows, columns, 2) @ np.array([1, 1j])
    corner, opposite = grid[:-1, :-1][cells], grid[1:, 1:][cells]
    x0, x1 = np.sort([corner.real, opposite.real], axis=0)
    y0, y1 = np.sort([corner.imag, opposite.imag], axis=0)
    whole_cells = shapely.contains(region, shapely.box(x0, y0, x1, y1))
    error = _cell_error((corner + opposite)[whole_cells] / 2, opposite - corner, images)
    if inverse and (found.found > 1).any():  # neighbours may come from different sheets
        error = float("inf")
    values = values.reshape(rows, columns, 2)
    pixels_off = error / frame.units_per_pixel
    return DisplacementField(
        read_only(values), read_only(known), origin, spacing, pixels_off, inverse
    )


def _cell_error(
    middle: Array, diagonal: Array, images: Callable[[Array], tuple[Array, Array, Array, Array]]
) -> float:
    """Bounds the error of bilinear interpolation on equal cells: (hx^2 + hy^2) / 8 max |f''|."""
    if not len(middle):
        return 0.0
    full = np.abs(diagonal[0])
    step, half = diagonal[0] / 4, full / 2
    most, off = 0.0, 0.0
    for _ in range(_ROUNDS):
        _, error, second, radius = images(middle)
        holds = half <= radius
        most = max(most, second[holds].max(initial=0.0))
        off = max(off, error.max(initial=0.0))
        middle = middle[~holds]
        if not len(middle) or 4 * len(middle) > _MOST_POINTS:
            break
        corners = np.array([step, -step, step.conjugate(), -step.conjugate()])
        middle = (middle[:, None] + corners).ravel()
        step, half = step / 2, half / 2
    return float("inf") if len(middle) else float(full**2 / 8 * most * (1 + 1e-9) + 2 * off)
