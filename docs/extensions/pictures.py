"""Links every picture to its file, because on a phone the page shows it too small."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx


def link(_app: Sphinx, document: nodes.document) -> None:
    """Set a scale: Sphinx links pictures with a scale. Notebooks' pictures have a width."""
    for image in document.findall(nodes.image):
        if not {"width", "height"} & set(image.attributes):
            image["scale"] = 100


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
