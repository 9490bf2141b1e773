"""Chapters of the course in a browser run from top to bottom and show their figures."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import nbformat
import pytest

from ..support.browser import LabNotebook, VoilaPage, still_sliders
from .conftest import OpenNotebook

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FOLDER = Path(__file__).parents[2] / "notebooks"
IMAGE = ".jp-OutputArea-output img"
RUNS = {
    "lab": ("09", LabNotebook),
    "notebook": ("04", functools.partial(LabNotebook, interface="notebook")),
    "voila": ("04", VoilaPage),
}


def code(chapter: str) -> list[Any]:
    (path,) = FOLDER.glob(f"{chapter}_*.ipynb")
    return [c for c in nbformat.read(path, as_version=4).cells if c.cell_type == "code"]


@pytest.mark.parametrize("name", RUNS)
def test_a_chapter_runs_and_shows_as_many_pictures_as_are_saved(
    open_notebook: OpenNotebook, name: str
) -> None:
    chapter, shown_by = RUNS[name]
    cells = code(chapter)
    book = open_notebook([cell.source for cell in cells], shown_by)
    outputs = [o for c in cells for o in c.outputs]
    texts = [output.get("data", {}).get("text/plain") for output in outputs]
    saved = [text for text in texts if text in ("<NotebookFigure>", "<LiveFigure>")]
    book.page.locator(IMAGE).nth(len(saved) - 1).wait_for(state="attached", timeout=60_000)
    for figure in book.page.locator("figure.glid-frames").all():
        assert not still_sliders(figure)
    assert texts.count("<LiveFigure>") == book.page.locator("figure.glid-frames").count() > 0
    assert not book.page.get_by_text("Traceback (most recent call last)").count()
    book.screenshot(f"chapter-{name}")
