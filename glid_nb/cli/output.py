"""Where results go: checked before the work starts, written when all of it is done."""

from __future__ import annotations

from pathlib import Path

from glid_nb._errors import InputFileError
from glid_nb._files import write_bytes_atomically, write_text_atomically


def check_file(path: Path) -> None:
    """Raise an OSError if a file cannot be made at ``path``, before hours are spent on it."""
    if path.is_dir():
        raise IsADirectoryError(21, "is a folder; name a file", str(path))
    if not path.parent.is_dir():
        raise FileNotFoundError(2, "there is no such folder to write to", str(path.parent))


def check_png(path: Path) -> None:
    """:func:`check_file`, and an InputFileError unless the name ends in .png."""
    if path.suffix.lower() != ".png":
        raise InputFileError(f"{path}: pictures are written as PNG; name a file that ends in .png")
    check_file(path)


def check_folder(path: Path) -> None:
    """Raise an OSError if a folder cannot be made at ``path``."""
    first = next(part for part in (path, *path.parents) if part.exists())
    if not first.is_dir():
        raise NotADirectoryError(20, "is a file; name a folder", str(first))


def write_all(files: dict[Path, bytes | str]) -> None:
    """Write several files, each atomically."""
    for path, data in files.items():
        if isinstance(data, str):
            write_text_atomically(path, data)
        else:
            write_bytes_atomically(path, data)
