"""The inverse of a map, sheet by sheet: what is drawn at a place, and what lies hidden below it."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Array
from glid_nb.geometry import Domain, MeshMap, as_points, triangulate
from glid_nb.harmonic import FixedPoints
from glid_nb.imaging.frame import PixelFrame
from glid_nb.imaging.order import Order, barycentric
from glid_nb.solvers import DeformationMap

_MESH_VERTICES = 2000
_NEWTON_STEPS = 8
_ROUNDING = 1e-7
_OVERHANG = 0.5  # straight triangles miss the map's image by less than this share of their size
_NEAR = 0.02  # of the shape's size: nothing that near is another sheet
_OPAQUE = 128  # of 255


class Sheets:
    """A deformed shape where it overlaps itself.

    ``order`` is that of the shape's parts. With the picture (h, w, 4) a part covers others only
    where the picture is opaque.
    """

    def __init__(
        self, map: DeformationMap, order: Order, image: NDArray[np.uint8] | None = None
    ) -> None:
        self._map, self._order, self._image = map, order, image
        if isinstance(map, MeshMap):
            self._vertices, self._triangles = (
                map.triangulation.vertices,
                map.triangulation.triangles,
            )
            images, self._overhang = map.images, 0.0
        else:
            self._vertices, self._triangles, images_of = _mesh(map.domain)
            images, self._overhang = images_of(map)[0].astype(float), _OVERHANG
        self._corners = images[self._triangles]
        self._near = _NEAR * float(np.ptp(self._vertices, axis=0).max())

    def source(self, point: Any) -> Array | None:
        """The point (2,) of the undeformed shape that is seen at ``point``; None outside the shape.

        Where only transparent parts are, that of the highest.
        """
        point = np.asarray(point, dtype=float)
        found = self._refined(point, *self._candidates(point[None], self._overhang)[1:])
        if not len(found):
            return None
        return found[np.lexsort((self._order(found), self._opaque(found)))[-1]]

    def hidden(self, points: Any) -> NDArray[np.bool_]:
        """(k,) bool: which of (k, 2) points of the undeformed shape another part covers."""
        points = np.reshape(np.asarray(points, dtype=float), (-1, 2))
        result = np.zeros(len(points), dtype=bool)
        which, found, inside = self._candidates(self._map(points) if len(points) else points, 0.0)
        # Most are the sheet that the point itself is on.
        other = inside & (np.linalg.norm(found - points[which], axis=1) > self._near)
        which, found = which[other], found[other]
        above = self._order(found) > self._order(points)[which]
        result[which[above & self._opaque(found)]] = True
        return result

    def _candidates(self, places: Array, overhang: float) -> tuple[Array, Array, Array]:
        """Triangles that hold (k, 2) places, or miss them by less than this share of their size.

        Gives (m,) of which place, (m, 2) sources by linear interpolation, and (m,) bool whether the
        place is inside the triangle.
        """
        low, high = self._corners.min(axis=1), self._corners.max(axis=1)
        room = overhang * (high - low)
        low, high = low - room, high + room
        x, y = places[:, :1], places[:, 1:]
        near = (low[:, 0] <= x) & (x <= high[:, 0]) & (low[:, 1] <= y) & (y <= high[:, 1])
        which, triangle = np.nonzero(near)
        weights = barycentric(self._corners[triangle], places[which])
        kept = (weights >= -max(overhang, _ROUNDING)).all(axis=1)
        which, triangle, weights = which[kept], triangle[kept], weights[kept]
        sources = np.einsum("mi,mid->md", weights, self._vertices[self._triangles[triangle]])
        return which, sources, np.asarray((weights >= -_ROUNDING).all(axis=1))

    def _refined(self, place: Array, guess: Array, inside: Array) -> Array:
        """The (m, 2) sources of a place in the domain, by Newton's method from (k, 2) guesses."""
        if isinstance(self._map, MeshMap) or not len(guess):
            return guess
        goal, z = complex(*place), guess @ np.array([1, 1j])
        for _ in range(_NEWTON_STEPS):
            w = self._map(as_points(z)) @ np.array([1, 1j]) - goal
            fz, fzb = self._map.wirtinger(as_points(z))
            with np.errstate(divide="ignore", invalid="ignore"):
                dz = (fzb * w.conj() - fz.conj() * w) / (np.abs(fz) ** 2 - np.abs(fzb) ** 2)
            known = np.isfinite(dz) & (np.abs(dz) < self._near)  # else it runs away
            z = np.where(known, z + dz, z)
            found = known & (np.abs(dz) < _ROUNDING * self._near)
            if (found | ~known).all():
                break
        sources = np.where(found[:, None], as_points(z), guess)
        kept = (found | inside) & self._map.domain.cage.contains(sources)
        return sources[kept]

    def _opaque(self, points: Array) -> NDArray[np.bool_]:
        if self._image is None:
            return np.ones(len(points), dtype=bool)
        height, width = self._image.shape[:2]
        x, y = np.floor(PixelFrame(width, height).to_pixel(points)).astype(int).T
        inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
        alpha = self._image[y.clip(0, height - 1), x.clip(0, width - 1), 3]
        return inside & (alpha >= _OPAQUE)


@functools.lru_cache(maxsize=4)
def _mesh(domain: Domain) -> tuple[Array, Array, FixedPoints]:
    mesh = triangulate(domain.cage, _MESH_VERTICES)
    return mesh.vertices, mesh.triangles, FixedPoints(domain, mesh.vertices)
