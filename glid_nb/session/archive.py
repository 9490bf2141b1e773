"""Zip archives from untrusted sources: read in memory, with every size checked first."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

from glid_nb._errors import InputFileError
from glid_nb._files import in_words, write_bytes_atomically

# Room for the zip directory of a few members.
_DIRECTORY_BYTES = 64 * 1024
# The second row is what zipfile raises for headers that make no sense.
_DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, EOFError),
    *(NotImplementedError, RuntimeError, ValueError, OSError, OverflowError),
)


def write_archive(path: Path, members: Mapping[str, bytes], stored: frozenset[str]) -> None:
    """Write members to a zip file, atomically; those named in ``stored`` are not compressed."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            # A fixed date, so that equal documents are equal files.
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_STORED if name in stored else zipfile.ZIP_DEFLATED
            archive.writestr(info, data)
    write_bytes_atomically(path, buffer.getvalue())


def read_archive(path: Path, most_bytes: Mapping[str, int]) -> dict[str, bytes]:
    """The members of a zip file, each no larger than allowed. Nothing is extracted to disk.

    Parameters
    ----------
    path : Path
    most_bytes : mapping
        The names that members may have, and the largest size of each when unpacked.

    Raises
    ------
    InputFileError
        When it is damaged, or has a member that is unknown, repeated, encrypted or too large.
    OSError
        When it cannot be read.
    """
    most = sum(most_bytes.values()) + _DIRECTORY_BYTES
    try:
        size = path.stat().st_size
        data = path.read_bytes() if size <= most else b""
    except OSError as error:
        raise in_words(error, path, "read") from error
    if size > most:
        raise InputFileError(f"the file has {size:,} bytes; {most:,} are allowed")
    members: dict[str, bytes] = {}
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for info in archive.infolist():
                if info.filename in members:
                    raise InputFileError(f"it holds {info.filename} twice")
                _check_member(info, most_bytes)
                members[info.filename] = archive.read(info)
    except InputFileError:
        raise
    except _DAMAGE as error:
        raise InputFileError(f"this is no intact zip file: {error}") from error
    return members


def _check_member(info: zipfile.ZipInfo, most_bytes: Mapping[str, int]) -> None:
    name, size = info.filename, info.file_size
    if name not in most_bytes:
        raise InputFileError(
            f"it holds {name!r:.80}, which does not belong there; expected only "
            f"{', '.join(most_bytes)}"
        )
    if info.flag_bits & 1:
        raise InputFileError(f"{name} is encrypted")
    # zipfile stops at this size whatever the compressed data hold.
    if size > most_bytes[name]:
        raise InputFileError(f"{name} unpacks to {size:,} bytes; {most_bytes[name]:,} are allowed")
