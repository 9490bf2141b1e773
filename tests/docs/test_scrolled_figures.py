"""A study's figure scrolls in a box of its own on a phone."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from docutils import nodes
from docutils.utils import new_document
from PIL import Image

from docs.extensions import scrolled_figures
from glid_nb.figures.style import CSS_DPI
from studies.figures import DPI


def boxes(tmp_path: Path, name: str, *beside: nodes.Node) -> list[str]:
    """The raw HTML that a page with a picture gets."""
    Image.new("RGB", (2 * DPI, 30), "white").save(tmp_path / name)
    document = new_document("page")
    document += nodes.paragraph("", "", nodes.image(uri=name, alt='Rex, "ours"'), *beside)
    env = SimpleNamespace(relfn2path=lambda uri: (uri, str(tmp_path / uri)))
    app: Any = SimpleNamespace(env=env)
    scrolled_figures.add(app, document)
    return [raw.astext() for raw in document.findall(nodes.raw)]


def test_the_box_has_the_figures_own_width_and_its_words(tmp_path: Path) -> None:
    begin, end = boxes(tmp_path, "figure.webp")
    assert f"--own-width: {round(2 * CSS_DPI)}px" in begin  # two inches, as large as in a notebook
    assert 'aria-label="Rex, &quot;ours&quot;"' in begin
    assert 'tabindex="0"' in begin
    assert end == "</div>"


def test_other_pictures_have_no_box(tmp_path: Path) -> None:
    assert boxes(tmp_path, "picture.png") == []
    assert boxes(tmp_path, "figure.webp", nodes.Text("in a sentence")) == []
