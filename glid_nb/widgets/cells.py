"""Which notebook cell is running, so that its rerun can close what it made before."""

from __future__ import annotations

import sys
import weakref
from typing import Any, Protocol


class Closable(Protocol):
    """Something that a cell made and that has to be closed."""

    def close(self) -> None:
        """End it."""


_made: dict[str, tuple[str, list[weakref.ref[Any]]]] = {}


def register(made: Closable) -> bool:
    """Close what earlier runs of this cell registered, and remember this for the next run.

    Outside a notebook nothing happens. Returns whether something was closed.
    """
    here = _running_cell()
    if here is None:
        return False
    cell, run = here
    last_run, earlier = _made.get(cell, (run, []))
    closed = []
    if last_run != run:
        closed = [old for reference in earlier if (old := reference()) is not None]
        for old in closed:
            old.close()
        earlier = []
    _made[cell] = (run, [*earlier, weakref.ref(made)])
    return bool(closed)


def _running_cell() -> tuple[str, str] | None:
    """The cell's identity and that of its run, where the notebook tells them."""
    ipython = sys.modules.get("IPython")
    shell: Any = None if ipython is None else ipython.get_ipython()
    parent = getattr(shell, "get_parent", dict)()
    cell = parent.get("metadata", {}).get("cellId")
    run = parent.get("header", {}).get("msg_id")
    return (str(cell), str(run)) if cell and run else None
