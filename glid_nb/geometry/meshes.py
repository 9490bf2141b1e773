"""Triangle meshes of a cage, and the piecewise linear maps on them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import pythoncdt
import scipy
import shapely
from numpy.typing import ArrayLike, NDArray

from glid_nb._arguments import check_type
from glid_nb._arrays import Array, Rebuilt, frozen, number_pairs, real_array
from glid_nb.geometry import _loops
from glid_nb.geometry._loops import GeometryError, Loops, place
from glid_nb.geometry.cage import Cage

# Least distances of lattice points, in spacings: from the boundary, because closer ones make flat
# triangles, and from wanted points.
_MARGIN, _CLEARANCE = 0.55, 0.6
_SAME = 1e-9  # points closer than this share of the cage's size count as one
_ROUNDING = 1e-12  # points off the mesh by this share of its coordinates count as on it
_BESIDE = 1e-7  # places beside an image triangle by this share of its size count as on it
_FEW = 16  # places for which no tree of the triangles is made
_ROW = np.sqrt(3.0) / 2.0  # height of a lattice row, in spacings


@dataclass(frozen=True, eq=False)
class Triangulation(Rebuilt):
    """A triangle mesh of a cage."""

    vertices: NDArray[np.float64]
    """(v, 2) positions; the first `n_boundary` lie on the cage, loop by loop in order."""
    triangles: NDArray[np.int32]
    """(t, 3) int32 vertex indices, counter-clockwise."""
    n_boundary: int

    def __post_init__(self) -> None:
        vars(self).update(vertices=frozen(self.vertices), triangles=frozen(self.triangles))

    @cached_property
    def graph(self) -> scipy.sparse.csr_array:
        """(v, v) lengths of the edges, symmetric."""
        a, b = self.triangles.ravel(), np.roll(self.triangles, -1, axis=1).ravel()
        lengths = np.linalg.norm(self.vertices[a] - self.vertices[b], axis=1)
        # All triangles are counter-clockwise, so no directed edge occurs twice.
        shape = (len(self.vertices),) * 2
        one_way: Any = scipy.sparse.coo_array((lengths, (a, b)), shape=shape).tocsr()
        return one_way.maximum(one_way.T)

    @cached_property
    def border(self) -> list[NDArray[np.int64]]:
        """The loops of edges that belong to one triangle only, as numbers of their vertices.

        The exterior runs counter-clockwise, holes clockwise.
        """
        starts, ends = self.triangles.ravel(), np.roll(self.triangles, -1, axis=1).ravel()
        edges = set(zip(starts.tolist(), ends.tolist(), strict=True))
        # All triangles are counter-clockwise, so an edge inside runs once in each direction.
        following = {a: b for a, b in sorted(edges) if (b, a) not in edges}
        loops = list[NDArray[np.int64]]()
        while following:
            loop = [next(iter(following))]
            while loop[-1] in following:
                loop.append(following.pop(loop[-1]))
            loops.append(np.array(loop[:-1]))
        return loops

    @cached_property
    def _tree(self) -> shapely.STRtree:
        triangles: Any = shapely.polygons(self.vertices[self.triangles])
        return shapely.STRtree(triangles)

    def find(self, x: Any, y: Any) -> NDArray[np.int64]:
        """The triangle of each point, -1 for none; x and y are numbers or arrays."""
        places: Any = np.asarray(shapely.points(x, y), dtype=object)
        triangle = np.full(places.shape, -1)
        which, found = self._tree.query(places.ravel(), predicate="intersects")
        triangle.flat[which] = found
        return triangle

    def covers(self, points: Array) -> NDArray[np.bool_]:
        """Which of (k, 2) points lie on the mesh, including rounded points of its boundary."""
        on = self.find(*points.T) >= 0
        beside = np.asarray(shapely.points(points[~on]), dtype=object)
        tolerance = _ROUNDING * max(float(np.abs(self.vertices).max()), 1e-300)
        nearest = self._tree.geometries[self._tree.nearest(beside)]
        on[~on] = shapely.distance(nearest, beside) <= tolerance
        return on

    def weights(self, points: ArrayLike) -> Any:
        """(k, v) sparse: interpolates at (k, 2) points; off the mesh by the nearest triangle."""
        points = np.reshape(np.asarray(points, dtype=float), (-1, 2))
        triangle = self.find(*points.T)
        beside = triangle < 0
        triangle[beside] = self._tree.nearest(np.asarray(shapely.points(points[beside])))
        corners = self.triangles[triangle]
        weights = barycentric(self.vertices[corners], points)
        rows, shape = np.repeat(np.arange(len(points)), 3), (len(points), len(self.vertices))
        return scipy.sparse.csr_array((weights.ravel(), (rows, corners.ravel())), shape)


@dataclass(frozen=True, eq=False)
class MeshMap(Rebuilt):
    """A triangle mesh and the images of its vertices."""

    triangulation: Triangulation
    images: Array
    """(v, 2), world coordinates."""

    def __post_init__(self) -> None:
        images = frozen(np.array(self.images, dtype=float))
        if images.shape != (shape := self.triangulation.vertices.shape):
            given = f"there are images of shape {images.shape} for vertices of shape {shape}"
            raise ValueError(f"{given}; give one image per vertex")
        object.__setattr__(self, "images", images)

    def __call__(self, points: ArrayLike, *, outside: Literal["extend", "nan"] = "extend") -> Array:
        """Images of (k, 2) points, by NumPy.

        A point off the mesh moves with the nearest triangle (``outside="extend"``, the default), or
        its image is NaN ("nan").
        """
        if outside not in ("extend", "nan"):
            raise GeometryError(f"outside must be 'extend' or 'nan', not {outside!r:.40}")
        if "Tracer" in type(points).__name__:
            what = "a map of a mesh looks its triangles up on the host, so JAX cannot trace it"
            raise GeometryError(f"{what}; pass an array of NumPy, or use a HarmonicMap")
        listed = np.asarray(points) if np.iscomplexobj(points) else points
        pairs = _loops.as_points(listed) if np.iscomplexobj(listed) else real_array(listed)
        xy = np.atleast_2d(pairs)
        if xy.ndim != 2 or xy.shape[1] != 2:
            raise GeometryError(f"points have shape {xy.shape}; expected (k, 2)")
        images = self.triangulation.weights(xy) @ self.images
        if outside == "nan":
            images[~self.triangulation.covers(xy)] = np.nan
        return images

    @property
    def areas(self) -> Array:
        """(t,) signed areas of the image triangles."""
        a, b, c = np.moveaxis(self.images[self.triangulation.triangles], 1, 0)
        u, v = b - a, c - a
        return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])

    @property
    def flipped(self) -> Array:
        """(t,) bool: image triangles that are turned over or flat."""
        return ~(self.areas > 0)


class Overlay:
    """The images of a mesh's triangles, and which of them lie over a place."""

    def __init__(self, mesh: Triangulation, images: Array) -> None:
        self._mesh, self._corners = mesh, np.asarray(images, dtype=float)[mesh.triangles]

    def sources(self, places: Array, overhang: Any = 0.0) -> tuple[Array, Array, Array]:
        """(m,) indices of (k, 2) places, (m, 2) their sources, and (m,) the least barycentric
        coordinate, one for each triangle over a place.

        Triangles that miss a place by less than ``overhang``, a share of their size, count too. It
        may be an array with one share for each triangle.
        """
        share = np.broadcast_to(overhang, len(self._corners))
        which, triangle = self._near(places, share)
        weights = barycentric(self._corners[triangle], places[which])
        least = weights.min(axis=1)
        kept = least >= -np.maximum(share[triangle], _BESIDE)
        corners = self._mesh.vertices[self._mesh.triangles[triangle[kept]]]
        return which[kept], np.einsum("mi,mid->md", weights[kept], corners), least[kept]

    def _near(self, places: Array, share: Array) -> tuple[Array, Array]:
        """Places, and triangles whose enlarged bounding boxes contain them."""
        low, high = self._corners.min(axis=1), self._corners.max(axis=1)
        margin = share[:, None] * (high - low)
        low, high = low - margin, high + margin
        if len(places) > _FEW:
            points: Any = shapely.points(places)
            which, triangle = shapely.STRtree(shapely.box(*low.T, *high.T)).query(points)
            return which, triangle
        x, y = places[:, :1], places[:, 1:]
        near = (low[:, 0] <= x) & (x <= high[:, 0]) & (low[:, 1] <= y) & (y <= high[:, 1])
        which, triangle = np.nonzero(near)
        return which, triangle


def barycentric(corners: Array, points: Array) -> Array:
    """(k, 3) barycentric coordinates of points (k, 2) in triangles (k, 3, 2) of any orientation."""
    second, third = (np.roll(corners - points[:, None], -k, axis=1) for k in (1, 2))
    weights = second[..., 0] * third[..., 1] - second[..., 1] * third[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return weights / weights.sum(axis=1, keepdims=True)


def triangulate(
    cage: Cage, n_vertices: int = 10_000, points: ArrayLike | None = None
) -> Triangulation:
    """Constrained Delaunay triangulation with evenly spread vertices.

    The cage's edges are cut into equal parts and the inside is filled with a hexagonal lattice of
    the same spacing, chosen to give about `n_vertices` vertices. All vertices of the cage are
    vertices of the mesh, so a cage with more vertices than that gives a larger mesh.

    The (k, 2) points, such as handles, become vertices too. A GeometryError names one outside.
    """
    check_type("cage", cage, Cage, "that of a domain is domain.cage")
    check_type("n_vertices", n_vertices, int | np.integer, "give a whole number")
    if n_vertices < 3:
        raise GeometryError(f"a triangulation needs at least 3 vertices, not {n_vertices}")
    spacing = _spacing(cage, n_vertices)
    whole = Loops.of(cage.loops)
    parts = whole.split(_parts(whole.lengths, spacing))
    loops = list(map(_loops.subdivided, cage.loops_complex, parts))
    given = [] if points is None else points
    wanted = number_pairs(given, "points must be a list of [x, y] pairs", GeometryError)
    outside = np.flatnonzero(~cage.contains(wanted))
    if outside.size:
        what = f"point {outside[0]} at {place(wanted[outside[0]])} is to be a vertex of the"
        where = "triangulation but does not lie inside the cage; move it inside or leave it out"
        raise GeometryError(f"{what} {where}")
    wanted = np.unique(wanted, axis=0)
    loops = [_with_points(loop, wanted, _SAME * cage.longer_side) for loop in loops]
    boundary = np.concatenate(loops)
    inside = _lattice(cage, spacing)
    border = _loops.as_points(boundary)
    if len(wanted):
        tree = scipy.spatial.KDTree
        wanted = wanted[tree(border).query(wanted)[0] > _SAME * cage.longer_side]
        near = tree(inside).query_ball_point(wanted, _CLEARANCE * spacing)
        inside = np.delete(inside, sorted({i for found in near for i in found}), axis=0)
    vertices = np.concatenate([border, wanted, inside])
    return Triangulation(vertices, constrained_delaunay(vertices, loops), len(boundary))


def _with_points(loop: Array, points: Array, tolerance: float) -> Array:
    """The loop with the points that lie on it inserted in order."""
    z, places = points @ np.array([1, 1j]), np.asarray(shapely.points(points))
    ring = shapely.LinearRing(_loops.as_points(loop))
    on = shapely.distance(ring, places) <= tolerance
    on &= (np.abs(z[:, None] - loop) > tolerance).all(axis=1)
    lengths = np.abs(np.roll(loop, -1) - loop)
    starts, between = np.cumsum(lengths) - lengths, shapely.line_locate_point(ring, places[on])
    order = np.argsort(np.concatenate([starts, between]), kind="stable")
    return np.concatenate([loop, z[on]], dtype=np.complex128)[order]


def _parts(lengths: Array, spacing: float) -> Array:
    return np.maximum(np.rint(lengths / spacing), 1).astype(np.int64)


def _spacing(cage: Cage, n_vertices: int) -> float:
    # n = (area - margin * perimeter) / cell + perimeter / spacing with cell = row * spacing^2.
    linear = cage.perimeter * (1.0 - _MARGIN / _ROW)
    root = np.sqrt(linear**2 + 4.0 * n_vertices * cage.area / _ROW)
    spacing = 1.0 / float((root - linear) / (2.0 * cage.area / _ROW))
    lengths = Loops.of(cage.loops).lengths
    # The formula is inaccurate for many short edges or slender limbs, so it is corrected.
    for _ in range(6):
        count = int(_parts(lengths, spacing).sum()) + len(_lattice(cage, spacing))
        if abs(count - n_vertices) <= 0.02 * n_vertices or spacing > cage.longer_side:
            break
        spacing *= (count / n_vertices) ** 0.6
    return spacing


def _lattice(cage: Cage, spacing: float) -> Array:
    """(p, 2) points of the hexagonal lattice inside the cage, away from its boundary."""
    inner = shapely.buffer(cage.polygon, -_MARGIN * spacing, quad_segs=4)
    if inner.is_empty:
        return np.empty((0, 2))
    shapely.prepare(inner)
    xmin, ymin, xmax, ymax = cage.bounds
    rows, columns = (ymax - ymin) / (_ROW * spacing), (xmax - xmin) / spacing
    row, k = np.indices((int(rows) + 1, int(columns) + 1))
    points = np.stack((xmin + (0.5 * (row % 2) + k) * spacing, ymin + row * _ROW * spacing), -1)
    return points[shapely.intersects_xy(inner, points[..., 0], points[..., 1])]


def constrained_delaunay(vertices: Array, loops: list[Array]) -> Array:
    """Triangles of the region bounded by the loops, whose points are the first vertices."""
    following = _loops.next_index(np.repeat(np.arange(len(loops)), [len(loop) for loop in loops]))
    # Any: numpy's stubs call an array a buffer from Python 3.12 on only.
    points: Any = np.ascontiguousarray(vertices)
    edges: Any = np.stack([np.arange(len(following)), following], axis=1).astype(np.uintc)
    delaunay = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    delaunay.insert_vertices(points)
    delaunay.insert_edges(edges)
    delaunay.erase_outer_triangles_and_holes()
    return delaunay.triangles_array()["vertices"].astype(np.int32)
