"""A picture as a texture of the graphics card."""

from __future__ import annotations

from typing import Any

import numpy as np
import pythreejs as three
from numpy.typing import NDArray
from PIL import Image

LARGEST_SIDE = 2048
"""Pixels of a texture's side at most; every graphics card can hold it."""


def picture_texture(image: NDArray[np.uint8]) -> Any:
    """A texture of a picture (h, w, 4), premultiplied by alpha.

    Its sides are powers of two, which WebGL 1 asks for where a texture is to look well when it is
    seen small.
    """
    width, height = (min(_power_of_two(n), LARGEST_SIDE) for n in (image.shape[1], image.shape[0]))
    premultiplied = Image.fromarray(image).convert("RGBa")
    resized = premultiplied.resize((width, height), Image.Resampling.BICUBIC)
    # The bytes are those of RGBa; a DataTexture begins at the bottom.
    pixels = np.frombuffer(resized.tobytes(), dtype=np.uint8).reshape(height, width, 4)
    return three.DataTexture(
        data=np.ascontiguousarray(pixels[::-1]),
        format="RGBAFormat",
        type="UnsignedByteType",
        minFilter="LinearMipMapLinearFilter",
        magFilter="LinearFilter",
        generateMipmaps=True,
        anisotropy=4,
    )


def _power_of_two(n: int) -> int:
    return 1 << max(n - 1, 1).bit_length()
