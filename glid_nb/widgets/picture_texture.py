"""A picture as a texture of the graphics card."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pythreejs as three
from numpy.typing import NDArray
from PIL import Image

LARGEST_SIDE = 2048
"""Pixels of a texture's side at most; every graphics card can hold it."""


def picture_texture(image: NDArray[np.uint8]) -> Any:
    """A texture of a picture (h, w, 4), premultiplied by alpha.

    Its sides are powers of two, the nearest ones: three.js asks for that where a texture is to look
    well when it is seen small.
    """
    size = (_nearest_power_of_two(image.shape[1]), _nearest_power_of_two(image.shape[0]))
    picture = Image.fromarray(image).convert("RGBa").resize(size, Image.Resampling.BICUBIC)
    # The bytes are those of RGBa; a DataTexture begins at the bottom.
    pixels = np.frombuffer(picture.tobytes(), dtype=np.uint8).reshape(size[1], size[0], 4)
    return three.DataTexture(
        data=np.ascontiguousarray(pixels[::-1]),
        format="RGBAFormat",
        type="UnsignedByteType",
        minFilter="LinearMipMapLinearFilter",
        magFilter="LinearFilter",
        generateMipmaps=True,
        anisotropy=4,
    )


def _nearest_power_of_two(n: int) -> int:
    return min(1 << round(math.log2(n)), LARGEST_SIDE)
