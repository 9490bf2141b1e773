"""Write the minutes of each chapter at its head: ``python tools/minutes.py``.

One rule counts them, so that chapters can be compared: a minute for 120 words, for each displayed
equation and for each cell of code that is to be read, and 6 for each exercise, rounded up to 5.
Solutions, folded cells and checks do not count. The rates were chosen so that the reading takes as
long as one reader's estimates of chapters 03 to 09b; nobody was timed.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import nbformat
from nbformat import NotebookNode

FOLDER = Path(__file__).resolve().parent.parent / "notebooks"
OWN_WORK = "13"
"""The chapter that is the student's own work; its minutes are not counted."""
WORDS, EXERCISE, STEP = 120, 6, 5

_EQUATION = re.compile(r"\$\$.+?\$\$", re.DOTALL)
_STATED = re.compile(r"(\*\*Minutes:\*\* *)(\d+)")


def counted(book: NotebookNode) -> int:
    """Minutes for reading a chapter and for its exercises."""
    words = equations = cells = exercises = 0
    for cell in book.cells:
        tags = set(cell.metadata.get("tags", ()))
        if cell.cell_type == "markdown":
            if not cell.source.startswith("<details"):
                equations += len(_EQUATION.findall(cell.source))
                words += len(_EQUATION.sub("", cell.source).split())
        elif "exercise" in tags:
            exercises += 1
        elif not tags & {"hide-input", "check", "remove-cell"}:
            cells += 1
    minutes = words / WORDS + equations + cells + EXERCISE * exercises
    return STEP * math.ceil(minutes / STEP)


def stated(book: NotebookNode) -> int:
    """The minutes at a chapter's head."""
    found = (_STATED.search(cell.source) for cell in book.cells[:3])
    return next(int(one[2]) for one in found if one)


def chapters() -> list[Path]:
    """The chapters whose minutes are counted."""
    found = sorted(FOLDER.glob("[0-9][0-9]*_*.ipynb"))
    return [path for path in found if not path.name.startswith(OWN_WORK)]


def main() -> None:
    for path in chapters():
        book = nbformat.read(path, as_version=4)
        before, now = stated(book), counted(book)
        if before != now:
            for cell in book.cells[:3]:
                cell.source = _STATED.sub(rf"\g<1>{now}", cell.source)
            nbformat.write(book, path)
            print(f"{path.name}: {now} instead of {before}")


if __name__ == "__main__":
    main()
