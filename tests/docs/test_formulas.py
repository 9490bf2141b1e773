"""Equations on pages and slides: where they wrap, and what stays together."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from docutils import nodes
from docutils.utils import new_document
from fontTools.ttLib import TTFont

from tools import equations

DOCS = Path(__file__).resolve().parents[2] / "docs"


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
    assert 'rspace="0.25em"' not in equations.mathml("a + b", "block")


def test_an_upper_limit_keeps_away_from_its_integral() -> None:
    made = equations.mathml(r"\int_a^b f", "block")
    assert '<mspace width="0.35em" /><mi>b</mi></mrow></msubsup>' in made
    assert "0.35em" not in equations.mathml(r"x_a^b", "block")


def test_every_stretched_character_of_the_font_can_be_stretched() -> None:
    """Browsers leave a character as it is if its repeated part connects to nothing."""
    math = TTFont(DOCS / "static" / "math.woff")["MATH"].table.MathVariants
    made = [one.GlyphAssembly for one in math.VertGlyphConstruction if one.GlyphAssembly]
    repeated = [part for one in made for part in one.PartRecords if part.PartFlags & 1]
    assert repeated
    for part in repeated:
        ends = part.StartConnectorLength, part.EndConnectorLength
        assert min(ends) >= math.MinConnectorOverlap, part.glyph


def operators(latex: str) -> list[tuple[str | None, str | None, str | None]]:
    """(text, lspace, rspace) of the operators whose spaces are set."""
    tree = ElementTree.fromstring(equations.mathml(latex, "inline"))
    found = [one for one in tree.iter() if one.tag.endswith("}mo") and one.text != "|"]
    return [(one.text, one.get("lspace"), one.get("rspace")) for one in found if one.get("lspace")]


@pytest.mark.parametrize(
    "latex", ["(-x)", "a = -x", "-x", "|-x|", "a, -x", r"\frac{-1}{z}", "2^{-1}"]
)
def test_a_sign_of_one_number_has_no_spaces(latex: str) -> None:
    assert operators(latex) == [("\u2212", "0", "0")]


@pytest.mark.parametrize("latex", ["a - b", "(a) - b", "|a| - |b|", r"|a|\pm|b|", "a_1^2 + b"])
def test_a_sign_between_numbers_has_equal_spaces(latex: str) -> None:
    ((_, left, right),) = operators(latex)
    assert left == right != "0"


def test_a_sign_in_an_index_has_no_spaces() -> None:
    assert operators("v_{i+1}") == [("+", "0", "0")]


def test_names_of_functions_have_a_thin_space_beside_letters_only() -> None:
    assert operators(r"\log z") == [("log", "0", "0.167em")]
    assert operators(r"2\arg z") == [("arg", "0.167em", "0.167em")]
    assert operators(r"a \ge \min(b)") == [("min", "0", "0")]
    assert operators(r"\det J") == [("det", "0", "0.167em")]


LONG = r"|f(v_i)| + |f(v_{i+1})| - |g(v_i)| - |g(v_{i+1})| \ge (L_f + L_g) \, l = c"


def test_a_long_formula_may_break_before_relations_and_signs_outside_brackets() -> None:
    made = equations.displayed(LONG)
    groups = re.findall(r"<span>(.*?)</span>", made)
    assert [group.count("<math") for group in groups] == [4, 1, 1]
    assert all("\u2265" in group or "=</mo>" in group for group in groups[1:])


def test_a_short_left_side_has_no_line_of_its_own() -> None:
    made = equations.displayed(r"L_f = " + LONG.partition(r" \ge")[0])
    first = re.findall(r"<span>(.*?)</span>", made)[0]
    assert first.split("<wbr>")[0].count("=</mo>") == 1


def test_parts_hold_the_whole_formula() -> None:
    parts = re.sub(r"<[^>]*>", "", equations.displayed(LONG))
    assert parts == re.sub(r"<[^>]*>", "", equations.mathml(LONG, "block"))


@pytest.mark.parametrize(
    "latex", ["a = b", r"\left( " + LONG.replace(r"\ge", "+").replace("= c", "") + r" \right)"]
)
def test_a_short_formula_and_a_bracket_do_not_break(latex: str) -> None:
    assert "<wbr>" not in equations.displayed(latex)


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
