"""Zip archives and PNG pictures from untrusted sources: read in memory, sizes checked first."""

import io
import weakref
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb._errors import InputFileError
from glid_nb._files import in_words
from glid_nb.imaging.read import picture_format, png

# The PNG of the picture encoded last: an editor saves the same one again and again.
_last: tuple[weakref.ref[NDArray[np.uint8]], bytes] | None = None
# Room for the zip directory of a few members.
_DIRECTORY_BYTES = 64 * 1024


def read_archive(path: Path, most_bytes: Mapping[str, int]) -> dict[str, bytes]:
    """The members of a zip file, read in memory; ``most_bytes`` is how large each may be.

    InputFileError when it is damaged, or has a member that is unknown, repeated or encrypted.
    """
    most = sum(most_bytes.values()) + _DIRECTORY_BYTES
    try:
        size = path.stat().st_size
        data = path.read_bytes() if size <= most else b""
    except OSError as error:
        raise in_words(error, path, "read") from None
    if size > most:
        raise InputFileError(f"the file has {size:,} bytes; {most:,} are allowed")
    members: dict[str, bytes] = {}
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for info in archive.infolist():
                _check_member(info, most_bytes)
                if info.filename in members:
                    raise InputFileError(f"it holds {info.filename} twice")
                members[info.filename] = archive.read(info)
    except InputFileError:
        raise
    except Exception as error:  # zipfile raises nearly anything for headers that make no sense
        if (kind := picture_format(data)) is not None:
            what = f"it is a {kind} picture; open it as the picture instead of as a session"
        elif zipfile.is_zipfile(io.BytesIO(data)):
            what = f"it is no intact zip file: {error}"
        else:
            what = "it is no zip file, so no session that was saved, or only a part of one"
        raise InputFileError(what) from None
    return members


def _check_member(info: zipfile.ZipInfo, most_bytes: Mapping[str, int]) -> None:
    name, size = info.filename, info.file_size
    if name not in most_bytes:
        wanted = f"expected only {', '.join(most_bytes)}"
        raise InputFileError(f"it holds {name!r:.80}, which does not belong there; {wanted}")
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputFileError(f"{name} is compressed by a method that sessions do not use")
    # zipfile stops at this size whatever the compressed data hold.
    if size > most_bytes[name]:
        raise InputFileError(f"{name} unpacks to {size:,} bytes; {most_bytes[name]:,} are allowed")


def image_png(image: NDArray[np.uint8]) -> bytes:
    """A read-only (h, w, 4) uint8 picture as PNG, pixel for pixel, hidden colours included."""
    global _last
    if _last is None or _last[0]() is not image:
        _last = weakref.ref(image), png(image, compress_level=1)
    return _last[1]


def read_png(
    data: bytes, size: tuple[int, int], mode: str, name: str
) -> NDArray[np.uint8] | NDArray[np.bool_]:
    """The pixels of a PNG; InputFileError, before decoding, for another (width, height) or mode."""
    if not data.startswith(b"\x89PNG\r\n\x1a\n"):
        raise InputFileError(f"{name} is no PNG picture")
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            if picture.size != size or picture.mode != mode:
                has = f"{name} has {picture.width} x {picture.height} pixels, mode {picture.mode}"
                raise InputFileError(f"{has}; announced were {size[0]} x {size[1]}, mode {mode}")
            # Pillow's own arrays of mode "1" hold the byte 255 for true.
            pixels = np.array(picture.convert("L")) > 0 if mode == "1" else np.array(picture)
    except InputFileError:
        raise
    except Exception as error:  # Pillow's decoder raises nearly anything for a damaged file
        raise InputFileError(f"{name} is damaged: {error}") from None
    pixels.setflags(write=False)
    return pixels
