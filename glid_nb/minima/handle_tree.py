"""The tree of a pose's handles: shortest paths inside the shape join each handle to its parent."""

import functools
from typing import NamedTuple

import numpy as np
from scipy.sparse import csgraph
from scipy.spatial.distance import cdist

from glid_nb._arrays import Array
from glid_nb.geometry import Domain, triangulate
from glid_nb.harmonic import as_complex
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.cauchy import first_by_edges

# Vertices of the mesh whose edges the paths follow. A path only has to tell how often the map turns
# along it, so a coarse mesh is enough.
_VERTICES = 300

_coarse_mesh = functools.lru_cache(maxsize=4)(triangulate)  # for all handles of a cage


class Edge(NamedTuple):
    """A handle, its parent in the tree, and the path between them."""

    child: int
    parent: int
    path: slice
    """The rows of :attr:`HandleTree.fz_rows` along the path, from the parent to the child."""


class HandleTree(NamedTuple):
    """The minimum spanning tree of the handles' distances inside the shape."""

    root: int
    """The handle whose distances to all others have the least sum."""
    edges: list[Edge]
    """Every edge comes after that of its parent."""
    fz_rows: Array
    """(p, m) rows whose products with phi's edge coefficients are f_z: first at the root, then at
    the points of each path."""


@functools.lru_cache(maxsize=32)
def handle_tree(domain: Domain, handles: bytes) -> HandleTree:
    """The tree of handles, given as the bytes of an (h, 2) float64 array.

    The last 32 trees are kept, since a drag asks for the same handles again.
    """
    points = np.frombuffer(handles).reshape(-1, 2)
    mesh = _coarse_mesh(domain.cage, _VERTICES)
    nearest = cdist(points, mesh.vertices).argmin(axis=1)
    lengths, before = csgraph.dijkstra(mesh.graph, indices=nearest, return_predecessors=True)
    distances = np.maximum(lengths[:, nearest], cdist(points, points))
    root = int(np.argmin(distances.sum(axis=0)))
    tree = csgraph.minimum_spanning_tree(distances)
    order, parents = csgraph.breadth_first_order(tree, root, directed=False)
    along = [points[root]]
    edges = list[Edge]()
    for i, j in zip(order[1:].tolist(), parents[order[1:]].tolist(), strict=True):
        back = [points[i]]
        at = before[j, nearest[i]]
        while at >= 0 and at != nearest[j]:
            back.append(mesh.vertices[at])
            at = before[j, at]
        edges.append(Edge(i, j, slice(len(along), len(along) + len(back) + 1)))
        along += [points[j], *back[::-1]]
    rows = first_by_edges(as_complex(along), basis_of(domain).singularities)
    return HandleTree(root, edges, rows)
