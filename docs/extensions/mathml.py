"""Equations as MathML; `tools/equations.py` makes it.

A displayed equation of several formulas wraps between them. A comma or a full stop after a formula
stays on its line.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from html import escape
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.writers.html5 import HTML5Translator

from tools import equations

_MARKS = re.compile(r"[.,;:?!)]+")
_TAG = re.compile(r"\\tag\*?\{([^{}]*)\}")


def made(make: Callable[..., str], *latex: str) -> str:
    try:
        return make(*latex)
    except ValueError as error:
        raise SphinxError(str(error)) from error


def keep_marks(_app: Sphinx, document: nodes.document) -> None:
    """Move the punctuation after a formula into its node."""
    for node in document.findall(nodes.math):
        after = node.next_node(nodes.Text, descend=False, siblings=True)
        if after is None or after is not node.parent[node.parent.index(node) + 1]:
            continue
        if marks := _MARKS.match(after):
            node["marks"] = marks[0]
            node.parent.replace(after, nodes.Text(after[marks.end() :]))


def visit_inline(self: HTML5Translator, node: nodes.math) -> None:
    formula = made(equations.mathml, node.astext(), "inline")
    marks = escape(node.get("marks", ""))
    self.body.append(f'<span class="formula">{formula}{marks}</span>' if marks else formula)
    raise nodes.SkipNode


def visit_block(self: HTML5Translator, node: nodes.math_block) -> None:
    latex = node.astext()
    tag = _TAG.search(latex)
    number = tag[1] if tag else node.get("number")
    names = " ".join(f'id="{escape(name)}"' for name in node["ids"][:1])
    formulas = [made(equations.displayed, one) for one in equations.pieces(_TAG.sub("", latex))]
    self.body.append(f'<div class="equation" {names}><div>{"".join(formulas)}</div>')
    if number:
        self.body.append(f'<span class="number">({escape(str(number))})</span>')
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    app.connect("doctree-read", keep_marks)
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
