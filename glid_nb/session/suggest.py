"""Suggest a first pose for a shape: handles at its ends, one or two of them moved."""

import numpy as np
import scipy
import shapely

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb.geometry import Domain, as_points, triangulate
from glid_nb.pose import Pose

_MESH_VERTICES = 3000
# Shares of the geodesic distance from the shape's middle to its farthest point.
# _LEAST_SPACING: the least distance between handles.
# _PULL_IN: how far a handle may move from a limb's end to where the limb is widest.
_LEAST_SPACING = 0.45
_PULL_IN = 0.15
_TURN = np.radians(24)
# A point is on another limb if its geodesic distance from a handle exceeds this times the handle's
# move.
_APART = 2.0


def suggest_pose(domain: Domain, max_handles: int = 7) -> Pose:
    """Handles at the middle and at the far ends of a shape, with one or two ends swung aside.

    The first handle is the point deepest inside the domain. The others are found by farthest-point
    sampling with distances measured inside the domain. Then each moves to where its limb is widest.
    Two ends turn about the middle by 24 degrees, away from the rest: the end farthest from the
    middle, and the end farthest from that one. Other handles stay. ``max_handles`` is at least 2.
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    if max_handles < 2:
        raise ValueError(f"max_handles is {max_handles}; it must be at least 2")
    mesh = triangulate(domain.cage, _MESH_VERTICES)
    graph = mesh.graph
    outline = shapely.MultiLineString([np.vstack([p, p[:1]]) for p in domain.cage.loops])
    clearance = np.asarray(shapely.distance(shapely.points(mesh.vertices), outline))

    chosen = _spread_out(graph, clearance, max_handles)
    handles = mesh.vertices[chosen]
    paths = np.asarray(scipy.sparse.csgraph.dijkstra(graph, indices=chosen))
    between = paths[:, chosen]
    first = int(np.argmax(between[0]))
    moved = [first]
    if len(chosen) > 3:
        moved.append(1 + int(np.argmax(between[first, 1:])))
    targets = handles.copy()
    for i in moved:
        targets[i] = _swung(handles[i], handles[0], mesh.vertices, paths[i])
    return Pose(handles, targets)


def _spread_out(graph: scipy.sparse.csr_array, clearance: Array, count: int) -> list[int]:
    middle = int(np.argmax(clearance))
    nearest = np.asarray(scipy.sparse.csgraph.dijkstra(graph, indices=middle))
    reach = float(nearest.max())
    chosen = [middle]
    while len(chosen) < count and nearest.max() > 0:
        end = int(np.argmax(nearest))
        if nearest[end] < _LEAST_SPACING * reach and len(chosen) > 2:
            break
        from_end = np.asarray(scipy.sparse.csgraph.dijkstra(graph, indices=end))
        vicinity = np.flatnonzero(from_end <= _PULL_IN * reach)
        handle = int(vicinity[np.argmax(clearance[vicinity])])
        if handle not in chosen and clearance[handle] > 0:
            chosen.append(handle)
        nearest = np.fmin(nearest, from_end)
    return chosen


def _swung(handle: Array, middle: Array, vertices: Array, path_lengths: Array) -> Array:
    turns = np.exp(1j * np.linspace(0, [_TURN, -_TURN], 7)[1:].T)
    ways = middle + as_points((handle - middle) @ [1, 1j] * turns)
    moved = np.linalg.norm(ways[0][-1] - handle)
    rest = vertices[path_lengths > _APART * moved]
    if not len(rest):
        return ways[0][-1]
    return max(ways, key=lambda way: np.linalg.norm(rest[:, None] - way, axis=2).min())[-1]
