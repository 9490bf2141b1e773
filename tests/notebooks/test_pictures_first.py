"""A chapter opens with a picture: what makes it ready, and what checks exercises, is folded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("[0-9][0-9]*_*.ipynb"))
MOST = 16  # lines of code above the first picture


def code_cells(path: Path) -> list[Any]:
    cells = nbformat.read(path, as_version=4).cells
    return [cell for cell in cells if cell.cell_type == "code"]


def is_folded(cell: Any) -> bool:
    """In JupyterLab. The site reads the tag `hide-input`."""
    return cell.metadata.get("jupyter", {}).get("source_hidden", False)


def tags(cell: Any) -> list[str]:
    return cell.metadata.get("tags", [])


def shows_a_picture(cell: Any) -> bool:
    return any("image/png" in output.get("data", ()) for output in cell.outputs)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_folded_in_jupyterlab_is_folded_on_the_site_and_checks_are(path: Path) -> None:
    for cell in code_cells(path):
        assert is_folded(cell) == ("hide-input" in tags(cell)), cell.id
        assert is_folded(cell) or "check" not in tags(cell), cell.id
        assert not is_folded(cell) or "exercise" not in tags(cell), cell.id


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_few_lines_of_code_stand_above_the_first_picture(path: Path) -> None:
    lines = 0
    for cell in code_cells(path):
        lines += 0 if is_folded(cell) else len(cell.source.splitlines())
        if shows_a_picture(cell):
            break
    assert lines <= MOST
