"""Sizes that were given to a widget, refused by name before anything is made."""

from __future__ import annotations

from typing import Any

from glid_nb._arguments import check_count

LEAST_CANVAS = 100
"""Least width and height of a canvas, CSS pixels."""


def check_vertices(n_vertices: Any) -> int | None:
    """The number of vertices of a canvas's mesh, or None.

    Raises
    ------
    TypeError, ValueError
        As `check_count`.
    """
    return None if n_vertices is None else check_count("n_vertices", n_vertices, 3, "vertices")
