"""Deformed shapes as triangles and as loops, fine enough to draw them with straight edges."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Floats
from glid_nb.geometry import Cage, as_points, triangulate
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import order_of
from glid_nb.pose import Pose

# Limits of refinement, because no mesh can follow a map close to its singularities.
MOST_VERTICES = 1_000_000
_MOST_ROUNDS = 12

_PER_EDGE = 4  # parts of each edge of the cage before refinement
_ALL = -np.inf, -np.inf, np.inf, np.inf

# The pieces of a triangle with new vertices on some sides. A new vertex on side 0, 1 or 2 adds 1, 2
# or 4 to the row's index. In a row, 0 to 2 are the corners, and 3 to 5 are the new vertices on the
# sides opposite to them.
_NONE = (-1, -1, -1)
_PIECES = np.array(
    [
        [(0, 1, 2), _NONE, _NONE, _NONE],
        [(0, 1, 3), (0, 3, 2), _NONE, _NONE],
        [(1, 2, 4), (1, 4, 0), _NONE, _NONE],
        [(2, 4, 3), (4, 0, 1), (4, 1, 3), _NONE],
        [(2, 0, 5), (2, 5, 1), _NONE, _NONE],
        [(1, 3, 5), (3, 2, 0), (3, 0, 5), _NONE],
        [(0, 5, 4), (5, 1, 2), (5, 2, 4), _NONE],
        [(0, 5, 4), (5, 1, 3), (4, 3, 2), (3, 4, 5)],
    ]
)

Ints = NDArray[np.int32]
Evaluation = Callable[[Floats], Floats]
Bounds = tuple[float, float, float, float]  # xmin, ymin, xmax, ymax


@dataclass(frozen=True, eq=False)
class DeformedMesh:
    """A triangulated domain and its image."""

    vertices: Floats
    images: Floats  # (v, 2) images of the vertices; both in world coordinates
    triangles: Ints  # (t, 3) counter-clockwise, sorted by height, the lowest first
    heights: Floats
    """(v,) heights. Where the image overlaps itself, the higher part covers the lower one; see
    `order_of`."""

    def __post_init__(self) -> None:
        for array in (self.vertices, self.images, self.triangles, self.heights):
            array.setflags(write=False)


def deformed_mesh(
    map: HarmonicMap,
    n_vertices: int = 5000,
    tolerance: float | None = None,
    pose: Pose | None = None,
    seen: Bounds = _ALL,
) -> DeformedMesh:
    """Triangulate a map's domain with about ``n_vertices`` even vertices, and map them.

    With a ``tolerance``, in world units, edges are halved. It ends when the image of each edge's
    midpoint is within ``tolerance`` of the midpoint of the image edge, or at a million vertices.
    Edges far from ``seen``, a rectangle of the plane, are not halved.
    """
    vertices, images, triangles = fine_mesh(map.domain.cage, map, n_vertices, tolerance, seen)
    heights = order_of(map.domain.cage, pose)(vertices)
    triangles = triangles[np.argsort(heights[triangles].mean(axis=1), kind="stable")]
    return DeformedMesh(vertices, images, triangles, heights)


def fine_mesh(
    cage: Cage, image: Evaluation, n_vertices: int, tolerance: float | None, seen: Bounds = _ALL
) -> tuple[Floats, Floats, Ints]:
    """Vertices (v, 2), their images (v, 2 m) under m maps, and triangles.

    ``image`` evaluates all m maps. The mesh is as fine as the map that bends edges most requires.
    """
    if tolerance is not None and not tolerance > 0:
        raise ValueError(f"tolerance is {tolerance}; it must be positive")
    start = triangulate(cage, n_vertices)
    vertices, triangles = start.vertices, start.triangles
    images = image(vertices)
    # Below this share of the image's size, rounding errors also bend edges.
    least = 1e-9 * float(np.ptp(images, axis=0).max())
    tolerance = np.inf if tolerance is None else max(tolerance, least)
    first = 0
    for _ in range(_MOST_ROUNDS):
        edges, edge_of = unique_edges(triangles)
        near = np.zeros(len(edges), dtype=bool)
        near[edge_of[_near(images[triangles], seen)]] = True
        # All other edges were straight enough in an earlier round.
        fresh = np.flatnonzero(near & (edges.max(axis=1) >= first))
        middles, middle_images, bend = _halved(image, vertices, images, edges[fresh])
        bent = bend > tolerance
        if not bent.any() or len(vertices) + bent.sum() > MOST_VERTICES:
            break
        first = len(vertices)
        new_vertex = np.full(len(edges), -1, np.int32)
        new_vertex[fresh[bent]] = first + np.arange(bent.sum(), dtype=np.int32)
        vertices = np.concatenate([vertices, middles[bent]])
        images = np.concatenate([images, middle_images[bent]])
        triangles = _split(triangles, new_vertex[edge_of])
    return vertices, images, triangles


def deformed_loops(map: HarmonicMap, tolerance: float = 0.002) -> list[Floats]:
    """Images of the cage's loops as polylines, within ``tolerance`` units or 1e-6 of their size."""
    loops = []
    for loop in map.domain.cage.loops_complex:
        points = as_points(subdivided(loop, np.full(len(loop), _PER_EDGE)))
        points = np.concatenate([points, points[:1]])
        images = map(points)
        tolerance = max(tolerance, 1e-6 * float(np.ptp(images, axis=0).max()))
        for _ in range(_MOST_ROUNDS):
            start = np.arange(len(points) - 1)
            edges = np.stack([start, start + 1], axis=1)
            middles, middle_images, bend = _halved(map, points, images, edges)
            bent = np.flatnonzero(bend > tolerance)
            if not len(bent):
                break
            points = np.insert(points, bent + 1, middles[bent], axis=0)
            images = np.insert(images, bent + 1, middle_images[bent], axis=0)
        loops.append(images[:-1])
    return loops


def _halved(
    image: Evaluation, points: Floats, images: Floats, edges: NDArray[np.integer]
) -> tuple[Floats, Floats, Floats]:
    """The edges' midpoints, their images, and their distances from the image edges' midpoints."""
    middles = points[edges].mean(axis=1)
    middle_images = image(middles)
    away = middle_images - images[edges].mean(axis=1)
    return middles, middle_images, np.hypot(away[:, ::2], away[:, 1::2]).max(axis=1)


def _near(corners: Floats, seen: Bounds) -> NDArray[np.bool_]:
    """(t,) bool: triangles whose image, under one of m maps, is at most its own size away.

    ``corners`` (t, 3, 2 m) are the images. The extra room allows for bent edges.
    """
    low, high = (limit.reshape(len(corners), -1, 2) for limit in (corners.min(1), corners.max(1)))
    room = (high - low).max(axis=2, keepdims=True)
    return ((low - room <= seen[2:]) & (high + room >= seen[:2])).all(axis=2).any(axis=1)


def unique_edges(triangles: NDArray[np.integer]) -> tuple[NDArray[np.integer], Ints]:
    """Unique edges (e, 2), and (t, 3) the index of the edge opposite to each vertex."""
    sides = np.stack([np.roll(triangles, -1, axis=1), np.roll(triangles, 1, axis=1)], axis=2)
    sides = np.sort(sides.reshape(-1, 2), axis=1)
    keys = sides @ np.array([1 << 32, 1])
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    return sides[first], inverse.reshape(-1, 3).astype(np.int32)


def _split(triangles: Ints, middle: Ints) -> Ints:
    """Split triangles at the new vertices on their sides (t, 3), -1 for none. Keeps the order."""
    pieces = _PIECES[(middle >= 0) @ [1, 2, 4]]
    corners = np.concatenate([triangles, middle], axis=1)
    new = np.take_along_axis(corners, pieces.reshape(-1, 12), axis=1).reshape(-1, 4, 3)
    return new[pieces[:, :, 0] >= 0]
