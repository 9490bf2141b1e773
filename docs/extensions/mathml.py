"""Equations as MathML, which browsers draw by themselves: no script and no network."""

from __future__ import annotations

import re
from html import escape
from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.errors import SphinxError
from sphinx.writers.html5 import HTML5Translator

_ARG = re.compile(r"\\arg\b")  # which latex2mathml does not know
_BAR = '<mo stretchy="false">|</mo>'  # of a modulus, without an operator's spaces
_LINES = ("\u00af", "\u2015")  # over conjugates: too short or too long, as letters
_MATHML = "http://www.w3.org/1998/Math/MathML"
_TAG = re.compile(r"\\tag\*?\{([^{}]*)\}")

ElementTree.register_namespace("", _MATHML)


def mathml(latex: str, display: str) -> str:
    """The element ``math``; ``display`` is "inline" or "block"."""
    try:
        made = convert(_ARG.sub(r"\\operatorname{arg}", latex), display=display)
    except Exception as error:  # whatever its parser raises, the equation is at fault
        raise SphinxError(f"latex2mathml cannot read {latex!r}: {error!r}") from error
    if unknown := re.findall(r">(\\\w+)", made):
        raise SphinxError(f"latex2mathml does not know {', '.join(unknown)} in {latex!r}")
    made = with_borders(made)
    return made.replace(_BAR, _BAR.replace(">", ' lspace="0" rspace="0">', 1))


def with_borders(math: str) -> str:
    """Draw the line over a conjugate as a border, which is as wide as what is below it."""
    tree = ElementTree.fromstring(math)
    for over in list(tree.iter(f"{{{_MATHML}}}mover")):
        if over[1].text in _LINES:
            over.tag, over.attrib = f"{{{_MATHML}}}mrow", {"class": "conjugate"}
            over.remove(over[1])
    return ElementTree.tostring(tree, encoding="unicode")


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
