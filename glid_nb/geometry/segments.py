"""Plane geometry of many pairs of segments at a time, as complex numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def cross(a: Array, b: Array) -> Array:
    """``a_x b_y - a_y b_x``."""
    return np.imag(np.conj(a) * b)


def point_distance(point: Array, start: Array, end: Array) -> Array:
    """Distances from points to the segments of the same index; shapes broadcast."""
    along = end - start
    square = np.real(along * np.conj(along))
    position = np.real((point - start) * np.conj(along)) / np.where(square > 0, square, 1)
    return np.abs(point - start - np.clip(position, 0, 1) * along)


def segments_cross(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Whether the segments from ``a`` to ``b`` and from ``c`` to ``d`` cross, no end on either."""
    ab, cd = b - a, d - c
    return (cross(ab, c - a) * cross(ab, d - a) < 0) & (cross(cd, a - c) * cross(cd, b - c) < 0)


def segment_distance(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Distances between the segments from ``a`` to ``b`` and those from ``c`` to ``d``."""
    ends = np.minimum(
        np.minimum(point_distance(a, c, d), point_distance(b, c, d)),
        np.minimum(point_distance(c, a, b), point_distance(d, a, b)),
    )
    return np.where(segments_cross(a, b, c, d), 0.0, ends)
