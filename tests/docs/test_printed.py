"""Printed tables keep their columns on a phone; printed sentences break."""

from __future__ import annotations

import pytest
from docutils import nodes
from docutils.utils import new_document

from docs.extensions import printed


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        ("The solver converged: the Newton decrement is small.\ncertified: True\n", False),
        ("  indented, and nothing below it\n", False),
        ("Newton       7 iterations\nL-BFGS     150 iterations\n", True),
        ("  BDHM: k <= 0.18\nNewton: k <= 0.16\n", True),
        ("[-28.65  84.6   35.55 182.97]", True),
    ],
)
def test_only_printed_tables_have_columns(text: str, columns: bool) -> None:
    assert printed.has_columns(text) is columns


def test_only_outputs_are_marked() -> None:
    document = new_document("page")
    table, code = (
        nodes.literal_block("a  b", "a  b", classes=["output"]),
        nodes.literal_block("a  b", "a  b"),
    )
    document += [table, code]
    printed.mark(None, document)  # pyright: ignore[reportArgumentType]
    assert "columns" in table["classes"]
    assert "columns" not in code["classes"]
