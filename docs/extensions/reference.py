"""Adjusts autodoc for the pages of the reference."""

from __future__ import annotations

import inspect
import itertools
import re
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from traitlets import HasTraits

MADE_BY_THE_PACKAGE = {
    f"glid_nb.{name}"
    for name in [
        "Certificate",
        "certificate.GlobalInjectivity",
        "Iteration",
        "Progress",
        "Result",
        "Status",
        "Tracing",
    ]
}
KEPT = {"name", "triangulation", "images", "areas", "flipped", "layered"}


def strip_examples(_app: Sphinx, document: nodes.document) -> None:
    """Remove the empty line at the end of examples; doctest needs it, readers do not."""
    for block in document.findall(nodes.literal_block):
        if block.get("language") == "pycon":
            text = block.astext().rstrip()
            block.replace_self(nodes.literal_block(text, text, **block.attributes))


def signature(
    _app: Sphinx, what: str, name: str, value: Any, _options: Any, *_: str | None
) -> tuple[str, str] | None:
    """No signature for classes that only the package makes; the real one for a widget.

    Traitlets hides a widget's constructor behind ``*args, **kwargs``.
    """
    if name in MADE_BY_THE_PACKAGE:
        return "", ""
    if what != "class" or not issubclass(value, HasTraits):
        return None
    own = inspect.signature(value.__init__)
    parameters = [
        p.replace(annotation=p.empty)
        for p in own.parameters.values()
        if p.name not in ("self", "kwargs")
    ]
    return str(own.replace(parameters=parameters, return_annotation=own.empty)), ""


def skip_inner(
    app: Sphinx, what: str, name: str, _value: Any, _skip: bool, _options: Any
) -> bool | None:
    """For a method, show only its name and its settings; the rest is internal."""
    if app.env.docname.endswith("reference/methods") and what == "class":
        return name not in KEPT or None
    return None


def closing_words(
    _app: Sphinx, _what: str, _name: str, _value: Any, _options: Any, lines: list[str]
) -> None:
    """Move text after the parameters of a docstring in front of them.

    In the numpy style, this text would be read as one more parameter.
    """
    heads = [i for i in range(len(lines) - 1) if re.fullmatch("-{3,}", lines[i + 1].strip())]
    for head, end in reversed(list(itertools.pairwise([*heads, len(lines)]))):
        if lines[head] in ("Parameters", "Returns"):
            blanks = (i for i in range(head, end) if not lines[i].strip())
            first = next(blanks, end)
            words = lines[first:end]
            if any(words):
                lines[first:end] = [""]
                lines[heads[0] : heads[0]] = [*words[1:], ""]


def keep_notebooks_out(app: Sphinx) -> None:
    """Write unpacked outputs of notebooks beside the doctrees, not beside the site."""
    folder = Path(app.doctreedir, "notebooks")
    config = app.env.mystnb_config  # type: ignore[attr-defined]
    app.env.mystnb_config = config.copy(  # type: ignore[attr-defined]
        output_folder=str(folder), execution_cache_path=str(folder / "cache")
    )


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", strip_examples)
    app.connect("autodoc-process-signature", signature)
    app.connect("autodoc-skip-member", skip_inner)
    app.connect("autodoc-process-docstring", closing_words, priority=400)  # before napoleon
    app.connect("builder-inited", keep_notebooks_out, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
