"""Closing a widget with everything that it is made of."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import ipywidgets


def close_with_parts(*widgets: ipywidgets.Widget) -> None:
    """Close widgets and all widgets that they hold: children, layouts, styles, textures.

    ipywidgets closes one at a time and registers every one, so what is not closed stays in the
    kernel and in the page for good. Parts must not be shared with a widget that lives on.
    """
    found: dict[int, ipywidgets.Widget] = {}
    waiting = list(widgets)
    while waiting:
        widget = waiting.pop()
        if id(widget) not in found:
            found[id(widget)] = widget
            for name in widget.traits(sync=True):
                waiting += _widgets_in(getattr(widget, name))
    for widget in found.values():
        widget.close()


def _widgets_in(value: Any) -> Iterator[ipywidgets.Widget]:
    if isinstance(value, ipywidgets.Widget):
        yield value
    elif isinstance(value, (list, tuple)):
        for item in value:
            yield from _widgets_in(item)
    elif isinstance(value, dict):
        for item in value.values():
            yield from _widgets_in(item)
