"""Messages from a page without a page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ipywidgets import Widget


def send(widget: Widget, content: dict[str, Any], buffers: Sequence[Any] = ()) -> None:
    """Give a widget a message as if its view on the page had sent it."""
    message = {"data": {"method": "custom", "content": content}}
    assert widget.comm is not None
    widget.comm.handle_msg({"content": message, "buffers": list(buffers)})
