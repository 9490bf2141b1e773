"""Mean value coordinates of a polygon (Floater 2003; Hormann & Floater 2006)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

# A point this close to an edge, relative to its ends' distances, is on it.
_ON_EDGE = 1e-12


def mean_value_coordinates(z: Array, polygon: Array) -> Array:
    """(k, n) coordinates of complex points, anywhere, with respect to a simple polygon (n,)."""
    s = polygon - z[:, None]
    after = np.roll(s, -1, axis=1)
    r = np.abs(s)
    r_after = np.abs(after)
    cross, dot = np.imag(s.conj() * after), np.real(s.conj() * after)
    scale = r * r_after
    flat = np.abs(cross) <= _ON_EDGE * scale
    tangent = np.where(flat, 0, (scale - dot) / np.where(flat, 1, cross))
    total = tangent + np.roll(tangent, 1, axis=1)
    w = total / np.where(r > 0, r, 1)
    w = w / w.sum(axis=1, keepdims=True)
    # On an edge: linear between its ends. At a vertex the two edges that meet there agree.
    rows, edges = np.nonzero(flat & (dot <= 0))
    span = r[rows, edges] + r_after[rows, edges]
    w[rows] = 0
    w[rows, edges] = r_after[rows, edges] / span
    w[rows, (edges + 1) % len(polygon)] = r[rows, edges] / span
    return w


def handle_polygon(handles: Array) -> Array:
    """(h,) indices that order the handles by their angle about their mean: a simple polygon."""
    return np.argsort(np.angle(handles - handles.mean()), kind="stable")
