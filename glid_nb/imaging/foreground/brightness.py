"""Foreground by a threshold on the brightness."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from glid_nb.imaging.foreground.alpha import alpha_score, is_opaque
from glid_nb.imaging.foreground.border import border_pixels

_WEIGHTS = (0.2125, 0.7154, 0.0721)  # of red, green and blue, as in skimage.color.rgb2gray
_ROWS = 64


def brightness(image: NDArray[np.unsignedinteger]) -> NDArray[np.float32]:
    """(h, w) brightness in [0, 1]."""
    weights = np.array([*_WEIGHTS, 0], dtype=np.float32) / np.iinfo(image.dtype).max
    result = np.empty(image.shape[:2], dtype=np.float32)
    for start in range(0, len(image), _ROWS):  # by rows: fits the cache and bounds the memory
        rows = slice(start, start + _ROWS)
        np.matmul(image[rows].astype(np.float32), weights, out=result[rows])
    return np.clip(result, 0, 1, out=result)


def border_is_bright(
    image: NDArray[np.unsignedinteger], values: NDArray[np.float32], threshold: float
) -> bool:
    """Whether most of the picture's border, where it is not transparent, is above the threshold.

    True for a transparent border: then dark ink on nothing is the likely picture.
    """
    border = border_pixels(values)[border_pixels(image[..., 3]) > 0]
    return not border.size or float(np.mean(border > threshold)) >= 0.5


def brightness_score(
    image: NDArray[np.unsignedinteger], values: NDArray[np.float32], inverted: bool
) -> NDArray[np.float32]:
    """The brightness, or 1 minus it; what is transparent counts as background either way."""
    score = 1 - values if inverted else values
    return score if is_opaque(image) else score * alpha_score(image)
