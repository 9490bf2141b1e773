"""The order in which parts of a shape cover each other, for canvas, picking, pictures and exports.

`Sheets` finds the source of what is drawn at a place: of all preimages, which `HarmonicMap.inverse`
finds, the one that covers the others. It also finds the points that are hidden below others.
"""

import bisect
import functools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import scipy
import shapely
from numpy.typing import NDArray

from glid_nb._arrays import Array
from glid_nb.geometry import (
    Cage,
    Domain,
    MeshMap,
    Overlay,
    Triangulation,
    triangulate,
)
from glid_nb.harmonic import FixedPoints, HarmonicMap
from glid_nb.imaging.frame import PixelFrame
from glid_nb.pose import DeformationMap, Pose

_VERTICES = 4000
_CANDIDATES = 2000  # vertices among which the innermost one is chosen
_REACH = 0.15  # of the cage's size: the distance over which a depth falls to about a third
_TIE = 0.02  # range of the limbs' heights, which decide where depths are equal, in steps of depth
_STIFFNESS = 1e6  # of a pin, relative to the mesh

_SHEET_VERTICES = 2000
_NEAR = 0.02  # of the shape's size: sources closer than this are on the same sheet
_OPAQUE = 128  # of 255


class Order:
    """Heights of a shape's points; the higher part covers the lower one. Heights grow from the
    trunk to the limbs. Around a handle, its depth outweighs this."""

    def __init__(self, mesh: Triangulation, limbs: Array, depths: Array) -> None:
        self._mesh, self._limbs, self._depths = mesh, limbs, depths
        self._heights = depths + _TIE * limbs

    def __call__(self, points: Any) -> Array:
        """(k,) heights of (k, 2) points of the undeformed shape."""
        return self._mesh.weights(points) @ self._heights

    def towards(self, other: "Order", share: float) -> "Order":
        """The order at a share of the way to another order of the same shape."""
        if other is self:
            return self
        return Order(self._mesh, self._limbs, self._depths + share * (other._depths - self._depths))

    def depths(self, points: Any) -> Array:
        """(k,) depths of (k, 2) points, spread from the handles' depths."""
        return self._mesh.weights(points) @ self._depths


def order_at(orders: Sequence[Order], times: Sequence[float], time: float) -> Order:
    """The order at a time, between those of two keyframes. A loop's last time is that of its return
    to the first one."""
    i = max(min(bisect.bisect_right(times, time), len(times) - 1) - 1, 0)
    first, last = orders[i], orders[(i + 1) % len(orders)]
    return first.towards(last, (time - times[i]) / (times[i + 1] - times[i]))


def order_of(cage: Cage, pose: Pose | None = None) -> Order:
    """The order of a shape's parts under the depths of a pose. Orders are cached."""
    if pose is None or not pose.depths.any():
        return _orders(cage)()
    return _orders(cage)(pose.handles.tobytes(), pose.depths.tobytes())


@functools.lru_cache(maxsize=4)  # cages, not orders: each cage has a mesh of several MB
def _orders(cage: Cage) -> Callable[..., Order]:
    mesh, limbs = _limbs_over_trunk(cage)

    @functools.lru_cache(maxsize=16)
    def order(handles: bytes = b"", depths: bytes = b"") -> Order:
        if not handles:
            return Order(mesh, limbs, np.zeros(len(limbs)))
        pins, reach = np.frombuffer(handles).reshape(-1, 2), _REACH * cage.longer_side
        return Order(mesh, limbs, _spread(mesh, pins, np.frombuffer(depths), reach))

    return order


def _limbs_over_trunk(cage: Cage) -> tuple[Triangulation, Array]:
    """A mesh, and (v,) heights from 0 to 1 that grow with the geodesic distance from its innermost
    point.

    They also grow, less, with the distance from the opposite end and with x. Otherwise the two ends
    of a ring or two arms would have the same height.
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
    """(v,) solution of ``u = reach^2 Laplace(u)`` with depths at pins; about 0 far from pins."""
    z, triangles = mesh.vertices @ np.array([1, 1j]), mesh.triangles
    sides = np.roll(z[triangles], 1, axis=1) - np.roll(z[triangles], -1, axis=1)
    area = 0.5 * np.imag(np.conj(sides[:, 0]) * sides[:, 1])[:, None, None]
    # Linear elements: the cotangent Laplacian and a lumped mass, a third of a triangle per corner.
    local = np.real(np.conj(sides[:, :, None]) * sides[:, None]) / (4 * area)
    local += np.eye(3) * area / 3 / reach**2
    entries = np.repeat(triangles, 3, axis=1).ravel(), np.tile(triangles, 3).ravel()
    matrix = scipy.sparse.coo_array((local.ravel(), entries), (len(z), len(z))).tocsr()
    at_pins = mesh.weights(pins)
    stiff = _STIFFNESS * matrix.diagonal().max() * at_pins.T
    return scipy.sparse.linalg.spsolve((matrix + stiff @ at_pins).tocsc(), stiff @ depths)


class Sheets:
    """A deformed shape that may overlap itself. Transparent parts of a picture hide nothing."""

    def __init__(self, map: DeformationMap, order: Order, image: Array | None = None) -> None:
        self._map, self._order, self._image = map, order, image

    def source(self, point: Any) -> Array | None:
        """The source (2,) of the visible part at a point; None outside the shape. If all parts at
        the point are transparent, the source of the highest."""
        place = np.reshape(np.asarray(point, dtype=float), (1, 2))
        if isinstance(self._map, HarmonicMap):
            found = self._map.inverse(place, all=True).points
        else:
            _, found, _ = self._overlay.sources(place)
        if not len(found):
            return None
        return found[np.lexsort((self._order(found), self._opaque(found)))[-1]]

    def visible(self, point: Any) -> Array | None:
        """Like `source`, but None where everything at the point is transparent."""
        found = self.source(point)
        return found if found is not None and self._opaque(found[None])[0] else None

    def sources(self, places: Array) -> Array:
        """Like `source` for many places (k, 2), with a mesh's accuracy; NaN outside the shape."""
        which, found, _ = self._overlay.sources(places)
        order = np.lexsort((self._order(found), self._opaque(found)))
        seen = np.full(places.shape, np.nan)
        seen[which[order]] = found[order]  # the last of several assignments stays
        return seen

    def hidden(self, points: Any) -> NDArray[np.bool_]:
        """(k,) bool: the points, (k, 2) of the undeformed shape, that another part covers."""
        points = np.reshape(np.asarray(points, dtype=float), (-1, 2))
        result = np.zeros(len(points), dtype=bool)
        if not len(points):
            return result
        which, found, _ = self._overlay.sources(self._map(points))
        # Most of the found sources are on the point's own sheet.
        other = np.linalg.norm(found - points[which], axis=1) > self._near
        which, found = which[other], found[other]
        above = self._order(found) > self._order(points)[which]
        result[which[above & self._opaque(found)]] = True
        return result

    @functools.cached_property
    def _drawn(self) -> tuple[Triangulation, Array]:
        """A mesh of the shape, and the images of its vertices."""
        if isinstance(self._map, MeshMap):
            return self._map.triangulation, self._map.images
        mesh, images_of = _sheet_mesh(self._map.domain)
        return mesh, images_of(self._map)[0].astype(float)

    @functools.cached_property
    def _overlay(self) -> Overlay:
        return Overlay(*self._drawn)

    @property
    def _near(self) -> float:
        return _NEAR * float(np.ptp(self._drawn[0].vertices, axis=0).max())

    def _opaque(self, points: Array) -> NDArray[np.bool_]:
        if self._image is None:
            return np.ones(len(points), dtype=bool)
        height, width = self._image.shape[:2]
        x, y = np.floor(PixelFrame(width, height).to_pixel(points)).astype(int).T
        return self._image[y.clip(0, height - 1), x.clip(0, width - 1), 3] >= _OPAQUE


@functools.lru_cache(maxsize=4)
def _sheet_mesh(domain: Domain) -> tuple[Triangulation, FixedPoints]:
    mesh = triangulate(domain.cage, _SHEET_VERTICES)
    return mesh, FixedPoints(domain, mesh.vertices)
