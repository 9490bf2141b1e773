"""Writing files atomically, with errors that name the file."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Literal


def write_bytes_atomically(path: Path, data: bytes) -> None:
    """Write ``data`` to a temporary file beside ``path``, then rename it over ``path``.

    The message of an OSError names ``path`` or its folder.
    """
    path = Path(path)
    if path.is_dir():
        raise IsADirectoryError(f"{path.absolute()} is a folder; name a file")
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            # mkstemp makes private files; set the permissions that open() would.
            mask = os.umask(0)
            os.umask(mask)
            Path(name).chmod(0o666 & ~mask)
            Path(name).replace(path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise in_words(error, path, "written") from error


def write_text_atomically(path: Path, text: str) -> None:
    """:func:`write_bytes_atomically` for UTF-8 text."""
    write_bytes_atomically(path, text.encode("utf-8"))


def in_words(error: OSError, path: Path, done: Literal["read", "written"]) -> OSError:
    """An error of the same class whose message says which file cannot be read or written, and why.

    The system's own message has an error number and the name of a temporary file.
    """
    path = path.absolute()
    if not path.parent.is_dir() and isinstance(error, FileNotFoundError | NotADirectoryError):
        text = f"The folder {path.parent} does not exist"
    elif isinstance(error, FileNotFoundError):
        text = f"The file {path} does not exist"
    else:
        text = f"{path} cannot be {done}: {error.strerror or error}"
    return type(error)(text)
