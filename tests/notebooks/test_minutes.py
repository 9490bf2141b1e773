"""The minutes at a chapter's head are counted by one rule, that of `tools/minutes.py`."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from tools import minutes


@pytest.mark.parametrize("path", minutes.chapters(), ids=lambda path: path.stem)
def test_a_chapter_states_the_minutes_that_are_counted(path: Path) -> None:
    book = nbformat.read(path, as_version=4)
    assert minutes.stated(book) == minutes.counted(book)


def test_words_equations_cells_and_exercises_count_and_nothing_that_is_folded() -> None:
    text = "word " * 240 + "$$a + b$$ $$c$$"
    cells = [new_markdown_cell(text), new_code_cell("shown"), new_code_cell("f()")]
    cells[2].metadata["tags"] = ["exercise"]
    book = new_notebook(cells=cells)  # 2 + 2 + 1 + 6 minutes
    assert minutes.counted(book) == 15
    folded = new_code_cell("check()")
    folded.metadata["tags"] = ["hide-input", "check"]
    book.cells += [new_markdown_cell(f"<details>{'word ' * 900}</details>"), folded]
    assert minutes.counted(book) == 15
    book.cells += [new_code_cell("one more")] * 5
    assert minutes.counted(book) == 20
