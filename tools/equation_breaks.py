"""Where a long displayed formula may go on in the next line: before a relation, or before a sign.

Browsers break no MathML. So a long formula becomes several elements, which a page sets like words.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from copy import copy
from xml.etree.ElementTree import Element

from tools.equation_spacing import MATHML, RELATIONS, SIGNS, name

_LONG = 24  # letters, digits and signs; shorter formulas fit a phone
_LABEL = 8  # as many on the left side of a formula leave room for more on its line
_OPENING, _CLOSING = frozenset("([{"), frozenset(")]}")
_RELATION_SPACE = "0.278em"


def broken(tree: Element) -> list[list[Element]]:
    """The parts of a formula ``math``, in groups that begin with a relation: lines should rather
    begin there than before a sign. A short formula is one part."""
    row = tree[0] if len(tree) == 1 and name(tree[0]) == "mrow" else None
    if row is None or _size(row) <= _LONG:
        return [[tree]]
    places = [0, *_places(list(row)), len(row)]
    if len(places) == 2:
        return [[tree]]
    groups = list[list[Element]]()
    for first, last in itertools.pairwise(places):
        if first == 0 or row[first].text in RELATIONS:
            groups.append([])
        groups[-1].append(_part(tree, list(row)[first:last]))
    return groups


def _places(row: list[Element]) -> list[int]:
    """Before which elements a new line may begin: outside brackets and moduli, and not after a
    short left side."""
    found, depth, bars = list[int](), 0, 0
    for i, element in enumerate(row):
        text = element.text or ""
        if name(element) != "mo":
            continue
        depth += (text in _OPENING) - (text in _CLOSING)
        bars += text == "|"
        sign = text in SIGNS and element.get("form") == "infix"
        if depth == 0 and bars % 2 == 0 and i and (sign or text in RELATIONS):
            found.append(i)
    label = found and row[found[0]].text in RELATIONS and _size(row[: found[0]]) <= _LABEL
    return found[1:] if label else found


def _size(elements: Iterable[Element]) -> int:
    """The number of letters, digits and signs."""
    return sum(name(one) in ("mi", "mo", "mn") for tree in elements for one in tree.iter())


def _part(tree: Element, elements: list[Element]) -> Element:
    """A formula with some of the elements. A relation that begins it keeps its spaces."""
    part = Element(tree.tag, {**tree.attrib, "display": "inline", "displaystyle": "true"})
    row = Element(f"{{{MATHML}}}mrow")
    first, *others = elements
    if name(first) == "mo" and first.text in RELATIONS:
        first = copy(first)
        first.attrib |= {"form": "infix", "lspace": _RELATION_SPACE, "rspace": _RELATION_SPACE}
    row.extend([first, *others])
    part.append(row)
    return part
