"""Image deformation by moving least squares (Schaefer, McPhail & Warren 2006)."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Kind = Literal["rigid", "similarity"]


def moving_least_squares(
    z: Array, handles: Array, targets: Array, kind: Kind = "rigid", alpha: float = 1.0
) -> Array:
    """Images of complex points ``z`` (k,).

    At each point the rigid motion or similarity that fits the handles best, with the weights
    ``|p_i - z|^(-2 alpha)``. Handles go to their targets exactly.
    """
    if not len(handles):
        return z.copy()
    distance = np.abs(z[:, None] - handles)
    at = distance.argmin(axis=1)
    exact = distance[np.arange(len(z)), at] == 0
    w = np.where(distance > 0, distance, 1.0) ** (-2 * alpha)
    w /= w.sum(axis=1, keepdims=True)
    middle, aim = w @ handles, w @ targets
    p, q = handles - middle[:, None], targets - aim[:, None]
    turn = (w * p.conj() * q).sum(axis=1)
    size = np.abs(turn) if kind == "rigid" else (w * np.abs(p) ** 2).sum(axis=1)
    turn = np.where(size > 0, turn / np.where(size > 0, size, 1), 1)
    return np.where(exact, targets[at], aim + turn * (z - middle))
