"""Equations on pages and slides: where they wrap, and what stays together."""

from __future__ import annotations

import pytest
from docutils import nodes
from docutils.utils import new_document

from tools import equations


def test_formulas_between_wide_spaces_are_pieces() -> None:
    assert equations.pieces(r"a = b, \qquad c = d") == ["a = b, ", " c = d"]
    assert equations.pieces(r"a, \quad b") == ["a, ", " b"]
    assert equations.pieces("a = b") == ["a = b"]


@pytest.mark.parametrize(
    "latex",
    [
        r"\frac{a \qquad b}{c}",
        r"\begin{cases} a & x \qquad y \end{cases}",
        r"\left( a \qquad b \right)",
        r"\qquad a",
    ],
)
def test_a_formula_is_not_divided_inside(latex: str) -> None:
    assert equations.pieces(latex) == [latex]


def test_an_arrow_is_no_bracket() -> None:
    assert len(equations.pieces(r"x \leftarrow y \qquad z")) == 2


def test_there_is_room_after_an_integral() -> None:
    made = equations.mathml(r"\oint \frac{g(w)}{w - z} dw", "block")
    assert 'rspace="0.25em"' in made
    assert "rspace" not in equations.mathml("a + b", "block")


@pytest.mark.slow
def test_a_full_stop_after_a_formula_belongs_to_its_node() -> None:
    from docs.extensions import mathml  # needs Sphinx

    formula, other = nodes.math("", "x"), nodes.math("", "y")
    paragraph = nodes.paragraph("", "", nodes.Text("See "), formula, nodes.Text("). And "), other)
    document = new_document("page")
    document += paragraph
    mathml.keep_marks(None, document)  # type: ignore[arg-type]
    assert formula["marks"] == ")."
    assert "marks" not in other
    assert paragraph.astext() == "See x And y"
