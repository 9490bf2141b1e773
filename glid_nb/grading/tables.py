"""Grades as a table to read, and as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence

from glid_nb.grading.grade import Grade, points

_TEXT = 70  # characters of a reason in a printed table


def table(grades: Sequence[Grade]) -> str:
    """One line for each exercise: student, exercise, verdict, reason."""
    rows = [("student", "exercise", "verdict", "")]
    rows += [(g.student, f"{g.chapter} {g.exercise}", g.verdict, _short(g.text)) for g in grades]
    widths = [max(len(row[i]) for row in rows) for i in range(3)]
    lines = ("  ".join(map(str.ljust, row, [*widths, 0])).rstrip() for row in rows)
    return "\n".join(_printable(line) for line in lines)


def everything(grades: Sequence[Grade]) -> str:
    """CSV with one line for each exercise."""
    head = ("student", "chapter", "exercise", "verdict", "text")
    rows = ((g.student, g.chapter, g.exercise, g.verdict, g.text) for g in grades)
    return _csv(head, rows)


def moodle(grades: Sequence[Grade]) -> str:
    """CSV for Moodle's import of grades: one line for each student, a column for each chapter."""
    names = list(dict.fromkeys(g.chapter for g in grades))
    rows = []
    for student, of in points(grades).items():
        own = [g for g in grades if g.student == student]
        said = [f"{g.chapter} {g.exercise}: {g.verdict}" for g in own]
        rows.append((student, *(of.get(name, "") for name in names), "; ".join(said)))
    return _csv(("Username", *names, "Feedback"), rows)


def canvas(grades: Sequence[Grade], possible: Mapping[str, int]) -> str:
    """CSV for Canvas's import into the gradebook. ``possible`` are the points of the chapters."""
    names = list(dict.fromkeys(g.chapter for g in grades))
    fixed = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
    rows: list[tuple[object, ...]] = [
        ("    Points Possible", "", "", "", "", *(possible[name] for name in names))
    ]
    for student, of in points(grades).items():
        rows.append((student, "", "", student, "", *(of.get(name, "") for name in names)))
    return _csv((*fixed, *names), rows)


def _csv(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([_cell(value) for value in row] for row in rows)
    return buffer.getvalue()


def _cell(value: object) -> object:
    """A text that a spreadsheet would take for a formula begins with an apostrophe."""
    if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t", "\r")):
        return f"'{value}"
    return value


def _short(text: str) -> str:
    return text if len(text) <= _TEXT else f"{text[: _TEXT - 3]}..."


def _printable(line: str) -> str:
    """Names and reasons come from students: no control characters reach the console."""
    return "".join(c if c.isprintable() else "?" for c in line)
