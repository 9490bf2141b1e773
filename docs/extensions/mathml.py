"""Equations as MathML; `tools/equations.py` makes it."""

from __future__ import annotations

import re
from html import escape
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.writers.html5 import HTML5Translator

from tools import equations

_TAG = re.compile(r"\\tag\*?\{([^{}]*)\}")


def mathml(latex: str, display: str) -> str:
    try:
        return equations.mathml(latex, display)
    except ValueError as error:
        raise SphinxError(str(error)) from error


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
