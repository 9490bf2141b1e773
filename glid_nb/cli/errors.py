"""What counts as bad input, and how it is said in one line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from glid_nb import InputError


class BadFileError(InputError):
    """The content of a file was refused."""


class CommandError(InputError):
    """A command cannot do what it is asked to."""


@contextmanager
def about(path: Path) -> Iterator[None]:
    """Put the name of the file in front of what is refused of its content."""
    try:
        yield
    except ValueError as error:
        if not is_bad_input(error) or str(path) in str(error):
            raise
        raise BadFileError(f"{path}: {error}") from error


def is_bad_input(error: BaseException) -> bool:
    """Whether an exception tells of the user's input rather than of a bug.

    A plain ValueError comes from a bug and keeps its traceback. What the operating system refuses
    is input as well.
    """
    return isinstance(error, OSError | InputError)


def one_line(error: BaseException) -> str:
    """The exception's message without line breaks, and with the file first."""
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split())
