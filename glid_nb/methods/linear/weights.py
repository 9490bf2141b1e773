"""Bounded biharmonic and harmonic weights of point handles, by libigl."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry import Triangulation

Array = NDArray[Any]

# Weights depend on the handles alone: while targets move they are not computed again.
_known: weakref.WeakKeyDictionary[Triangulation, tuple[Any, Array]] = weakref.WeakKeyDictionary()


def bounded_biharmonic_weights(mesh: Triangulation, handles: Array, iterations: int = 20) -> Array:
    """(v, h) weights in [0, 1] that add up to 1 (Jacobson et al. 2011).

    Each column has the least ``w K M^-1 K w`` within its bounds (``K`` the cotangent Laplacian,
    ``M`` the Voronoi areas); then rows are divided by their sums. Where ``iterations`` end libigl's
    active-set method early, as they do on 10^4 vertices, bounds hold up to about 1e-4.
    """

    def compute() -> Array:
        import igl  # noqa: PLC0415

        vertices, faces = _mesh(mesh)
        w = igl.bbw(
            vertices, faces, handles.astype(np.int64), np.eye(len(handles)), max_iter=iterations
        )
        w = np.asarray(w)
        return w / w.sum(axis=1, keepdims=True)

    return _remembered(mesh, ("bounded", handles.tobytes(), iterations), compute)


def harmonic_weights(mesh: Triangulation, handles: Array, power: int = 2) -> Array:
    """(v, h) weights with vanishing Laplacian (``power = 1``) or bi-Laplacian (2)."""

    def compute() -> Array:
        import igl  # noqa: PLC0415

        vertices, faces = _mesh(mesh)
        boundary = np.eye(len(handles))
        return np.asarray(igl.harmonic(vertices, faces, handles.astype(np.int64), boundary, power))

    return _remembered(mesh, ("harmonic", handles.tobytes(), power), compute)


def _remembered(mesh: Triangulation, key: Any, compute: Callable[[], Array]) -> Array:
    """The weights of a mesh that were computed last, if they are those of the key."""
    known = _known.get(mesh)
    if known is None or known[0] != key:
        known = _known[mesh] = (key, compute())
    return known[1]


def _mesh(mesh: Triangulation) -> tuple[Array, Array]:
    vertices = np.column_stack([mesh.vertices, np.zeros(len(mesh.vertices))])
    return np.ascontiguousarray(vertices), np.ascontiguousarray(mesh.triangles, dtype=np.int64)
