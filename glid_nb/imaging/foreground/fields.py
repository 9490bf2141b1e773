"""Fields that the methods measure: alpha, brightness, distance from a colour."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb.imaging.errors import TraceError
from glid_nb.imaging.read import as_rgba8

_LEAST_SHARE = 0.001  # of transparent or opaque pixels; fewer are a speck
_WEIGHTS = (0.2125, 0.7154, 0.0721)  # of red, green and blue, as in skimage.color.rgb2gray
_ROWS = 64  # rows per block, which fit the cache and bound the memory
_WALKED_PIXELS = 40_000  # of the random walker, which takes a quarter of a second for them


def alpha(image: NDArray[np.unsignedinteger]) -> NDArray[np.float32]:
    """(h, w) alpha in [0, 1]."""
    return image[..., 3] * np.float32(1 / np.iinfo(image.dtype).max)


def is_opaque(image: NDArray[np.unsignedinteger]) -> bool:
    return bool(image[..., 3].min() == np.iinfo(image.dtype).max)


def alpha_is_informative(image: NDArray[np.unsignedinteger]) -> bool:
    """Whether more than a speck is transparent and more than a speck is opaque."""
    transparent = np.count_nonzero(image[..., 3] < np.iinfo(image.dtype).max / 2)
    total = image.shape[0] * image.shape[1]
    return _LEAST_SHARE < transparent / total < 1 - _LEAST_SHARE


def check_alpha(image: NDArray[np.unsignedinteger]) -> None:
    """Raise a TraceError if alpha is constant."""
    low, high = image[..., 3].min(), image[..., 3].max()
    if low == high == 0:
        raise TraceError("the image has no foreground: it is fully transparent")
    if low == high:
        raise TraceError(
            "the foreground covers the whole image: its alpha channel is "
            f"{low / np.iinfo(image.dtype).max:.3g} everywhere; use method='color', 'threshold' or "
            "'scribbles'",
            "The picture is equally transparent everywhere; choose Colour or Brightness, or paint "
            "over the shape with Scribbles",
        )


def brightness(image: NDArray[np.unsignedinteger]) -> NDArray[np.float32]:
    """(h, w) brightness in [0, 1]."""
    weights = np.array([*_WEIGHTS, 0], dtype=np.float32) / np.iinfo(image.dtype).max
    result = np.empty(image.shape[:2], dtype=np.float32)
    for rows in _row_blocks(image):
        np.matmul(image[rows].astype(np.float32), weights, out=result[rows])
    return np.clip(result, 0, 1, out=result)


def color_distance(
    image: NDArray[np.unsignedinteger], color: tuple[float, float, float]
) -> NDArray[np.float32]:
    """(h, w) Euclidean distance from a colour in sRGB, over sqrt(3): black to white is 1.

    It is linear along an anti-aliased edge, so the edge is found with sub-pixel accuracy, and sixty
    times as fast to compute as a perceptual distance in CIELAB.
    """
    scale = np.float32(1 / (np.iinfo(image.dtype).max * np.sqrt(3)))
    centre = np.array(color, dtype=np.float32) * np.float32(1 / np.sqrt(3))
    result = np.zeros(image.shape[:2], dtype=np.float32)
    for rows in _row_blocks(image):
        total = result[rows]
        for channel in range(3):
            difference = image[rows, :, channel] * scale
            difference -= centre[channel]
            difference *= difference
            total += difference
        np.sqrt(total, out=total)
    return np.minimum(result, 1, out=result)


def scaled_picture(image: NDArray[np.unsignedinteger]) -> NDArray[np.float64]:
    """The picture scaled down to 40,000 pixels, for scribbles.

    (h, w, 3) in [0, 1]; (h, w, 4) with premultiplied colours where alpha varies.
    """
    height, width = image.shape[:2]
    scale = min(1.0, np.sqrt(_WALKED_PIXELS / (height * width)))
    small = Image.fromarray(as_rgba8(image))
    if scale < 1:
        size = max(1, round(width * scale)), max(1, round(height * scale))
        small = small.resize(size, Image.Resampling.BOX)
    data = np.asarray(small, dtype=np.float64) / 255
    data[..., :3] *= data[..., 3:]
    if data[..., 3].min() == data[..., 3].max():  # it would weaken the contrast of the colours
        data = data[..., :3]
    return data


def _row_blocks(image: NDArray[np.unsignedinteger]) -> Iterator[slice]:
    return (slice(start, start + _ROWS) for start in range(0, len(image), _ROWS))
