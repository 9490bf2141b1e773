"""The symmetric Dirichlet density of maps, and its mean over a shape's area.

Our solver minimises the mean along the boundary, a method on a mesh the mean over the area. To
compare their results, this module measures all maps over the area.
"""

from typing import Any

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.energies import SymmetricDirichlet
from glid_nb.geometry import Triangulation
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.mesh.operators import MeshOperators

Array = NDArray[Any]


@double_precision
def densities(mesh: Triangulation, images: Array) -> Array:
    """(t,) density of a piecewise linear map; infinite where it folds."""
    x, y = (np.abs(d) ** 2 for d in MeshOperators(mesh).wirtinger(images @ np.array([1, 1j])))
    upright = x > y
    density = SymmetricDirichlet().density(jnp.where(upright, x, 1), jnp.where(upright, y, 0))
    return np.where(upright, density, np.inf)


@double_precision
def density_at(map_: HarmonicMap, points: Array) -> Array:
    """(p,) density of a harmonic map, from its own ``f_z`` and ``f_zbar``."""
    x, y = (jnp.abs(derivative) ** 2 for derivative in map_.wirtinger(points))
    return np.asarray(SymmetricDirichlet().density(x, y))


def area_mean(density: Array, mesh: Triangulation) -> float:
    """The mean of a density, given on each triangle, over the area of the mesh at rest."""
    return float(MeshOperators(mesh).weights @ density)


def harmonic_area_mean(map_: HarmonicMap, mesh: Triangulation) -> float:
    """The area mean of a harmonic map's density, sampled at the middle of each triangle."""
    return area_mean(density_at(map_, mesh.vertices[mesh.triangles].mean(axis=1)), mesh)


def mesh_area_mean(images: Array, mesh: Triangulation) -> float:
    """The area mean of the density of a piecewise linear map."""
    return area_mean(densities(mesh, images), mesh)
