"""The spaces of operators in MathML, as TeX sets them.

latex2mathml names no forms. A browser then takes each sign that does not begin its row for one
between two numbers, and a function's name has wide spaces, or none.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element

MATHML = "http://www.w3.org/1998/Math/MathML"
RELATIONS = frozenset("=<>≤≥≈≠∈∼≪≫→←↦⊂")
SIGNS = frozenset("+−±∓")
_OPENING = frozenset("([{,;")
_BAR = frozenset("|")
_CLOSING = frozenset(")]},;.")
_FUNCTIONS = frozenset(["log", "ln", "exp", "sin", "cos", "tan", "cosh", "sinh", "lim"])
_THIN = "0.167em"
_MEDIUM = "0.222em"
_ROWS = ("math", "mrow", "mtd", "msqrt", "mstyle")
_SCRIPTS = ("msub", "msup", "msubsup", "munder", "mover", "munderover")


def name(element: Element) -> str:
    """The tag without its namespace."""
    return element.tag.rpartition("}")[2]


def core(element: Element) -> Element:
    """The element below scripts and limits, as `max` in `max_i`."""
    while name(element) in _SCRIPTS and len(element):
        element = element[0]
    return element


def space_operators(tree: Element) -> None:
    """Give signs and functions' names their spaces, everywhere in a formula."""
    for sign in tree.iter(f"{{{MATHML}}}mi"):
        if sign.text in SIGNS:
            sign.tag = f"{{{MATHML}}}mo"
    _space(tree, in_script=False)


def _space(element: Element, *, in_script: bool) -> None:
    if name(element) in _ROWS:
        _space_row(list(element), in_script=in_script)
    for i, child in enumerate(element):
        _space(child, in_script=in_script or (i > 0 and name(element) in _SCRIPTS))


def _space_row(row: list[Element], *, in_script: bool) -> None:
    bars = 0
    for i, element in enumerate(row):
        here = core(element)
        before = core(row[i - 1]) if i else None
        after = core(row[i + 1]) if i + 1 < len(row) else None
        opened = before is None or _is(before, _OPENING) or (_is(before, _BAR) and bars % 2 == 1)
        if _is(here, SIGNS):
            prefix = opened or _is(before, RELATIONS | SIGNS)
            space = "0" if prefix or in_script else _MEDIUM
            here.attrib |= {"form": "prefix" if prefix else "infix"}
            here.attrib |= {"lspace": space, "rspace": space}
        elif is_function(here):
            here.tag = f"{{{MATHML}}}mo"
            follows = (
                before is not None
                and not opened
                and (name(before) != "mo" or _is(before, _CLOSING | _BAR))
            )
            tight = after is None or _is(after, _OPENING | _CLOSING)
            here.attrib |= {"lspace": _THIN if follows else "0", "rspace": "0" if tight else _THIN}
        bars += _is(here, _BAR)


def is_function(element: Element) -> bool:
    """Whether this is a name such as log, det or Re."""
    text = element.text or ""
    if name(element) == "mi":
        return text in _FUNCTIONS
    return name(element) == "mo" and len(text) > 1 and text.isalpha()


def _is(element: Element | None, texts: frozenset[str]) -> bool:
    return element is not None and name(element) == "mo" and element.text in texts
