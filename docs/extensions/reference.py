"""What the reference's pages need beyond autodoc."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from traitlets import HasTraits


def strip_examples(_app: Sphinx, document: nodes.document) -> None:
    """Examples end with an empty line for doctest, which need not be seen."""
    for block in document.findall(nodes.literal_block):
        if block.get("language") == "pycon":
            text = block.astext().rstrip()
            block.replace_self(nodes.literal_block(text, text, **block.attributes))


def widget_signature(
    _app: Sphinx, what: str, _name: str, value: Any, _options: Any, *_: str | None
) -> tuple[str, str] | None:
    """Of a widget's constructor, which traitlets hides behind ``*args, **kwargs``."""
    if what != "class" or not issubclass(value, HasTraits):
        return None
    own = inspect.signature(value.__init__)
    parameters = [
        p.replace(annotation=p.empty)
        for p in own.parameters.values()
        if p.name not in ("self", "kwargs")
    ]
    return str(own.replace(parameters=parameters, return_annotation=own.empty)), ""


def keep_notebooks_out(app: Sphinx) -> None:
    """What is unpacked of notebooks goes beside the doctrees, not beside the site."""
    folder = Path(app.doctreedir, "notebooks")
    config = app.env.mystnb_config  # type: ignore[attr-defined]
    app.env.mystnb_config = config.copy(  # type: ignore[attr-defined]
        output_folder=str(folder), execution_cache_path=str(folder / "cache")
    )


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", strip_examples)
    app.connect("autodoc-process-signature", widget_signature)
    app.connect("builder-inited", keep_notebooks_out, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
