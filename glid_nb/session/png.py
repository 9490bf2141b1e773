"""Pictures and masks of a document as PNG, without loss."""

from __future__ import annotations

import io
import weakref
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb._errors import InputFileError

_SIGNATURE = b"\x89PNG\r\n\x1a\n"

# The PNG of the picture encoded last: an editor saves the same one again and again.
_last: tuple[weakref.ref[NDArray[np.uint8]], bytes] | None = None


def image_png(image: NDArray[np.uint8]) -> bytes:
    """A read-only (h, w, 4) uint8 picture as PNG, pixel for pixel, hidden colours included."""
    global _last
    if _last is None or _last[0]() is not image:
        _last = weakref.ref(image), light_png(image)
    return _last[1]


def light_png(pixels: NDArray[Any]) -> bytes:
    """Pixels as lightly compressed PNG: 4 megapixels take a tenth of a second."""
    from glid_nb.export.picture import png  # noqa: PLC0415 - the first canvas does not need it

    return png(pixels, compress_level=1)


def read_png(
    data: bytes, size: tuple[int, int], mode: str, name: str
) -> NDArray[np.uint8] | NDArray[np.bool_]:
    """The pixels of a PNG that must have the given (width, height) and mode; read-only.

    Raises
    ------
    InputFileError
        When it is damaged; before decoding, when size or mode differ.
    """
    if not data.startswith(_SIGNATURE):
        raise InputFileError(f"{name} is no PNG picture")
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            if picture.size != size or picture.mode != mode:
                raise InputFileError(
                    f"{name} has {picture.width} x {picture.height} pixels of the mode "
                    f"{picture.mode}; announced were {size[0]} x {size[1]} of the mode {mode}"
                )
            # Pillow's own arrays of mode "1" hold the byte 255 for true.
            pixels = np.array(picture.convert("L")) > 0 if mode == "1" else np.array(picture)
    except InputFileError:
        raise
    except Exception as error:  # Pillow's decoder raises nearly anything for a damaged file
        raise InputFileError(f"{name} is damaged: {error}") from error
    pixels.setflags(write=False)
    return pixels
