"""Pictures in the text of notebooks are part of the notebook."""

from __future__ import annotations

import re
from pathlib import Path

import nbformat
import pytest

from tools.attach_pictures import ROOT, attach

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
PICTURE = re.compile(r"!\[[^\]]*\]\(([^)]*)\)|<img[^>]*src=[\"']?([^\"'\s>]*)")


def shown(path: Path) -> list[tuple[nbformat.NotebookNode, str]]:
    cells = nbformat.read(path, as_version=4).cells
    text = [cell for cell in cells if cell.cell_type == "markdown"]
    return [(cell, "".join(found)) for cell in text for found in PICTURE.findall(cell.source)]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_picture_in_the_text_is_attached_to_its_cell(path: Path) -> None:
    """A picture by its path is missing in a copy. Voila refuses a page with one outside its
    folder."""
    for cell, place in shown(path):
        assert place.startswith("attachment:"), f"{path.name} shows {place} by its path"
        attached = cell.get("attachments", {})
        assert place.removeprefix("attachment:") in attached
        attach(cell)
        assert cell.attachments == attached, "run python tools/attach_pictures.py"


def test_the_editors_notebook_shows_the_editor() -> None:
    (path,) = (path for path in NOTEBOOKS if path.stem == "02_editor")
    assert [place for _, place in shown(path)] == ["attachment:editor-deform.png"]
