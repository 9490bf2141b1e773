"""Marks printed tables: on a phone they scroll sideways, and printed sentences break."""

from __future__ import annotations

from textwrap import dedent
from typing import TYPE_CHECKING, Any

from docutils import nodes

if TYPE_CHECKING:  # the functions need no Sphinx
    from sphinx.application import Sphinx


def has_columns(text: str) -> bool:
    """Whether spaces align something in a printed text; in sentences there is one at a time."""
    return "  " in dedent(text).rstrip()


def mark(_app: Sphinx, document: nodes.document) -> None:
    """Give printed tables the class ``columns``, for the style sheet."""
    for block in document.findall(nodes.literal_block):
        if "output" in block["classes"] and has_columns(block.astext()):
            block["classes"].append("columns")


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", mark)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
