"""Decode pictures with all their bits and every kind of transparency.

Pillow rounds 16-bit colours to 8 bit. It also compares the transparent colour of a PNG (its tRNS
chunk) with pixels that it has scaled. So this module reads PNG and TIFF of more than 8 bit itself.
"""

import functools
import io
import sys
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps, UnidentifiedImageError
from PIL.PngImagePlugin import PngImageFile
from PIL.TiffImagePlugin import TiffImageFile

from glid_nb.imaging.frame import TraceError

RGBA = NDArray[np.uint8] | NDArray[np.uint16]
"""(h, w, 4) red, green, blue and alpha (not premultiplied), row 0 at the top."""

MAX_SIDE = 8000  # longest accepted side, in pixels

# Pillow's other formats start programs (EPS), are no pictures, or have no signature.
_FORMATS = (
    *("PNG", "JPEG", "GIF", "TIFF", "WEBP", "BMP", "AVIF", "JPEG2000"),
    *("ICO", "ICNS", "PPM", "PSD", "PCX", "QOI", "SGI"),
)
_TIFF_STARTS = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
_BITS_PER_SAMPLE, _ORIENTATION, _PROFILE = 258, 274, 34675  # TIFF tags
_GREY_BITS = {"1": 1, "L;2": 2, "L;4": 4, "L": 8}  # bits of grey PNGs, by Pillow's raw mode
# For each EXIF orientation: the signs of the steps down and across, and whether to transpose first.
_ORIENTED = {
    **{2: (1, -1, False), 3: (-1, -1, False), 4: (-1, 1, False), 5: (1, 1, True)},
    **{6: (1, -1, True), 7: (-1, -1, True), 8: (-1, 1, True)},
}


class ColorWarning(UserWarning):
    """A picture's colours or transparency may be read wrongly: its colour space cannot be used, so
    sRGB is taken, or Pillow has dropped what tells its transparent colour."""


@functools.cache
def formats() -> tuple[str, ...]:
    """Names of the formats that are read and that this Pillow knows (AVIF since 11.3)."""
    Image.init()
    return tuple(name for name in _FORMATS if name in Image.OPEN)


def opened(data: bytes, name: str) -> Image.Image | None:
    """Open a picture from a file's bytes, without decoding; None for a TIFF unknown to Pillow."""
    if not data:
        raise TraceError(f"{name} is empty")
    try:
        with warnings.catch_warnings():  # what Pillow finds too large, `check_size` refuses
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            return Image.open(io.BytesIO(data), formats=formats())
    except UnidentifiedImageError:
        if data.startswith(_TIFF_STARTS):
            return None
        advice = "not in a picture format that can be read; save it as PNG or JPEG first"
        if data.startswith(b"PK"):
            kind = "a session or another zip file"
            advice = f"{kind}; open a session with glid_nb.Editor(path=...)"
        raise TraceError(f"{name} is {advice}") from None


def unread_file(picture: Image.Image) -> bytes | None:
    """The file's bytes of an opened PNG or TIFF that is not decoded yet; None for others."""
    file = getattr(picture, "fp", None)
    fresh = isinstance(picture, PngImageFile | TiffImageFile) and picture.tile
    if not fresh or file is None or picture.tell() != 0:
        return None
    place = file.tell()
    file.seek(0)
    data = file.read()
    file.seek(place)
    return data


def picture_pixels(picture: Image.Image, data: bytes | None, name: str) -> NDArray[Any]:
    """(h, w) or (h, w, c) pixels of an opened picture, upright. They are RGBA unless the picture
    has more than 8 bit. ``data`` is the picture's file, or None if it is not known."""
    if 0 in picture.size:
        raise TraceError(f"{name} is empty: it has {picture.width} x {picture.height} pixels")
    check_size(*picture.size, name)  # before the pixels are decoded
    if data is not None and isinstance(picture, PngImageFile) and picture.tile:
        raw = str(picture.tile[0].args)
        if raw.endswith(";16B"):
            return _wide_png(picture, data, raw)
        _correct_key(picture, raw)
    if isinstance(picture, TiffImageFile) and picture.mode != "CMYK":
        bits = max(picture.tag_v2.get(_BITS_PER_SAMPLE, (8,)))
        if data is not None and bits > 8:
            return _wide_tiff(picture, data, name)
    picture = ImageOps.exif_transpose(picture)  # a copy
    if data is None:
        _doubt_key(picture, name)
    if picture.mode == "F" or picture.mode.startswith("I"):
        grey, key = np.asarray(picture), picture.info.get("transparency")
        return _keyed(grey[..., np.newaxis], key) if isinstance(key, int) else grey
    # Pillow drops the alpha of La, and makes LAB transparent.
    step = {"La": "LA", "LAB": "RGB", "HSV": "RGB"}.get(picture.mode)
    if step == "LA":
        return _straight_grey(picture)
    return np.array((picture.convert(step) if step else picture).convert("RGBA"))


def tiff_pixels(
    data: bytes, name: str, as_stored: bool = False
) -> tuple[NDArray[Any], bytes | None]:
    """Upright pixels and the ICC profile of a TIFF of any depth, decoded by tifffile.

    ``as_stored`` returns all samples unchanged, also samples that are no colours.
    """
    import tifffile  # noqa: PLC0415  (slow to import and seldom needed; scikit-image brings it)

    with tifffile.TiffFile(io.BytesIO(data)) as file:
        page: Any = file.pages.first
        check_size(page.imagewidth, page.imagelength, name)
        array = page.asarray()
        if page.axes == "SYX":
            array = np.moveaxis(array, 0, -1)
        if not as_stored:
            array = _as_colours(array, page, tifffile)
        orientation = page.tags.valueof(_ORIENTATION, 1)
        return _upright(array, orientation), page.tags.valueof(_PROFILE)


def eight_bit(rgba: RGBA) -> NDArray[np.uint8]:
    """Round pixels to 8 bit. Pixels of 8 bit are returned as they are."""
    if rgba.dtype == np.uint8:
        return rgba.view(np.uint8)
    return (rgba // 257 + (rgba % 257 > 128)).astype(np.uint8)


def check_size(width: int, height: int, name: str = "the image") -> None:
    """Raise a TraceError about ``name`` if a side is longer than `MAX_SIDE`."""
    if max(width, height) > MAX_SIDE:
        most = f"a side may have at most {MAX_SIDE}: scale it down first"
        raise TraceError(f"{name} is too large, {width} x {height} pixels; {most}")


def _wide_png(picture: Image.Image, data: bytes, raw: str) -> NDArray[np.uint16]:
    """The pixels of a 16-bit PNG. Alpha is added if one of its colours is transparent."""
    if raw == "LA;16B":  # four bytes, as RGBA has
        array = _decoded_as(data, "RGBA").view(">u2").astype(np.uint16)
    elif raw == "I;16B":
        array = np.asarray(ImageOps.exif_transpose(picture))[..., np.newaxis].astype(np.uint16)
    else:
        array = _both_bytes(data, raw)
    key = picture.info.get("transparency")
    if key is None or array.shape[2] not in (1, 3):
        return array
    return _keyed(array, key)


def _both_bytes(data: bytes, raw: str) -> NDArray[np.uint16]:
    """The 16-bit colours of a file that Pillow decodes in a raw mode such as "RGB;16B".

    Pillow keeps only the high byte of each colour. Decoding again with the other byte order gives
    the low byte.
    """
    mode, _, order = raw.partition(";16")
    if order == "N":
        order = sys.byteorder[0].upper()
    high = _decoded_as(data, f"{mode};16{order}").astype(np.uint16)
    high <<= 8
    high |= _decoded_as(data, f"{mode};16{'L' if order == 'B' else 'B'}")
    return high


def _decoded_as(data: bytes, raw: str) -> NDArray[np.uint8]:
    with Image.open(io.BytesIO(data), formats=formats()) as picture:
        tiles = []
        for tile in picture.tile:
            told: Any = tile.args
            args = raw if isinstance(told, str) else (raw, *told[1:])
            tiles.append(tile._replace(args=args))
        picture.tile = tiles
        return np.array(ImageOps.exif_transpose(picture))


def _correct_key(picture: Image.Image, raw: str) -> None:
    """Scale the transparent colour of a grey PNG in the same way as Pillow scales its pixels."""
    key = picture.info.get("transparency")
    if isinstance(key, tuple):
        picture.info["transparency"] = tuple(value & 255 for value in key)
    elif isinstance(key, int) and raw in _GREY_BITS:
        # With one bit, newer versions of Pillow give the key 255 instead of 1.
        most = (1 << _GREY_BITS[raw]) - 1
        picture.info["transparency"] = (key & most) * (255 // most)


def _doubt_key(picture: Image.Image, name: str) -> None:
    """Correct the transparent colour of a decoded PNG of 16-bit colours, or warn about one that may
    have had other bits: Pillow does not tell how many bits the file had."""
    key = picture.info.get("transparency")
    remedy = "pass the file's path, or the picture before it is decoded"
    if isinstance(key, tuple) and max(key) > 255:
        picture.info["transparency"] = tuple(value >> 8 for value in key)
        what = "was decoded to 8 bit, so more than one colour may be transparent"
        warnings.warn(f"{name} {what}; {remedy}", ColorWarning, stacklevel=2)
    elif isinstance(key, int) and picture.mode == "L" and key < 16:
        values = np.flatnonzero(picture.histogram())
        if key not in values and (values % 17 == 0).all():
            what = f"has the transparent grey {key}, but no pixel has it after decoding"
            warnings.warn(f"{name} {what}; {remedy}", ColorWarning, stacklevel=2)


def _keyed(array: NDArray[Any], key: int | tuple[int, ...]) -> NDArray[np.uint16]:
    """(h, w, c) pixels of 16 bit with alpha: transparent where they have the colour ``key``."""
    opaque = (array != np.array(key, np.uint16)).any(axis=2)
    return np.dstack([array, opaque * np.uint16(65535)]).astype(np.uint16, copy=False)


def _straight_grey(picture: Image.Image) -> NDArray[np.uint8]:
    """(h, w, 2) straight grey and alpha of a picture with premultiplied grey."""
    array = np.array(picture)
    grey, alpha = array[..., 0].astype(np.uint32), array[..., 1].astype(np.uint32)
    array[..., 0] = np.minimum((grey * 255 + alpha // 2) // np.maximum(alpha, 1), 255)
    return array


def _wide_tiff(picture: TiffImageFile, data: bytes, name: str) -> NDArray[Any]:
    """Decode a TIFF of more than 8 bit with tifffile. If tifffile lacks the compression, use
    Pillow."""
    try:
        return tiff_pixels(data, name)[0]
    except ValueError as error:
        if "imagecodecs" not in str(error):
            raise
    args: Any = picture.tile[0].args
    raw = args[0]
    if raw.startswith(("RGB;16", "RGBA;16")):
        return _both_bytes(data, raw)
    upright = ImageOps.exif_transpose(picture)
    return np.asarray(upright if upright.mode.startswith("I") else upright.convert("RGBA"))


def _as_colours(array: NDArray[Any], page: Any, tifffile: Any) -> NDArray[Any]:
    """Convert a page's pixels so that white is the largest value and alpha is straight."""
    if page.photometric == tifffile.PHOTOMETRIC.MINISWHITE and array.dtype.kind == "u":
        colour = array if array.ndim == 2 else array[..., :1]
        np.subtract(np.iinfo(array.dtype).max, colour, out=colour)
    return _with_alpha(array, page, tifffile)


def _with_alpha(array: NDArray[Any], page: Any, tifffile: Any) -> NDArray[Any]:
    """Drop a page's samples that are neither colour nor alpha, and make alpha straight."""
    if array.ndim != 3 or not page.extrasamples:
        return array
    colours = array.shape[2] - len(page.extrasamples)
    kind = page.extrasamples[0]
    if kind == tifffile.EXTRASAMPLE.UNSPECIFIED:
        return array[..., :colours]
    array = array[..., : colours + 1]
    if kind == tifffile.EXTRASAMPLE.ASSOCALPHA:
        full = np.iinfo(array.dtype).max if array.dtype.kind == "u" else 1
        alpha = array[..., -1:].astype(np.float64)
        straight = array[..., :-1] * (full / np.where(alpha > 0, alpha, full))
        straight = np.minimum(np.rint(straight) if full > 1 else straight, full)
        array = np.concatenate([straight.astype(array.dtype), array[..., -1:]], axis=2)
    return array


def _upright(array: NDArray[Any], orientation: int) -> NDArray[Any]:
    down, across, transposed = _ORIENTED.get(orientation, (1, 1, False))
    array = array.swapaxes(0, 1) if transposed else array
    return array[::down, ::across]
