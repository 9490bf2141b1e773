"""The symmetric Dirichlet density of maps, and its mean over a shape's area.

What a solver minimises depends on its space: ours takes the mean along the boundary, a method on a
mesh that over the area. To compare where they end, all maps are measured here over one area.
"""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.energies import SymmetricDirichlet
from glid_nb.geometry import Triangulation
from glid_nb.harmonic import HarmonicMap

Array = NDArray[Any]


def densities(rest: Array, triangles: Array, images: Array) -> Array:
    """(t,) density of a piecewise linear map; infinite where it folds."""
    source, image = (_edges(v.astype(float), triangles) for v in (rest, images))
    jacobian = image @ np.linalg.inv(source)
    det = np.linalg.det(jacobian)
    dirichlet = (jacobian**2).sum(axis=(1, 2)) / 2
    positive = det > 0
    return np.where(positive, dirichlet * (1 + np.where(positive, det, 1.0) ** -2), np.inf)


@double_precision
def density_at(map_: HarmonicMap, points: Array) -> Array:
    """(p,) density of a harmonic map, from its own ``f_z`` and ``f_zbar``."""
    x, y = (jnp.abs(derivative) ** 2 for derivative in map_.wirtinger(points))
    return np.asarray(SymmetricDirichlet().density(x, y))


def area_mean(density: Array, mesh: Triangulation) -> float:
    """The mean of a density, given on each triangle, over the area of the mesh at rest."""
    area = np.linalg.det(_edges(mesh.vertices, mesh.triangles))
    return float(area @ density / area.sum())


def harmonic_area_mean(map_: HarmonicMap, mesh: Triangulation) -> float:
    """The area mean of a harmonic map's density, taken in the middle of each triangle."""
    return area_mean(density_at(map_, mesh.vertices[mesh.triangles].mean(axis=1)), mesh)


def mesh_area_mean(images: Array, mesh: Triangulation) -> float:
    """The area mean of the density of a piecewise linear map."""
    return area_mean(densities(mesh.vertices, mesh.triangles, images), mesh)


def _edges(vertices: Array, triangles: Array) -> Array:
    """(t, 2, 2) two edges of each triangle as columns."""
    return np.stack(
        [vertices[triangles[:, k]] - vertices[triangles[:, 0]] for k in (1, 2)], axis=-1
    )
