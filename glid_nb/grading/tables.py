"""Grades as a table to read, and as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from glid_nb.grading.handed_in import Grade
from glid_nb.grading.verdicts import ALL, RIGHT

_TEXT = 70  # characters of a reason in a printed table
_HEAD = ("student", "exercise", "verdict")


def table(grades: Sequence[Grade]) -> str:
    """One line for each exercise: student, exercise, verdict, reason."""
    columns = Columns.of((g.student, g.chapter) for g in grades)
    return "\n".join([columns.head, *map(columns.line, grades)])


@dataclass(frozen=True)
class Columns:
    """The widths of the table's columns, known before anything is graded."""

    widths: tuple[int, int, int]

    @classmethod
    def of(cls, expected: Iterable[tuple[str, str]]) -> Columns:
        """The widths for the (student, chapter) that are going to be graded."""
        widths = [len(name) for name in _HEAD]
        for student, chapter in expected:
            widths[0] = max(widths[0], len(student))
            widths[1] = max(widths[1], len(chapter) + 2)  # the exercise's number
        return cls((widths[0], widths[1], max(map(len, ALL))))

    @property
    def head(self) -> str:
        return self._written((*_HEAD, ""))

    def line(self, grade: Grade) -> str:
        exercise = f"{grade.chapter} {grade.exercise}" if grade.chapter else ""
        return self._written((grade.student, exercise, grade.verdict, _short(grade.text)))

    def _written(self, row: tuple[str, ...]) -> str:
        return _printable("  ".join(map(str.ljust, row, [*self.widths, 0])).rstrip())


def everything(grades: Sequence[Grade]) -> str:
    """CSV with one line for each exercise."""
    head = ("student", "chapter", "exercise", "verdict", "text")
    rows = ((g.student, g.chapter, g.exercise or "", g.verdict, g.text) for g in grades)
    return _csv(head, rows)


def moodle(grades: Sequence[Grade]) -> str:
    """CSV for Moodle's import of grades: one line for each student, a column for each chapter."""
    names = _chapters(grades)
    rows = []
    for student, of in points(grades).items():
        own = [g for g in grades if g.student == student]
        said = [f"{g.chapter} {g.exercise}: {g.verdict}" if g.chapter else g.text for g in own]
        rows.append((student, *(of.get(name, "") for name in names), "; ".join(said)))
    return _csv(("Username", *names, "Feedback"), rows)


def canvas(grades: Sequence[Grade], possible: Mapping[str, int]) -> str:
    """CSV for Canvas's import into the gradebook. ``possible`` are the points of the chapters."""
    names = _chapters(grades)
    fixed = ("Student", "ID", "SIS User ID", "SIS Login ID", "Section")
    rows: list[tuple[object, ...]] = [
        ("    Points Possible", "", "", "", "", *(possible[name] for name in names))
    ]
    for student, of in points(grades).items():
        rows.append((student, "", "", student, "", *(of.get(name, "") for name in names)))
    return _csv((*fixed, *names), rows)


def points(grades: Sequence[Grade]) -> dict[str, dict[str, int]]:
    """The number of right exercises, by student and chapter."""
    found = dict[str, dict[str, int]]()
    for one in grades:
        of_student = found.setdefault(one.student, {})
        if not one.chapter:
            continue
        of_student[one.chapter] = of_student.get(one.chapter, 0) + (one.verdict == RIGHT)
    return found


def _chapters(grades: Sequence[Grade]) -> list[str]:
    return list(dict.fromkeys(g.chapter for g in grades if g.chapter))


def _csv(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(head)
    writer.writerows([_cell(value) for value in row] for row in rows)
    # Names and reasons come from students, and half a surrogate pair cannot be written.
    return buffer.getvalue().encode(errors="replace").decode()


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
