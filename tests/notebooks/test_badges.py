"""The line about where a notebook runs, and the cell for Colab."""

from __future__ import annotations

import ast
from typing import Any

import nbformat

from tools import badges


def test_the_cells_stand_below_the_title_once_however_often_they_are_written() -> None:
    book = nbformat.v4.new_notebook()
    book.cells = [nbformat.v4.new_markdown_cell("# Title"), nbformat.v4.new_code_cell("1 + 1")]
    for repository in (None, "owner/name", "owner/name"):
        badges.with_badges(book, "03_x.ipynb", repository)
    assert [cell.id for cell in book.cells[1:3]] == ["run-it", "colab"]
    assert len(book.cells) == 4
    nbformat.validate(book)


def test_binder_comes_first_and_every_link_opens_this_notebook() -> None:
    line = badges.line("03_x.ipynb", "owner/name")
    assert line.index("mybinder.org") < line.index("colab.research") < line.index("raw.github")
    assert line.count("owner/name") == line.count("notebooks/03_x.ipynb") == 3
    assert "untested" in line


def test_the_colab_cell_does_nothing_elsewhere() -> None:
    namespace: dict[str, Any] = {}
    exec(badges.COLAB, namespace)
    assert "output" not in namespace
    assert isinstance(ast.parse(badges.COLAB).body[-1], ast.If)
