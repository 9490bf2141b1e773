"""What was given to a widget, refused by name before anything is made."""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from numbers import Integral
from typing import Any

from ipywidgets import Widget

from glid_nb._errors import did_you_mean

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


def check_keywords(widget: type[Widget], given: Iterable[str]) -> None:
    """Refuse keywords that a widget does not have, neither itself nor from ipywidgets.

    Raises
    ------
    TypeError
        For the first of them; the message has the name that was probably meant.
    """
    traits = [name for name in widget.class_trait_names() if not name.startswith("_")]
    own = [name for name in inspect.signature(widget.__init__).parameters if name != "self"]
    for name in given:
        if name not in traits:
            hint = did_you_mean(name, [*own, *traits])
            raise TypeError(f"{widget.__name__} takes no argument {name!r}{hint}")
