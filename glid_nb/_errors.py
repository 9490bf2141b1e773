"""How bad input is refused: one base class, the place in front, and "did you mean"."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


class InputError(ValueError):
    """What was given is refused; the message names the culprit, the place and the remedy.

    Every refusal of the package is of a subclass. A plain ValueError comes from a bug.
    """


class InputFileError(InputError):
    """A file does not hold what it should; the message names the file and the key."""


@contextmanager
def about(where: str | Path, kind: type[InputError] = InputFileError) -> Iterator[None]:
    """Put ``where``, a file or a key, in front of what is refused here; raise it as ``kind``."""
    try:
        yield
    except InputError as error:
        text = str(error)
        if not re.match(rf"{re.escape(str(where))}(: | (is|has|holds|must) )", text):
            text = f"{where}: {text}"
        raise kind(text) from error


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """For the end of a refusal: ``; did you mean 'cage'?``, or nothing if no known name is near."""
    near = difflib.get_close_matches(str(name), list(known), 1)
    return f"; did you mean {near[0]!r}?" if near else ""
