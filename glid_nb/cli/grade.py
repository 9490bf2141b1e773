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
import sys
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from types import FrameType

import glid_nb
from glid_nb._errors import InputError
from glid_nb.cli.many import refuse_standard_output
from glid_nb.cli.output import check_files, step, write
from glid_nb.grading import tables
from glid_nb.grading.grade import grade
from glid_nb.grading.handed_in import Grade, HandedIn, chapters_in, handed_in

LIMIT = 60.0
_LONGEST = 86_400.0  # seconds: a day


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
    files = {name: getattr(chosen, name) for name in ("csv", "moodle", "canvas")}
    for name, path in files.items():
        if path is not None:
            refuse_standard_output(path, f"--{name}", "the table is printed there, so name a file")
    check_files(files.values(), [])
    chapters = chapters_in(chosen.chapters or _own_chapters())
    if not chosen.folder.is_dir():
        raise InputError(f"{chosen.folder} is no folder")
    found = handed_in(chosen.folder, chapters)  # all are read before one is run
    possible = {name: len(chapter.notebook.exercises) for name, chapter in chapters.items()}
    grades = list[Grade]()
    try:
        with _ended_by_signals():
            _grade_all(found, chosen, grades)
    except (KeyboardInterrupt, SystemExit):
        count = len({(one.student, one.chapter) for one in grades})
        text = f"{count} of {len(found.counting)} notebooks were graded before the interruption"
        print(f"glid-nb: {text}", file=sys.stderr)
        raise
    finally:  # also after Ctrl-C, with the grades so far
        every = [*grades, *found.others]
        _write(files["csv"], tables.everything(every))
        _write(files["moodle"], tables.moodle(every))
        _write(files["canvas"], tables.canvas(every, possible))
    if chosen.json:
        print(json.dumps([asdict(one) for one in every]))


def _grade_all(found: HandedIn, chosen: argparse.Namespace, grades: list[Grade]) -> None:
    """Grade one hand-in after the other, print each, and add it to ``grades``."""
    say = _nothing if chosen.json else functools.partial(print, flush=True)
    expected = [(one.student, one.chapter.name) for one in found.counting]
    columns = tables.Columns.of([*expected, *((one.student, "") for one in found.others)])
    say(columns.head)
    for one in found.counting:
        with step(f"grading {one.path.relative_to(chosen.folder)}"):
            own = grade(one, limit=chosen.limit, folder=chosen.folder)
        grades += own
        say("\n".join(map(columns.line, own)))
    for line in found.others:
        say(columns.line(line))


def _write(path: Path | None, text: str) -> None:
    if path is not None:
        write(path, text)


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
    if value > _LONGEST:
        raise argparse.ArgumentTypeError(f"a limit is at most {_LONGEST:g} seconds, which is a day")
    return value
