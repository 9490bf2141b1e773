"""Equations as MathML, which browsers draw by themselves: no script and no network."""

from __future__ import annotations

import re
from html import escape
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.writers.html5 import HTML5Translator

_TAG = re.compile(r"\\tag\*?\{([^{}]*)\}")


def mathml(latex: str, display: str) -> str:
    """The element ``math``; ``display`` is "inline" or "block"."""
    try:
        return convert(latex, display=display)
    except Exception as error:  # whatever its parser raises, the equation is at fault
        raise SphinxError(f"latex2mathml cannot read {latex!r}: {error!r}") from error


def visit_inline(self: HTML5Translator, node: nodes.math) -> None:
    self.body.append(mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def visit_block(self: HTML5Translator, node: nodes.math_block) -> None:
    latex = node.astext()
    tag = _TAG.search(latex)
    number = tag[1] if tag else node.get("number")
    names = " ".join(f'id="{escape(name)}"' for name in node["ids"][:1])
    self.body.append(f'<div class="equation" {names}>{mathml(_TAG.sub("", latex), "block")}')
    if number:
        self.body.append(f'<span class="number">({escape(str(number))})</span>')
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
