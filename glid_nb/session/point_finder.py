"""The inverse of a map: the point of the undeformed shape that is drawn at a place."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb.geometry import Domain, MeshMap, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import DeformationMap

_MESH_VERTICES = 2000
_NEWTON_STEPS = 6
_ROUNDING = 1e-9


def find_source(map: DeformationMap, point: Any) -> Array | None:
    """The point z (2,) of the domain with f(z) = ``point``; None if there is none.

    Where the shape overlaps itself, it is the one that is drawn last, on top. Newton's method
    refines what is found on a coarse mesh.
    """
    point = np.asarray(point, dtype=float)
    if isinstance(map, MeshMap):
        triangles, vertices = map.layered, map.triangulation.vertices
        return _in_triangles(map.images[triangles], vertices[triangles], point, turned_over=True)
    vertices, triangles = _mesh(map.domain)
    guess = _in_triangles(map(vertices)[triangles], vertices[triangles], point)
    if guess is None:
        return None
    candidates = (_newton(map, guess, point), guess)
    inside = map.domain.cage.contains
    return next((z for z in candidates if z is not None and inside(z[None])[0]), None)


@functools.lru_cache(maxsize=4)
def _mesh(domain: Domain) -> tuple[Array, Array]:
    mesh = triangulate(domain.cage, _MESH_VERTICES)
    return mesh.vertices, mesh.triangles


def _in_triangles(
    images: Array, corners: Array, point: Array, turned_over: bool = False
) -> Array | None:
    """Interpolate linearly in the last of the triangles (t, 3, 2) that contain the point.

    Flipped triangles are skipped unless ``turned_over``: a coarse triangle may be flipped where the
    map itself is not.
    """
    second, third = (np.roll(images - point, -k, axis=1) for k in (1, 2))
    weights = second[..., 0] * third[..., 1] - second[..., 1] * third[..., 0]
    total = weights.sum(axis=1)
    side = np.sign(total) if turned_over else np.ones(len(total))
    holding = np.flatnonzero(
        (side[:, None] * weights >= -_ROUNDING * np.abs(total)[:, None]).all(axis=1)
        & (side * total > 0)
    )
    if not holding.size:
        return None
    last = holding[-1]
    return weights[last] @ corners[last] / total[last]


def _newton(map: HarmonicMap, start: Array, point: Array) -> Array | None:
    z = np.array(start)
    for _ in range(_NEWTON_STEPS):
        w = complex(*(map(z[None])[0] - point))
        fz, fzb = (complex(d[0]) for d in map.wirtinger(z[None]))
        determinant = abs(fz) ** 2 - abs(fzb) ** 2
        if not determinant > 0:
            return None
        dz = (fzb * w.conjugate() - fz.conjugate() * w) / determinant
        z = z + np.array([dz.real, dz.imag])
        if abs(dz) < _ROUNDING:
            break
    return z if np.isfinite(z).all() else None
