"""The buttons below a chapter's title."""

from __future__ import annotations

import re
from pathlib import Path

import nbformat

from tools import badges

FOLDER = Path(__file__).parents[2] / "notebooks"


def a_notebook() -> nbformat.NotebookNode:
    book = nbformat.v4.new_notebook()
    book.cells = [nbformat.v4.new_markdown_cell("# Title"), nbformat.v4.new_code_cell("1 + 1")]
    return book


def test_there_are_two_buttons_below_the_title_however_often_they_are_written() -> None:
    book = a_notebook()
    for _ in range(2):
        badges.with_buttons(book, "03_x.ipynb", "owner/name")
    assert [cell.id for cell in book.cells[1:2]] == ["run-it"]
    assert len(book.cells) == 3
    assert len(re.findall(r"\]\(https://", book.cells[1].source)) == 2
    nbformat.validate(book)


def test_both_open_this_notebook() -> None:
    text = badges.buttons("03_x.ipynb", "owner/name")
    assert text.count("owner/name") == text.count("notebooks/03_x.ipynb") == 2


def test_binder_finds_the_notebook_in_a_folder_that_binder_is_configured_for() -> None:
    """The button's path is relative to the repository, whose folder `binder` installs all."""
    path = FOLDER.parent / "notebooks" / "03_why_pictures_fold.ipynb"
    assert path.is_file()
    assert f"labpath=notebooks/{path.name}" in badges.buttons(path.name, "owner/name")
    assert (FOLDER.parent / "binder" / "requirements.txt").is_file()


def test_without_a_public_repository_there_are_none() -> None:
    book = a_notebook()
    badges.with_buttons(book, "03_x.ipynb", "owner/name")
    badges.with_buttons(book, "03_x.ipynb")
    assert [cell.source for cell in book.cells] == ["# Title", "1 + 1"]
    for path in FOLDER.glob("[0-9][0-9]*_*.ipynb"):
        ids = [cell.id for cell in nbformat.read(path, as_version=4).cells]
        assert not {"run-it", "colab"} & set(ids), path.name
