"""Find what was handed in, and let a referee judge it."""

from __future__ import annotations

import contextlib
import json
import os
import re
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from glid_nb._errors import InputError
from glid_nb.grading.chapters import Notebook, answers
from glid_nb.grading.said import Said
from glid_nb.grading.verdicts import CRASHED, MISSING, RIGHT, SLOW

_MOODLE = re.compile(r"_\d+_assignsubmission_file_?$")
_OTHER_FILES = 50_000_000  # bytes of pictures and other files beside a notebook
_OWN_SECONDS = 900  # that a chapter's own cells may take
_REASON = 4000  # bytes at the end of the referee's errors, for a reason
_KEPT = ("PATH", "HOME", "TMPDIR", "LANG", "LC_ALL", "GLID_NB_CACHE", "SYSTEMROOT", "TEMP", "TMP")


@dataclass(frozen=True)
class Chapter:
    name: str
    text: str

    @property
    def notebook(self) -> Notebook:
        return Notebook.from_json(json.loads(self.text))


@dataclass(frozen=True)
class HandIn:
    """A notebook that was handed in. Its text is read before anybody's code runs."""

    student: str
    chapter: Chapter
    path: Path
    text: str


@dataclass(frozen=True)
class Grade:
    student: str
    chapter: str
    """Empty for a student without any notebook."""
    exercise: int
    verdict: str
    """One of `verdicts`."""
    text: str


def chapters_in(folder: Path) -> dict[str, Chapter]:
    """The course's own chapters, by name. Raises an InputError if there is none."""
    paths = sorted(folder.glob("[0-9][0-9]*_*.ipynb"))
    if not paths:
        raise InputError(f"{folder} has no chapter such as 07_newton.ipynb")
    return {path.stem: Chapter(path.stem, path.read_text(encoding="utf-8")) for path in paths}


def hand_ins(folder: Path, chapters: Mapping[str, Chapter]) -> list[HandIn]:
    """All notebooks in a folder, by student.

    The student is the name of the first folder below, or what stands before the chapter in the
    file's name. Raises an InputError if a notebook belongs to no chapter.
    """
    found = []
    for path in sorted(folder.rglob("*.ipynb")):
        inside = path.relative_to(folder)
        if ".ipynb_checkpoints" in inside.parts:
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        named = next((name for name in chapters if name in path.stem), "")
        with contextlib.suppress(InputError, ValueError, AttributeError):
            named = named or Notebook.from_json(json.loads(text)).chapter
        if named not in chapters:
            raise InputError(f"{path}: its name contains no chapter such as {next(iter(chapters))}")
        before = path.stem.partition(named)[0].strip("_- ")
        student = _student(inside.parts[0]) if len(inside.parts) > 1 else before
        found.append(HandIn(student or path.stem, chapters[named], path, text))
    if not found:
        raise InputError(f"{folder} has no notebook")
    return found


def _student(folder: str) -> str:
    return _MOODLE.sub("", folder)


def without_notebook(folder: Path, found: Sequence[HandIn]) -> list[Grade]:
    """A line for each student whose folder has no notebook."""
    having = {one.path.relative_to(folder).parts[0] for one in found}
    text = "the folder has no notebook"
    return [
        Grade(_student(path.name), "", 0, MISSING, text)
        for path in sorted(folder.iterdir())
        if path.is_dir() and not path.name.startswith(".") and path.name not in having
    ]


def grade(hand_in: HandIn, *, limit: float, folder: Path) -> Iterator[Grade]:
    """The grades of one hand-in, one for each exercise of its chapter.

    The answers run in a process of their own, in a copy of the files beside the notebook. Each may
    take ``limit`` seconds. ``folder`` is the one with all hand-ins.
    """
    chapter = hand_in.chapter.notebook
    count = len(chapter.exercises)

    def told(exercise: int, verdict: str, text: str) -> Grade:
        return Grade(hand_in.student, hand_in.chapter.name, exercise, verdict, text)

    try:
        given = answers(chapter, Notebook.from_json(json.loads(hand_in.text)))
    except (ValueError, RecursionError, InputError) as error:
        text = f"the file is no notebook: {error}"
        yield from (told(i, CRASHED, text) for i in range(1, count + 1))
        return
    if all(given[cell.id].untouched for cell in chapter.exercises):
        for i, cell in enumerate(chapter.exercises, 1):
            yield told(i, given[cell.id].nothing, given[cell.id].untouched)
        return
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        work = Path(name) / "work"
        work.mkdir()
        if hand_in.path.parent != folder:
            _copy_other_files(hand_in.path.parent, work)
        verdicts, why = _judged(hand_in, work, limit, _OWN_SECONDS + count * 3 * limit)
    for i in range(1, count + 1):
        yield told(i, *verdicts.get(i, why))


def _copy_other_files(source: Path, target: Path) -> None:
    """Copy the pictures and modules beside a notebook, but no links."""
    files = [path for path in source.iterdir() if path.is_file() and not path.is_symlink()]
    files = [path for path in files if path.suffix != ".ipynb"]
    if sum(path.stat().st_size for path in files) <= _OTHER_FILES:
        for path in files:
            shutil.copyfile(path, target / path.name)


def _judged(
    hand_in: HandIn, work: Path, limit: float, seconds: float
) -> tuple[dict[int, tuple[str, str]], tuple[str, str]]:
    """The verdicts by exercise, and what holds for exercises without a verdict."""
    token = secrets.token_hex(16)
    job = {
        "token": token,
        "chapter": hand_in.chapter.text,
        "handed_in": hand_in.text,
        "folder": str(work),
        "limit": limit,
    }
    line = (json.dumps(job) + "\n").encode()
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "glid_nb.grading.referee"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            cwd=work.parent,
            env=_environment(),
            start_new_session=True,
        )
        said = Said(process, token)
        try:
            _tell(process, line)
            process.wait(seconds)
            why = CRASHED, " ".join(["the grading ended early", *_last_line(errors)])
        except subprocess.TimeoutExpired:
            why = SLOW, f"the whole chapter takes longer than {seconds:g} seconds"
        finally:
            _end(process)
            process.wait()  # it is killed, so this does not take long
    verdicts = dict[int, tuple[str, str]]()
    for verdict in said.lines():
        data = json.loads(verdict)
        verdicts.setdefault(data["exercise"], (data["verdict"], data["text"]))
    return verdicts, why


def _tell(process: subprocess.Popen[bytes], line: bytes) -> None:
    """Send the job. A referee that has ended already is noticed later."""
    assert process.stdin is not None
    with contextlib.suppress(OSError), process.stdin as stream:
        stream.write(line)


def _last_line(errors: IO[bytes]) -> list[str]:
    size = errors.seek(0, os.SEEK_END)
    errors.seek(max(0, size - _REASON))
    return errors.read(_REASON).decode(errors="replace").strip().splitlines()[-1:]


def _environment() -> dict[str, str]:
    """No passwords and tokens of the lecturer."""
    kept = {name: os.environ[name] for name in _KEPT if name in os.environ}
    package = str(Path(__file__).resolve().parents[2])
    paths = [package, *filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))]
    return {**kept, "PYTHONPATH": os.pathsep.join(paths), "MPLBACKEND": "agg"}


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the referee and the processes that it has started."""
    if os.name == "posix":
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()


def points(grades: Sequence[Grade]) -> dict[str, dict[str, int]]:
    """The number of right exercises, by student and chapter."""
    found = dict[str, dict[str, int]]()
    for one in grades:
        of_student = found.setdefault(one.student, {})
        if not one.chapter:
            continue
        of_student[one.chapter] = of_student.get(one.chapter, 0) + (one.verdict == RIGHT)
    return found
