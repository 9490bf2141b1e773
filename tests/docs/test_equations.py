"""The page of the paper's equations is complete, and the named code cites the equations."""

from __future__ import annotations

import functools
import importlib
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "equations.md"
TEXT = PAGE.read_text(encoding="utf-8")

# How many numbered equations each appendix has.
APPENDICES = {"A": 1, "B": 2, "C": 8, "D": 4, "E": 10, "F": 8, "G": 11, "H": 1, "I": 2}
LETTERED = {4: "abcd", 10: "ab"}  # equations of several lines
NUMBERS = [
    *(f"({n}{letter})" for n in range(1, 34) for letter in LETTERED.get(n, [""])),
    *(f"({name}.{n})" for name, count in APPENDICES.items() for n in range(1, count + 1)),
]
THEOREMS = [
    "Theorem 4.1",
    "Theorem 4.2",
    "Theorem 8.1",
    "Corollary 8.2",
    "Theorem A.1",
    "Lemma C.1",
    "Proposition I.1",
]
LINES = [f"line {n}" for n in range(1, 25)]
TABLES = ["Algorithm 1", "Table 1", "Table 2"]
FIGURES = [f"Figure {n}" for n in range(1, 13)]


class Row(NamedTuple):
    label: str
    where: str
    differs: str
    section: str
    """The part of the paper, as a docstring names it: "Section 5", "Appendix D"."""

    def __str__(self) -> str:
        return self.label


def rows() -> list[Row]:
    """The rows of all tables with the four columns."""
    found = []
    for part in re.split(r"^## ", TEXT, flags=re.MULTILINE)[1:]:
        section = re.match(r"(?:Section \d+|Appendix [A-I])", part)
        for line in part.splitlines():
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            if section and len(cells) == 4 and cells[0] not in ("paper", "---"):
                found.append(Row(cells[0], cells[2], cells[3], section[0]))
    return found


ROWS = rows()


def dotted(text: str) -> list[str]:
    return re.findall(r"`(glid_nb(?:\.\w+)+)`", text)


@functools.cache
def resolved(name: str) -> Any:
    """The object of a dotted name: the longest module that there is, then attributes."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        module = ".".join(parts[:length])
        try:
            found = importlib.import_module(module)
        except ModuleNotFoundError as error:
            if not module.startswith(str(error.name)):  # another import failed there
                raise
            continue
        return functools.reduce(getattr, parts[length:], found)
    raise ModuleNotFoundError(name)


def documentation(name: str) -> str:
    return resolved(name).__doc__ or ""


def names_its_place(text: str, row: Row) -> bool:
    """Whether a docstring names the row's number, or, where it has none, its part of the paper."""
    label = "Algorithm 1" if row.label in (*LINES, "input", "output") else row.label
    return label in text or (row.label not in (*NUMBERS, *THEOREMS) and row.section in text)


@pytest.mark.parametrize("name", sorted(set(dotted(TEXT))))
def test_every_name_on_the_page_exists(name: str) -> None:
    resolved(name)


def test_a_name_that_does_not_exist_is_found() -> None:
    resolved("glid_nb.certificate.paper.turning")
    for wrong in ("glid_nb.certificate.paper.turned", "glid_nb.certificates.paper"):
        with pytest.raises((AttributeError, ModuleNotFoundError)):
            resolved(wrong)


@pytest.mark.parametrize("path", sorted(set(re.findall(r"`([\w/]+\.py)`", TEXT))))
def test_every_file_on_the_page_exists(path: str) -> None:
    assert (ROOT / path).is_file()


@pytest.mark.parametrize("label", [*NUMBERS, *THEOREMS, *LINES, *TABLES])
def test_everything_numbered_has_one_row(label: str) -> None:
    assert [row.label for row in ROWS].count(label) == 1


@pytest.mark.parametrize("label", FIGURES)
def test_every_figure_has_a_row(label: str) -> None:
    assert f"\n| {label} | " in TEXT


def test_rows_are_in_the_order_of_the_paper() -> None:
    assert [row.label for row in ROWS if row.label in NUMBERS] == NUMBERS
    assert [row.label for row in ROWS if row.label in LINES] == LINES


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_a_row_names_code_or_says_why_there_is_none(row: Row) -> None:
    assert dotted(row.where) or (row.where == "–" and row.differs)


@pytest.mark.parametrize(
    ("row", "name"),
    [(row, name) for row in ROWS for name in dotted(row.where)],
    ids=str,
)
def test_code_names_its_place_in_the_paper(row: Row, name: str) -> None:
    assert names_its_place(documentation(name), row), f"{name} does not name {row.label}"
