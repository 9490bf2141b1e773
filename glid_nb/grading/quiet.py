"""What a chapter's cells need outside a kernel, and figures that are not drawn."""

from __future__ import annotations

from typing import Any
from unittest.mock import MagicMock

from glid_nb import figures


def namespace_of_a_chapter() -> dict[str, Any]:
    return {"__name__": "__main__", "display": _nothing}


def without_figures() -> None:
    """From now on figures of this process draw nothing."""
    for name in dir(figures):
        setattr(figures, name, _nothing)


def _nothing(*_: Any, **__: Any) -> Any:
    return MagicMock()
