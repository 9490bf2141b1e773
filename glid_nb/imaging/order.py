"""Which part of a shape covers which: one order for the canvas, picking, pictures and exports."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import scipy
import shapely

from glid_nb._arrays import Array
from glid_nb.geometry import Cage, Triangulation, triangulate
from glid_nb.solvers import Pose

_VERTICES = 4000
_CANDIDATES = 2000  # vertices that the innermost one is chosen from
_REACH = 0.15  # of the cage's size: the distance over which a depth falls to about a third
_TIE = 0.02  # of one step of depth: the range of the order that holds where depths are equal
_STIFFNESS = 1e6  # of a pin, relative to the mesh


class Order:
    """Heights of a shape's points: where its image overlaps itself, the higher covers the lower.

    They are piecewise linear on one mesh of the undeformed shape. Without depths they grow from
    the trunk to the limbs; a depth of the pose's handles outweighs that around its pin.
    """

    def __init__(self, shape: _Shape, depths: Array) -> None:
        self._shape, self._depths = shape, depths

    def __call__(self, points: Any) -> Array:
        """(k,) heights of (k, 2) points of the undeformed shape."""
        return self._shape.weights(points) @ (self._depths + _TIE * self._shape.limbs)

    def depths(self, points: Any) -> Array:
        """(k,) depths that the handles' depths give to (k, 2) points."""
        return self._shape.weights(points) @ self._depths


def order_of(cage: Cage, pose: Pose | None = None) -> Order:
    """The order of a shape's parts under the depths of a pose; kept for the next call."""
    if pose is None or not pose.depths.any():
        return _order(cage, b"", b"")
    return _order(cage, pose.handles.tobytes(), pose.depths.tobytes())


@functools.lru_cache(maxsize=16)
def _order(cage: Cage, handles: bytes, depths: bytes) -> Order:
    shape = _shape(cage)
    return Order(shape, shape.spread(np.frombuffer(handles).reshape(-1, 2), np.frombuffer(depths)))


class _Shape:
    """A mesh of the undeformed shape, on which heights are linear."""

    def __init__(self, cage: Cage) -> None:
        self._mesh, self._size = triangulate(cage, _VERTICES), cage.longer_side
        triangles: Any = shapely.polygons(self._mesh.vertices[self._mesh.triangles])
        self._tree = shapely.STRtree(triangles)
        self.limbs = _limbs_over_trunk(cage, self._mesh)
        """(v,) heights from 0 to 1 of the order without depths."""

    def weights(self, points: Any) -> Any:
        """The sparse (k, v) matrix that interpolates at (k, 2) points."""
        points, mesh = np.reshape(np.asarray(points, dtype=float), (-1, 2)), self._mesh
        places, triangle = shapely.points(points), np.full(len(points), -1)
        which, found = self._tree.query(places, predicate="intersects")
        triangle[which] = found
        beside = triangle < 0  # on the boundary, up to rounding
        triangle[beside] = self._tree.nearest(places[beside])
        corners = mesh.triangles[triangle]
        weights = barycentric(mesh.vertices[corners], points)
        rows = np.repeat(np.arange(len(points)), 3)
        shape = (len(points), len(mesh.vertices))
        return scipy.sparse.csr_array((weights.ravel(), (rows, corners.ravel())), shape)

    def spread(self, pins: Array, depths: Array) -> Array:
        """(v,) solution u of ``u = r^2 Laplace(u)`` with the depths at the pins.

        Far from all pins u is 0, so that a depth does not change the order of other limbs.
        """
        if not len(pins):
            return np.zeros(len(self._mesh.vertices))
        z, triangles = self._mesh.vertices @ np.array([1, 1j]), self._mesh.triangles
        sides = np.roll(z[triangles], 1, axis=1) - np.roll(z[triangles], -1, axis=1)
        area = 0.5 * np.imag(np.conj(sides[:, 0]) * sides[:, 1])[:, None, None]
        # Linear elements: the cotangent Laplacian, and a mass of a third of a triangle per corner.
        local = np.real(np.conj(sides[:, :, None]) * sides[:, None]) / (4 * area)
        local += np.eye(3) * area / 3 / (_REACH * self._size) ** 2
        entries = np.repeat(triangles, 3, axis=1).ravel(), np.tile(triangles, 3).ravel()
        matrix = scipy.sparse.coo_array((local.ravel(), entries), (len(z), len(z))).tocsr()
        at_pins = self.weights(pins)
        stiff = _STIFFNESS * matrix.diagonal().max() * at_pins.T
        return scipy.sparse.linalg.spsolve((matrix + stiff @ at_pins).tocsc(), stiff @ depths)


_shape = functools.lru_cache(maxsize=4)(_Shape)


def _limbs_over_trunk(cage: Cage, mesh: Triangulation) -> Array:
    """(v,) heights that grow with the geodesic distance from the shape's innermost point.

    So limbs cover the trunk; smaller shares of the distance from the opposite point and of x order
    the two ends of a ring and the left and right arm.
    """

    def distances(vertex: int) -> Array:
        return scipy.sparse.csgraph.dijkstra(mesh.graph, indices=vertex)

    n = len(mesh.vertices)
    candidates = np.arange(0, n, max(1, n // _CANDIDATES))
    outline = shapely.boundary(cage.polygon)
    inside = shapely.distance(outline, shapely.points(mesh.vertices[candidates]))
    inner = distances(candidates[np.argmax(inside)])
    heights = inner + 0.35 * (distances(int(np.argmax(inner))) + mesh.vertices[:, 0])
    return (heights - heights.min()) / np.ptp(heights)


def barycentric(corners: Array, points: Array) -> Array:
    """(k, 3) barycentric coordinates of points (k, 2) in triangles (k, 3, 2) of any orientation."""
    second, third = (np.roll(corners - points[:, None], -k, axis=1) for k in (1, 2))
    weights = second[..., 0] * third[..., 1] - second[..., 1] * third[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        return weights / weights.sum(axis=1, keepdims=True)
