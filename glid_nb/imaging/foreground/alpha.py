"""Foreground by the alpha channel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from glid_nb.imaging.errors import TraceError

_LEAST_SHARE = 0.001


def alpha_score(image: NDArray[np.unsignedinteger]) -> NDArray[np.float32]:
    """(h, w) alpha in [0, 1]."""
    return image[..., 3] * np.float32(1 / np.iinfo(image.dtype).max)


def is_informative(image: NDArray[np.unsignedinteger]) -> bool:
    """Whether more than a speck is transparent, and more than a speck is not."""
    transparent = np.count_nonzero(image[..., 3] < np.iinfo(image.dtype).max / 2)
    total = image.shape[0] * image.shape[1]
    return _LEAST_SHARE < transparent / total < 1 - _LEAST_SHARE


def is_opaque(image: NDArray[np.unsignedinteger]) -> bool:
    """Whether alpha is 1 everywhere."""
    return bool(image[..., 3].min() == np.iinfo(image.dtype).max)


def check_alpha(image: NDArray[np.unsignedinteger]) -> None:
    """Raise where alpha is the same everywhere."""
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
