"""Letting a widget answer its page while a cell runs."""

from __future__ import annotations

from typing import Any

import ipywidgets


def answer_during_cells(widget: ipywidgets.Widget) -> None:
    """Have a widget's messages handled where its page sends them: in a thread beside the cells.

    JupyterLab addresses a widget's messages to a subshell, a thread of the kernel that runs no
    cells. ipykernel from 7.4 on redirects them to the loop that last sent something to the page,
    which for a widget that a cell made is the main one, and there they wait until the cell that
    runs has ended. A widget that calls this must be ready for handlers in another thread. Where the
    kernel has no such redirection, or the page no subshell, nothing changes.
    """
    comm: Any = widget.comm
    if hasattr(comm, "_reply_subshell_for"):
        comm._reply_subshell_for = _as_addressed


def _as_addressed(_data: Any, addressed: str | None) -> str | None:
    return addressed
