"""Every picture leads to its file: on a phone a page shows less of it than there is."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx


def link(_app: Sphinx, document: nodes.document) -> None:
    """Name a scale, as Sphinx links pictures that have one; notebooks' have a width already."""
    for image in document.findall(nodes.image):
        if not {"width", "height"} & set(image.attributes):
            image["scale"] = 100


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
