"""How stiff areas change the matrices of a solve."""

import functools
from typing import Any

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb._jax import jax
from glid_nb._runtime import double_precision
from glid_nb.geometry import Domain, as_points, graded_panels
from glid_nb.harmonic import as_complex, basis_of, cauchy
from glid_nb.pose import FULL_WEIGHT, Stiffness
from glid_nb.solvers import discretisation
from glid_nb.solvers.discretisation import Discretisation, Matrices, padded
from glid_nb.solvers.whitening import whitened

NODES = 128  # inside the areas; a fixed number, so that painting more compiles nothing
# The grid of these nodes: the factor that makes it coarser, and its most lines in one direction.
_COARSER, _MOST_LINES = 1.03, 400


@functools.lru_cache(maxsize=4)
@double_precision
def stiff_matrices(disc: Discretisation, stiffness: Stiffness) -> Matrices:
    """The matrices with the weights of a stiffness; the same object if nothing is stiff.

    The weight of a node on the boundary is multiplied by ``FULL_WEIGHT**strength``. Nodes inside
    the areas get the same extra density, as a mean over the area of the cage.
    """
    m, panels = disc.matrices, disc.panels
    areas = stiffness.within(disc.domain.cage)
    if not areas:
        return m
    p, count = len(m.real), len(panels)
    added = np.zeros(len(m.weights))
    added[:count] = _added(stiffness, panels.start)
    if disc.can_split:
        added[p : p + count] = _added(stiffness, panels.middle)
    weights, index = np.asarray(m.weights), np.asarray(m.hessian_index)
    inner, nodes = _inside(disc.domain, stiffness)
    at_nodes = whitened(nodes, np.arange(NODES), m.whitening, np.asarray(m.whitened).dtype.type)
    hessian = np.asarray(m.hessian_weights) * (1 + added[index])
    changed = {
        "nodes": np.hstack([m.nodes, nodes]),
        "weights": np.concatenate([weights * (1 + added), inner]),
        "hessian_index": np.concatenate([index, len(weights) + np.arange(NODES)]),
        "hessian_weights": np.concatenate([hessian, inner]),
        "whitened": np.hstack([m.whitened, at_nodes]),
        "stiff": weights @ added + inner.sum(),
    }
    return m._replace(**jax.device_put(changed))


def _added(stiffness: Stiffness, z: Array) -> Array:
    return FULL_WEIGHT ** stiffness(as_points(z)) - 1


def stiff_nodes(domain: Domain, stiffness: Stiffness) -> dict[str, Any]:
    """How a stiffness changes the energy, as plain values for the solver in a page.

    ``factors`` of the weights at the starts, then at the middles, of the graded panels; ``points``
    inside the areas and their ``weights``.
    """
    panels = graded_panels(domain)
    factors = 1 + _added(stiffness, np.concatenate([panels.start, panels.middle]))
    z, weights = _nodes_inside(domain, stiffness)
    points = as_points(z).tolist()
    return {"factors": factors.tolist(), "points": points, "weights": weights.tolist()}


@functools.lru_cache(maxsize=4)
def _inside(domain: Domain, stiffness: Stiffness) -> tuple[Array, Array]:
    """Weights and ``D`` at nodes inside the areas, padded to `NODES`."""
    z, weights = _nodes_inside(domain, stiffness)
    d = discretisation.complex_basis(cauchy.first_derivatives, z, basis_of(domain))
    return padded(weights, NODES, 0.0), discretisation.real_columns(padded(d, NODES))


def _nodes_inside(domain: Domain, stiffness: Stiffness) -> tuple[Array, Array]:
    """Complex nodes on a square grid inside the areas, at most `NODES`, and their weights."""
    whole = shapely.union_all(list(stiffness.within(domain.cage).values()))
    shapely.prepare(whole)
    left, bottom, right, top = whole.bounds
    step = max(np.sqrt(whole.area / NODES), max(right - left, top - bottom) / _MOST_LINES)
    while True:
        x, y = np.meshgrid(np.arange(left, right, step), np.arange(bottom, top, step))
        x, y = x.ravel() + step / 2, y.ravel() + step / 2
        inside = shapely.contains_xy(whole, x, y)
        if np.count_nonzero(inside) <= NODES:
            break
        step *= _COARSER
    z = (x + 1j * y)[inside]
    if not len(z):
        z = as_complex(shapely.get_coordinates(whole.representative_point()))
    return z, _added(stiffness, z) * whole.area / len(z) / domain.cage.area
