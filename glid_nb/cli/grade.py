"""Grade handed-in chapters of the course.

FOLDER holds notebooks, such as STUDENT/07_newton.ipynb or STUDENT_07_newton.ipynb. The course's own
checks judge the cells that the students filled in. Each exercise is right, wrong, untouched,
missing, crashed or too slow. Everything else in a handed-in notebook is ignored, its outputs too.

The answers run as your user, in a process of their own. This is no sandbox: they can read and
delete your files. Grade strangers' code in a container without network.
"""

import argparse
import contextlib
import functools
import json
import math
import signal
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from types import FrameType

import glid_nb
from glid_nb._errors import InputError
from glid_nb.cli.output import check_files, step, write
from glid_nb.grading import grade as grading
from glid_nb.grading import tables

LIMIT = 60.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("folder", type=Path, metavar="FOLDER", help="what was handed in")
    chapters = "folder of the course's own chapters (default: that of the checkout)"
    add("--chapters", type=Path, metavar="FOLDER", help=chapters)
    limit = "seconds that the answer to an exercise may take (default: 60)"
    add("--limit", type=_seconds, default=LIMIT, metavar="SECONDS", help=limit)
    add("--csv", type=Path, metavar="grades.csv", help="file for all verdicts and reasons")
    add("--moodle", type=Path, metavar="moodle.csv", help="file for Moodle's import of grades")
    add("--canvas", type=Path, metavar="canvas.csv", help="file for Canvas's gradebook")
    add("--json", action="store_true", help="print the verdicts as JSON")


def run(chosen: argparse.Namespace) -> None:
    check_files([chosen.csv, chosen.moodle, chosen.canvas], [])
    chapters = grading.chapters_in(chosen.chapters or _own_chapters())
    if not chosen.folder.is_dir():
        raise InputError(f"{chosen.folder} is no folder")
    found = grading.hand_ins(chosen.folder, chapters)  # all are read before one is run
    empty = grading.without_notebook(chosen.folder, found)
    expected = [(one.student, one.chapter.name) for one in found]
    expected += [(one.student, "") for one in empty]
    say = _nothing if chosen.json else functools.partial(print, flush=True)
    columns = tables.Columns.of(expected)
    say(columns.head)
    grades = list[grading.Grade]()
    with _ended_by_signals():
        for one in found:
            with step(f"grading {one.path.relative_to(chosen.folder)}"):
                own = list(grading.grade(one, limit=chosen.limit, folder=chosen.folder))
            grades += own
            say("\n".join(map(columns.line, own)))
    grades += empty
    for one in empty:
        say(columns.line(one))
    possible = {name: len(chapter.notebook.exercises) for name, chapter in chapters.items()}
    files = {
        chosen.csv: tables.everything(grades),
        chosen.moodle: tables.moodle(grades),
        chosen.canvas: tables.canvas(grades, possible),
    }
    for path, text in files.items():
        if path is not None:
            write(path, text)
    if chosen.json:
        print(json.dumps([asdict(one) for one in grades]))


def _nothing(text: str) -> None:
    """Print no table beside JSON."""


@contextlib.contextmanager
def _ended_by_signals() -> Iterator[None]:
    """Leave by an exception when the process is to end, so that it ends the answers' processes.

    A signal that is ignored, as SIGHUP under nohup, stays ignored.
    """

    def leave(number: int, _frame: FrameType | None) -> None:
        raise SystemExit(128 + number)

    known = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    numbers = [number for number in known if signal.getsignal(number) != signal.SIG_IGN]
    before = {number: signal.signal(number, leave) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _own_chapters() -> Path:
    folder = Path(glid_nb.__file__).resolve().parents[1] / "notebooks"
    if not folder.is_dir():
        raise InputError("name the folder of the course's own chapters: --chapters FOLDER")
    return folder


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not (math.isfinite(value) and value > 0):
        raise argparse.ArgumentTypeError(f"a limit is a number of seconds, not {text!r:.40}")
    return value
