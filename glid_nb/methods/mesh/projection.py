"""Projection onto maps of bounded distortion, which turn no triangle over (Kovalsky et al. 2015).

The differentials of the current map are projected onto ``|f_zbar| <= k |f_z|`` triangle by
triangle; the next map is the closest one on the hyperplane that separates them, the constraints
kept. That needs one solve with the Laplacian's factor per iteration. It need not succeed.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.methods.mesh.operators import MeshOperators, Pinned

Array = NDArray[Any]

BOUND, ENOUGH = 0.9, 0.95
"""The little dilatation is projected onto the first bound until it is below the second, at which
the singular values' ratio is 39."""


def project(
    operators: MeshOperators, pinned: Pinned, w: Array, most_iterations: int = 500
) -> tuple[Array, int]:
    """A map close to ``w`` with the same held vertices, and how many iterations it took.

    Whether triangles are left that are turned over is for the caller to see.
    """
    for iteration in range(most_iterations):
        fz, fzb = operators.wirtinger(w)
        if (np.abs(fzb) < ENOUGH * np.abs(fz)).all():
            return w, iteration
        pz, pzb = closest(fz, fzb, BOUND)
        nz, nzb = fz - pz, fzb - pzb
        gap = float(operators.weights @ (np.abs(nz) ** 2 + np.abs(nzb) ** 2))
        normal = operators.adjoint(nz, nzb)
        direction = pinned.solve(normal)
        slope = float(np.real(np.vdot(normal, direction)))
        if not slope > 0:
            return w, iteration
        w = w - (gap / slope) * direction
    return w, most_iterations


def closest(fz: Array, fzb: Array, bound: float) -> tuple[Array, Array]:
    """The closest differentials with ``|f_zbar| <= bound |f_z|``."""
    a, b = np.abs(fz), np.abs(fzb)
    t = (a + bound * b) / (1 + bound**2)
    outside = b > bound * a
    safe_a, safe_b = np.where(a > 0, a, 1), np.where(b > 0, b, 1)
    pz = np.where(outside, t * np.where(a > 0, fz / safe_a, 1), fz)
    pzb = np.where(outside, bound * t * fzb / safe_b, fzb)
    return pz, pzb
