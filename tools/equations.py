"""Equations as MathML, which browsers draw by themselves: no script and no network."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from latex2mathml.converter import convert

from tools.equation_breaks import broken
from tools.equation_spacing import MATHML, space_operators

_ARG = re.compile(r"\\arg\b")  # which latex2mathml does not know
_BAR = '<mo stretchy="false">|</mo>'  # of a modulus, without an operator's spaces
_LINES = ("\u00af", "\u2015")  # over conjugates: too short or too long, as letters
_INTEGRALS = ("\u222b", "\u222e")  # lean over what follows, if nothing keeps it away

ElementTree.register_namespace("", MATHML)


def mathml(latex: str, display: str) -> str:
    """The element ``math``; ``display`` is "inline" or "block".

    Raises a ValueError for an equation that latex2mathml cannot read.
    """
    return _written(_tree(latex, display))


def displayed(latex: str) -> str:
    """HTML of a displayed formula. A long one may break between its parts, which are in spans.

    Raises a ValueError like :func:`mathml`.
    """
    groups = broken(_tree(latex, "block"))
    if sum(map(len, groups)) == 1:
        return _written(groups[0][0])
    lines = (f"<span>{'<wbr>'.join(map(_written, parts))}</span>" for parts in groups)
    return f'<span class="broken">{"<wbr>".join(lines)}</span>'


def _tree(latex: str, display: str) -> ElementTree.Element:
    try:
        made = convert(_ARG.sub(r"\\operatorname{arg}", latex), display=display)
    except Exception as error:  # whatever its parser raises, the equation is at fault
        raise ValueError(f"latex2mathml cannot read {latex!r}: {error!r}") from error
    if unknown := re.findall(r">(\\\w+)", made):
        raise ValueError(f"latex2mathml does not know {', '.join(unknown)} in {latex!r}")
    tree = ElementTree.fromstring(made)
    arrange(tree)
    space_operators(tree)
    return tree


def _written(tree: ElementTree.Element) -> str:
    made = ElementTree.tostring(tree, encoding="unicode")
    return made.replace(_BAR, _BAR.replace(">", ' lspace="0" rspace="0">', 1))


def pieces(latex: str) -> list[str]:
    """The formulas between wide spaces. On a narrow page each can have a line of its own."""
    found = re.split(r"\\q?quad(?![a-zA-Z])", latex)
    return found if all(map(_is_whole, found)) else [latex]


def _is_whole(latex: str) -> bool:
    """Whether nothing in a piece begins or ends in another one."""
    braces = latex.count("{") == latex.count("}")
    pairs = (r"\begin", r"\end"), (r"\left", r"\right")
    counts = ([len(re.findall(re.escape(one) + r"(?![a-z])", latex)) for one in p] for p in pairs)
    return bool(latex.strip()) and braces and all(first == last for first, last in counts)


def _moved_right(upper: ElementTree.Element) -> ElementTree.Element:
    """An upper limit beside the top of an integral, which leans there."""
    moved = ElementTree.Element(f"{{{MATHML}}}mrow")
    moved.append(ElementTree.Element(f"{{{MATHML}}}mspace", width="0.35em"))
    moved.append(upper)
    return moved


def arrange(tree: ElementTree.Element) -> None:
    """Draw the line over a conjugate as a border, which is as wide as what is below it, and leave
    room after integrals and before their upper limits."""
    for operator in tree.iter(f"{{{MATHML}}}mo"):
        if operator.text in _INTEGRALS:
            operator.set("rspace", "0.25em")
    for limits in tree.iter(f"{{{MATHML}}}msubsup"):
        if limits[0].text in _INTEGRALS:
            limits[2] = _moved_right(limits[2])
    for over in list(tree.iter(f"{{{MATHML}}}mover")):
        if over[1].text in _LINES:
            over.tag, over.attrib = f"{{{MATHML}}}mrow", {"class": "conjugate"}
            over.remove(over[1])
