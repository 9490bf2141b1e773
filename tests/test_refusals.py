"""How bad input is refused, wherever that is."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import glid_nb
from glid_nb._errors import InputError, InputFileError, about, did_you_mean

PACKAGE = Path(glid_nb.__file__).parent


@pytest.mark.slow
def test_every_refusal_of_the_package_is_an_input_error() -> None:
    """A plain ValueError is what a bug raises; the command line tells them apart by the class."""
    strangers = [
        f"{path.relative_to(PACKAGE)}: {node.name}"
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef) and "ValueError" in map(ast.unparse, node.bases)
    ]
    assert strangers == ["_errors.py: InputError"]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("the key 'phi' is missing", "a.json: the key 'phi' is missing"),
        ("a.json is not a JSON file", "a.json is not a JSON file"),
        ("a.json: phi[0] is nan", "a.json: phi[0] is nan"),
        ("a.jsonx is another file", "a.json: a.jsonx is another file"),
    ],
)
def test_the_place_stands_in_front_once(text: str, named: str) -> None:
    with pytest.raises(InputFileError) as refusal, about(Path("a.json")):
        raise InputError(text)
    assert str(refusal.value) == named


def test_a_bug_is_left_alone() -> None:
    with pytest.raises(ZeroDivisionError), about("a.json"):
        _ = 1 / 0


def test_a_name_that_is_near_is_offered() -> None:
    assert did_you_mean("holse", ("cage", "holes")) == "; did you mean 'holes'?"
    assert did_you_mean("q", ("cage", "holes")) == ""
