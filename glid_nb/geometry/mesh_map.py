"""A piecewise linear map as a value."""

from __future__ import annotations

import functools
import weakref
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glid_nb.geometry.triangulate import Triangulation

Array = NDArray[Any]


# One per mesh: the iterations of a method or of a drag share it.
_finders: weakref.WeakKeyDictionary[Triangulation, Any] = weakref.WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class MeshMap:
    """A triangle mesh and the images of its vertices.

    Parameters
    ----------
    triangulation : Triangulation
        The mesh of the domain.
    images : (v, 2) array
        Images of its vertices, world coordinates.
    """

    triangulation: Triangulation
    images: Array

    def __post_init__(self) -> None:
        images = np.array(self.images, dtype=float)
        if images.shape != self.triangulation.vertices.shape:
            raise ValueError(
                f"there are images of shape {images.shape} for vertices of shape "
                f"{self.triangulation.vertices.shape}; give one image per vertex"
            )
        images.setflags(write=False)
        object.__setattr__(self, "images", images)

    def __call__(self, points: ArrayLike) -> Array:
        """Images of (k, 2) points; one off the mesh moves with a triangle at the nearest vertex."""
        xy = np.atleast_2d(np.asarray(points, dtype=float))
        if xy.ndim != 2 or xy.shape[1] != 2:
            raise ValueError(f"points have shape {xy.shape}; expected (k, 2)")
        triangle = _finder(self.triangulation)(xy[:, 0], xy[:, 1])
        mesh = self.triangulation
        beside = triangle < 0
        if beside.any():
            from scipy.spatial import KDTree  # noqa: PLC0415 - only for points off the mesh

            nearest = KDTree(mesh.vertices).query(xy[beside])[1]
            triangle[beside] = self._any_triangle[nearest]
        corners = mesh.triangles[triangle]
        a, b, c = (mesh.vertices[corners[:, i]] for i in range(3))
        matrix = np.stack([b - a, c - a], axis=-1)
        weights = np.linalg.solve(matrix, (xy - a)[..., None])[..., 0]
        weights = np.column_stack([1 - weights.sum(axis=1), weights])
        return np.einsum("ki,kid->kd", weights, self.images[corners])

    @property
    def areas(self) -> Array:
        """(t,) signed areas of the image triangles."""
        a, b, c = (self.images[self.triangulation.triangles[:, i]] for i in range(3))
        u, v = b - a, c - a
        return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])

    @property
    def flipped(self) -> Array:
        """(t,) bool: image triangles that are turned over or flat."""
        return ~(self.areas > 0)

    @property
    def layered(self) -> Array:
        """(t, 3) triangles from the left of the undeformed shape to its right.

        Drawn in this order, overlapping sheets stay apart.
        """
        mesh = self.triangulation
        middle = mesh.vertices[mesh.triangles, 0].mean(axis=1)
        return mesh.triangles[np.argsort(middle, kind="stable")]

    @functools.cached_property
    def _any_triangle(self) -> Array:
        mesh = self.triangulation
        owner = np.zeros(len(mesh.vertices), dtype=int)
        owner[mesh.triangles.ravel()] = np.repeat(np.arange(len(mesh.triangles)), 3)
        return owner


def _finder(mesh: Triangulation) -> Any:
    """A function of x and y: the triangle of each point, -1 for none."""
    known = _finders.get(mesh)
    if known is None:
        from matplotlib.tri import Triangulation as Planar  # noqa: PLC0415 - slow to import

        x, y = mesh.vertices.T
        known = _finders[mesh] = Planar(x, y, mesh.triangles).get_trifinder()
    return known
