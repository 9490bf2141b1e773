"""Zip archives that somebody else may have made: read in memory, with every size known before."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

from glid_nb._errors import InputFileError
from glid_nb._files import in_words, write_bytes_atomically

# A document has at most a handful of members; their names, sizes and places fit in this.
_DIRECTORY_BYTES = 64 * 1024


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
        The file.
    most_bytes : mapping
        The names that members may have, and how large each may be when unpacked.

    Raises
    ------
    InputFileError
        When it is no zip file, is damaged, or has a member that is unknown, repeated, encrypted or
        too large.
    OSError
        When it cannot be read; the message says why in plain words.
    """
    most = sum(most_bytes.values()) + _DIRECTORY_BYTES
    try:
        size = path.stat().st_size
        if size > most:
            raise InputFileError(f"the file has {size:,} bytes; {most:,} are allowed")
        data = path.read_bytes()
    except OSError as error:
        raise in_words(error, path, "read") from error
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            _check_members(members, most_bytes)
            return {info.filename: archive.read(info) for info in members}
    except InputFileError:
        raise
    # The second row is what zipfile raises for headers that make no sense.
    except (
        *(zipfile.BadZipFile, zlib.error, EOFError),
        *(NotImplementedError, RuntimeError, ValueError, OSError, OverflowError),
    ) as error:
        raise InputFileError(f"this is no intact zip file: {error}") from error


def _check_members(members: list[zipfile.ZipInfo], most_bytes: Mapping[str, int]) -> None:
    seen: set[str] = set()
    for info in members:
        name = info.filename
        if name not in most_bytes:
            raise InputFileError(
                f"it holds {name!r:.80}, which does not belong there; expected only "
                f"{', '.join(most_bytes)}"
            )
        if name in seen:
            raise InputFileError(f"it holds {name} twice")
        seen.add(name)
        if info.flag_bits & 1:
            raise InputFileError(f"{name} is encrypted")
        # zipfile stops at this size whatever the compressed data hold.
        if info.file_size > most_bytes[name]:
            raise InputFileError(
                f"{name} unpacks to {info.file_size:,} bytes; {most_bytes[name]:,} are allowed"
            )
