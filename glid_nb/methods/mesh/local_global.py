"""ARAP on a mesh by local and global steps (Liu et al. 2008), with hard constraints."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.methods.mesh.operators import MeshOperators, Pinned

Array = NDArray[Any]


def local_global(
    operators: MeshOperators, pinned: Pinned, w: Array, targets: Array, iterations: int
) -> Array:
    """Images after some iterations; triangles may turn over."""
    for _ in range(iterations):
        fz, _ = operators.wirtinger(w)
        modulus = np.abs(fz)
        rotation = np.where(modulus > 0, fz / np.where(modulus > 0, modulus, 1), 1)
        w = pinned.solve(2 * operators.adjoint(rotation, 0 * rotation), targets)
    return w
