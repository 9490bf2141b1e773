"""Chapters and handed-in notebooks, as cells; answers, and which of them were touched."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from glid_nb._errors import InputFileError, about
from glid_nb._json import read_object
from glid_nb.grading.verdicts import MISSING, UNTOUCHED

TAGS = ("exercise", "check", "answer")
_CHECK = re.compile(r"^(with check|run_check)\(", re.MULTILINE)
_FUNCTION = re.compile(r"^def (\w+)\(", re.MULTILINE)


@dataclass(frozen=True)
class Cell:
    """A cell of code."""

    id: str
    source: str
    tags: tuple[str, ...] = ()

    @property
    def functions(self) -> tuple[str, ...]:
        """The names of the functions that the cell defines."""
        return tuple(n.name for n in ast.parse(self.source).body if isinstance(n, ast.FunctionDef))


@dataclass(frozen=True)
class Notebook:
    """The cells of code of a notebook, and the chapter that its metadata name."""

    cells: tuple[Cell, ...]
    chapter: str = ""

    @classmethod
    def read(cls, path: Path) -> Notebook:
        """Raises an InputFileError for a file that is no notebook."""
        with about(path):
            return cls.from_json(read_object(path))

    @classmethod
    def parsed(cls, text: str) -> Notebook:
        """The notebook in a file's text. Raises an InputFileError for any other text."""
        try:
            return cls.from_json(json.loads(text))
        except InputFileError:
            raise
        except (ValueError, RecursionError, MemoryError) as error:
            raise InputFileError(str(error) or "it does not fit into memory") from None

    @classmethod
    def from_json(cls, book: Any) -> Notebook:
        """Raises an InputFileError if the value is no notebook."""
        cells = book.get("cells") if isinstance(book, Mapping) else None
        if not isinstance(cells, list):
            raise InputFileError("this is no notebook: it has no cells")
        metadata = book.get("metadata", {})
        ours = metadata.get("glid_nb", {}) if isinstance(metadata, dict) else {}
        chapter = ours.get("chapter", "") if isinstance(ours, dict) else ""
        return cls(tuple(_code_cells(cells)), chapter if isinstance(chapter, str) else "")

    @property
    def exercises(self) -> tuple[Cell, ...]:
        return tuple(cell for cell in self.cells if "exercise" in cell.tags)


def _code_cells(cells: Sequence[Any]) -> Iterator[Cell]:
    for cell in cells:
        if not isinstance(cell, dict) or cell.get("cell_type") != "code":
            continue
        source = cell.get("source", "")
        metadata = cell.get("metadata", {})
        tags = metadata.get("tags", []) if isinstance(metadata, dict) else []
        yield Cell(
            str(cell.get("id", "")),
            "".join(map(str, source)) if isinstance(source, list) else str(source),
            tuple(tag for tag in tags if isinstance(tag, str)) if isinstance(tags, list) else (),
        )


@dataclass(frozen=True)
class Answer:
    """What somebody wrote into an exercise."""

    source: str
    """The code, with the cells that the student added before the check. Empty if untouched."""
    untouched: str = ""
    """Why there is nothing to check: the cell is as it was given, empty or missing."""
    missing: bool = False
    """Whether there is no such cell."""

    @property
    def nothing(self) -> str:
        """The verdict if there is nothing to check."""
        return MISSING if self.missing else UNTOUCHED


def answers(chapter: Notebook, handed_in: Notebook) -> dict[str, Answer]:
    """The answers to a chapter's cells with the tag `exercise` or `answer`, by the cells' ids.

    Cells are found by their ids. If an editor has changed all ids, they are found by the order of
    the cells with the same tag. A cell that is still not found is the one that defines the same
    function. Cells of the chapter that a student has edited are ignored.
    """
    given = {cell.id: cell for cell in chapter.cells}
    theirs = list(handed_in.cells)
    wanted = [cell for cell in chapter.cells if {"exercise", "answer"} & set(cell.tags)]
    if not {cell.id for cell in wanted} & {cell.id for cell in theirs}:
        theirs = _renamed(chapter, theirs)
    theirs = _found_by_function(wanted, given, theirs)
    found, more = dict[str, list[str]](), list[str]()
    for cell in theirs:
        if cell.id not in given:
            more.append(cell.source)
        elif given[cell.id] in wanted:
            found.setdefault(cell.id, []).extend([*more, cell.source])
            more, last = [], cell.id
        elif "check" in given[cell.id].tags and found:
            found[last].extend(more)
            more = []
    return {cell.id: _answer(cell, found.get(cell.id)) for cell in wanted}


def _renamed(chapter: Notebook, cells: Sequence[Cell]) -> list[Cell]:
    """The cells with the chapter's ids where tags and their order tell which is which."""
    ids = {tag: [c.id for c in chapter.cells if tag in c.tags] for tag in TAGS}
    sources = {cell.source: cell.id for cell in chapter.cells}
    renamed = []
    for cell in cells:
        tags = ("check",) if _CHECK.search(cell.source) else cell.tags
        tag = next((tag for tag in TAGS if tag in tags and ids[tag]), None)
        new = ids[tag].pop(0) if tag else sources.get(cell.source, cell.id)
        renamed.append(Cell(new, cell.source, cell.tags))
    return renamed


def _found_by_function(
    wanted: Sequence[Cell], given: Mapping[str, Cell], cells: Sequence[Cell]
) -> list[Cell]:
    """The cells with the chapter's ids for those that define the function of a lost cell."""
    present = {cell.id for cell in cells}
    lost = {name: c.id for c in wanted if c.id not in present for name in c.functions}
    renamed = []
    for cell in cells:
        defined = () if cell.id in given else _FUNCTION.findall(cell.source)
        new = next((lost[name] for name in defined if name in lost), cell.id)
        renamed.append(Cell(new, cell.source, cell.tags))
    return renamed


def _answer(given: Cell, sources: Sequence[str] | None) -> Answer:
    if sources is None:
        return Answer("", "the cell is missing", missing=True)
    source = "\n\n".join(map(without_magics, sources))
    try:
        tree = ast.parse(source)
        same = ast.dump(tree) == ast.dump(ast.parse(given.source))
    except (SyntaxError, ValueError, RecursionError, MemoryError):  # the last two: nested too deep
        return Answer(source)
    if not tree.body:
        return Answer("", "the cell is empty")
    return Answer("", "the cell is as it was given") if same else Answer(source)


def without_magics(source: str) -> str:
    """The code without IPython's lines that begin with % or !."""
    return re.sub(r"^[%!].*$", "", source, flags=re.MULTILINE)
