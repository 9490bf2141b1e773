"""Read files, and write them atomically, with errors that name the file."""

import contextlib
import errno
import io
import os
import re
import secrets
import stat
import zipfile
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import BinaryIO, Literal

from glid_nb._errors import InputFileError


def write_atomically(path: str | Path, data: bytes | str) -> None:
    """Write ``data``, text as UTF-8, to a temporary file beside ``path``, then rename it to
    ``path``.

    Links and permissions stay. Some files are overwritten in place instead: files with other hard
    links or another owner, and files that Windows does not replace because another program has them
    open. If that fails, the old content is restored. Raises an OSError that names ``path`` or its
    folder.
    """
    path = path_of(path)
    target = Path(os.path.realpath(path))
    try:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder; name a file")
        _replace(target, data.encode() if isinstance(data, str) else data)
    except OSError as error:
        linked = os.path.islink(path)  # noqa: PTH114 - Path's may raise
        raise in_words(error, target if linked else path, "written") from None


def _replace(target: Path, data: bytes) -> None:
    try:
        old = target.stat()
    except FileNotFoundError:
        old = None
    if old is not None and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "it is write-protected")
    if old is not None and not stat.S_ISREG(old.st_mode):
        target.write_bytes(data)
        return
    # tempfile makes private files; open() gives a new file the usual permissions.
    temporary = target.with_name(f".glid-nb-{secrets.token_hex(8)}.tmp")
    mode = 0o666 if old is None else stat.S_IMODE(old.st_mode)
    try:
        with open(temporary, "xb", opener=lambda name, flags: os.open(name, flags, mode)) as file:
            _write(file, data)
            new = os.fstat(file.fileno())
        if old and (old.st_nlink > 1 or (old.st_uid, old.st_gid) != (new.st_uid, new.st_gid)):
            _overwrite(target, data)
        else:
            if old:
                temporary.chmod(mode)
            try:
                temporary.replace(target)
            except PermissionError:  # on Windows, while another program has the file open
                if old is None:
                    raise
                _overwrite(target, data)
    finally:
        temporary.unlink(missing_ok=True)


def _overwrite(target: Path, data: bytes) -> None:
    before = target.read_bytes()
    with target.open("r+b") as file:
        try:
            _write(file, data)
        except BaseException:
            file.seek(0)
            _write(file, before)
            raise


def _write(file: BinaryIO, data: bytes) -> None:
    file.write(data)
    file.truncate()
    file.flush()
    os.fsync(file.fileno())


def zipped(files: Mapping[str, bytes], stored: Collection[str] = ()) -> bytes:
    """Files as a zip. Those named in ``stored`` are not compressed. Equal files give equal
    bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, data in files.items():
            method = zipfile.ZIP_STORED if name in stored else zipfile.ZIP_DEFLATED
            entry = zipfile.ZipInfo(name)  # its date is 1980
            entry.create_system = 3  # always Unix
            archive.writestr(entry, data, method)
    return buffer.getvalue()


def same_file(path: Path, other: Path) -> bool:
    """Whether two paths name the same file, also through links, or will once it is made."""
    linked = path.is_file() and other.exists() and path.samefile(other)
    first, second = (os.path.normcase(os.path.realpath(name)) for name in (path, other))
    return linked or first == second


def discard(path: Path) -> None:
    """Delete a file. Ignores a missing file, and a refusal by Windows while it is open
    elsewhere."""
    with contextlib.suppress(FileNotFoundError, PermissionError):
        path.unlink()


_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
_DIRECTIONS = re.compile(r"[\u202a-\u202e\u2066-\u2069]")  # they would disguise a file's ending
_LONGEST = 100  # bytes of UTF-8; most systems allow 255, with what stands around the name


def portable_name(text: str) -> str:
    """Make a file name that every system accepts from a text; "" if no character is possible.

    A long text is cut, so that there is room for an ending and for the name of another file before.
    """
    name = re.sub(r'[<>:"/\\|?*\x00-\x1f]+', "_", _DIRECTIONS.sub("", text)).strip(" .")
    # Also drops half a character at the cut, and surrogates, which no file name can have.
    name = name.encode("utf-8", "ignore")[:_LONGEST].decode("utf-8", "ignore").strip(" .")
    return f"_{name}" if _RESERVED.fullmatch(name) else name


def read_file(path: str | os.PathLike[str], most: int | None = None) -> bytes:
    """The bytes of a file. Raises an InputFileError for more than ``most`` bytes, or an OSError
    that names the file."""
    path = path_of(path)
    try:
        if path.is_dir():  # Windows would call it a file without permission
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if most is not None and (size := path.stat().st_size) > most:
            raise InputFileError(f"the file has {size:,} bytes; {most:,} are allowed")
        return path.read_bytes()
    except OSError as error:
        raise in_words(error, path, "read") from None


def path_of(name: str | os.PathLike[str]) -> Path:
    """Check a path. Raises an InputFileError for a null byte or an invalid character."""
    try:
        possible = b"\0" not in os.fsencode(name)
    except UnicodeEncodeError:
        possible = False
    if not possible:
        raise InputFileError(f"{str(name)!r:.80} has a character that file names cannot have")
    return Path(name)


def in_words(error: OSError, path: Path, done: Literal["read", "written"]) -> OSError:
    """An error of the same class that says which file cannot be read or written, and why."""
    path = path.absolute()
    if not path.parent.is_dir() and isinstance(error, FileNotFoundError | NotADirectoryError):
        text = f"The folder {path.parent} does not exist"
    elif isinstance(error, FileNotFoundError):
        text = f"The file {path} does not exist"
    else:
        text = f"{path} cannot be {done}: {error.strerror or error}"
    return type(error)(text)
