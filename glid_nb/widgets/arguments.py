"""Sizes that were given to a widget, refused by name before anything is made."""

from __future__ import annotations

from numbers import Integral
from typing import Any

LEAST_CANVAS = 100
"""Least width and height of a canvas, CSS pixels."""


def check_count(name: str, value: Any, least: int, unit: str) -> int:
    """``value`` as an int.

    Raises
    ------
    TypeError
        It is no whole number.
    ValueError
        It is less than ``least``.
    """
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be a whole number of {unit}, not {value!r:.60}")
    if value < least:
        raise ValueError(f"{name} is {value}; it must be at least {least} {unit}")
    return int(value)


def check_vertices(n_vertices: Any) -> int | None:
    """The number of vertices of a canvas's mesh, or None.

    Raises
    ------
    TypeError, ValueError
        As `check_count`.
    """
    return None if n_vertices is None else check_count("n_vertices", n_vertices, 3, "vertices")
