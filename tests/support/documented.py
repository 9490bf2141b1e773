"""The commands that the documentation shows, read from its pages.

Tests run them as printed: a server that is started in another way may work where the documented
command does not.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = (
    REPOSITORY / "README.md",
    REPOSITORY / "docs" / "course.md",
    *sorted((REPOSITORY / "docs" / "howto").glob("*.md")),
)
PROGRAMS = "glid-nb|glid-check|jupyter|voila|python|python3|pip|make"

_BLOCK = re.compile(r"^```(?:sh|bash)\n(.*?)^```", re.DOTALL | re.MULTILINE)
_FENCED = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
_SPAN = re.compile(rf"`((?:{PROGRAMS})\s[^`]+)`")


@dataclass(frozen=True)
class Command:
    """A line of a shell that a page shows, in a block or within a sentence."""

    page: str
    text: str
    in_sentence: bool = field(default=False, compare=False)

    @property
    def words(self) -> list[str]:
        """The command as a shell splits it, without its comment."""
        return shlex.split(self.text, comments=True)

    def __str__(self) -> str:
        return f"{self.page}: {self.text}"


def commands(path: Path) -> list[Command]:
    """The commands that a page shows: the lines of its shell blocks, then commands within
    sentences."""
    text = path.read_text(encoding="utf-8")
    page = path.relative_to(REPOSITORY).as_posix()
    lines = [line for block in _BLOCK.findall(text) for line in block.splitlines()]
    spans = [" ".join(span.split()) for span in _SPAN.findall(_FENCED.sub("", text))]
    found = [Command(page, line.strip()) for line in lines]
    found += [Command(page, span, in_sentence=True) for span in spans]
    return [command for command in dict.fromkeys(found) if command.words]


def documented(*start: str) -> list[str]:
    """The first documented command that runs a program of this environment with these words."""
    for path in PAGES:
        for command in commands(path):
            if spoken(command.words)[: len(start)] == list(start):
                return here(command.words)
    raise AssertionError(f"no page shows a command that begins with {' '.join(start)!r}")


def spoken(words: Sequence[str]) -> list[str]:
    """The words with the program's bare name."""
    return [Path(words[0]).name, *words[1:]]


def here(words: Sequence[str]) -> list[str]:
    """The words with the program of this environment in place of the page's ``.venv``, or PATH."""
    program = Path(sys.executable).parent / Path(words[0]).name
    return [str(program) if program.exists() else words[0], *words[1:]]


def checkout(folder: Path) -> Path:
    """A copy of the repository as it would be cloned: what git tracks, as it is now."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    done = subprocess.run(listed, cwd=REPOSITORY, capture_output=True, check=True)
    for name in filter(None, done.stdout.decode().split("\0")):
        source, copy = REPOSITORY / name, folder / name
        if source.is_file():
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(source.read_bytes())
    return folder
