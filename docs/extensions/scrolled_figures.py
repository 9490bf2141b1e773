"""On a phone, a study's figure keeps its size and scrolls sideways, so that its text stays legible.

Its panels stand in rows and columns with names at their edges, so they cannot come below each other
as those of a notebook do (`narrow_figures.py`).
"""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from docutils import nodes
from PIL import Image

from glid_nb.figures.style import CSS_DPI
from studies.figures import DPI

if TYPE_CHECKING:  # the functions need no Sphinx
    from sphinx.application import Sphinx


def opening(path: Path, words: str) -> str:
    """The tag that begins the scrolled box; the keyboard reaches the box, as the theme's tables."""
    with Image.open(path) as picture:
        width = round(picture.width * CSS_DPI / DPI)
    return (
        f'<div class="scrolled-figure" style="--own-width: {width}px" tabindex="0" '
        f'role="group" aria-label="{escape(words)}">'
    )


def add(app: Sphinx, document: nodes.document) -> None:
    """Put each figure of a study into a box, which the style sheet lets scroll on narrow pages."""
    for image in list(document.findall(nodes.image)):
        path = Path(app.env.relfn2path(image["uri"])[1])
        shown = image.parent
        if path.suffix != ".webp" or not isinstance(shown, nodes.paragraph) or len(shown) > 1:
            continue
        place, parent = shown.parent.index(shown), shown.parent
        parent.insert(place + 1, nodes.raw("", "</div>", format="html"))
        parent.insert(place, nodes.raw("", opening(path, image.get("alt", "")), format="html"))


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", add, priority=400)  # before Sphinx collects the pictures
    return {"parallel_read_safe": True, "parallel_write_safe": True}
