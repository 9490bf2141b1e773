"""Find what was handed in: which notebook counts for each student and chapter, and the others."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from pathlib import Path

from glid_nb._errors import InputError
from glid_nb.grading.chapters import Notebook
from glid_nb.grading.verdicts import LEFT_OUT, MISSING

_MOODLE = re.compile(r"_\d+_assignsubmission_file_?$")
_LARGEST = 100_000_000  # bytes of a notebook


@dataclass(frozen=True)
class Chapter:
    name: str
    text: str

    @property
    def notebook(self) -> Notebook:
        return Notebook.parsed(self.text)


@dataclass(frozen=True)
class HandIn:
    """A notebook that was handed in. Its text is read before anybody's code runs."""

    student: str
    chapter: Chapter
    path: Path
    text: str
    unread: str = ""
    """Why the file could not be read."""


@dataclass(frozen=True)
class Grade:
    student: str
    chapter: str
    """Empty for a line that is about no exercise, such as for a student without any notebook."""
    exercise: int
    verdict: str
    """One of `verdicts`."""
    text: str


@dataclass(frozen=True)
class HandedIn:
    """What a folder holds."""

    counting: tuple[HandIn, ...]
    """One notebook for each student and chapter."""
    others: tuple[Grade, ...]
    """A line for each notebook that is not graded, and for each student without a notebook."""


def chapters_in(folder: Path) -> dict[str, Chapter]:
    """The course's own chapters, by name. Raises an InputError if there is none."""
    paths = sorted(folder.glob("[0-9][0-9]*_*.ipynb"))
    if not paths:
        raise InputError(f"{folder} has no chapter such as 07_newton.ipynb")
    return {path.stem: Chapter(path.stem, _text(path)) for path in paths}


def handed_in(folder: Path, chapters: Mapping[str, Chapter]) -> HandedIn:
    """All notebooks in a folder, by student.

    The student is the name of the first folder below, or what stands before the chapter in the
    file's name. Raises an InputError if no notebook belongs to a chapter.
    """
    students = _students(folder)
    found, others = list[HandIn](), list[Grade]()
    for path in _notebooks(folder):
        one = _read(path, folder, students, chapters)
        if isinstance(one, HandIn):
            found.append(one)
        else:
            others.append(one)
    if not found:
        reasons = [f": {one.text}" for one in others[:1]]
        raise InputError("".join([f"{folder} has no notebook to grade", *reasons]))
    counting, copies = _one_for_each(found, folder)
    lines = [*copies, *others]
    named = {one.student for one in [*found, *others]}
    return HandedIn(tuple(counting), (*lines, *_without_notebook(students.values(), named)))


def _notebooks(folder: Path) -> Iterator[Path]:
    """The notebooks and the links that a student may have made, without hidden files."""
    for path in sorted(folder.rglob("*")):
        if any(part.startswith(".") for part in path.relative_to(folder).parts):
            continue  # checkpoints, and what macOS adds to an archive
        notebook = path.suffix.lower() == ".ipynb"
        if (path.is_symlink() and (notebook or path.is_dir())) or (notebook and path.is_file()):
            yield path


def _students(folder: Path) -> dict[str, str]:
    """The students by the names of their folders.

    Moodle adds a number to each name. It stays where two students have the same name.
    """
    names = [path.name for path in sorted(folder.iterdir()) if path.is_dir()]
    names = [name for name in names if not name.startswith(".")]
    short = {name: _MOODLE.sub("", name) for name in names}
    count = Counter(short.values())
    return {name: short[name] if count[short[name]] == 1 else name for name in names}


def _read(
    path: Path, folder: Path, students: Mapping[str, str], chapters: Mapping[str, Chapter]
) -> HandIn | Grade:
    """The hand-in, or why the file is none."""
    text, unread = "", ""
    if not path.is_symlink():
        try:
            text = _text(path)
        except (OSError, MemoryError, InputError) as error:
            reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
            unread = f"it cannot be read: {reason}"
    name = _named(path.stem, chapters) or _named_inside(text)
    before = _split(path.stem, name)[0].strip("_- ")
    student = students.get(path.relative_to(folder).parts[0]) or before or path.stem
    if not path.is_symlink() and name in chapters:
        return HandIn(student, chapters[name], path, text, unread)
    reason = f"its name contains no chapter such as {next(iter(chapters))}"
    if path.is_symlink():
        reason = "it is a link, and links are not followed"
    return Grade(student, "", 0, LEFT_OUT, f"{_place(path, folder)}: {reason}")


def _place(path: Path, folder: Path) -> str:
    """Where a file lies in a student's folder."""
    first, *inside = path.relative_to(folder).parts
    return "/".join(inside) or first


def _text(path: Path) -> str:
    """A notebook's text, in whatever encoding of Unicode an editor has saved it."""
    if path.stat().st_size > _LARGEST:
        raise InputError(f"it is larger than {_LARGEST // 1_000_000} MB")
    raw = path.read_bytes()
    return raw.decode(json.detect_encoding(raw), errors="replace")


def _named(stem: str, chapters: Mapping[str, Chapter]) -> str:
    """The chapter in a file's name, in capitals or not."""
    return next((name for name in chapters if name.casefold() in stem.casefold()), "")


def _named_inside(text: str) -> str:
    """The chapter that a notebook's metadata name."""
    try:
        return Notebook.parsed(text).chapter
    except InputError:
        return ""


def _split(stem: str, name: str) -> tuple[str, str]:
    """What stands before and after a chapter's name. All before, if the name is not there."""
    found = re.search(re.escape(name), stem, re.IGNORECASE) if name else None
    return (stem[: found.start()], stem[found.end() :]) if found else (stem, "")


def _one_for_each(found: Sequence[HandIn], folder: Path) -> tuple[list[HandIn], list[Grade]]:
    """The notebook that counts for each student and chapter, and a line for each other one."""
    by = dict[tuple[str, str], list[HandIn]]()
    for one in found:
        by.setdefault((one.student, one.chapter.name), []).append(one)
    counting, others = list[HandIn](), list[Grade]()
    for candidates in by.values():
        best, *copies = sorted(candidates, key=_order)
        counting.append(best)
        for copy in copies:
            text = f"{_place(copy.path, folder)}: {_place(best.path, folder)} counts instead"
            others.append(Grade(copy.student, "", 0, LEFT_OUT, text))
    return counting, others


def _order(one: HandIn) -> tuple[bool, bool, float, str]:
    """First a file with the chapter's own name, then one that ends with it, then the newest."""
    name = one.chapter.name.casefold()
    own, last = one.path.stem.casefold() == name, one.path.stem.casefold().endswith(name)
    return not own, not last, -_modified(one.path), str(one.path)


def _modified(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def _without_notebook(students: Iterable[str], having: Set[str]) -> list[Grade]:
    """A line for each student whose folder has no notebook."""
    text = "the folder has no notebook"
    return [Grade(name, "", 0, MISSING, text) for name in students if name not in having]
