"""Equations as MathML, which browsers draw by themselves: no script and no network."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from latex2mathml.converter import convert

_ARG = re.compile(r"\\arg\b")  # which latex2mathml does not know
_BAR = '<mo stretchy="false">|</mo>'  # of a modulus, without an operator's spaces
_LINES = ("\u00af", "\u2015")  # over conjugates: too short or too long, as letters
_MATHML = "http://www.w3.org/1998/Math/MathML"

ElementTree.register_namespace("", _MATHML)


def mathml(latex: str, display: str) -> str:
    """The element ``math``; ``display`` is "inline" or "block".

    Raises a ValueError for an equation that latex2mathml cannot read.
    """
    try:
        made = convert(_ARG.sub(r"\\operatorname{arg}", latex), display=display)
    except Exception as error:  # whatever its parser raises, the equation is at fault
        raise ValueError(f"latex2mathml cannot read {latex!r}: {error!r}") from error
    if unknown := re.findall(r">(\\\w+)", made):
        raise ValueError(f"latex2mathml does not know {', '.join(unknown)} in {latex!r}")
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
