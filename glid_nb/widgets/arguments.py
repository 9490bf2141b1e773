"""Checks of a widget's arguments, before anything is made."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from typing import Any

from ipywidgets import Widget

from glid_nb import _arguments
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


def check_keywords(widget: type[Widget], given: Iterable[str]) -> None:
    """Refuse keywords that neither a widget nor ipywidgets has.

    Raises
    ------
    TypeError
        For the first of them, with the name that was probably meant.
    """
    own = [name for name in inspect.signature(widget.__init__).parameters if name != "self"]
    traits = [name for name in widget.class_trait_names() if not name.startswith("_")]
    _arguments.check_keywords(widget.__name__, given, [*own, *traits])
