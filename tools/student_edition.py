"""Write the student edition of the course: ``python tools/student_edition.py [FOLDER]``.

It has the chapters without solutions. A check cell runs its check from a file in the folder
`checks`, so the notebook does not show it. Exercises and checks carry nbgrader's metadata.
"""

from __future__ import annotations

import itertools
import re
import shutil
import sys
from pathlib import Path

import nbformat
from nbformat import NotebookNode

FOLDER = Path(__file__).resolve().parent.parent / "notebooks"
CHECK = """from glid_nb.course import run_check

run_check("checks/{chapter}.py", {number}, globals())"""
_DOCS_LINK = re.compile(r"\[([^\]]+)\]\(\.\./(docs/[^)]+)\)")  # there is no folder docs beside it
_SOLUTION = re.compile(r"<details>\s*<summary>Solution</summary>")


def has(cell: NotebookNode, tag: str) -> bool:
    return tag in cell.metadata.get("tags", ())


def nbgrader(name: str, *, graded: bool) -> NotebookNode:
    """The metadata of nbgrader's schema 3: a cell to fill in, or a locked check for one point."""
    points = {"points": 1} if graded else {}
    return NotebookNode(
        grade_id=name,
        grade=graded,
        solution=not graded,
        locked=graded,
        task=False,
        schema_version=3,
        **points,
    )


def student_edition(book: NotebookNode, chapter: str) -> tuple[NotebookNode, str]:
    """The chapter for students, and the text of its file of checks."""
    cells, checks, exercises = list[NotebookNode](), list[str](), itertools.count(1)
    for given in book.cells:
        if _SOLUTION.match(given.source):
            continue
        cell = NotebookNode(given, metadata=NotebookNode(given.metadata))
        cells.append(cell)
        if cell.cell_type == "markdown":
            cell.source = _DOCS_LINK.sub(r"\1 (`\2`)", cell.source)
        number = len(checks) + 1
        if has(cell, "exercise"):
            cell.metadata.nbgrader = nbgrader(f"exercise-{next(exercises)}", graded=False)
        elif has(cell, "answer"):
            cell.metadata.nbgrader = nbgrader(f"answer-{cell.id}", graded=False)
        elif has(cell, "check"):
            checks.append(f"# %% exercise {number}\n{cell.source.strip()}\n")
            cell.source = CHECK.format(chapter=chapter, number=number)
            cell.outputs, cell.execution_count = [], None
            cell.metadata.nbgrader = nbgrader(f"check-{number}", graded=True)
    metadata = NotebookNode(book.metadata, glid_nb={"chapter": chapter})
    return NotebookNode(book, cells=cells, metadata=metadata), "\n\n".join(checks)


def main(folder: Path) -> None:
    (folder / "checks").mkdir(parents=True, exist_ok=True)
    paths = sorted(FOLDER.glob("[0-9][0-9]*_*.ipynb"))
    for path in paths:
        book, checks = student_edition(nbformat.read(path, as_version=4), path.stem)
        nbformat.write(book, folder / path.name)
        (folder / "checks" / f"{path.stem}.py").write_text(checks, encoding="utf-8")
    shutil.copyfile(FOLDER / "sessions.py", folder / "sessions.py")
    print(f"{folder}: {len(paths)} chapters without solutions")


if __name__ == "__main__":
    main(Path(*sys.argv[1:2] or ["student"]))
