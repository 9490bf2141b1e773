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
    the trunk to the limbs; the depths of handles outweigh that around their pins.
    """

    def __init__(self, mesh: Triangulation, limbs: Array, depths: Array) -> None:
        self._mesh, self._depths = mesh, depths
        self._heights = depths + _TIE * limbs

    def __call__(self, points: Any) -> Array:
        """(k,) heights of (k, 2) points of the undeformed shape."""
        return self._mesh.weights(points) @ self._heights

    def depths(self, points: Any) -> Array:
        """(k,) depths that the handles' depths give to (k, 2) points."""
        return self._mesh.weights(points) @ self._depths


def order_of(cage: Cage, pose: Pose | None = None) -> Order:
    """The order of a shape's parts under the depths of a pose; kept for the next call."""
    if pose is None or not pose.depths.any():
        return _order(cage, b"", b"")
    return _order(cage, pose.handles.tobytes(), pose.depths.tobytes())


@functools.lru_cache(maxsize=16)
def _order(cage: Cage, handles: bytes, depths: bytes) -> Order:
    mesh, limbs = _limbs_over_trunk(cage)
    if not handles:
        return Order(mesh, limbs, np.zeros(len(limbs)))
    pins, reach = np.frombuffer(handles).reshape(-1, 2), _REACH * cage.longer_side
    return Order(mesh, limbs, _spread(mesh, pins, np.frombuffer(depths), reach))


@functools.lru_cache(maxsize=4)
def _limbs_over_trunk(cage: Cage) -> tuple[Triangulation, Array]:
    """A mesh, and (v,) heights from 0 to 1 that grow with the distance from its innermost point.

    Distances are geodesic. Smaller shares of the distance from the opposite point and of x order
    the two ends of a ring and the left and right arm.
    """
    mesh = triangulate(cage, _VERTICES)
    candidates = np.arange(0, len(mesh.vertices), max(1, len(mesh.vertices) // _CANDIDATES))
    outline = shapely.boundary(cage.polygon)
    inside = shapely.distance(outline, shapely.points(mesh.vertices[candidates]))
    distances = functools.partial(scipy.sparse.csgraph.dijkstra, mesh.graph)
    inner = distances(indices=candidates[np.argmax(inside)])
    heights = inner + 0.35 * (distances(indices=int(np.argmax(inner))) + mesh.vertices[:, 0])
    return mesh, (heights - heights.min()) / np.ptp(heights)


def _spread(mesh: Triangulation, pins: Array, depths: Array, reach: float) -> Array:
    """(v,) solution u of ``u = reach^2 Laplace(u)`` with the depths at the pins.

    Far from all pins u is 0, so that a depth does not change the order of other limbs.
    """
    z, triangles = mesh.vertices @ np.array([1, 1j]), mesh.triangles
    sides = np.roll(z[triangles], 1, axis=1) - np.roll(z[triangles], -1, axis=1)
    area = 0.5 * np.imag(np.conj(sides[:, 0]) * sides[:, 1])[:, None, None]
    # Linear elements: the cotangent Laplacian, and a mass of a third of a triangle per corner.
    local = np.real(np.conj(sides[:, :, None]) * sides[:, None]) / (4 * area)
    local += np.eye(3) * area / 3 / reach**2
    entries = np.repeat(triangles, 3, axis=1).ravel(), np.tile(triangles, 3).ravel()
    matrix = scipy.sparse.coo_array((local.ravel(), entries), (len(z), len(z))).tocsr()
    at_pins = mesh.weights(pins)
    stiff = _STIFFNESS * matrix.diagonal().max() * at_pins.T
    return scipy.sparse.linalg.spsolve((matrix + stiff @ at_pins).tocsc(), stiff @ depths)
