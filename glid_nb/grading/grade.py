"""Let a referee judge what was handed in."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from glid_nb._errors import InputError
from glid_nb.grading.chapters import Notebook, answers
from glid_nb.grading.handed_in import Grade, HandIn
from glid_nb.grading.said import Said
from glid_nb.grading.verdicts import CRASHED, SLOW

_OTHER_FILES = 50_000_000  # bytes of pictures and other files beside a notebook
_OWN_SECONDS = 900  # that a chapter's own cells may take
_REASON = 4000  # bytes at the end of the referee's errors, for a reason
_KEPT = ("PATH", "HOME", "TMPDIR", "LANG", "LC_ALL", "GLID_NB_CACHE", "SYSTEMROOT", "TEMP", "TMP")


def grade(hand_in: HandIn, *, limit: float, folder: Path) -> list[Grade]:
    """The grades of one hand-in, one for each exercise of its chapter.

    The answers run in a process of their own, in a copy of the files beside the notebook. Each may
    take ``limit`` seconds. ``folder`` is the one with all hand-ins. Whatever goes wrong is a
    verdict, so that the other hand-ins are graded too.
    """
    try:
        return list(_grades(hand_in, limit, folder))
    except Exception as error:
        return _crashed(hand_in, f"grading it raises {type(error).__name__}: {error}")


def _crashed(hand_in: HandIn, text: str) -> list[Grade]:
    count = len(hand_in.chapter.notebook.exercises)
    return [_told(hand_in, exercise, CRASHED, text) for exercise in range(1, count + 1)]


def _told(hand_in: HandIn, exercise: int, verdict: str, text: str) -> Grade:
    return Grade(hand_in.student, hand_in.chapter.name, exercise, verdict, text)


def _grades(hand_in: HandIn, limit: float, folder: Path) -> Iterator[Grade]:
    chapter = hand_in.chapter.notebook
    count = len(chapter.exercises)
    if hand_in.unread:
        yield from _crashed(hand_in, hand_in.unread)
        return
    try:
        given = answers(chapter, Notebook.parsed(hand_in.text))
    except InputError as error:
        yield from _crashed(hand_in, f"the file is no notebook: {error}")
        return
    if all(given[cell.id].untouched for cell in chapter.exercises):
        for i, cell in enumerate(chapter.exercises, 1):
            yield _told(hand_in, i, given[cell.id].nothing, given[cell.id].untouched)
        return
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        work = Path(name) / "work"
        work.mkdir()
        if hand_in.path.parent != folder:
            _copy_other_files(hand_in.path.parent, work)
        verdicts, why = _judged(hand_in, work, limit, _OWN_SECONDS + count * 3 * limit)
    for i in range(1, count + 1):
        yield _told(hand_in, i, *verdicts.get(i, why))


def _copy_other_files(source: Path, target: Path) -> None:
    """Copy the pictures and modules beside a notebook, but no links."""
    files = [path for path in source.iterdir() if path.is_file() and not path.is_symlink()]
    files = [path for path in files if path.suffix.lower() != ".ipynb"]
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
