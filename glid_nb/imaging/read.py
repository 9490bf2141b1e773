"""Read pictures from files and arrays as (h, w, 4) RGBA of 8 or 16 bit."""

import io
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from glid_nb._errors import InputFileError, about
from glid_nb._files import read_file
from glid_nb.imaging.color import ColorSpace, cmyk_in_srgb, in_srgb
from glid_nb.imaging.decode import (
    MAX_SIDE,
    RGBA,
    check_size,
    eight_bit,
    formats,
    opened,
    picture_pixels,
    tiff_pixels,
    unread_file,
)
from glid_nb.imaging.frame import TraceError

__all__ = ["MAX_SIDE", "RGBA", "ImageSource", "as_rgba", "as_rgba8", "png", "read_image"]

ImageSource = str | os.PathLike[str] | bytes | Image.Image | ArrayLike
"""What is accepted as a picture: a path, a file's bytes, a PIL image or an array."""

_ADDRESS = re.compile(r"([a-z][a-z0-9+.-]+):/{1,2}(.*)", re.IGNORECASE | re.DOTALL)
_ROWS = 256  # rows per block; a whole picture in float would need gigabytes
_PERCEPTUAL = b"\0"  # the rendering intent in an sRGB chunk


def read_image(source: ImageSource, name: str | None = None) -> RGBA:
    """Read a picture as an (h, w, 4) array of red, green, blue and alpha, row 0 at the top.

    Alpha is not premultiplied. The source is the path or the bytes of a file (PNG, JPEG, TIFF, GIF,
    WebP, BMP, AVIF, JPEG 2000, Photoshop or another pixel format; the first frame is read), a PIL
    image, or an array as in `as_rgba`. EXIF orientation is applied. All kinds of transparency are
    read: alpha, one transparent colour, and transparent entries of a palette.

    Colours are converted to sRGB from an embedded ICC profile, or from a PNG's cICP, gAMA and cHRM
    chunks. A damaged profile is ignored, with a ColorWarning. The result is uint8. It is uint16 if
    the source has more than 8 bit (PNG, TIFF, arrays) and no profile other than sRGB. Messages call
    the picture ``name``, by default the file's path.

    Raises a TraceError when the file is missing, damaged or not a picture, when the path is a URL,
    or when the picture is empty or too large.
    """
    if isinstance(source, (str, os.PathLike)):
        name, source = name or str(Path(source)), _bytes_of(source)
    name = name or "the picture"
    try:
        if isinstance(source, Image.Image):
            if (data := unread_file(source)) is not None:
                pixels = _decode(data, name)
                source.load()  # closes its file, as any use of a picture does
                return pixels
            return _from_pillow(source, None, name)
        if isinstance(source, (bytes, bytearray, memoryview)):
            return _decode(bytes(source), name)
    except TraceError:
        raise
    except Image.DecompressionBombError:
        most = f"a side may have at most {MAX_SIDE} pixels"
        raise TraceError(f"{name} is too large: {most}; scale it down first") from None
    except Exception as error:  # decoders raise errors of any type
        raise TraceError(f"{name} is damaged or cut short: {error}") from None
    return as_rgba(source)


def as_rgba(image: ArrayLike) -> RGBA:
    """Convert an array to (h, w, 4) RGBA.

    The array is (h, w) or (h, w, 1) grey, (h, w, 2) grey and alpha, (h, w, 3) RGB or (h, w, 4)
    RGBA. Its type is bool, uint8, uint16, or float in [0, 1]. The result is uint8 for bool and
    uint8, and uint16 for the other types. A uint8 or uint16 RGBA array is returned itself. Raises a
    TraceError for an array that is empty, too large or of another shape or type, and for floats
    that are NaN or outside [0, 1]. Masked pixels of a masked array become transparent.
    """
    if isinstance(image, np.ma.MaskedArray) and np.ma.is_masked(image):
        return _with_masked_pixels_transparent(image)
    try:
        array: NDArray[Any] = np.asarray(image)
    except ValueError as error:  # rows of different lengths
        raise TraceError(f"the image is not an array: {error}") from None
    if array.ndim not in (2, 3) or (array.ndim == 3 and not 0 <= array.shape[2] <= 4):
        wanted = "(h, w) or (h, w, c) with 1 to 4 channels (grey, grey + alpha, RGB, RGBA)"
        given = array.shape or type(image).__name__
        raise TraceError(f"an image must have the shape {wanted}, not {given}")
    if array.size == 0:
        raise TraceError(f"the image is empty: its shape is {array.shape}")
    height, width = array.shape[:2]
    check_size(width, height)
    if array.ndim == 2:
        array = array[..., np.newaxis]
    if array.dtype == np.bool_:
        array = array.astype(np.uint8) * np.uint8(255)
    if np.issubdtype(array.dtype, np.floating):
        array = _from_float(array)
    array = array.astype(array.dtype.newbyteorder("="), copy=False)
    if array.dtype not in (np.uint8, np.uint16):
        wanted = "convert it to uint8, uint16, bool or to float in [0, 1]"
        raise TraceError(f"the image has the type {array.dtype}; {wanted}")
    channels = array.shape[2]
    if channels == 4:
        return array
    rgba: NDArray[Any] = np.empty((height, width, 4), dtype=array.dtype)
    rgba[..., :3] = array[..., : 3 if channels == 3 else 1]
    rgba[..., 3] = array[..., 1] if channels == 2 else np.iinfo(array.dtype).max
    return rgba


def _with_masked_pixels_transparent(image: np.ma.MaskedArray) -> RGBA:
    rgba = as_rgba(image.filled(0)).copy()
    masked = np.ma.getmaskarray(image)
    rgba[masked if masked.ndim == 2 else masked.any(axis=2), 3] = 0
    return rgba


def png(pixels: NDArray[np.uint8], compress_level: int = 6) -> bytes:
    """A PNG file of (h, w), (h, w, 3) or (h, w, 4) pixels, marked as sRGB."""
    buffer = io.BytesIO()
    picture = Image.fromarray(pixels)
    picture.save(buffer, "PNG", compress_level=compress_level, pnginfo=srgb_chunk())
    return buffer.getvalue()


def srgb_chunk() -> PngInfo:
    """The chunk, for Pillow, that marks the colours of a PNG as sRGB."""
    chunks = PngInfo()
    chunks.add(b"sRGB", _PERCEPTUAL)
    return chunks


def as_rgba8(image: ArrayLike) -> NDArray[np.uint8]:
    """`as_rgba`, rounded to 8 bit."""
    return eight_bit(as_rgba(image))


def _from_float(array: NDArray[Any]) -> NDArray[np.uint16]:
    low, high = float(array.min()), float(array.max())
    if not (np.isfinite(low) and np.isfinite(high)):
        row, column, *_ = place = tuple(np.argwhere(~np.isfinite(array))[0])
        where = f"the image holds {array[place]} in row {row}, column {column}"
        raise TraceError(f"{where}; replace NaN and infinite values")
    # Interpolation may overshoot by rounding errors.
    if low < -1e-6 or high > 1 + 1e-6:
        worst = f"this one holds {low if low < -1e-6 else high:.6g}"
        remedy = "divide it by its largest possible value"
        raise TraceError(f"a float image must lie in [0, 1], {worst}; {remedy}")
    result = np.empty(array.shape, dtype=np.uint16)
    for start in range(0, len(array), _ROWS):
        block = array[start : start + _ROWS].astype(np.float64)
        result[start : start + _ROWS] = np.rint(block.clip(0, 1) * 65535)
    return result


def _bytes_of(path: str | os.PathLike[str]) -> bytes:
    if address := _ADDRESS.match(str(path)):
        scheme, rest = address.groups()  # a Path keeps one slash of two
        what = f"{scheme}://{rest} is an address, and only files are read"
        raise TraceError(f"{what}; download the picture, and give its file's path or its bytes")
    try:
        return read_file(path)
    except (OSError, InputFileError) as error:
        raise TraceError(str(error)) from None


def _decode(data: bytes, name: str) -> RGBA:
    picture = opened(data, name)
    if picture is None:
        array, profile = tiff_pixels(data, name)
        space = ColorSpace(profile)
        return in_srgb(_from_array(array, name), space, name)
    with picture:
        return _from_pillow(picture, data, name)


def picture_format(data: bytes) -> str | None:
    """Pillow's name for the format of a picture's file, such as "JPEG"; None for other files."""
    try:
        with Image.open(io.BytesIO(data), formats=formats()) as picture:
            return picture.format
    except Exception:  # damaged pictures count as no picture
        return None


def _from_pillow(picture: Image.Image, data: bytes | None, name: str) -> RGBA:
    space = ColorSpace.of(picture, data)
    if 0 not in picture.size:
        check_size(*picture.size, name)  # before the pixels are decoded
    if picture.mode == "CMYK" and (converted := cmyk_in_srgb(picture, space, name)) is not None:
        return converted
    array = picture_pixels(picture, data, name)
    return in_srgb(_from_array(array, name), space, name)


def _from_array(array: NDArray[Any], name: str) -> RGBA:
    # Pillow gives 16-bit pixels as 32-bit integers, and also 8-bit pixels that came from an array.
    if array.dtype in (np.int32, np.uint16):
        low, high = int(array.min()), int(array.max())
        if low < 0 or high > 65535:
            raise TraceError(f"{name}: values run from {low} to {high}; only 8 and 16 bit are read")
        array = array.astype(np.uint8 if array.dtype == np.int32 and high < 256 else np.uint16)
    with about(name, TraceError):
        return as_rgba(array)
