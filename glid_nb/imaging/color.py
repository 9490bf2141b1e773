"""Convert colours from the colour space that a file declares to sRGB.

A file can declare its colour space by an embedded ICC profile, which LittleCMS converts
(`PIL.ImageCms`, in 8 bit). A PNG can also declare it by its chunks cICP, sRGB, gAMA and cHRM. In a
PNG the first of cICP, iCCP, sRGB and gAMA counts (PNG specification, third edition, section 4.3).
A file that declares nothing is sRGB.
"""

import io
import struct
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageCms, ImageOps
from PIL.PngImagePlugin import PngImageFile

from glid_nb.imaging.decode import RGBA, ColorWarning, eight_bit

_ROWS = 256  # converted at a time, to bound the memory
_SRGB_GAMMA = 1 / 2.2  # the value in the gAMA chunk of an sRGB picture
_SAME = 2e-3  # primaries and exponents this close count as equal, because files round them
_STEPS = 9  # levels of each channel in the test whether a profile changes anything

_D65 = (0.3127, 0.3290)
_SRGB = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06)
_PRIMARIES = {  # white, red, green, blue of each code point of ITU-T H.273, which cICP uses
    1: (*_D65, *_SRGB),
    5: (*_D65, 0.64, 0.33, 0.29, 0.60, 0.15, 0.06),
    6: (*_D65, 0.630, 0.340, 0.310, 0.595, 0.155, 0.070),
    7: (*_D65, 0.630, 0.340, 0.310, 0.595, 0.155, 0.070),
    9: (*_D65, 0.708, 0.292, 0.170, 0.797, 0.131, 0.046),
    11: (0.314, 0.351, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060),
    12: (*_D65, 0.680, 0.320, 0.265, 0.690, 0.150, 0.060),
}
_BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)

Curve = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def _srgb_curve(value: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light of encoded values in [0, 1] (IEC 61966-2-1)."""
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def _bt709_curve(value: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light of encoded values in [0, 1] (ITU-R BT.709)."""
    return np.where(value < 0.081, value / 4.5, ((value + 0.099) / 1.099) ** (1 / 0.45))


def _power(exponent: float) -> Curve:
    return lambda value: value**exponent


_CURVES: dict[int, Curve] = {  # by the code points of ITU-T H.273
    **dict.fromkeys((1, 6, 14, 15), _bt709_curve),
    **{4: _power(2.2), 5: _power(2.8), 8: _power(1.0), 13: _srgb_curve},
}


@dataclass(frozen=True)
class ColorSpace:
    """The colour space of a file: an ICC profile, or primaries and a curve; sRGB by default."""

    profile: bytes | None = None
    primaries: tuple[float, ...] = _PRIMARIES[1]  # x and y of white, red, green and blue
    curve: Curve = _srgb_curve
    unknown: str = ""  # a declaration that cannot be used, as a clause of a sentence

    @classmethod
    def of(cls, picture: Image.Image, data: bytes | None = None) -> Self:
        """The space of an opened picture. ``data`` is its file; without it, the cICP chunk of a PNG
        is not read."""
        told = picture.info
        if data is not None and isinstance(picture, PngImageFile):
            code = next((body for kind, body in _png_chunks(data) if kind == b"cICP"), None)
            if code is not None and len(code) == 4:
                return cls._of_code(*code)
        if profile := told.get("icc_profile"):
            return cls(profile)
        gamma = told.get("gamma")
        if told.get("srgb") is not None or not gamma or not np.isfinite(gamma):
            return cls()
        primaries = tuple(told.get("chromaticity") or _PRIMARIES[1])
        if np.abs(np.subtract(primaries, _PRIMARIES[1])).max() < _SAME:
            primaries = _PRIMARIES[1]
        curve = _srgb_curve if abs(gamma - _SRGB_GAMMA) < _SAME else _power(1 / gamma)
        return cls(primaries=primaries, curve=curve)

    @classmethod
    def _of_code(cls, primaries: int, curve: int, matrix: int, full_range: int) -> Self:
        """The space of a cICP chunk's four code points."""
        if primaries not in _PRIMARIES or curve not in _CURVES or matrix or full_range != 1:
            codes = f"cICP {primaries}, {curve}, {matrix}, {full_range}"
            return cls(unknown=f"its colour space ({codes}) is not known")
        return cls(primaries=_PRIMARIES[primaries], curve=_CURVES[curve])


def in_srgb(pixels: RGBA, space: ColorSpace, name: str) -> RGBA:
    """Convert pixels (h, w, 4) from a space to sRGB. If a profile changes them, to 8 bit."""
    if space.unknown:
        _warn(name, space.unknown)
    if space.profile is not None:
        return _by_profile(pixels, space.profile, name)
    if space.primaries == _PRIMARIES[1] and space.curve is _srgb_curve:
        return pixels
    matrix = _matrix_to_srgb(space.primaries)
    if matrix is None:
        _warn(name, "its primaries (cHRM) do not form a triangle around its white point")
        return pixels
    full = np.iinfo(pixels.dtype).max
    linear = space.curve(np.arange(full + 1) / full).astype(np.float32)
    result = pixels.copy()
    for top in range(0, len(pixels), _ROWS):
        light = linear[pixels[top : top + _ROWS, :, :3]] @ matrix.T
        np.clip(light, 0, 1, out=light)
        curved = 1.055 * light ** np.float32(1 / 2.4) - 0.055
        encoded = np.where(light <= 0.0031308, 12.92 * light, curved)
        result[top : top + _ROWS, :, :3] = np.rint(encoded * full)
    return result


def cmyk_in_srgb(picture: Image.Image, space: ColorSpace, name: str) -> RGBA | None:
    """Convert a CMYK picture by its profile; None if it has no usable profile."""
    if space.profile is None:
        return None
    transform = _transform_of(space.profile, "CMYK", "RGB", name)
    if transform is None:
        return None
    converted = ImageCms.applyTransform(ImageOps.exif_transpose(picture), transform)
    assert converted is not None
    return np.array(converted.convert("RGBA"))


def _by_profile(pixels: RGBA, data: bytes, name: str) -> RGBA:
    grey = data[16:20] == b"GRAY"  # the profile's device colour space
    modes = ("L", "RGB") if grey else ("RGBA", "RGBA")
    transform = _transform_of(data, *modes, name)
    if transform is None:
        return pixels
    if grey and (pixels[..., :2] != pixels[..., 1:3]).any():
        _warn(name, "its colour profile is for grey pictures")
        return pixels
    if _changes_nothing(transform, grey):
        return pixels
    pixels = eight_bit(pixels)
    result = pixels.copy()
    for top in range(0, len(pixels), _ROWS):
        band = pixels[top : top + _ROWS]
        given = Image.fromarray(np.ascontiguousarray(band[..., 0] if grey else band))
        converted = ImageCms.applyTransform(given, transform)
        result[top : top + _ROWS, :, :3] = np.asarray(converted)[..., :3]
    return result


def _transform_of(data: bytes, mode: str, wanted: str, name: str) -> Any:
    """LittleCMS's transform from a profile to sRGB; None, with a warning, if it has none."""
    try:
        profile = ImageCms.ImageCmsProfile(io.BytesIO(data))
        srgb: Any = ImageCms.createProfile("sRGB")
        return ImageCms.buildTransform(profile, srgb, mode, wanted)
    except (OSError, ImageCms.PyCMSError) as error:
        _warn(name, f"its colour profile cannot be used ({error})")
        return None


def _changes_nothing(transform: Any, grey: bool) -> bool:
    """Whether a transform to sRGB changes nothing. Then pixels are kept bit for bit."""
    if grey:
        given = np.arange(256, dtype=np.uint8)[np.newaxis]
        before = given[..., np.newaxis]
    else:
        levels = np.linspace(0, 255, _STEPS).astype(np.uint8)
        before = np.stack(np.meshgrid(levels, levels, levels), axis=-1).reshape(1, -1, 3)
        given = np.dstack([before, np.full(before.shape[:2], 255, np.uint8)])
    after = np.asarray(ImageCms.applyTransform(Image.fromarray(given), transform))[..., :3]
    return bool(np.abs(after.astype(int) - before).max() <= 1)


def _matrix_to_srgb(primaries: tuple[float, ...]) -> NDArray[np.float32] | None:
    """(3, 3) from linear RGB to linear sRGB, with whites adapted by Bradford's method; None for
    primaries that form no triangle around white."""
    ours = _matrix_to_xyz(_PRIMARIES[1])
    theirs = _matrix_to_xyz(primaries)
    if ours is None or theirs is None:
        return None
    white, wanted = _BRADFORD @ theirs.sum(axis=1), _BRADFORD @ ours.sum(axis=1)
    adapted = np.linalg.solve(_BRADFORD, np.diag(wanted / white) @ _BRADFORD)
    return np.linalg.solve(ours, adapted @ theirs).astype(np.float32)


def _matrix_to_xyz(primaries: tuple[float, ...]) -> NDArray[np.float64] | None:
    """(3, 3) from linear RGB to CIE XYZ, where white has Y = 1."""
    x, y = np.reshape(primaries, (4, 2)).T
    if (y <= 0).any():
        return None
    columns = np.stack([x / y, np.ones(4), (1 - x - y) / y])
    if abs(np.linalg.det(columns[:, 1:])) < 1e-6:
        return None
    strength = np.linalg.solve(columns[:, 1:], columns[:, 0])
    return columns[:, 1:] * strength if (strength > 0).all() else None


def _png_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """The kinds and contents of a PNG's chunks before its pixels."""
    place = 8
    while place + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, place)
        if kind == b"IDAT":
            return
        yield kind, data[place + 8 : place + 8 + length]
        place += length + 12


def _warn(name: str, what: str) -> None:
    text = f"{name}: {what}; its colours are taken as sRGB"
    warnings.warn(text, ColorWarning, stacklevel=2)
