"""The inverse of a map, sheet by sheet: what is drawn at a place, and what lies hidden below it."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array
from glid_nb.geometry import Domain, MeshMap, Triangulation, as_points, triangulate
from glid_nb.geometry.meshes import barycentric
from glid_nb.harmonic import FixedPoints, HarmonicMap
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.order import Order
from glid_nb.solvers import DeformationMap

_MESH_VERTICES = 2000
_NEWTON_STEPS = 8
_ROUNDING = 1e-7
_OVERHANG = 0.5  # straight triangles miss the map's image by less than this share of their size
_NEAR = 0.02  # of the shape's size: nothing that near is another sheet
_OPAQUE = 128  # of 255


class Sheets:
    """A deformed shape where it overlaps itself, in an order of its parts.

    Where the picture (h, w, 4) is transparent, if it is given, what lies below is seen.
    """

    def __init__(
        self, map: DeformationMap, order: Order, image: NDArray[np.uint8] | None = None
    ) -> None:
        self._map, self._order, self._image = map, order, image
        if isinstance(map, MeshMap):
            self._mesh, images = map.triangulation, map.images
        else:
            self._mesh, images_of = _mesh(map.domain)
            images = images_of(map)[0].astype(float)
        self._corners = images[self._mesh.triangles]
        self._near = _NEAR * float(np.ptp(self._mesh.vertices, axis=0).max())

    def source(self, point: Any) -> Array | None:
        """The point (2,) of the undeformed shape that is seen at ``point``; None outside the shape.

        Where only transparent parts are, that of the highest.
        """
        curved = isinstance(self._map, HarmonicMap)
        place = np.reshape(np.asarray(point, dtype=float), (1, 2))
        _, found = self._drawn_at(place, _OVERHANG if curved else 0.0)
        if curved and len(found):
            found = self._refined(complex(*point), found)
        if not len(found):
            return None
        return found[np.lexsort((self._order(found), self._opaque(found)))[-1]]

    def hidden(self, points: Any) -> NDArray[np.bool_]:
        """(k,) bool: which of (k, 2) points of the undeformed shape another part covers."""
        points = np.reshape(np.asarray(points, dtype=float), (-1, 2))
        result = np.zeros(len(points), dtype=bool)
        if not len(points):
            return result
        which, found = self._drawn_at(self._map(points), 0.0)
        # Most are the sheet that the point itself is on.
        other = np.linalg.norm(found - points[which], axis=1) > self._near
        which, found = which[other], found[other]
        above = self._order(found) > self._order(points)[which]
        result[which[above & self._opaque(found)]] = True
        return result

    def _drawn_at(self, places: Array, overhang: float) -> tuple[Array, Array]:
        """What triangles hold (k, 2) places, or miss them by less than a share of their size.

        (m,) of which place, (m, 2) sources by linear interpolation.
        """
        low, high = self._corners.min(axis=1), self._corners.max(axis=1)
        low, high = low - overhang * (high - low), high + overhang * (high - low)
        x, y = places[:, :1], places[:, 1:]
        near = (low[:, 0] <= x) & (x <= high[:, 0]) & (low[:, 1] <= y) & (y <= high[:, 1])
        which, triangle = np.nonzero(near)
        weights = barycentric(self._corners[triangle], places[which])
        kept = (weights >= -max(overhang, _ROUNDING)).all(axis=1)
        corners = self._mesh.vertices[self._mesh.triangles[triangle[kept]]]
        return which[kept], np.einsum("mi,mid->md", weights[kept], corners)

    def _refined(self, place: complex, guess: Array) -> Array:
        """The sources of a place in the domain, by Newton's method from (m, 2) guesses."""
        assert isinstance(self._map, HarmonicMap)
        z = guess @ np.array([1, 1j])
        for _ in range(_NEWTON_STEPS):
            w = self._map(as_points(z)) @ np.array([1, 1j]) - place
            fz, fzb = self._map.wirtinger(as_points(z))
            with np.errstate(divide="ignore", invalid="ignore"):
                dz = (fzb * w.conj() - fz.conj() * w) / (np.abs(fz) ** 2 - np.abs(fzb) ** 2)
            known = np.isfinite(dz) & (np.abs(dz) < self._near)  # else it runs away
            z = np.where(known, z + dz, z)
            found = known & (np.abs(dz) < _ROUNDING * self._near)
            if (found | ~known).all():
                break
        sources = as_points(z)[found] if found.any() else guess
        return sources[self._map.domain.cage.contains(sources)]

    def _opaque(self, points: Array) -> NDArray[np.bool_]:
        if self._image is None:
            return np.ones(len(points), dtype=bool)
        height, width = self._image.shape[:2]
        x, y = np.floor(PixelFrame(width, height).to_pixel(points)).astype(int).T
        return self._image[y.clip(0, height - 1), x.clip(0, width - 1), 3] >= _OPAQUE


@functools.lru_cache(maxsize=4)
def _mesh(domain: Domain) -> tuple[Triangulation, FixedPoints]:
    mesh = triangulate(domain.cage, _MESH_VERTICES)
    return mesh, FixedPoints(domain, mesh.vertices)
